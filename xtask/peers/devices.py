"""Sliders with devices in OpenSeesPy, by the scripts that Slipstick writes, beside the exact answer.

The scripts run as they are, with stick as springs of several stiffnesses and with the samples as they are
and cut in five. Times are the least of several runs.
"""

import time

import numpy as np

from cases import ROOT
from machine import Process, note

GRAVITY = 9.80665
BLOCK_KG, FLOOR_KG = 325.0, 201.0
#: Sliding displacements over which friction builds up, with parts into which a sample is cut.
TRIALS = [(1e-3, 1), (1e-4, 1), (1e-5, 1), (1e-5, 5), (1e-6, 1), (1e-6, 5)]

STRUCTURE = """
[block]
mass = "325 kg"

[[storey]]
mass = "201 kg"
frequency = "2.15 Hz"
damping_ratio = 0.01
"""
PENDULUM = """
[slider]
static_friction = 0.05
kinetic_friction = 0.05
radius = "2 m"
"""
EXPONENTIAL = """
[slider]
static_friction = 0.03
kinetic_friction = { slow = 0.03, fast = 0.055, rate = "30 s/m" }
radius = "2 m"
"""
PIECES = """
[slider]
static_friction = 0.03
radius = "2 m"

[slider.kinetic_friction]
velocity = ["0 m/s", "0.02 m/s", "0.1 m/s", "0.3 m/s"]
coefficient = [0.03, 0.04, 0.05, 0.055]
"""
GAPS = """
[slider.stop]
gap = { positive = "40 mm", negative = "30 mm" }
"""
DOUBLE = """
[[slider.surface]]
radius = "0.4 m"
friction = 0.03
travel = "60 mm"

[[slider.surface]]
radius = "1.6 m"
friction = 0.055
travel = "600 mm"
"""
TRIPLE = """
[slider.triple]
effective_radius = ["1 m", "0.1 m", "0.1 m", "1.05 m"]
friction = [0.045, 0.02, 0.02, 0.08]
travel = ["150 mm", "50 mm", "50 mm", "200 mm"]
"""
CONTENTS = """
[[contents]]
floor = 1
mass = "50 kg"
static_friction = 0.1
kinetic_friction = 0.1
"""
UP = 'vertical = "{records}/taft-021.txt"\nvertical_scale = 0.667'

#: Title, what OpenSees calls it, friction that builds up first, model, more of the motion.
DEVICES = [
    ("friction by speed, exponential, pendulum 2 m", "`VelDependent` in `singleFPBearing`",
     0.03, EXPONENTIAL, ""),
    ("friction by speed in pieces, pendulum 2 m", "`VelDepMultiLinear` in `singleFPBearing`",
     0.03, PIECES, ""),
    ("pendulum 2 m under vertical motion, N(t)/R", "`Coulomb` in `singleFPBearing`",
     0.05, PENDULUM, UP),
    ("double pendulum", "`TripleFrictionPendulum`, one surface stuck", 0.03, DOUBLE, ""),
    ("triple pendulum", "`TripleFrictionPendulum`", 0.02, TRIPLE, ""),
    ("elastic stops of 0.5 kN/mm", "`ElasticPP`, `ElasticPPGap`",
     0.05, PENDULUM + GAPS + 'stiffness = "0.5 kN/mm"\n', ""),
    ("rigid stops, restitution 0.5", "`ElasticPP`, `ViscoelasticGap` as stiff as stick",
     0.05, PENDULUM + GAPS + "restitution = 0.5\n", ""),
    ("contents on the floor", "`ElasticPP` twice", 0.05, PENDULUM + CONTENTS, ""),
]


def model(text, more):
    records = ROOT / "examples" / "records"
    motion = f'[motion]\nrecord = "{records}/taft-111.txt"\nunits = "g"\ndt = "0.01 s"\nscale_to = "0.3 g"\n'
    return STRUCTURE + text + motion + more.format(records=records) + "\n"


def attempt(script, parts):
    """Sliding displacement and seconds of a script, or why there is none."""
    names = {"__name__": "slipstick.opensees"}
    exec(compile(script, "<script>", "exec"), names)
    start = time.process_time()
    try:
        _, sliding = names["analyse"](parts=parts)
    except ArithmeticError as error:
        return None, str(error)
    return np.array(sliding), time.process_time() - start


def measure(device, helper, folder, rounds):
    """Slipstick's row, then one for each stiffness and number of parts."""
    title, element, friction, text, more = device
    file = folder / "device.toml"
    file.write_text(model(text, more))
    helper.ask("load", file)
    samples, events = map(int, helper.ask("history", folder / "exact.bin"))
    exact = np.fromfile(folder / "exact.bin", "<f8")
    peak = np.abs(exact).max()
    weight = (BLOCK_KG + FLOOR_KG) * GRAVITY
    times = {"slipstick": []}
    answers = {}
    for turn in range(rounds):
        times["slipstick"] += [int(ns) * 1e-9 for ns in helper.ask("time", 20)]
        for key in TRIALS:
            if isinstance(answers.get(key), str):
                continue
            yield_m, parts = key
            script = folder / "device.py"
            helper.ask("script", repr(friction * weight / yield_m), script)
            answer, seconds = attempt(script.read_text(), parts)
            answers[key] = seconds if answer is None else answer
            if answer is not None:
                times.setdefault(key, []).append(seconds)
    own = min(times["slipstick"])
    rows = [{
        "device": title, "element": element, "program": "slipstick", "seconds": own,
        "times_slipstick": 1.0, "samples": samples, "events": events, "exact_peak_m": peak,
    }]
    for (yield_m, parts), answer in answers.items():
        row = {"device": title, "program": "opensees", "yield_m": yield_m, "parts": parts}
        if isinstance(answer, str):
            rows.append({**row, "failure": answer})
            continue
        least = min(times[yield_m, parts])
        rows.append({
            **row, "seconds": least, "times_slipstick": least / own,
            "peak_error": np.abs(answer).max() / peak - 1.0,
            "residual_error": (answer[-1] - exact[-1]) / peak,
            "history_error": np.abs(answer - exact).max() / peak,
        })
    return rows


def measured(program, folder, quick):
    """Rows of all devices."""
    helper = Process(program)
    rows = []
    for device in DEVICES:
        note(f"device: {device[0]}")
        rows += measure(device, helper, folder, 1 if quick else 3)
    return rows


def table(rows, quantity, per_cent):
    """Markdown: one table a device."""
    lines = [
        "",
        "### Devices",
        "",
        "The Taft record at 0.3 g on a storey of 2.15 Hz, and the script that Slipstick writes of each model for",
        "OpenSees, with stick as springs that yield at several displacements and each sample in one step or in five.",
    ]
    for device in dict.fromkeys(row["device"] for row in rows):
        first, *others = [row for row in rows if row["device"] == device]
        lines += [
            "",
            f"**{device}**: {first['element']}; {first['samples']} samples, {first['events']} events.",
            "",
            "| program | time | × Slipstick | peak, % | residual, % | history, % |",
            "|---|--:|--:|--:|--:|--:|",
            f"| Slipstick | {quantity(first['seconds'])} | 1 | exact | exact | exact |",
        ]
        for row in others:
            yield_m = f"{row['yield_m']:.0e}".replace("e-0", "e-")
            label = f"OpenSeesPy, yield {yield_m} m" + (", dt/5" if row["parts"] == 5 else "")
            if "failure" in row:
                lines.append(f"| {label} | – | – | {row['failure']} | | |")
                continue
            cells = [
                label, quantity(row["seconds"]), f"{row['times_slipstick']:.3g}",
                per_cent(row["peak_error"]), per_cent(row["residual_error"]), per_cent(row["history_error"]),
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return lines
