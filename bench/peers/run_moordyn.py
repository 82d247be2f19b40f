"""One case of the sea trial in MoorDyn, through its Python interface.

    python run_moordyn.py MODEL CASE PIPE_ELEMENTS HOSE_ELEMENTS STEP

Prints one line of JSON: processor time of the calls of the solver in the motion alone, and results.

MoorDyn's points carry no moments, so the buffer is two points of half its mass each, joined by one
stiff segment that also carries its drag and added mass, and pipe and hose are hinged to it. Floats
are points between the three lines of the hose. The start is MoorDyn's own relaxation in still water,
whose state is taken over into a system with the current.
"""

import json
import math
import os
import sys
import tempfile
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import moordyn
import numpy as np

from sea_trial import SeaTrial, report

# Damping of the axial springs over critical damping: what keeps the explicit steps of coarse pipes
# quiet, and does not touch the heave response.
PIPE_DAMPING, HOSE_DAMPING = 1.0, 0.5
# The buffer's segment is as stiff as the step allows: its frequency times the step.
LINK_STIFFNESS, LINK_DAMPING, LINK_DIAMETER = 0.7, 0.3, 0.02


def deck(trial, pipe_elements, hose_elements, step, current):
    """The input file's text; `current`: whether it acts."""
    nodes = trial.hanging_chain(pipe_elements, hose_elements)
    lengths, counts = trial.hose_parts(hose_elements)
    buffer, rho = trial.buffer, trial.density
    upper, lower = nodes[pipe_elements], nodes[pipe_elements + 1]
    knots = np.cumsum([pipe_elements + 1] + counts)
    # The segment replaces only the distance of the two points; weight and water come with it.
    half_mass = buffer["mass"] / 2
    volume = (buffer["mass"] - buffer["wet_weight"] / trial.gravity) / rho / 2
    stiffness = min(trial.pipe.axial_stiffness,
                    (LINK_STIFFNESS / step)**2 * buffer["length"] * half_mass / 2)
    damping = 2 * LINK_DAMPING * buffer["length"] * math.sqrt(
        stiffness / buffer["length"] * half_mass / 2)
    link_mass = rho * math.pi / 4 * LINK_DIAMETER**2
    link_drag = buffer["drag_area"] / (LINK_DIAMETER * buffer["length"])
    link_added = buffer["normal_added_mass"] / (link_mass * buffer["length"])

    def line_type(name, s, damping):
        return (f"{name} {s.diameter} {s.mass} {s.axial_stiffness} {-damping} "
                f"{s.bending_stiffness} {s.normal_drag} {s.normal_added_mass} {s.axial_drag} 0\n")

    def point(number, kind, place, mass=0.0, volume=0.0, drag_area=0.0, added=0.0):
        return (f"{number} {kind} {place[0]:.6f} 0 {place[1]:.6f} {mass} {volume} {drag_area} "
                f"{added}\n")

    text = "sea trial\n\n---- LINE TYPES ----\n"
    text += "Name Diam Mass EA BA EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s) (N-m2) (-) (-) (-) (-)\n"
    text += line_type("pipe", trial.pipe, PIPE_DAMPING)
    text += line_type("hose", trial.hose, HOSE_DAMPING)
    text += (f"link {LINK_DIAMETER} {link_mass} {stiffness} {damping} 0 {link_drag} {link_added} "
             "0 0\n")
    text += "---- POINTS ----\nID Attachment X Y Z M V CdA Ca\n(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)\n"
    text += point(1, "Coupled", (0, 0)) + point(2, "Coupled", trial.miner[[0, 2]])
    text += point(3, "Free", upper, half_mass, volume) + point(4, "Free", lower, half_mass, volume)
    for k, f in enumerate(trial.floats):
        displaced = (f.lift / trial.gravity + f.mass) / rho
        text += point(5 + k, "Free", nodes[knots[k + 1]], f.mass, displaced, f.drag_area,
                      f.added_mass / (rho * displaced))
    text += "---- LINES ----\nID LineType A B UnstrLen NumSegs Outputs\n(#) (-) (#) (#) (m) (-) (-)\n"
    text += f"1 pipe 1 3 {trial.pipe_length} {pipe_elements} -\n"
    text += f"2 link 3 4 {buffer['length']} 1 -\n"
    ends = [4] + [5 + k for k in range(len(trial.floats))] + [2]
    for k, (length, count) in enumerate(zip(lengths, counts)):
        text += f"{3 + k} hose {ends[k]} {ends[k + 1]} {length:.9g} {count} -\n"
    # A step a little above the coupling step makes it exactly one; the seabed is out of reach.
    text += ("---- OPTIONS ----\n0 writeLog\nRK2 tScheme\n"
             f"{step * (1 + 1e-6):.12g} dtM\n1300 WtrDpth\n{rho} rho\n{trial.gravity} g\n"
             "3e4 kBot\n3e3 cBot\n120 TmaxIC\n1 dtIC\n1e-4 threshIC\n"
             f"{int(current)} Currents\n1 disableOutput\n1 disableOutTime\n---- END ----\n")
    return text


def write_current(trial):
    """The file in which MoorDyn looks for the current."""
    levels = sorted({0.0, *(depth for depth, _ in trial.profile)})
    rows = [(10.0, 0.0)] + [(-d, d) for d in levels] + [(-1400.0, 1400.0)]
    with open("current_profile.txt", "w", encoding="ascii") as stream:
        stream.write("current\ncurrent\nz ux uy uz\n")
        for z, depth in sorted(rows):
            x, y = trial.current_speed(depth) * trial.current_direction
            stream.write(f"{z} {x:.9f} {y:.9f} 0\n")


def system(trial, mesh, step, current, name):
    with open(name, "w", encoding="ascii") as stream:
        stream.write(deck(trial, *mesh, step, current))
    made = moordyn.Create(name)
    moordyn.SetVerbosity(made, moordyn.LEVEL_NONE)
    return made


def simulate(trial, mesh, step):
    ends = [0.0, 0.0, 0.0, *trial.miner]
    write_current(trial)
    still = system(trial, mesh, step, False, "still.txt")
    moordyn.Init(still, ends, [0.0] * 6)
    moordyn.SaveState(still, "state.bin")
    moordyn.Close(still)
    sea = system(trial, mesh, step, True, "sea.txt")
    moordyn.Init_NoIC(sea, ends, [0.0] * 6)
    moordyn.LoadState(sea, "state.bin")
    points = [moordyn.GetPoint(sea, k) for k in (1, 2, 3, 4)]

    steps = round(trial.duration / step)
    times = np.arange(steps + 1) * step
    path = np.array([trial.tow(t)[0] for t in times])
    height = np.array([trial.heave_motion(t)[0] for t in times])
    # The end velocity is held over a coupling step: the mean one leads to the right place.
    vx, vz = np.diff(path) / step, np.diff(height) / step
    middle, forces = np.zeros((steps + 1, 3)), np.zeros((steps + 1, 6))
    middle[0] = np.mean([moordyn.GetPointPos(p) for p in points[2:]], axis=0)
    status = "ok"
    clock = time.process_time()
    for i in range(steps):
        position = [path[i], 0.0, height[i], ends[3] + path[i], 0.0, ends[5]]
        velocity = [vx[i], 0.0, vz[i], vx[i], 0.0, 0.0]
        force = moordyn.Step(sea, position, velocity, times[i], step)
        b, e = moordyn.GetPointPos(points[2]), moordyn.GetPointPos(points[3])
        middle[i + 1] = [(b[k] + e[k]) / 2 for k in range(3)]
        forces[i + 1] = force
        if not abs(force[2]) < 5e7:
            status = "unstable"
            break
    cpu = time.process_time() - clock
    # MoorDyn leaves the inertia of the half elements at moving ends out of its forces.
    ship, miner = (np.array(moordyn.GetPointM(p)) for p in points[:2])
    moordyn.Close(sea)
    acceleration = np.zeros((steps + 1, 3))
    acceleration[:, 0] = [trial.tow(t)[2] for t in times]
    forces[:, 3:] -= acceleration @ miner.T
    acceleration[:, 2] = [trial.heave_motion(t)[2] for t in times]
    forces[:, :3] -= acceleration @ ship.T
    return status, cpu, times, middle - np.c_[path, 0 * path, 0 * path], forces


def main():
    model, case, pipe, hose, step = sys.argv[1:]
    trial = SeaTrial(os.path.abspath(model), case)
    mesh, step = (int(pipe), int(hose)), float(step)
    step = trial.duration / math.ceil(trial.duration / step - 1e-9)
    shown = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            status, cpu, times, offset, forces = simulate(trial, mesh, step)
        except Exception as error:
            status = f"failed: {error}"
        os.chdir("/")
    sys.stdout.flush()
    os.dup2(shown, 1)
    if status != "ok":
        print(json.dumps({"status": status}))
        return
    # The first sample is before the first step.
    top = np.linalg.norm(forces[1:, :3], axis=1)
    report(trial, times[1:], offset[1:, :2], top, forces[1:, 3:], status=status, step_s=step,
           cpu_s=cpu, simulated_s=trial.duration, version=f"MoorDyn {version()}")


def version():
    from importlib.metadata import version as installed
    return installed("moordyn")


if __name__ == "__main__":
    main()
