"""The far-field study: how long it takes, on how many threads, in how much memory; a part of the
same runs in a numba loop and in OpenSeesPy, scaled to the whole; and its parts as one table in
pandas, Polars and DuckDB."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import duckdb
import numpy as np

import cases
import numba_loop
import opensees
from machine import machine, note
from readers import as_one_table

# The study's model takes g as records do.
cases.GRAVITY = cases.RECORD_G

BLOCK_KG, FLOOR_KG, DAMPING = 20e3, 30e3, 0.05


def prepare(folder):
    """The example with its records beside it; `None` where there are none."""
    records = cases.records_folder()
    if records is None:
        return None
    source = cases.ROOT / "examples" / "studies"
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("tank.toml", "far-field.toml"):
        shutil.copy(source / name, folder / name)
    far_field = folder / "far-field"
    far_field.mkdir(exist_ok=True)
    for path in (records / "fema_p695_far_field").iterdir():
        shutil.copy(path, far_field / path.name)
    return folder / "far-field.toml"


def run(slipstick, plan, out, jobs):
    """Seconds and peak memory in bytes of one study."""
    shutil.rmtree(out, ignore_errors=True)
    command = [slipstick, "study", plan, "--out", out, "--jobs", str(jobs), "-q"]
    start = time.perf_counter()
    child = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.perf_counter() - start
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"bench-study: slipstick ended with {child.returncode}")
    scale = 1 if sys.platform == "darwin" else 1024
    return seconds, usage.ru_maxrss * scale, usage.ru_utime + usage.ru_stime


def with_count(plan, count):
    """A copy of the plan with another number of samples."""
    text = plan.read_text().replace("count  = 1000", f"count  = {count}")
    other = plan.with_name(f"far-field-{count}.toml")
    other.write_text(text)
    return other


def rows(out, runs):
    table = f"read_parquet('{out}/parts/*.parquet')"
    columns = ('run, record, scale, "slider.kinetic_friction", "slider.static_friction", '
               '"slider.radius", "storey.1.period", peak_sliding_displacement_m')
    listed = ", ".join(map(str, runs))
    query = f"select {columns} from {table} where run in ({listed}) order by run"
    return duckdb.sql(query).fetchall()


def case_of(row, folder, cache):
    run_, record, scale, kinetic, static, radius, period, _ = row
    if record not in cache:
        path = folder / record
        if path.suffix == ".AT2":
            cache[record] = cases.read_record(path)
        else:
            lines = (line.split() for line in path.read_text().splitlines())
            pairs = np.array([line for line in lines if len(line) == 2], float)
            cache[record] = float(round(pairs[1, 0] - pairs[0, 0], 9)), pairs[:, 1]
    dt, values = cache[record]
    k, c = cases.storey(FLOOR_KG, 1.0 / period, DAMPING)
    spring = (BLOCK_KG + FLOOR_KG) * cases.GRAVITY / radius
    ground = values * cases.RECORD_G * scale
    return cases.Case(str(run_), record, BLOCK_KG, FLOOR_KG, spring, k, c, static, kinetic, dt,
                      ground)


def peers(out, folder, runs, quick):
    """Seconds a run of the numba loop and of OpenSeesPy, and how far their peaks are from ours."""
    stride = runs // (88 if quick else 880)
    chosen = rows(out, range(stride // 2, runs, stride))
    cache = {}
    listed = [case_of(row, folder, cache) for row in chosen]
    arguments = [numba_loop.prepare(case) for case in listed]
    numba_loop.loop(*arguments[0])
    start = time.perf_counter()
    peaks = [numba_loop.loop(*argument)[2] for argument in arguments]
    numba_seconds = (time.perf_counter() - start) / len(listed)
    ours = np.array([row[-1] for row in chosen])
    numba_error = float(np.max(np.abs(np.array(peaks) - ours) / np.maximum(ours, 1e-9)))
    ops = opensees.load()
    few = range(0, len(listed), len(listed) // (4 if quick else 22))
    start = time.perf_counter()
    for index in few:
        opensees.run(ops, listed[index], 1e-5)
    return {
        "numba_runs": len(listed),
        "numba_seconds": numba_seconds,
        "numba_error": numba_error,
        "opensees_runs": len(few),
        "opensees_seconds": (time.perf_counter() - start) / len(few),
    }


def thousands(number):
    return f"{number:,.0f}".replace(",", "\u202f")


def markdown(result):
    whole, mem = result["whole"], result["memory"]
    one, two = result["threads"]["1"], result["threads"]["2"]
    peers_ = result["peers"]
    runs = result["runs"]
    lines = [
        "<!-- Written by `cargo xtask bench-study --write`. -->",
        "",
        f"One run: {result['machine']}.",
        "",
        f"The far-field example, {runs} runs (44 records, 20 levels, {runs // 880} designs), with "
        "its rows written, every thousandth run again and certified, and summarised:",
        "",
        "| | |",
        "|---|--:|",
        f"| time on {whole['jobs']} threads | {whole['seconds']:.1f} s |",
        f"| runs a second | {thousands(runs / whole['seconds'])} |",
        f"| each run beyond the first {result['part']}, on {whole['jobs']} threads | "
        f"{1e6 * result['seconds_a_further_run']:.0f} µs |",
        f"| {result['part']} runs, one thread over two | {one / two:.2f} × |",
        f"| numba's loop, the same runs on one thread, scaled from {peers_['numba_runs']} | "
        f"{peers_['numba_seconds'] * runs:.0f} s |",
        f"| largest difference of a peak from numba's | {peers_['numba_error']:.1e} |",
        f"| OpenSeesPy, scaled from {peers_['opensees_runs']} runs | "
        f"{peers_['opensees_seconds'] * runs / 3600:.1f} h |",
        f"| numba over Slipstick, both on one thread | "
        f"{peers_['numba_seconds'] / result['seconds_a_run_on_one_thread']:.1f} × |",
        f"| OpenSeesPy over Slipstick, both on one thread | "
        f"{thousands(peers_['opensees_seconds'] / result['seconds_a_run_on_one_thread'])} × |",
        "",
        "Peak memory of the whole process:",
        "",
        "| runs | memory |",
        "|--:|--:|",
    ]
    lines += [f"| {runs} | {size / 2**20:.0f} MiB |" for runs, size in mem]
    lines += ["", f"{result['table']['readers']} open the folder of its parts as one table: "
              f"{result['table']['rows']} rows, {result['table']['ok']} of them ok.", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--slipstick", required=True)
    parser.add_argument("--folder", required=True, type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    plan = prepare(options.folder)
    if plan is None:
        raise SystemExit("bench-study: expected the far-field records in $SLIPSTICK_RECORDS")
    out = options.folder / "out"
    counts = [11, 34, 114] if options.quick else [11, 341, 1000]
    part = with_count(plan, counts[1])
    note("one thread and two")
    seconds = {1: [], 2: []}
    for _ in range(2):
        for jobs in seconds:
            seconds[jobs].append(run(options.slipstick, part, out, jobs)[0])
    threads = {str(jobs): min(each) for jobs, each in seconds.items()}
    took, memory = {}, []
    for count in counts:
        note(f"{880 * count} runs")
        jobs = min(2, os.cpu_count() or 1)
        took[count], size, _ = run(options.slipstick, with_count(plan, count), out, jobs)
        memory.append((880 * count, size))
    runs = 880 * counts[-1]
    note("peers")
    result = {
        "machine": machine("openseespy", "numba"),
        "runs": runs,
        "part": 880 * counts[1],
        "whole": {"jobs": jobs, "seconds": took[counts[2]]},
        "threads": threads,
        "seconds_a_run_on_one_thread": threads["1"] / (880 * counts[1]),
        "seconds_a_further_run": (took[counts[2]] - took[counts[1]]) / (runs - 880 * counts[1]),
        "memory": memory,
        "table": as_one_table(out / "parts", runs),
        "peers": peers(out, options.folder, runs, options.quick),
    }
    (options.folder / "studies.json").write_text(json.dumps(result, indent=1) + "\n")
    (options.folder / "studies.md").write_text(markdown(result))


main()
