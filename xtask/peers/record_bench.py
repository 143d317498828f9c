"""Times reading records and response spectra here and in NumPy, ObsPy, eqsig and pyrotd, interleaved.

Called by `cargo xtask bench-records`, which builds the helper and makes the Python environment. All
files are in memory; times are medians over rounds in which every program has its turn. The record is
Taft, twenty times over where reading is timed.
"""

import argparse
import io
import json
import statistics
import time
import warnings
from pathlib import Path

import eqsig
import numpy as np
import obspy
import pyrotd

import cases
from machine import Process, machine, note

G = cases.RECORD_G
DAMPINGS = [0.01, 0.02, 0.05, 0.1, 0.2]
PERIODS = 0.02 * np.exp(np.arange(200) / 199 * np.log(500))


def seconds_of(answer):
    """Seconds of each turn, and the count that ends the answer."""
    *times, count = answer
    return [int(ns) * 1e-9 for ns in times], int(count)


def timed(function):
    """Seconds of one call, and what it returns."""
    start = time.perf_counter()
    out = function()
    return time.perf_counter() - start, out


def files(folder, values):
    """Name, path, what Slipstick is given, and the other programs by name."""
    dt, n = 0.01, len(values)
    at2 = "PEER STRONG MOTION DATABASE RECORD\nTaft, repeated\nACCELERATION TIME HISTORY IN UNITS OF G\n"
    at2 += f"NPTS= {n:7d}, DT= {dt:.4f} SEC\n"
    body = "".join(f"{v:15.7E}" + ("\n" if i % 5 == 4 else "") for i, v in enumerate(values))
    csv = "".join(f"{i * dt:.2f},{v * G:.6f}\n" for i, v in enumerate(values))
    column = "".join(f"{v:.6f}\n" for v in values)

    def write(name, data):
        (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        return folder / name

    head = "time_s,acceleration_m_per_s2\n"
    labelled = write("eqsig.txt", f"Taft\n{n} {dt}\n" + column)
    counts = np.round(values * 1e6).astype(np.int32)
    trace = obspy.Trace(counts, {"delta": dt, "network": "XX", "station": "TAFT", "channel": "HNE"})
    seed, sac = io.BytesIO(), io.BytesIO()
    obspy.Stream([trace]).write(seed, format="MSEED", encoding="STEIM2")
    trace.copy().write(sac, format="SAC")

    def split(text):
        return np.fromstring(text, sep=" ")

    return [
        ("AT2", write("taft.AT2", at2 + body + "\n"), (),
         {"NumPy fromstring": lambda: split((at2 + body).split("\n", 4)[4])}),
        ("CSV, two columns", write("taft.csv", head + csv), (),
         {"NumPy fromstring": lambda: split((head + csv).split("\n", 1)[1].replace(",", " ")).reshape(-1, 2),
          "NumPy loadtxt": lambda: np.loadtxt(io.StringIO(head + csv), delimiter=",", skiprows=1)}),
        ("one column", write("taft.txt", column), (dt, "g"),
         {"NumPy fromstring": lambda: split(column),
          "NumPy loadtxt": lambda: np.loadtxt(io.StringIO(column)),
          "eqsig load_values_and_dt": lambda: eqsig.load_values_and_dt(str(labelled))[0]}),
        ("MiniSEED, Steim2", write("taft.mseed", seed.getvalue()), ("-", "1e-6 g"),
         {"ObsPy": lambda: obspy.read(io.BytesIO(seed.getvalue()), format="MSEED")[0].data}),
        ("SAC", write("taft.sac", sac.getvalue()), ("-", "1e-6 g"),
         {"ObsPy": lambda: obspy.read(io.BytesIO(sac.getvalue()), format="SAC")[0].data}),
    ]


def reading(helper, folder, rounds):
    rows = []
    values = np.tile(cases.taft()[1], 20)
    for name, path, given, others in files(folder, values):
        note(f"  {name}")
        times = {"Slipstick": []} | {other: [] for other in others}
        for _ in range(rounds):
            took, count = seconds_of(helper.ask("read", path, 5, *given))
            if count != len(values):
                raise SystemExit(f"bench-records: {count} values of {len(values)} in {path}")
            times["Slipstick"] += took
            for other, function in others.items():
                seconds, found = timed(function)
                if len(np.asarray(found)) != len(values):
                    raise SystemExit(f"bench-records: {other} finds {len(found)} values in {path}")
                times[other].append(seconds)
        size = path.stat().st_size
        median = {other: statistics.median(each) for other, each in times.items()}
        rows += [{"file": name, "program": other, "bytes": size, "seconds": median[other],
                  "times_slipstick": median[other] / median["Slipstick"]} for other in times]
    return rows


def spectra(helper, folder, rounds, quick):
    """200 periods by five damping ratios of 60 s at 200 Hz."""
    values = cases.taft()[1]
    fine = np.interp(np.arange(2 * len(values) - 1) / 2, np.arange(len(values)), values) * G
    fine = np.concatenate([fine, np.zeros(12001)])[:12001]
    source, out = folder / "spectrum.bin", folder / "psa.bin"
    fine.astype("<f8").tofile(source)
    others = {
        "eqsig": lambda: np.array(
            [eqsig.sdof.pseudo_response_spectra(fine, 0.005, PERIODS, xi)[2] for xi in DAMPINGS]),
        "pyrotd": lambda: np.array(
            [pyrotd.calc_spec_accels(0.005, fine, 1 / PERIODS, xi).spec_accel for xi in DAMPINGS]),
    }
    times = {"Slipstick": []} | {other: [] for other in others}
    found = {}
    for _ in range(1 if quick else rounds):
        times["Slipstick"] += seconds_of(helper.ask("spectrum", source, 0.005, 5, out))[0]
        for other, function in others.items():
            note(f"  {other}")
            seconds, found[other] = timed(function)
            times[other].append(seconds)
    ours = np.fromfile(out, "<f8").reshape(len(DAMPINGS), len(PERIODS))
    median = {other: statistics.median(each) for other, each in times.items()}
    rows = []
    for other in times:
        differs = [] if other == "Slipstick" else np.abs(found[other] / ours - 1).ravel()
        rows.append({"program": other, "seconds": median[other],
                     "times_slipstick": median[other] / median["Slipstick"],
                     "difference_median": float(np.median(differs)) if len(differs) else None,
                     "difference_largest": float(np.max(differs)) if len(differs) else None})
    return rows


def markdown(result):
    lines = [
        "<!-- Written by `cargo xtask bench-records --write`. -->",
        "",
        f"Medians of one interleaved run on one thread: {result['machine']}.",
        "",
        "Reading a file that is in memory. NumPy is given the values alone: it reads no header, checks "
        "no count and finds no units.",
        "",
        "| file | program | time | MB/s | × Slipstick |",
        "|---|---|--:|--:|--:|",
    ]
    for row in result["reading"]:
        lines.append(f"| {row['file']} | {row['program']} | {1e3 * row['seconds']:.4g} ms | "
                     f"{row['bytes'] / row['seconds'] / 1e6:.0f} | {row['times_slipstick']:.3g} |")
    lines += [
        "",
        "Response spectra of 200 periods and five damping ratios, 60 s at 200 Hz. The last columns are "
        "the difference of PSa from Slipstick's; eqsig takes the largest value at samples, pyrotd works "
        "by Fourier transform.",
        "",
        "| program | time | × Slipstick | median difference | largest |",
        "|---|--:|--:|--:|--:|",
    ]
    for row in result["spectra"]:
        differs = [row["difference_median"], row["difference_largest"]]
        cells = ["" if d is None else f"{d:.1e}" for d in differs]
        lines.append(f"| {row['program']} | {1e3 * row['seconds']:.4g} ms | "
                     f"{row['times_slipstick']:.3g} | {cells[0]} | {cells[1]} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--helper", required=True)
    parser.add_argument("--folder", required=True, type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore", DeprecationWarning)
    helper = Process(options.helper)
    rounds = 3 if options.quick else 15
    note("reading")
    rows = reading(helper, options.folder, rounds)
    note("spectra")
    result = {
        "machine": machine("numpy", "obspy", "eqsig", "pyrotd"),
        "reading": rows,
        "spectra": spectra(helper, options.folder, 3, options.quick),
    }
    (options.folder / "records.json").write_text(json.dumps(result, indent=1) + "\n")
    (options.folder / "records.md").write_text(markdown(result))


main()
