"""A frame of OpenSees on a sliding slab, in two directions: its own time history beside Slipstick's, by the modes.

Called by `cargo xtask bench-structure`. The frame is that of examples/structures/opensees-frame.py, its masses at the
floors alone, so that twelve modes are all. It has no damping, which the two programs would define differently.
OpenSees slides on its section `Bidirectional`, elastic up to the friction, by Newmark's constant average acceleration;
Slipstick reads OpenSees' own report of the modes. Units of the frame: kN, m, t, s.
"""

import argparse
import json
import math
import os
import runpy
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np

import opensees
from machine import machine, note

ROOT = Path(__file__).resolve().parents[2]
FLOORS = [10, 20, 30, 40]
SLAB_T, FRICTION, GRAVITY = 120.0, 0.05, 9.80665
DT, DURATION = 0.01, 6.0
# Time step in s, and stiffness of the section in kN/m.
STEPS = [(1e-3, 1e7), (5e-4, 1e8), (2.5e-4, 3e8), (1.25e-4, 1e9)]
COUNTS = [2, 3, 4, 6, 8, 10, 12]
FIGURES = ["peak resultant of s", "peak s_x", "peak s_y", "roof over the slab"]


def ground():
    """Accelerations along x and y in m/s², from zero on."""
    t = np.arange(0.0, DURATION + 0.5 * DT, DT)
    x = 2.0 * np.sin(9.0 * t) + 1.2 * np.sin(14.3 * t)
    y = 1.7 * np.sin(7.7 * t) + np.sin(18.1 * t + 0.4) - math.sin(0.4)
    return x, y


def history(ops, frame, dt, stiffness):
    """Seconds, and the peaks of |s|, |s_x|, |s_y| and of the roof over the slab, in m."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1000, 5.0, 4.0, 0.0)
    ops.fix(1000, 1, 1, 1, 1, 1, 1)
    ops.node(1001, 5.0, 4.0, 0.0)
    ops.fix(1001, 0, 0, 1, 1, 1, 1)
    ops.mass(1001, SLAB_T, SLAB_T, 0.0, 0.0, 0.0, 0.0)
    frame(0.0, 1001)
    weight = (SLAB_T + sum(ops.nodeMass(node, 1) for node in FLOORS)) * GRAVITY
    ops.section("Bidirectional", 1, stiffness, FRICTION * weight, 0.0, 0.0, "Vy", "Vz")
    ops.element("zeroLengthSection", 900, 1000, 1001, 1, "-orient", 0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
    for axis, values in enumerate(ground(), 1):
        ops.timeSeries("Path", axis, "-dt", DT, "-values", *values.tolist())
        ops.pattern("UniformExcitation", axis, axis, "-accel", axis)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-13, 60)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    peaks, start = np.zeros(4), time.process_time()
    for step in range(round(DURATION / dt)):
        if ops.analyze(1, dt) != 0:
            raise SystemExit(f"bench-structure: OpenSees does not converge at {step * dt:.4f} s")
        s = np.array(ops.nodeDisp(1001)[:2])
        roof = np.array(ops.nodeDisp(FLOORS[-1])[:2]) - s
        peaks = np.maximum(peaks, [np.hypot(*s), *np.abs(s), np.hypot(*roof)])
    return time.process_time() - start, peaks


def convert(slipstick, ops, modes):
    """The table of modes and the mass of the structure in t, by the report that OpenSees writes."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    modes["frame"](0.0)
    mass = sum(ops.nodeMass(node, 1) for node in FLOORS)
    modes["write_modes"](3 * len(FLOORS), FLOORS, "-fullGenLapack")
    points = [f"--point=floor{i}={node}" for i, node in enumerate(FLOORS, 1)]
    subprocess.run(
        [slipstick, "structure", "convert", "opensees-modal.txt", "opensees-eigenvectors.csv",
         "--mass-unit", "t", "--damping", "0", *points, "-o", "modes.csv"],
        check=True, stdout=subprocess.DEVNULL,
    )
    lines = Path("modes.csv").read_text().splitlines(keepends=True)
    return [line for line in lines if not line.startswith("#")], mass


def write_ground():
    """The motions as the records x.csv and y.csv."""
    for axis, values in zip("xy", ground()):
        rows = (f"{i * DT!r},{value!r}\n" for i, value in enumerate(values.tolist()))
        Path(f"{axis}.csv").write_text("time_s,acceleration_m_per_s2\n" + "".join(rows))


def exact(slipstick, table, mass, count):
    """The summary of a run with the first modes of the table."""
    Path("some.csv").write_text("".join(table[: count + 1]))
    points = "".join(f'[[structure.point]]\nname = "floor{i}"\nheight = "{3.2 * i:.1f} m"\n'
                     for i in range(1, len(FLOORS) + 1))
    Path("model.toml").write_text(
        f'[block]\nmass = "{SLAB_T} t"\n[slider]\nstatic_friction = {FRICTION}\nkinetic_friction = {FRICTION}\n'
        f'[structure]\nmass = "{mass!r} t"\nmodes = "some.csv"\n{points}'
        '[motion]\nrecord = "x.csv"\nrecord_y = "y.csv"\n'
    )
    run = subprocess.run([slipstick, "run", "model.toml", "--json"], check=True, capture_output=True, text=True)
    return json.loads(run.stdout)


def shares(table, mass, count):
    """Shares of the mass along x and y of the first modes."""
    rows = [line.split(",") for line in table]
    columns = [rows[0].index(f"participation_{axis}") for axis in "xy"]
    return [sum(float(row[column]) ** 2 for row in rows[1 : count + 1]) / (1e3 * mass) for column in columns]


def seconds(slipstick):
    """The least time of a run of model.toml, its files and its certificate included."""
    least = math.inf
    for _ in range(20):
        start = time.perf_counter()
        subprocess.run([slipstick, "run", "model.toml"], check=True, capture_output=True)
        least = min(least, time.perf_counter() - start)
    return least


def figures(summary):
    """The peaks of |s|, |s_x|, |s_y| and of the roof over the slab, in m."""
    s = [part["peak_sliding_displacement_m"] for part in (summary, summary["x"], summary["y"])]
    return np.array([*s, summary["points"][-1]["peak_displacement_m"]])


def per_cent(errors):
    return " | ".join(f"{100.0 * error:+.2g}" for error in errors)


def shear_frame(storeys):
    """The same uniform shear frame twice: by its storeys, and by its modes."""
    mass, frequency, damping = 1000.0, 2.0 * math.pi * 10.0 / storeys, 0.03
    stiffness = mass * (frequency / (2.0 * math.sin(math.pi / (4 * storeys + 2)))) ** 2
    ties = np.diag([2.0] * (storeys - 1) + [1.0]) - np.eye(storeys, k=1) - np.eye(storeys, k=-1)
    squares, shapes = np.linalg.eigh(stiffness / mass * ties)
    shapes /= math.sqrt(mass)
    storey = f'[[storey]]\nmass = "{mass} kg"\nstiffness = "{stiffness!r} N/m"\ndamping_ratio = {damping}\n'
    by_storeys = storey * storeys
    names = [f"floor{i}" for i in range(1, storeys + 1)]
    rows = ["period_s,damping_ratio,participation_x," + ",".join(f"{name}_x" for name in names)]
    for square, shape in zip(squares, shapes.T):
        numbers = [2.0 * math.pi / math.sqrt(square), damping, mass * shape.sum(), *shape]
        rows.append(",".join(repr(float(number)) for number in numbers))
    Path(f"frame-{storeys}.csv").write_text("\n".join(rows) + "\n")
    by_modes = f'[structure]\nmass = "{storeys * mass} kg"\nmodes = "frame-{storeys}.csv"\n'
    by_modes += "".join(f'[[structure.point]]\nname = "{name}"\n' for name in names)
    return by_storeys, by_modes


def pace(slipstick, quick):
    """For each number of storeys: seconds a run as storeys and as modes, and how far the peaks are apart."""
    record, runs = ROOT / "examples/records/taft-111.txt", 100 if quick else 1000
    out = {}
    for storeys in (1, 5, 20):
        times, peaks = ([], []), []
        for kind, structure in enumerate(shear_frame(storeys)):
            Path(f"frame-{storeys}-{kind}.toml").write_text(
                '[block]\nmass = "1000 kg"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n'
                f'radius = "2 m"\n{structure}[motion]\nrecord = "{record}"\nunits = "g"\ndt = "0.01 s"\n'
                'scale_to = "0.3 g"\n'
            )
            Path(f"plan-{storeys}-{kind}.toml").write_text(
                f'model = "frame-{storeys}-{kind}.toml"\n[vary]\n'
                f'"slider.radius" = {{ linspace = ["1 m", "3 m", {runs}] }}\n[sampling]\nmethod = "grid"\n'
            )
            run = [slipstick, "run", f"frame-{storeys}-{kind}.toml", "--json"]
            summary = json.loads(subprocess.run(run, check=True, capture_output=True, text=True).stdout)
            peaks.append(summary["peak_sliding_displacement_m"])
        for turn in range(3 if quick else 11):
            for kind in (0, 1):
                study = [slipstick, "study", f"plan-{storeys}-{kind}.toml", "-j", "1", "-q", "--out", f"study-{turn}-{kind}"]
                start = time.perf_counter()
                subprocess.run(study, check=True, capture_output=True)
                times[kind].append((time.perf_counter() - start) / runs)
                shutil.rmtree(f"study-{turn}-{kind}")
        out[storeys] = [min(times[0]), min(times[1]), abs(peaks[1] / peaks[0] - 1.0)]
    return out


def page(peers, all_modes, fewer, taken, frames):
    """Markdown: the other program's steps, what fewer modes make of it, and a shear frame both ways."""
    mm = " | ".join(f"{1e3 * value:.6g}" for value in figures(all_modes))
    heads = " | ".join(FIGURES)
    lines = [
        "<!-- Written by `cargo xtask bench-structure --write`. -->",
        "",
        f"Measured on {machine('openseespy')}.",
        "",
        f"| | {heads} | time |",
        "|---|--:|--:|--:|--:|--:|",
        f"| Slipstick, 12 modes, mm | {mm} | {taken:.2g} s, process and certificate included |",
    ]
    for (dt, stiffness), (seconds, peaks) in peers.items():
        errors = per_cent(peaks / figures(all_modes) - 1.0)
        lines.append(f"| OpenSees, step {1e3 * dt:g} ms, section {stiffness:.0e} kN/m, off by % | {errors} "
                     f"| {seconds:.2g} s |")
    lines += ["", f"| modes | mass along x, y, % | {heads}, off by % |", "|--:|--:|--:|--:|--:|--:|"]
    for count, (shares, summary) in fewer.items():
        mass = ", ".join(f"{100.0 * share:.1f}" for share in shares)
        lines.append(f"| {count} | {mass} | {per_cent(figures(summary) / figures(all_modes) - 1.0)} |")
    lines += [
        "",
        "| uniform shear frame, Taft, a run of a study | as storeys, µs | as its modes, µs | ratio | peak apart by |",
        "|---|--:|--:|--:|--:|",
    ]
    for storeys, (as_storeys, as_modes, apart) in frames.items():
        lines.append(f"| n = {storeys} | {1e6 * as_storeys:.0f} | {1e6 * as_modes:.0f} "
                     f"| {as_modes / as_storeys:.2f} | {apart:.0e} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", required=True, type=Path)
    parser.add_argument("--slipstick", required=True)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    slipstick = str(Path(options.slipstick).resolve())
    os.chdir(options.folder)
    ops = opensees.load()
    modes = runpy.run_path(str(ROOT / "examples/structures/opensees-frame.py"))
    write_ground()
    table, mass = convert(slipstick, ops, modes)
    note("Slipstick, all modes")
    all_modes = exact(slipstick, table, mass, COUNTS[-1])
    if not all_modes["checks"]["holds"]:
        raise SystemExit("bench-structure: the run with all modes is not certified")
    taken = seconds(slipstick)
    fewer = {count: (shares(table, mass, count), exact(slipstick, table, mass, count)) for count in COUNTS[:-1]}
    peers = {}
    for dt, stiffness in STEPS[:2] if options.quick else STEPS:
        note(f"OpenSees, steps of {1e3 * dt:g} ms")
        peers[dt, stiffness] = history(ops, modes["frame"], dt, stiffness)
    Path("structure.md").write_text(page(peers, all_modes, fewer, taken, pace(slipstick, options.quick)))


main()
