"""One case of the sea trial in EXUDYN, with its ANCF cable elements and generalised-alpha.

    python run_exudyn.py MODEL CASE PIPE_ELEMENTS HOSE_ELEMENTS STEP

Prints one line of JSON: processor time of the solver's call for the motion alone, and results.

EXUDYN knows no water. Wet weight, drag and lumped added mass are one generic object over all nodes,
whose functions are compiled with numba; its matrices are rough, as Newton's method needs no more.
The buffer is one stiff element that shares its slope with the pipe; the hose is hinged to it and at
the floats, since a cubic element of metres cannot follow the short bends there.
"""

import json
import math
import os
import sys
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import exudyn as exu
import numba
import numpy as np
from exudyn.utilities import (
    CoordinateConstraint, MarkerNodeCoordinate, NodePointGround, NodePointSlope1,
    ObjectANCFCable, ObjectGenericODE2, SensorNode, SensorObject)

from sea_trial import SeaTrial, report

SPECTRAL_RADIUS = 0.8
# Strain-rate damping of the pipe, over its stiffness [s]: the fast axial waves need some.
PIPE_DAMPING = 5e-4
# Bending stiffness of the buffer over that of the pipe.
BUFFER_STIFFNESS = 100.0
# Gauss points and weights on 0 .. 1.
POINTS = 0.5 + np.array([-1.0, 0.0, 1.0]) * math.sqrt(0.15)
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18


@numba.njit(cache=True)
def water_speed(z, depths, speeds):
    return np.interp(-z, depths, speeds)


@numba.njit(cache=True)
def add_loads(place, rate, pairs, lengths, weight, normal, axial, lumps, lump_weight, lump_drag,
              depths, speeds, flow, points, weights, out):
    """Wet weight and drag of all elements and lumps, added to the generalised forces (n x 6)."""
    shape, slope = np.zeros(4), np.zeros(4)
    for e in range(lengths.size):
        i, j, l = pairs[e, 0], pairs[e, 1], lengths[e]
        for g in range(points.size):
            s = points[g]
            shape[0], shape[1] = 1 - 3*s*s + 2*s**3, l*(s - 2*s*s + s**3)
            shape[2], shape[3] = 3*s*s - 2*s**3, l*(s**3 - s*s)
            slope[0], slope[1] = 6*(s*s - s), l*(1 - 4*s + 3*s*s)
            slope[2], slope[3] = -slope[0], l*(3*s*s - 2*s)
            axis, water = np.zeros(3), np.zeros(3)
            z = 0.0
            for c in range(3):
                axis[c] = (slope[0]*place[i, c] + slope[1]*place[i, 3 + c]
                           + slope[2]*place[j, c] + slope[3]*place[j, 3 + c])
                water[c] = -(shape[0]*rate[i, c] + shape[1]*rate[i, 3 + c]
                             + shape[2]*rate[j, c] + shape[3]*rate[j, 3 + c])
            z = (shape[0]*place[i, 2] + shape[1]*place[i, 5]
                 + shape[2]*place[j, 2] + shape[3]*place[j, 5])
            axis /= math.sqrt(axis[0]**2 + axis[1]**2 + axis[2]**2)
            speed = water_speed(z, depths, speeds)
            water[0] += speed * flow[0]
            water[1] += speed * flow[1]
            along = water[0]*axis[0] + water[1]*axis[1] + water[2]*axis[2]
            across = 0.0
            for c in range(3):
                across += (water[c] - along*axis[c])**2
            across = math.sqrt(across)
            for c in range(3):
                force = (normal[e]*across*(water[c] - along*axis[c])
                         + axial[e]*abs(along)*along*axis[c])
                if c == 2:
                    force -= weight[e]
                force *= weights[g] * l
                out[i, c] += shape[0]*force
                out[i, 3 + c] += shape[1]*force
                out[j, c] += shape[2]*force
                out[j, 3 + c] += shape[3]*force
    for k in range(lumps.size):
        n = lumps[k]
        speed = water_speed(place[n, 2], depths, speeds)
        x, y, z = speed*flow[0] - rate[n, 0], speed*flow[1] - rate[n, 1], -rate[n, 2]
        drag = lump_drag[k] * math.sqrt(x*x + y*y + z*z)
        out[n, 0] += drag*x
        out[n, 1] += drag*y
        out[n, 2] += drag*z - lump_weight[k]


@numba.njit(cache=True)
def add_matrices(place, rate, pairs, lengths, added, normal, axial, lumps, lump_added, lump_drag,
                 depths, speeds, flow, mass, damping):
    """Added mass and the derivative of drag by velocity, lumped at the nodes (n x 3 x 3)."""
    for e in range(lengths.size):
        i, j, half = pairs[e, 0], pairs[e, 1], 0.5*lengths[e]
        axis = place[j, :3] - place[i, :3]
        axis = axis / math.sqrt(axis[0]**2 + axis[1]**2 + axis[2]**2)
        for n in (i, j):
            speed = water_speed(place[n, 2], depths, speeds)
            water = np.array([speed*flow[0], speed*flow[1], 0.0]) - rate[n, :3]
            along = water[0]*axis[0] + water[1]*axis[1] + water[2]*axis[2]
            across = water - along*axis
            size = math.sqrt(across[0]**2 + across[1]**2 + across[2]**2) + 1e-9
            for a in range(3):
                for b in range(3):
                    project = (1.0 if a == b else 0.0) - axis[a]*axis[b]
                    mass[n, a, b] += half*added[e]*project
                    damping[n, a, b] += half*(
                        normal[e]*(size*project + across[a]*across[b]/size)
                        + 2*axial[e]*abs(along)*axis[a]*axis[b])
    for k in range(lumps.size):
        n = lumps[k]
        speed = water_speed(place[n, 2], depths, speeds)
        water = np.array([speed*flow[0], speed*flow[1], 0.0]) - rate[n, :3]
        size = math.sqrt(water[0]**2 + water[1]**2 + water[2]**2) + 1e-9
        for a in range(3):
            mass[n, a, a] += lump_added[k]
            for b in range(3):
                same = size if a == b else 0.0
                damping[n, a, b] += lump_drag[k]*(same + water[a]*water[b]/size)


class Cable:
    """The system in EXUDYN."""

    def __init__(self, trial, pipe_elements, hose_elements):
        self.trial = trial
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.moving = False
        self.place, self.nodes, self.pairs, self.lengths = [], [], [], []
        self.coefficients = {"weight": [], "normal": [], "axial": [], "added": []}
        self.hinges = []
        shape = trial.hanging_chain(pipe_elements, hose_elements)
        lengths, counts = trial.hose_parts(hose_elements)
        pipe = [trial.pipe_length / pipe_elements] * pipe_elements
        buffer_length = trial.buffer["length"]
        first = 0
        self.add_run(shape[:pipe_elements + 2], pipe + [buffer_length], pipe_elements)
        first = pipe_elements + 1
        for length, count in zip(lengths, counts):
            self.hinges.append((len(self.nodes) - 1, len(self.nodes)))
            self.add_run(shape[first:first + count + 1], [length / count] * count, None)
            first += count
        self.buffer_nodes = (pipe_elements, pipe_elements + 1)
        self.arrays()
        self.add_constraints()
        self.add_water()
        self.mbs.Assemble()

    def add_run(self, shape, lengths, pipe_elements):
        """Elements in a row that share slopes; the last one of the pipe's run is the buffer."""
        trial, start = self.trial, len(self.nodes)
        points = np.c_[shape[:, 0], 0 * shape[:, 0], shape[:, 1]]
        chords = np.diff(points, axis=0)
        chords /= np.linalg.norm(chords, axis=1)[:, None]
        for k, point in enumerate(points):
            slope = chords[max(k - 1, 0)] + chords[min(k, len(chords) - 1)]
            place = np.r_[point, slope / np.linalg.norm(slope)]
            self.place.append(place)
            self.nodes.append(self.mbs.AddNode(NodePointSlope1(referenceCoordinates=list(place))))
        for k, length in enumerate(lengths):
            section = trial.hose if pipe_elements is None else trial.pipe
            is_buffer = k == pipe_elements
            damping_time = section.damping_time if pipe_elements is None else PIPE_DAMPING
            half_density = 0.5 * trial.density
            mass, bending = section.mass, section.bending_stiffness
            weight = trial.wet_weight(section)
            normal = half_density * section.normal_drag * section.diameter
            axial = half_density * section.axial_drag * math.pi * section.diameter
            added = trial.density * section.area * section.normal_added_mass
            if is_buffer:
                body = trial.buffer
                mass, weight = body["mass"] / length, body["wet_weight"] / length
                bending *= BUFFER_STIFFNESS
                normal, axial = half_density * body["drag_area"] / length, 0.0
                added = body["normal_added_mass"] / length
            pair = (start + k, start + k + 1)
            self.mbs.AddObject(ObjectANCFCable(
                length=length, massPerLength=mass, bendingStiffness=bending,
                axialStiffness=section.axial_stiffness,
                axialDamping=damping_time * section.axial_stiffness, bendingDamping=0.0,
                nodeNumbers=[self.nodes[n] for n in pair], useReducedOrderIntegration=1))
            self.pairs.append(pair)
            self.lengths.append(length)
            for key, value in (("weight", weight), ("normal", normal), ("axial", axial),
                               ("added", added)):
                self.coefficients[key].append(value)

    def arrays(self):
        trial = self.trial
        self.place = np.array(self.place)
        self.pairs, self.lengths = np.array(self.pairs), np.array(self.lengths)
        for key, values in self.coefficients.items():
            setattr(self, key, np.array(values))
        self.lumps = np.array([first for first, _ in self.hinges[1:]])
        self.lump_weight = np.array([-f.lift for f in trial.floats])
        self.lump_added = np.array([f.mass + f.added_mass for f in trial.floats])
        self.lump_drag = np.array([0.5 * trial.density * f.drag_area for f in trial.floats])
        self.depths = np.array([depth for depth, _ in trial.profile])
        self.speeds = np.array([speed for _, speed in trial.profile])

    def marker(self, node, coordinate):
        return self.mbs.AddMarker(MarkerNodeCoordinate(
            nodeNumber=self.nodes[node], coordinate=coordinate))

    def add_constraints(self):
        mbs, trial = self.mbs, self.trial
        ground = mbs.AddMarker(MarkerNodeCoordinate(
            nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))

        def follow(motion, part):
            return lambda mbs, t, item, offset: motion(t)[part] if self.moving else 0.0

        self.supports = []
        for node, motions in ((0, (trial.tow, None, trial.heave_motion)),
                              (len(self.nodes) - 1, (trial.tow, None, None))):
            for coordinate, motion in enumerate(motions):
                functions = {} if motion is None else {
                    "offsetUserFunction": follow(motion, 0),
                    "offsetUserFunction_t": follow(motion, 1)}
                self.supports.append(mbs.AddObject(CoordinateConstraint(
                    markerNumbers=[ground, self.marker(node, coordinate)], offset=0.0,
                    **functions)))
        for pair in self.hinges:
            for coordinate in range(3):
                mbs.AddObject(CoordinateConstraint(
                    markerNumbers=[self.marker(node, coordinate) for node in pair]))

    def add_water(self):
        count = len(self.nodes)
        still, flow = np.zeros(2), np.array(self.trial.current_direction)
        size = 6 * count
        index = np.arange(count)[:, None, None]
        rows = (6*index + np.arange(3)[None, :, None] + 0*np.arange(3)[None, None, :]).ravel()
        columns = (6*index + np.arange(3)[None, None, :] + 0*np.arange(3)[None, :, None]).ravel()
        kept = {"time": None, "mass": None}

        def matrix(blocks):
            values = blocks.ravel()
            there = np.flatnonzero(values)
            container = exu.MatrixContainer()
            container.SetWithSparseMatrix(
                np.column_stack([rows[there], columns[there], values[there]]), size, size,
                useDenseMatrix=False)
            return container

        def state(q, q_t):
            return (self.place + np.asarray(q).reshape(count, 6),
                    np.ascontiguousarray(np.asarray(q_t).reshape(count, 6)))

        def blocks(place, rate):
            mass, damping = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
            add_matrices(place, rate, self.pairs, self.lengths, self.added, self.normal, self.axial,
                         self.lumps, self.lump_added, self.lump_drag, self.depths, self.speeds,
                         flow if self.moving else still, mass, damping)
            return mass, damping

        def force(mbs, t, item, q, q_t):
            out = np.zeros((count, 6))
            add_loads(*state(q, q_t), self.pairs, self.lengths, self.weight, self.normal,
                      self.axial, self.lumps, self.lump_weight, self.lump_drag, self.depths,
                      self.speeds, flow if self.moving else still, POINTS, WEIGHTS, out)
            return out.ravel()

        def mass(mbs, t, item, q, q_t):
            # Added mass turns with the line; within one step its direction may stay.
            if kept["time"] != t:
                kept.update(time=t, mass=matrix(blocks(*state(q, q_t))[0]))
            return kept["mass"]

        def jacobian(mbs, t, item, q, q_t, factor, factor_t):
            return matrix(factor_t * blocks(*state(q, q_t))[1])

        force(None, 0.0, 0, np.zeros(size), np.zeros(size))
        start = matrix(blocks(self.place, np.zeros((count, 6)))[0])
        self.mbs.AddObject(ObjectGenericODE2(
            nodeNumbers=self.nodes, massMatrix=start, forceUserFunction=force,
            jacobianUserFunction=jacobian, massMatrixUserFunction=mass))

    def sensors(self):
        def node(number):
            return self.mbs.AddSensor(SensorNode(
                nodeNumber=self.nodes[number], storeInternal=True, writeToFile=False,
                outputVariableType=exu.OutputVariableType.Position))

        def support(number):
            return self.mbs.AddSensor(SensorObject(
                objectNumber=number, storeInternal=True, writeToFile=False,
                outputVariableType=exu.OutputVariableType.Force))

        places = [node(number) for number in (0, *self.buffer_nodes)]
        forces = [support(number) for number in self.supports]
        self.mbs.Assemble()
        return places, forces

    def simulate(self, step):
        places, forces = self.sensors()
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.parallel.numberOfThreads = 1
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        static = settings.staticSolver
        static.numberOfLoadSteps, static.verboseMode = 1, 0
        static.newton.relativeTolerance, static.newton.absoluteTolerance = 1e-8, 1e-2
        static.newton.maxIterations = 60
        static.newton.numericalDifferentiation.relativeEpsilon = 1e-7
        self.mbs.SolveStatic(settings, updateInitialValues=True, showHints=False)
        self.moving = True
        integration = settings.timeIntegration
        integration.numberOfSteps = round(self.trial.duration / step)
        integration.endTime = self.trial.duration
        integration.verboseMode = 0
        integration.newton.useModifiedNewton = True
        integration.newton.relativeTolerance = 1e-3
        integration.newton.absoluteTolerance = 1e-3
        integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
        integration.adaptiveStep = True
        settings.solution.sensors.writePeriod = step
        clock = time.process_time()
        self.mbs.SolveDynamic(settings, storeSolver=True, showHints=False)
        cpu = time.process_time() - clock
        ship, *buffer = [self.mbs.GetSensorStoredData(sensor) for sensor in places]
        pulls = np.column_stack([self.mbs.GetSensorStoredData(s)[:, 1] for s in forces])
        # Constraints tell their multipliers; the pipe pulls the ship down.
        pulls *= -np.sign(pulls[:, 2].mean())
        middle = np.mean([b[:, 1:4] for b in buffer], axis=0)
        middle[:, 0] -= ship[:, 1]
        return cpu, ship[:, 0], middle, pulls


def main():
    model, case, pipe, hose, step = sys.argv[1:]
    trial = SeaTrial(model, case)
    shown = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    failure = None
    try:
        cpu, times, offset, forces = Cable(trial, int(pipe), int(hose)).simulate(float(step))
    except BaseException as error:  # EXUDYN ends a failed solution with SystemExit.
        failure = f"failed: {str(error)[:200]}"
    sys.stdout.flush()
    os.dup2(shown, 1)
    if failure:
        print(json.dumps({"status": failure}))
        return
    # The first sample is before the first step.
    top = np.linalg.norm(forces[1:, :3], axis=1)
    report(trial, times[1:], offset[1:, :2], top, forces[1:, 3:], status="ok", step_s=float(step),
           cpu_s=cpu, simulated_s=float(times[-1]), version=f"EXUDYN {exu.__version__}")


if __name__ == "__main__":
    main()
