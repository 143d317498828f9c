"""Frames of 0 to 20 storeys: time a sample beside an event-exact loop in numba on the same systems.

Called by `cargo xtask bench-storeys`. The systems are those of the example `storeys_bench`: Taft at
0.3 g, 1000 kg a floor and the block, 5 % of critical damping, a pendulum of 2 m.
"""

import argparse
import json
import math
import subprocess
import time
from pathlib import Path

import numpy as np

import cases
import numba_frame
from machine import machine, note

ROOT = Path(__file__).resolve().parents[2]
GRAVITY = 9.80665
PAIR_FIELDS = ["storeys", "name", "samples", "events", "peak_m", "both", "along_x"]
FIELDS = ["name", "storeys", "samples", "events", "peak_m", "demands", "history", "checked", "set_up"]


def taft():
    lines = (ROOT / "examples/records/taft-111.txt").read_text().split("\n")
    values = np.array([float(line) for line in lines if line.strip() and line[0] != "#"])
    return values * (0.3 * GRAVITY / np.abs(values).max())


def rival(ground, storeys, quick):
    """Seconds a run, peak of |s| and events of the numba loop."""
    rate = math.pi / (0.1 * storeys * math.sin(math.pi / (4 * storeys + 2)))
    arguments = numba_frame.prepare(
        ground, 0.01, 1000.0, [1000.0] * storeys, [1000.0 * rate * rate] * storeys, 0.05,
        1000.0 * (storeys + 1) * GRAVITY / 2.0, 0.06, 0.05, GRAVITY,
    )
    peak, events = numba_frame.loop(*arguments)
    least = math.inf
    for _ in range(5 if quick else 50):
        start = time.perf_counter()
        numba_frame.loop(*arguments)
        least = min(least, time.perf_counter() - start)
    return least, peak, events


def pairs(helper):
    """All pairs of the far field; none where the records are not at hand."""
    records = cases.records_folder()
    if records is None:
        return []
    note("  two directions")
    command = [helper, "pairs", records / "fema_p695_far_field"]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = (dict(zip(PAIR_FIELDS, line.split("\t"))) for line in out.strip().split("\n"))
    return [{key: value if key == "name" else float(value) for key, value in row.items()} for row in rows]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--helper", required=True)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    out = subprocess.run([options.helper], capture_output=True, text=True, check=True).stdout
    ground, rows = taft(), []
    for line in out.strip().split("\n"):
        row = dict(zip(FIELDS, line.split("\t")))
        row = {key: value if key == "name" else float(value) for key, value in row.items()}
        storeys = int(row["storeys"])
        if row["name"] in ("n = 1, T = 0.1 s", "n = 2", "n = 5", "n = 10", "n = 20"):
            note(f"  numba, {row['name']}")
            seconds, peak, events = rival(ground, storeys, options.quick)
            row |= {
                "numba": seconds * 1e9,
                "numba_events": events,
                "numba_peak_error": peak / row["peak_m"] - 1.0,
            }
        rows.append(row)
    plane = pairs(options.helper)
    result = {"rows": rows, "pairs": plane}
    (options.folder / "storeys.json").write_text(json.dumps(result, indent=1) + "\n")
    (options.folder / "storeys.md").write_text(page(rows) + page_of_pairs(plane))


def page(rows):
    lines = [
        f"Measured on {machine('numba')}: nanoseconds a sample, the least of many runs.",
        "",
        "| system | events | demands | history over demands | with certificate over demands "
        "| set-up, µs | numba loop | numba over demands | its events | its peak off by |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for row in rows:
        samples = row["samples"]
        rival = " | | | "
        if "numba" in row:
            rival = (f"{row['numba'] / samples:.0f} | {row['numba'] / row['demands']:.1f} "
                     f"| {row['numba_events']} | {abs(row['numba_peak_error']):.0e}")
        lines.append(
            f"| {row['name']} | {row['events']:.0f} | {row['demands'] / samples:.1f} "
            f"| {row['history'] / row['demands']:.1f} | {row['checked'] / row['demands']:.1f} "
            f"| {row['set_up'] / 1000:.0f} | {rival} |"
        )
    return "\n".join(lines) + "\n"


def page_of_pairs(pairs):
    if not pairs:
        return ""
    lines = [
        "",
        "Two directions: the pairs of the far field of FEMA P-695 as recorded, a pendulum of 2.2 m with friction "
        "0.06; milliseconds of the demands, the least of many runs.",
        "",
        "| storeys | pairs | median | worst | over the component along x alone, median |",
        "|--:|--:|--:|--:|--:|",
    ]
    for storeys in sorted({row["storeys"] for row in pairs}):
        of = [row for row in pairs if row["storeys"] == storeys]
        both = np.array([row["both"] for row in of])
        ratio = np.median(both / np.array([row["along_x"] for row in of]))
        lines.append(
            f"| {storeys:.0f} | {len(of)} | {np.median(both) / 1e6:.1f} | {both.max() / 1e6:.1f} | {ratio:.0f} |"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
