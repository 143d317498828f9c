"""Times the Python package beside the command and the Rust call, interleaved.

Called by `cargo xtask bench-python`, which builds package, command and helper. Of every figure the least of
several turns is taken: on a shared machine others only ever add to it.
"""

import argparse
import compileall
import json
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import distributed
import pandas

import slipstick as ss
from machine import Process, machine, note
from slipstick.dask import submit_study

IMPORT = (
    "import numpy, time; t = time.perf_counter(); import slipstick; "
    "print(time.perf_counter() - t)"
)

PLAN = """\
model = "tank.toml"
[vary]
"slider.kinetic_friction" = {{ uniform = [0.02, 0.05] }}
"slider.static_friction" = {{ uniform = [0.05, 0.08] }}
[sampling]
method = "sobol"
count = {count}
seed = 1
"""


def least(turns, *functions):
    """The least seconds of each function over turns in which every one has its own."""
    best = [float("inf")] * len(functions)
    for _ in range(turns):
        for i, function in enumerate(functions):
            start = time.perf_counter()
            function()
            best[i] = min(best[i], time.perf_counter() - start)
    return best


def importing(turns):
    """Seconds of the import with NumPy loaded, its modules compiled to bytecode, as pip leaves them."""
    compileall.compile_dir(Path(ss.__file__).parent, quiet=1)
    call = [sys.executable, "-c", IMPORT]
    return min(
        float(subprocess.run(call, check=True, capture_output=True, text=True).stdout)
        for _ in range(turns)
    )


def calls(model, motion, turns):
    """Seconds of a call of `run`, and of what in it is not the analysis in Rust: the way there and back.

    Both times of the latter are of one call: two analyses differ by more than it.
    """
    whole, beyond = float("inf"), float("inf")
    for _ in range(turns):
        start = time.perf_counter()
        response = ss.run(model, motion)
        seconds = time.perf_counter() - start
        whole = min(whole, seconds)
        beyond = min(beyond, seconds - response._core._took_s())
        del response
    return whole, beyond


def single(helper, model_path, turns):
    """Seconds of one analysis in a Rust program and here, and of what a call here adds to it."""
    model = ss.Model.read(model_path)
    motion = ss.run(model).motion
    best = [float("inf")] * 3
    values = tomllib.loads(model_path.read_text(encoding="utf-8"))
    del values["slider"]["bounds"]
    alone = ss.Model(values)
    for _ in range(turns):
        best[0] = min(best[0], 1e-9 * min(map(int, helper.ask(20))))
        best[1] = min(best[1], calls(model, motion, 20)[0])
        best[2] = min(best[2], calls(alone, motion, 50)[1])
    return best


def light(helper, model_path, turns):
    """Seconds of the solver alone in a Rust program, and of a call here without history and check."""
    values = tomllib.loads(model_path.read_text(encoding="utf-8"))
    del values["slider"]["bounds"]
    alone, motion = ss.Model(values), ss.run(ss.Model.read(model_path)).motion
    best = [float("inf")] * 2
    for _ in range(turns):
        best[0] = min(best[0], 1e-9 * min(map(int, helper.ask("demands 50"))))
        for _ in range(50):
            start = time.perf_counter()
            ss.run(alone, motion, history=False, check=False)
            best[1] = min(best[1], time.perf_counter() - start)
    return best


def many(program, folder, examples, count, turns):
    """Seconds of a study by the command and here, and of its table in pandas."""
    shutil.copy(examples / "studies" / "tank.toml", folder / "tank.toml")
    text = (folder / "tank.toml").read_text()
    record = (examples / "records" / "taft-111.txt").resolve().as_posix()
    (folder / "tank.toml").write_text(text.replace("../records/taft-111.txt", record))
    plan, out = folder / "plan.toml", folder / "out"
    plan.write_text(PLAN.format(count=count))

    def command():
        shutil.rmtree(out, ignore_errors=True)
        subprocess.run([program, "study", plan, "--out", out, "-q"], check=True, stdout=subprocess.DEVNULL)

    def package():
        shutil.rmtree(out, ignore_errors=True)
        package.study = ss.study(plan, out)

    package()
    drawn = package.study.table
    paths = {name: drawn[name] for name in ("slider.kinetic_friction", "slider.static_friction")}
    model = ss.Model.read(folder / "tank.toml")
    motion = ss.run(model).motion

    def arrays():
        ss.demands(model, motion, paths)

    times = least(turns, command, package, arrays)
    table = package.study.table
    assert len(table) == count and package.study.failures == 0
    return [*times, *least(max(turns, 5), lambda: pandas.DataFrame.from_arrow(table))]


def cluster(folder, examples, count, turns):
    """Seconds of a study on one thread, on one worker of Dask and on two."""
    records = ss.read_suite(examples / "records" / "taft-111.txt", units="g", dt=0.01)
    model = ss.Model.read(examples / "studies" / "tank.toml")
    vary = {"slider.kinetic_friction": {"uniform": [0.02, 0.05]}}
    plan = ss.Plan(model, records, vary, samples=count, seed=1, scale=[2.0])
    times = {}
    for workers in [0, 1, 2]:
        out = folder / f"cluster-{workers}"

        def fresh():
            shutil.rmtree(out, ignore_errors=True)

        def alone():
            fresh()
            ss.study(plan, out, jobs=1)

        if workers == 0:
            times[workers] = least(turns, alone)[0]
            continue
        with (
            distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None
            ) as local,
            distributed.Client(local) as client,
        ):
            client.gather(client.map(_warm, range(4 * workers)))

            def shards():
                fresh()
                client.gather(submit_study(plan, client, out, shards=4 * workers))
                ss.study(plan, out, jobs=1)

            times[workers] = least(turns, shards)[0]
    return times


def _warm(_):
    import slipstick

    return slipstick.__version__


def markdown(result):
    def row(what, found, bar):
        return f"| {what} | {found} | {bar} |"

    r = result
    rows = [
        row("what a call of `run` adds to its work in Rust (motion, history, certificate, figures), both timed in "
            "the same call; `examples/taft.toml` without `slider.bounds`", f"{1e6 * r['beyond_s']:.1f} µs", "20 µs"),
        row("`run` of the whole `examples/taft.toml`: lower, nominal and upper friction",
            f"{1e3 * r['run_s']:.2f} ms", ""),
        row("the same in a Rust program", f"{1e3 * r['rust_s']:.2f} ms", ""),
        row("`run(history=False, check=False)` of it without `slider.bounds`, over the solver alone in a Rust program "
            f"({1e6 * r['solver_s']:.1f} µs)", f"{r['light_s'] / r['solver_s']:.2f} ×", "1.3 ×"),
        row("`import slipstick`, NumPy loaded", f"{1e3 * r['import_s']:.1f} ms", "20 ms"),
        row(
            f"{r['runs']} runs over the command ({r['command_s']:.2f} s)",
            f"{r['study_s'] / r['command_s']:.3f} ×",
            "1.05 ×",
        ),
        row("the same designs by `demands`, over the command", f"{r['demands_s'] / r['command_s']:.3f} ×", "1.05 ×"),
        row("their table in pandas", f"{1e3 * r['pandas_s']:.0f} ms", "100 ms"),
        row("wheel", f"{r['wheel_bytes'] / 1e6:.1f} MB", "5 MB"),
        row("`LocalCluster`, 1 worker of one thread over none",
            f"{r['cluster_s']['0'] / r['cluster_s']['1']:.2f}", "≥ 0.9"),
        row("`LocalCluster`, 2 workers over 1",
            f"{r['cluster_s']['1'] / r['cluster_s']['2']:.2f}", "≥ 1.7"),
    ]
    return "\n".join(
        [
            "<!-- Written by `cargo xtask bench-python --write`. -->",
            "",
            f"The least of {r['turns']} interleaved turns: {r['machine']}. {r['load']}",
            "",
            "| what | measured | bar |",
            "|---|--:|--:|",
            *rows,
            "",
        ]
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--helper", required=True)
    parser.add_argument("--slipstick", required=True)
    parser.add_argument("--examples", required=True, type=Path)
    parser.add_argument("--wheel", required=True, type=Path)
    parser.add_argument("--folder", required=True, type=Path)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    turns = 2 if options.quick else 7
    count = 4096 if options.quick else 100_000
    model = options.examples / "taft.toml"
    note("import")
    import_s = importing(10 * turns)
    note("one analysis")
    helper = Process([options.helper, str(model)])
    rust_s, run_s, beyond_s = single(helper, model, 10 * turns)
    solver_s, light_s = light(helper, model, 10 * turns)
    note("a study")
    command_s, study_s, demands_s, pandas_s = many(options.slipstick, options.folder, options.examples, count, turns)
    note("a cluster")
    cluster_s = cluster(options.folder, options.examples, count, min(turns, 3))
    load = Path("/proc/loadavg")
    busy = float(load.read_text().split()[1]) if load.is_file() else 0.0
    result = {
        "machine": machine("numpy", "pandas", "distributed"),
        "load": f"Mean load of the last five minutes: {busy:.1f}.",
        "turns": turns,
        "import_s": import_s,
        "rust_s": rust_s,
        "run_s": run_s,
        "beyond_s": beyond_s,
        "runs": count,
        "command_s": command_s,
        "study_s": study_s,
        "demands_s": demands_s,
        "solver_s": solver_s,
        "light_s": light_s,
        "pandas_s": pandas_s,
        "cluster_s": {str(workers): seconds for workers, seconds in cluster_s.items()},
        "wheel_bytes": options.wheel.stat().st_size,
    }
    (options.folder / "python.json").write_text(json.dumps(result, indent=1) + "\n")
    (options.folder / "python.md").write_text(markdown(result), encoding="utf-8")


if __name__ == "__main__":
    main()
