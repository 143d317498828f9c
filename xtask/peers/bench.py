"""Times the same analyses in several programs, interleaved, and compares all with the exact answer.

Called by `cargo xtask bench-peers`, which builds the helper and makes the Python environment.
Times are medians over rounds in which every program has its turn; imports, compilation and the
start of processes are left out. Programs that run here are timed by the processor time of this process, so
that long runs do not pay for what else the machine does. Slipstick's time includes setting up the system; numba's leaves
its matrix exponentials out.
"""

import argparse
import json
import statistics
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import cases
import devices
import numba_loop
import opensees
import pyslammer_rigid
import reference
import scipy_events
from machine import Process, machine, note

LABELS = {
    "slipstick": "Slipstick",
    "slipstick-prepared": "Slipstick, system and motion prepared",
    "slipstick-native": "Slipstick, built for this processor",
    "slipstick-history": "Slipstick with history",
    "slipstick-checked": "Slipstick with history and certificate",
    "numba": "event-exact loop, numba",
    "opensees-1e-5": "OpenSeesPy, yield 1e-5 m",
    "opensees-1e-6": "OpenSeesPy, yield 1e-6 m",
    "opensees-1e-6-fine": "OpenSeesPy, yield 1e-6 m, dt/5",
    "pyslammer": "pySLAMMER, one run for each way",
    "scipy": "SciPy solve_ivp with events",
}


# Program, yield displacement in m, parts into which a sample is cut.
OPENSEES = [("opensees-1e-5", 1e-5, 1), ("opensees-1e-6", 1e-6, 1), ("opensees-1e-6-fine", 1e-6, 5)]


class Helper(Process):
    """The example `peer_bench`, told what to load and to time."""

    def __init__(self, program, folder):
        super().__init__(program)
        self.folder = folder

    def load(self, case):
        file = self.folder / "case.bin"
        case.to_file(file)
        self.ask("load", file)

    def seconds(self, what, count):
        return [int(ns) * 1e-9 for ns in self.ask("time", what, count)]

    def answer(self):
        file = self.folder / "history.bin"
        peak, events = self.ask("history", file)
        return np.fromfile(file, "<f8"), float(peak), int(events)


def by_call(function, count):
    """A timer in the form of `Helper.seconds` for something called here."""

    def seconds(repeats):
        out = []
        for _ in range(min(repeats, count)):
            start = time.process_time()
            function()
            out.append(time.process_time() - start)
        return out

    return seconds


def programs(case, helpers, ops, quick, only_fast=False):
    """Yields key, timer, rounds, (history, peak, events or None)."""
    for key, helper in helpers.items():
        helper.load(case)
        answer = helper.answer()
        kinds = {key: "demands"}
        if key == "slipstick":
            kinds |= {"slipstick-prepared": "prepared"}
            if not only_fast:
                kinds |= {"slipstick-history": "history", "slipstick-checked": "checked"}
        for name, what in kinds.items():
            yield name, (lambda n, h=helper, w=what: h.seconds(w, n)), 1000, answer
    arguments = numba_loop.prepare(case)
    history, _, peak, events = numba_loop.loop(*arguments)
    timer = by_call(lambda: numba_loop.loop(*arguments), 1000)
    yield "numba", timer, 1000, (history, peak, events)
    if only_fast and quick:
        return
    for key, yield_m, parts in OPENSEES:
        if only_fast and key != "opensees-1e-5":
            continue
        try:
            history = opensees.run(ops, case, yield_m, parts)
        except ArithmeticError as error:
            note(f"  {key}: {error}")
            continue
        run = by_call(lambda y=yield_m, p=parts: opensees.run(ops, case, y, p), 1)
        yield key, run, 2 if quick else 5, (history, np.abs(history).max(), None)
    if not only_fast and pyslammer_rigid.fits(case):
        history = pyslammer_rigid.run(case)
        run = by_call(lambda: pyslammer_rigid.run(case), 1)
        yield "pyslammer", run, 2 if quick else 5, (history, np.abs(history).max(), None)
    if not only_fast:
        history, peak = scipy_events.run(case)
        run = by_call(lambda: scipy_events.run(case), 1)
        yield "scipy", run, 1 if quick else 3, (history, peak, None)


def measure(case, helpers, ops, cache, rounds, quick, only_fast=False):
    """Rows of one case: time and errors of every program."""
    exact, exact_peak, exact_events = reference.exact(case, cache)
    same, same_peak, _ = reference.exact(case.with_static_as_kinetic(), cache)
    entries = list(programs(case, helpers, ops, quick, only_fast))
    times = {key: [] for key, *_ in entries}
    for turn in range(rounds):
        for key, timer, limit, _ in entries:
            if turn < limit:
                times[key] += timer(3 if quick else 10)
    # One helper holds one case at a time, so all its timings of this case end here.
    median = {key: statistics.median(values) for key, values in times.items()}
    rows = []
    for key, _, _, (history, peak, events) in entries:
        count = min(len(history), len(exact))
        spread = np.abs(history[:count] - exact[:count]).max()
        rows.append({
            "case": case.name,
            "title": case.title,
            "samples": len(case.ground),
            "events": exact_events,
            "program": key,
            "seconds": median[key],
            "fastest_seconds": min(times[key]),
            "times_slipstick": median[key] / median["slipstick"],
            "peak_error": peak / exact_peak - 1.0,
            "residual_error_m": history[-1] - exact[-1],
            "residual_error": (history[-1] - exact[-1]) / exact_peak,
            "history_error": spread / exact_peak,
            "history_error_same_friction": None
            if case.mu_static == case.mu_kinetic or not key.startswith("opensees")
            else np.abs(history[:count] - same[:count]).max() / same_peak,
            "events_found": events,
            "exact_peak_m": exact_peak,
            "exact_residual_m": exact[-1],
        })
    return rows


def suite(helpers, ops, cache, rounds, quick):
    """All far-field records as one case: times added up, the worst error."""
    collected = {}
    records = cases.far_field_cases()
    for case in records[:4] if quick else records:
        note(f"  {case.name}")
        for row in measure(case, helpers, ops, cache, rounds, quick, only_fast=True):
            collected.setdefault(row["program"], []).append(row)
    if not collected:
        return []
    count = max(len(rows) for rows in collected.values())
    base = sum(row["seconds"] for row in collected["slipstick"])
    out = []
    for key, rows in collected.items():
        if len(rows) < count:
            note(f"  {key} solved {len(rows)} of {count} records: left out")
            continue
        total = sum(row["seconds"] for row in rows)
        worst = {k: max((row[k] for row in rows), key=abs)
                 for k in ("peak_error", "residual_error_m", "residual_error", "history_error")}
        found = [row["events_found"] for row in rows]
        out.append({
            **rows[0], **worst,
            "case": "far field",
            "title": f"{count} far-field records at 0.3 g, as E; times added up, worst errors",
            "samples": sum(row["samples"] for row in rows),
            "events": sum(row["events"] for row in rows),
            "seconds": total,
            "fastest_seconds": sum(row["fastest_seconds"] for row in rows),
            "times_slipstick": total / base,
            "history_error_same_friction": max(
                (row["history_error_same_friction"] for row in rows
                 if row["history_error_same_friction"] is not None), default=None),
            "events_found": None if None in found else sum(found),
        })
    return out


def pieces(case, helper, rounds):
    """Seconds that an event and the set-up of a system take.

    Cutting every sample in two doubles the ordinary samples and leaves the events.
    """
    dt, ground = case.finer(2)
    finer = replace(case, dt=dt, ground=ground)
    times = {"coarse": [], "fine": [], "setup": []}
    for _ in range(rounds):
        helper.load(case)
        events = helper.answer()[2]
        times["coarse"] += helper.seconds("demands", 10)
        times["setup"] += helper.seconds("setup", 10)
        helper.load(finer)
        times["fine"] += helper.seconds("demands", 10)
    median = {key: statistics.median(values) for key, values in times.items()}
    event = (2.0 * median["coarse"] - median["fine"] - median["setup"]) / events
    return {"case": case.name, "event_seconds": event, "setup_seconds": median["setup"]}


def quantity(seconds):
    for size, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if abs(seconds) >= size:
            break
    return f"{seconds / size:.3g} {unit}"


def per_cent(fraction):
    return "" if fraction is None else f"{100.0 * abs(fraction):.1e}"


def table(rows, parts, scripts, machine):
    """Markdown: one table a case, and what an event and a set-up cost."""
    lines = [
        "<!-- Written by `cargo xtask bench-peers --write`. -->",
        "",
        f"Medians of one interleaved run: {machine}.",
        "",
        "Errors are against the exact answer and in per cent of the exact peak of the sliding",
        "displacement. OpenSeesPy's material knows one coefficient of friction: its last column is",
        "the error against the exact answer for static = kinetic friction.",
    ]
    for case in dict.fromkeys(row["case"] for row in rows):
        mine = [row for row in rows if row["case"] == case]
        first = mine[0]
        lines += [
            "",
            f"**{case}**: {first['title']}; {first['samples']} samples, {first['events']} events.",
            "",
            "| program | time | × Slipstick | peak, % | residual, % | history, % | same friction, % |",
            "|---|--:|--:|--:|--:|--:|--:|",
        ]
        for row in mine:
            cells = [
                LABELS[row["program"]], quantity(row["seconds"]), f"{row['times_slipstick']:.3g}",
                per_cent(row["peak_error"]), per_cent(row["residual_error"]),
                per_cent(row["history_error"]), per_cent(row["history_error_same_friction"]),
            ]
            lines.append("| " + " | ".join(cells) + " |")
    lines += ["", "| Slipstick, case | an event | set-up of a system |", "|---|--:|--:|"]
    for part in parts:
        cells = part["case"], quantity(part["event_seconds"]), quantity(part["setup_seconds"])
        lines.append("| " + " | ".join(cells) + " |")
    lines += devices.table(*scripts, quantity, per_cent)
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--helper", required=True)
    parser.add_argument("--native-helper")
    parser.add_argument("--device-helper", required=True)
    parser.add_argument("--folder", required=True, type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    helpers = {"slipstick": Helper(options.helper, options.folder)}
    if options.native_helper:
        helpers["slipstick-native"] = Helper(options.native_helper, options.folder)
    ops = opensees.load()
    rounds = 3 if options.quick else 15
    rows = []
    for case in cases.named_cases():
        note(f"case {case.name}")
        rows += measure(case, helpers, ops, options.folder, rounds, options.quick)
    note("far-field records")
    rows += suite(helpers, ops, options.folder, min(rounds, 3), options.quick)
    parts = [pieces(case, helpers["slipstick"], rounds)
             for case in cases.named_cases() if case.name in ("A", "B", "F")]
    scripts = devices.measured(options.device_helper, options.folder, options.quick)
    where = machine("openseespy", "pyslammer", "numba", "scipy")
    result = {"machine": where, "rows": rows, "pieces": parts, "devices": scripts[0], "plane": scripts[1]}
    (options.folder / "peers.json").write_text(json.dumps(result, indent=1, default=float) + "\n")
    (options.folder / "peers.md").write_text(table(rows, parts, scripts, where))


main()
