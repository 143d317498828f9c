"""Sliders with devices, and in two directions, in OpenSeesPy, by the scripts that Slipstick writes, beside
the exact answer.

The scripts run as they are, with stick as springs of several stiffnesses and with the samples as they are
and cut in parts. Times are the least of several runs.
"""

import time

import numpy as np

from cases import ROOT
from machine import Process, note

GRAVITY = 9.80665
BLOCK_KG, FLOOR_KG = 325.0, 201.0
#: Sliding displacements over which friction builds up, with parts into which a sample is cut.
TRIALS = [(1e-3, 1), (1e-4, 1), (1e-5, 1), (1e-5, 5), (1e-6, 1), (1e-6, 5)]

BLOCK = """
[block]
mass = "325 kg"
"""
STRUCTURE = BLOCK + """
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

#: The same in two directions: steps of 10 ms and of 1 ms.
TRIALS_IN_PLANE = [(1e-4, 1), (1e-5, 1), (1e-5, 10)]
STIFFER_ALONG_Y = 'frequency_y = "3 Hz"\n'
ALONG_Y = 'record_y = "{records}/taft-021.txt"'

#: Title, what OpenSees calls it, weight that presses, friction that builds up first, model.
PLANE = [
    ("rigid block, pendulum 2 m", "`Coulomb` in `singleFPBearing`",
     BLOCK_KG * GRAVITY, 0.05, BLOCK + PENDULUM),
    ("a storey that is stiffer along y, pendulum 2 m", "`Coulomb` in `singleFPBearing`",
     (BLOCK_KG + FLOOR_KG) * GRAVITY, 0.05, STRUCTURE + STIFFER_ALONG_Y + PENDULUM),
    ("the same, friction by speed, exponential", "`VelDependent` in `singleFPBearing`",
     (BLOCK_KG + FLOOR_KG) * GRAVITY, 0.03, STRUCTURE + STIFFER_ALONG_Y + EXPONENTIAL),
]


def model(text, more):
    records = ROOT / "examples" / "records"
    motion = f'[motion]\nrecord = "{records}/taft-111.txt"\nunits = "g"\ndt = "0.01 s"\nscale_to = "0.3 g"\n'
    return text + motion + more.format(records=records) + "\n"


def as_numbers(sliding):
    """Displacements at the samples, those in two directions as x + iy."""
    sliding = np.array(sliding)
    return sliding if sliding.ndim == 1 else sliding[:, 0] + 1j * sliding[:, 1]


def attempt(script, parts):
    """Sliding displacement and seconds of a script, or why there is none."""
    names = {"__name__": "slipstick.opensees"}
    exec(compile(script, "<script>", "exec"), names)
    start = time.process_time()
    try:
        _, sliding = names["analyse"](parts=parts)
    except ArithmeticError as error:
        return None, str(error)
    return as_numbers(sliding), time.process_time() - start


def measure(title, element, friction_n, text, trials, helper, folder, rounds):
    """Slipstick's row, then one for each stiffness and number of parts."""
    file = folder / "device.toml"
    file.write_text(text)
    helper.ask("load", file)
    samples, events = map(int, helper.ask("history", folder / "exact.bin"))
    exact = np.fromfile(folder / "exact.bin", "<f8")
    if len(exact) > samples:
        exact = as_numbers(exact.reshape(2, -1).T)
    peak = np.abs(exact).max()
    times = {"slipstick": []}
    answers = {}
    for turn in range(rounds):
        times["slipstick"] += [int(ns) * 1e-9 for ns in helper.ask("time", 20)]
        for key in trials:
            if isinstance(answers.get(key), str):
                continue
            yield_m, parts = key
            script = folder / "device.py"
            helper.ask("script", repr(friction_n / yield_m), script)
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
            "residual_error": abs(answer[-1] - exact[-1]) / peak,
            "history_error": np.abs(answer - exact).max() / peak,
        })
    return rows


def measured(program, folder, quick):
    """Rows of all devices, and of all cases in two directions."""
    helper, rounds = Process(program), 1 if quick else 3
    devices, plane = [], []
    weight_n = (BLOCK_KG + FLOOR_KG) * GRAVITY
    for title, element, friction, text, more in DEVICES:
        note(f"device: {title}")
        text = model(STRUCTURE + text, more)
        devices += measure(title, element, friction * weight_n, text, TRIALS, helper, folder, rounds)
    for title, element, weight_n, friction, text in PLANE:
        note(f"two directions: {title}")
        text = model(text, ALONG_Y)
        plane += measure(title, element, friction * weight_n, text, TRIALS_IN_PLANE, helper, folder, rounds)
    return devices, plane


def table(devices, plane, quantity, per_cent):
    """Markdown: one table a device, one a case in two directions."""
    lines = [
        "",
        "### Devices",
        "",
        "The Taft record at 0.3 g on a storey of 2.15 Hz, and the script that Slipstick writes of each model for",
        "OpenSees, with stick as springs that yield at several displacements and each sample in one step or in five.",
    ]
    lines += tables(devices, quantity, per_cent)
    lines += [
        "",
        "### Two directions",
        "",
        "Both components of the Taft record, the larger at 0.3 g, and the script that Slipstick writes for OpenSees: stick",
        "as a spring that yields at 0.1 mm and at 10 µm, steps of 10 ms and of 1 ms. Errors are lengths of vectors.",
    ]
    return lines + tables(plane, quantity, per_cent)


def tables(rows, quantity, per_cent):
    """One table a model."""
    lines = []
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
            label = f"OpenSeesPy, yield {yield_m} m" + (f", dt/{row['parts']}" if row["parts"] > 1 else "")
            if "failure" in row:
                lines.append(f"| {label} | – | – | {row['failure']} | | |")
                continue
            cells = [
                label, quantity(row["seconds"]), f"{row['times_slipstick']:.3g}",
                per_cent(row["peak_error"]), per_cent(row["residual_error"]), per_cent(row["history_error"]),
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return lines
