"""The sea trial as the peers see it: read from the same model file, in SI, with its motions.

Every number comes from examples/sea-trial-1km.toml; nothing of the system is written down here a
second time. Axes: x and y horizontal, z up, origin in the mean sea surface below the ship.
"""

import json
import math
import re
import tomllib
from dataclasses import dataclass

import numpy as np
from scipy.optimize import fsolve

FACTORS = {
    "": 1.0, "m": 1.0, "s": 1.0, "kg": 1.0, "t": 1e3, "N": 1.0, "kN": 1e3, "MN": 1e6, "GPa": 1e9,
    "deg": math.pi / 180, "m/s": 1.0, "m/s^2": 1.0, "kg/m": 1.0, "kg/m^3": 1.0, "m^2": 1.0,
    "kN m^2": 1e3,
}


def si(value):
    """A number in SI: bare numbers are SI already, strings carry a unit."""
    if isinstance(value, (int, float)):
        return float(value)
    number, unit = re.fullmatch(r"\s*([-+.\deE]+)\s*(.*?)\s*", value).groups()
    return float(number) * FACTORS[unit]


def overlaid(base, change):
    """A table with the values of another laid over it."""
    result = dict(base)
    for key, value in change.items():
        both = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = overlaid(result[key], value) if both else value
    return result


@dataclass
class Section:
    """A line's cross section, per metre."""
    diameter: float
    mass: float
    axial_stiffness: float
    bending_stiffness: float
    damping_time: float
    normal_drag: float
    axial_drag: float
    normal_added_mass: float

    @classmethod
    def of(cls, table):
        outer = si(table["outer_diameter"])
        if table["kind"] == "pipe":
            inner = si(table["inner_diameter"])
            steel = math.pi / 4 * (outer**2 - inner**2)
            modulus = si(table["youngs_modulus"])
            mass = (si(table["density"]) * steel
                    + si(table["content_density"]) * math.pi / 4 * inner**2)
            axial = modulus * steel
            bending = modulus * math.pi / 64 * (outer**4 - inner**4)
        else:
            mass = si(table["mass"])
            axial, bending = si(table["axial_stiffness"]), si(table["bending_stiffness"])
        assert table["axial_added_mass"] == 0
        return cls(outer, mass, axial, bending, si(table.get("structural_damping", 0.0)),
                   table["normal_drag"], table["axial_drag"], table["normal_added_mass"])

    @property
    def area(self):
        return math.pi / 4 * self.diameter**2


@dataclass
class Float:
    """A lump on the hose."""
    at: float
    lift: float
    mass: float
    added_mass: float
    drag_area: float


class SeaTrial:
    """One load case."""

    def __init__(self, file, case):
        with open(file, "rb") as stream:
            study = tomllib.load(stream)
        table = overlaid(study, study["cases"][case])
        self.gravity = si(table["environment"]["gravity"])
        self.density = si(table["environment"]["water"]["density"])
        current = table["environment"]["current"]
        heading = si(current["heading"])
        self.current_direction = np.array([math.cos(heading), math.sin(heading)])
        self.profile = [(si(p["depth"]), si(p["speed"])) for p in current["profile"]]
        self.pipe = Section.of(table["line_types"]["lift_pipe"])
        self.hose = Section.of(table["line_types"]["hose"])
        lines = table["lines"]
        self.pipe_length = si(lines["lift_pipe"]["sections"][0]["length"])
        self.hose_length = si(lines["hose"]["sections"][0]["length"])
        attachments = sorted(lines["hose"]["attachments"].values(), key=lambda f: si(f["at"]))
        self.floats = [Float(si(f["at"]), si(f["net_lift"]), si(f["mass"]), si(f["added_mass"]),
                             si(f["drag_area"])) for f in attachments]
        self.buffer = {key: si(value) for key, value in table["bodies"]["buffer"].items()}
        assert self.buffer["axial_added_mass"] == 0
        self.miner = np.array([si(x) for x in table["vessels"]["miner"]["position"]])
        tow, heave = table["motions"]["tow"], table["motions"]["heave"]
        self.speed, self.speed_ramp = si(tow["speed"]), si(tow["ramp"])
        self.heave, self.period = si(heave["amplitude"]), si(heave["period"])
        self.heave_ramp = si(heave["ramp"])
        self.duration = si(table["dynamics"]["duration"])
        self.window = si(table["dynamics"]["statistics_window"])

    def wet_weight(self, section):
        """Weight in water per metre [N/m]."""
        return (section.mass - self.density * section.area) * self.gravity

    def current_speed(self, depth):
        """Speed of the current [m/s]."""
        return float(np.interp(depth, *zip(*self.profile)))

    def tow(self, t):
        """Path, speed and acceleration of the tow in x."""
        u = min(max(t / self.speed_ramp, 0.0), 1.0)
        path = self.speed * (self.speed_ramp * (2.5 * u**4 - 3 * u**5 + u**6)
                             + max(t - self.speed_ramp, 0.0))
        acceleration = self.speed / self.speed_ramp * 30 * u**2 * (1 - u)**2
        return path, self.speed * smooth(u), acceleration

    def heave_motion(self, t):
        """Height, speed and acceleration of the ship's heave."""
        u, rate = min(max(t / self.heave_ramp, 0.0), 1.0), 1 / self.heave_ramp
        omega = 2 * math.pi / self.period
        s, s1, s2 = smooth(u), 30 * u**2 * (1 - u)**2 * rate, 60 * u * (1 - u) * (1 - 2 * u) * rate**2
        sin, cos = math.sin(omega * t), math.cos(omega * t)
        return (self.heave * s * sin, self.heave * (s1 * sin + s * omega * cos),
                self.heave * (s2 * sin + 2 * s1 * omega * cos - s * omega**2 * sin))

    def hose_parts(self, elements):
        """Lengths of the hose between floats, and elements in each."""
        ends = [0.0] + [f.at for f in self.floats] + [self.hose_length]
        lengths = np.diff(ends)
        counts = [max(1, round(elements * l / self.hose_length)) for l in lengths[:-1]]
        counts.append(max(1, elements - sum(counts)))
        return list(lengths), counts

    def hanging_chain(self, pipe_elements, hose_elements):
        """Still-water shape of the elastic chain without bending, in the plane y = 0.

        Positions (x, z) of the nodes from the ship over the buffer's two ends to the miner. The
        buffer hangs as one stiff segment. A first shape for the peers' own statics.
        """
        lengths, counts = self.hose_parts(hose_elements)
        l_buffer, w_buffer = self.buffer["length"], self.buffer["wet_weight"]
        pipe, hose = self.pipe, self.hose
        # Segments from the miner upwards: length, stiffness, weight; and the load at the upper node.
        segments = []
        for k in reversed(range(len(counts))):
            length = lengths[k] / counts[k]
            weight = self.wet_weight(hose) * length
            loads = [0.0] * (counts[k] - 1) + [-self.floats[k - 1].lift if k else 0.0]
            segments += [(length, hose.axial_stiffness, weight, load) for load in loads]
        segments.append((l_buffer, pipe.axial_stiffness, w_buffer, 0.0))
        length = self.pipe_length / pipe_elements
        weight = self.wet_weight(pipe) * length
        segments += [(length, pipe.axial_stiffness, weight, 0.0)] * pipe_elements

        def march(force):
            tension, position = np.array(force, float), self.miner[[0, 2]]
            nodes = [position]
            for length, stiffness, weight, load in segments:
                pull = tension + [0.0, 0.5 * weight]
                size = math.hypot(*pull)
                position = position + length * (1 + size / stiffness) * pull / size
                tension = tension + [0.0, weight + load]
                nodes.append(position)
            return np.array(nodes)

        guess = (0.3 * 1e4, 1e4)
        for start in [(6e3, 1.9e4), guess, (1e4, 2e4)]:
            force, _, success, _ = fsolve(lambda f: march(f)[-1], start, full_output=True)
            if success == 1:
                return march(force)[::-1]
        raise RuntimeError("no equilibrium of the chain without bending")


def smooth(u):
    """Quintic from 0 to 1 with level ends."""
    return u**3 * (10 - 15 * u + 6 * u**2)


def report(trial, times, offset, top, hose, **facts):
    """Prints the compared results: one JSON document on one line.

    offset: (n x 2) [m] of the buffer's centre from the ship; top: (n) [N] size of the force of the
    pipe on the ship; hose: (n x 3) [N] force of the hose on the miner.
    """
    start = times[-1] - trial.window

    def mean(values):
        inside = times > start - 1e-9
        return float(np.trapezoid(values[inside], times[inside]) / np.ptp(times[inside]))

    facts["outcome"] = {
        "offset_m": [mean(offset[:, k]) for k in range(2)],
        "top_n": [float(top.min()), float(top.max())],
        "hose_n": [mean(hose[:, k]) for k in range(3)],
    }
    print(json.dumps(facts), flush=True)
