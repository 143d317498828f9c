"""The package as its users meet it."""

import inspect
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import slipstick as ss
from slipstick import _core
from support import EXAMPLES, block, command, pulse, suite

MODELS = ["taft.toml", "el-centro.toml", "frame-pendulum.toml"]

PLAN = """\
model = "{model}"
[vary]
"slider.kinetic_friction" = {{ uniform = [0.02, 0.05] }}
"slider.static_friction" = {{ uniform = [0.05, 0.08] }}
[sampling]
method = "sobol"
count = {samples}
seed = 1
"""


def plan(folder: Path, samples: int = 32) -> Path:
    path = folder / "plan.toml"
    path.write_text(PLAN.format(model=(EXAMPLES / "studies" / "tank.toml").as_posix(), samples=samples))
    return path


@pytest.mark.parametrize("name", MODELS)
def test_figures_are_those_of_the_command_bit_for_bit(name: str) -> None:
    command = os.environ.get("SLIPSTICK_COMMAND")
    if command is None:
        pytest.skip("SLIPSTICK_COMMAND is not set")
    path = EXAMPLES / name
    printed = subprocess.run(
        [command, "run", str(path), "--json", "-q"], check=True, capture_output=True, text=True
    ).stdout
    response = ss.run(ss.Model.read(path))
    assert response._core._summary_json() == printed
    assert response.holds


def test_history_has_the_columns_of_the_file_and_the_peak() -> None:
    response = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    history, knots = response.history, response.knots
    assert list(history)[:3] == ["time_s", "table_acceleration_m_per_s2", "sliding_displacement_m"]
    assert len(history["time_s"]) == response.summary["samples"] < len(knots["time_s"])
    peak = np.abs(knots["sliding_displacement_m"]).max()
    assert peak == response.summary["peak_sliding_displacement_m"]
    assert set(np.unique(knots["direction"])) <= {-1.0, 0.0, 1.0}
    assert len(response.energy["input_j"]) == len(knots["time_s"])
    with pytest.raises(ValueError, match="read-only"):
        history["time_s"][0] = 1.0
    with pytest.raises(TypeError):
        history["time_s"] = history["time_s"]  # type: ignore[index]


def test_a_motion_from_an_array_is_the_motion_of_the_file() -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    record = ss.read_record(EXAMPLES / "records" / "taft-021.txt", units="g", dt="0.01 s")
    array = ss.Motion(record.acceleration_m_per_s2, dt=record.dt_s, units="m/s2")
    assert array == record
    assert ss.run(model, array).events == ss.run(model, record).events
    scaled = record.scaled(pga="0.3 g")
    assert scaled.pga_m_per_s2 == pytest.approx(0.3 * 9.80665, rel=1e-15)
    times = ss.Motion(record.acceleration_m_per_s2, times_s=record.time_s, units="m/s2")
    assert times == record


def test_models_change_and_compare() -> None:
    model = block()
    changed = model.with_({"slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    assert changed != model and changed.value("slider.kinetic_friction") == 0.05
    assert model.value("slider.kinetic_friction") == 0.08
    assert changed == ss.Model.from_toml(changed.toml)
    assert len({model, block(), changed}) == 2
    assert changed.values["slider.radius"] == "2 m"
    keys = {"floor": 0, "mass": "200 kg", "static_friction": 0.3, "kinetic_friction": 0.25}
    added = model.with_({f"contents.1.{key}": value for key, value in keys.items()})
    assert added.values["contents.1.mass"] == "200 kg" and added == model.with_({"contents": [keys]})
    with pytest.raises(ss.InputError, match="expected contents.1, for there is none yet"):
        model.with_({"contents.2.mass": "200 kg"})


@pytest.mark.parametrize("value", [block(), pulse(), ss.Model.read(EXAMPLES / "taft.toml")])
def test_values_pickle(value: object) -> None:
    assert pickle.loads(pickle.dumps(value)) == value


def test_arrays_need_not_be_aligned() -> None:
    buffer = np.zeros(4 * 8 + 1, dtype="u1")
    skewed = np.frombuffer(buffer[1:].data, dtype="f8")
    assert not skewed.flags.aligned
    assert len(ss.Motion(skewed, dt=0.5, units="g")) == 4
    assert len(ss.Motion(np.zeros(8)[::2], dt=0.5, units="g")) == 4


def test_inputs_that_cannot_be_are_told() -> None:
    with pytest.raises(ss.InputError) as caught:
        ss.Model.from_toml('[block]\nmass = "3 mm"\n', "tank.toml")
    error = caught.value
    assert (error.source, error.line, error.column, error.path) == ("tank.toml", 2, 8, "block.mass")
    assert "mass" in error.expected and "3 mm" in error.found
    back = pickle.loads(pickle.dumps(error))
    assert str(back) == str(error) and back.line == 2
    with pytest.raises(ss.InputError) as caught:
        block().with_({"slider.radus": "2 m"})
    assert caught.value.nearest == "slider.radius"
    for wrong in [{"block.mass": "325"}, {"block.mass": True}, {"block.mass": [1]}, {}, {1: 2}]:
        with pytest.raises(ss.InputError):
            ss.Model(wrong)  # type: ignore[arg-type]
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        ss.Model.read("nowhere.toml")
    with pytest.raises(ss.InputError, match="motion"):
        ss.run(block())


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"acceleration": [0.0, np.nan, 1.0], "dt": 0.1}, "sample 1"),
        ({"acceleration": [[0.0, 1.0]], "dt": 0.1}, "shape"),
        ({"acceleration": ["a"], "dt": 0.1}, "type"),
        ({"acceleration": [1j, 0], "dt": 0.1}, "type"),
        ({"acceleration": [0.0, 1.0]}, "dt"),
        ({"acceleration": [0.0, 1.0], "dt": "0.1 m"}, "dt"),
        ({"acceleration": [0.0, 1.0], "dt": -1.0}, "dt"),
        ({"acceleration": [0.0, 1.0], "dt": 0.1, "times_s": [0, 1]}, "both"),
        ({"acceleration": [0.0, 1.0], "times_s": [0, 1, 2]}, "times_s"),
        ({"acceleration": [0.0, 1.0], "dt": 0.1, "vertical": [0.0]}, "vertical"),
        ({"acceleration": [0.0, 1.0], "dt": 0.1, "units": "kg"}, "units"),
        ({"acceleration": [], "dt": 0.1}, "sample"),
    ],
)
def test_arrays_that_are_no_motion_are_told(arguments: dict[str, object], told: str) -> None:
    with pytest.raises(ValueError, match=told) as caught:
        ss.Motion(**{"units": "g", **arguments})  # type: ignore[arg-type]
    assert isinstance(caught.value, (ss.InputError, ss.RecordError))


def test_records_that_are_none_are_told(tmp_path: Path) -> None:
    path = tmp_path / "bad.txt"
    path.write_text("0\nx\n0\n")
    with pytest.raises(ss.RecordError) as caught:
        ss.read_record(path, units="g", dt=0.01)
    assert (caught.value.line, caught.value.column, caught.value.found) == (2, 1, "x")
    with pytest.raises(FileNotFoundError):
        ss.read_record(tmp_path / "none.txt")


def test_no_answer_has_a_time() -> None:
    stepwise = block().with_({"analysis.method": "stepwise", "slider.spring": "1e9 kN/m"})
    with pytest.raises(ss.SolveError) as caught:
        ss.run(stepwise, pulse())
    assert caught.value.time_s is not None


def test_the_report_is_one_page(tmp_path: Path) -> None:
    response = ss.run(block(), pulse())
    page = response.report(tmp_path / "report.html", units="us").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and " in<" in page
    with pytest.raises(ss.InputError, match="units"):
        response.report(tmp_path / "report.html", units="furlong")


def test_a_study_is_one_table_for_four_libraries(tmp_path: Path) -> None:
    study = ss.study(plan(tmp_path))
    table = study.table
    assert study.runs == len(table) == 32 and study.failures == 0
    name = "peak_sliding_displacement_m"
    values = table[name]
    assert table.units[name] == "m"
    pandas = pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    duckdb = pytest.importorskip("duckdb")
    arrow = pyarrow.table(table)
    assert arrow.schema.field(name).metadata[b"unit"] == b"m"
    found = duckdb.sql(f"select {name} from arrow").fetchnumpy()[name]
    for column in [
        arrow[name].to_numpy(),
        polars.DataFrame(table)[name].to_numpy(),
        pandas.DataFrame.from_arrow(table)[name].to_numpy(),
        found,
    ]:
        assert np.array_equal(column, values)


def test_a_study_in_a_folder_is_that_of_the_command(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    study = ss.study(plan(tmp_path, 4096), tmp_path / "a", progress=lambda *at: seen.append(at))
    assert study.runs == 4096
    again = ss.study(plan(tmp_path, 4096), tmp_path / "a")
    assert again.table == study.table
    command = os.environ.get("SLIPSTICK_COMMAND")
    if command is None:
        pytest.skip("SLIPSTICK_COMMAND is not set")
    out = tmp_path / "b"
    subprocess.run([command, "study", tmp_path / "plan.toml", "--out", out, "-q"], check=True)
    for part in sorted((out / "parts").iterdir()):
        assert part.read_bytes() == (tmp_path / "a" / "parts" / part.name).read_bytes()


def values(samples: int = 64) -> ss.Plan:
    return ss.Plan(
        ss.Model.read(EXAMPLES / "studies" / "tank.toml"),
        suite(),
        {"slider.kinetic_friction": {"uniform": [0.02, 0.05]}, "slider.radius": ["1 m", "2 m"]},
        samples=samples,
        seed=3,
        measure="PGA",
        scale_to=["0.2 g", "0.4 g"],
    )


def test_a_plan_of_values_is_the_plan_of_its_files(tmp_path: Path) -> None:
    plan = values()
    study = ss.study(plan)
    assert study.runs == 3 * 2 * 64 and study.failures == 0
    of_files = ss.study(plan.write(tmp_path)).table
    assert set(of_files["record"]) == {f"records/{name}.csv" for name in suite()}
    # What is of values keeps the names of the records.
    assert set(study.table["record"]) == set(suite())
    name = "peak_sliding_displacement_m"
    assert np.array_equal(study.table[name], of_files[name])
    assert pickle.loads(pickle.dumps(plan)).digest == plan.digest
    assert values(128).digest != plan.digest
    names = ["../a", "b/c.AT2", "100 %", "*", ".d"]
    assert ss.study(ss.Plan(block(), {name: pulse() for name in names})).table["record"] == names
    with pytest.raises(ss.InputError, match="^records: expected names that are not empty"):
        ss.study(ss.Plan(block(), {"": pulse()}))


def test_dask_gives_the_bytes_of_one_process(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from slipstick.dask import run_study

    plan = values(1024)
    alone = ss.study(plan, tmp_path / "alone")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        together = run_study(plan, client, tmp_path / "together", shards=4)
        of_a_path = run_study(plan.write(tmp_path), client, tmp_path / "path", shards=2)
    assert together.table == alone.table and len(of_a_path.table) == len(alone.table)
    for part in (tmp_path / "alone" / "parts").iterdir():
        for folder in ["together", "path"]:
            assert part.read_bytes() == (tmp_path / folder / "parts" / part.name).read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="processes are killed as POSIX does")
def test_a_killed_worker_changes_no_byte_of_the_command(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from slipstick.dask import submit_study

    plan, out = values(4096), tmp_path / "together"
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = client.run(os.getpid)
        futures = submit_study(plan, client, out, shards=16)
        deadline = time.monotonic() + 60
        while not any(out.glob("parts/part-*.parquet")):
            assert time.monotonic() < deadline
            time.sleep(0.005)
        os.kill(next(iter(workers.values())), signal.SIGKILL)
        unfinished = sum(future.status != "finished" for future in futures)
        client.gather(futures)
    assert unfinished > 0, "the worker was killed too late to matter"
    ss.study(plan, out)
    command("study", plan.write(tmp_path), "--out", tmp_path / "alone", "-q")
    parts = sorted((tmp_path / "alone" / "parts").iterdir())
    assert [part.name for part in parts] == sorted(part.name for part in (out / "parts").iterdir())
    for part in parts:
        assert part.read_bytes() == (out / "parts" / part.name).read_bytes()


def test_a_plan_that_cannot_be_is_told(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text('model = "nowhere.toml"\n')
    with pytest.raises(ss.InputError) as caught:
        ss.study(path)
    assert caught.value.line == 1 and caught.value.path == "model"


def test_threads_share_models() -> None:
    model, motion = block(), pulse()
    expected = ss.run(model, motion).events
    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(lambda _: ss.run(model, motion).events == expected, range(100)))


def _run_in_child(queue: "multiprocessing.Queue[bool]", folder: str) -> None:
    queue.put(ss.study(plan(Path(folder)), jobs=2).failures == 0)


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_after_a_study_do_not_hang(tmp_path: Path, method: str) -> None:
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"this system cannot {method}")
    ss.study(plan(tmp_path), jobs=2)
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    child = context.Process(target=_run_in_child, args=(queue, str(tmp_path)))
    child.start()
    assert queue.get(timeout=60)
    child.join(60)


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX does")
def test_ctrl_c_stops_a_study_and_leaves_whole_parts(tmp_path: Path) -> None:
    path, out = plan(tmp_path, 1 << 21), tmp_path / "out"
    code = "import sys, slipstick as ss\nss.study(sys.argv[1], sys.argv[2])"
    child = subprocess.Popen([sys.executable, "-c", code, path, out], stderr=subprocess.PIPE)
    parts = out / "parts"
    deadline = time.monotonic() + 60
    while not (parts.is_dir() and any(parts.glob("part-*.parquet"))):
        assert child.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    child.send_signal(signal.SIGINT)
    _, told = child.communicate(timeout=30)
    assert b"KeyboardInterrupt" in told
    assert all(part.name.startswith("part-") for part in parts.iterdir())


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX does")
@pytest.mark.parametrize("method", ["exact", "stepwise"])
def test_ctrl_c_stops_one_long_analysis(method: str) -> None:
    # Nine million samples, near the most that a history may have, and twenty storeys: with its certificate many seconds either way.
    count, storeys = {"exact": (9_000_000, 0), "stepwise": (1_000_000, 20)}[method]
    code = f"""
import os, signal, threading, time
import numpy as np
import slipstick as ss

def interrupt():
    global sent
    time.sleep(0.4)
    sent = time.monotonic(), time.process_time()
    os.kill(os.getpid(), signal.SIGINT)

storey = {{"mass": "1 t", "stiffness": "4 kN/mm", "damping_ratio": 0.05}}
frame = {{"storey": [storey] * {storeys}}} if {storeys} else {{}}
slider = {{"static_friction": 0.1, "kinetic_friction": 0.08}}
model = ss.Model({{"block": {{"mass": "1 t"}}, "slider": slider, "analysis": {{"method": "{method}"}}, **frame}})
motion = ss.Motion(np.sin(0.05 * np.arange({count})), dt=0.005, units="m/s2")
threading.Thread(target=interrupt).start()
try:
    ss.run(model, motion)
except KeyboardInterrupt:
    print(time.monotonic() - sent[0], time.process_time() - sent[1])
"""
    told = []
    # Others only ever add to the time: the least of three counts, of that on the clock and that on the processor.
    for _ in range(3):
        ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
        assert ended.returncode == 0 and ended.stdout, ended.stderr
        told += map(float, ended.stdout.split())
        if min(told) < 0.2:
            return
    raise AssertionError(f"interrupted after {told} s")


def test_an_exception_of_progress_stops_the_work(tmp_path: Path) -> None:
    def stop(done: int, planned: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ss.study(plan(tmp_path, 1 << 21), tmp_path / "out", progress=stop)


def test_other_threads_go_on_while_a_study_runs(tmp_path: Path) -> None:
    turns: list[float] = []
    over = threading.Event()

    def count() -> None:
        while not over.is_set():
            turns.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=count, daemon=True)
    thread.start()
    ss.study(plan(tmp_path, 4096))
    over.set()
    thread.join()
    assert len(turns) > 10


def test_figures_return_axes(tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    response = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    axes = response.plot()
    assert len(axes) == 3
    axes[0].figure.savefig(tmp_path / "figure.png")
    _, ax = matplotlib.pyplot.subplots()
    assert response.plot.loop(ax=ax) is ax
    # On axes of one's own the history alone, as of motions and comparisons.
    assert response.plot(ax=ax, color="k") is ax and ax.get_ylabel() == "Sliding displacement s (mm)"
    plot = response.plot
    for draw in [plot.history, plot.acceleration, plot.energy, plot.drift, plot.demand]:
        assert draw().get_xlabel() == "Time (s)"
    with pytest.raises(ValueError, match="floor_spectrum=True"):
        plot.floor_spectra()
    spectra = ss.run(response.model, floor_spectrum=True).plot.floor_spectra()
    assert len(spectra.lines) == 3
    with pytest.raises(ValueError, match="contents"):
        plot.contents()
    devices = ss.Model(
        {
            "block": {"mass": "325 kg"},
            "slider": {"static_friction": 0.1, "kinetic_friction": 0.08},
            "contents": [{"floor": 0, "mass": "1 kg", "static_friction": 0.05, "kinetic_friction": 0.04}],
        }
    )
    assert ss.run(devices, pulse()).plot.contents().get_legend_handles_labels()[1] == ["contents 1 on block"]
    matplotlib.pyplot.close("all")


def test_ida_and_fragility_are_those_of_the_command(tmp_path: Path) -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    records = suite()
    assert list(records) == ["taft-021", "taft-111", "el-centro-180"]
    ida = ss.ida(model, records, scale_to="0.1..0.8 g:8", limit="40 mm")
    assert len(ida.table) == 72 and len(ida.tables["capacities"]) == 9
    ida = ss.ida(model, records, scale_to="0.1..0.8 g:8", limit="40 mm", bounds="nominal")
    assert len(ida.table) == 24
    with pytest.raises(ss.StudyError, match="are separated"):
        ss.fragility(ida)
    curve = ss.fragility(ida, fit_to="capacities")
    assert "fragility" in curve.tables and "<svg" in next(iter(curve.figures.values()))
    command = os.environ.get("SLIPSTICK_COMMAND")
    if command is None:
        pytest.skip("SLIPSTICK_COMMAND is not set")
    path = EXAMPLES / "taft.toml"
    names = [str(EXAMPLES / "records" / name) for name in ["taft-*.txt", "el-centro-180.txt"]]
    subprocess.run(
        [command, "ida", path, "--records", names[0], "--records", names[1], "--units", "g"]
        + ["--dt", "0.01 s", "--scale-to", "0.1..0.8 g:8", "--limit", "40 mm", "-q"]
        + ["--bounds", "nominal", "--out", tmp_path / "out"],
        check=True,
        capture_output=True,
    )
    assert ida.table.to_csv() == (tmp_path / "out" / "ida.csv").read_text()


def test_keywords_are_the_fields_of_the_request() -> None:
    functions = [ss.run, ss.suite, ss.spectrum, ss.sensitivity, ss.ida, ss.fragility, ss.design, ss.compare]
    functions += [ss.identify.cyclic, ss.identify.free_vibration, ss.identify.shaking_table]
    what_goes_in = {"model", "models", "motion", "motions", "records", "second", "target", "source", "tests", "measured"}
    what_goes_in |= {"levels", "exceeded", "runs", "capacities", "reached"}
    what_is_kept = {"history", "check"}
    for function in functions:
        keywords = inspect.signature(function).parameters
        fields = {name: default for name, _, _, default, _ in _core.fields(function.__name__.replace("_", "-"))}
        beside = what_goes_in | what_is_kept | {"jobs", "progress"}
        assert set(keywords) - beside == set(fields), function
        # Defaults stand in the core alone.
        for name in fields:
            assert keywords[name].default in (None, (), False, inspect.Parameter.empty), name


def test_a_suite_is_that_of_the_command(tmp_path: Path) -> None:
    model, records = ss.Model.read(EXAMPLES / "taft.toml"), suite()
    found = ss.suite(model, records, measure="PGV", scale_to="0.3 m/s")
    path = tmp_path / "out"
    names = [str(EXAMPLES / "records" / name) for name in ["taft-*.txt", "el-centro-180.txt"]]
    files = ["--records", *names, "--units", "g", "--dt", "0.01 s"]
    asked = ["--measure", "PGV", "--scale-to", "0.3 m/s", "--out", path, "--json", "-q"]
    assert found._core._summary_json() == command("run", EXAMPLES / "taft.toml", *files, *asked)
    assert found.table.to_csv() == (path / "runs.csv").read_text()
    # What reading a file said is not lost on the way.
    assert [warning["kind"] for warning in found.summary["warnings"]] == ["first_sample_not_zero"]
    pairs = {name: records[name] for name in list(records)[:2]}
    other = dict(reversed(pairs.items()))
    together = ss.suite(model, pairs, second=other, scale=2.0)
    assert len(together.table) == 2 * 3 and "peak_sliding_displacement_100_30_m" in together.table.columns
    both = ss.suite({"a": model, "b": model}, pairs, second=other, scale=2.0, pairs="separate")
    assert len(both.table) == 2 * 4 * 3 and "pair" in both.table.columns
    with pytest.raises(ss.InputError, match="^scale: expected only one of scale and scale_to, found both$"):
        ss.suite(model, records, scale=2.0, scale_to="0.3 g")
    with pytest.raises(ss.InputError, match="^periods: expected target or code_spectrum beside them"):
        ss.suite(model, records, periods="1 s..2 s")
    with pytest.raises(ss.InputError, match="^second: expected one other component for each of 3"):
        ss.ida(model, records, second=pairs)


def test_what_is_wrong_with_a_plan_is_said_of_its_argument() -> None:
    records = suite()
    for wrong, message in [
        ({"records": {}}, "^records: expected at least one motion"),
        ({"records": None, "scale": [2.0]}, r"^scale: expected records beside it, found \[2.0\]$"),
        ({"records": None, "scale_to": ["1 g"]}, "^scale_to: expected records beside it"),
        ({"samples": 3}, "^samples: expected vary beside it, found 3$"),
        ({"second": {}}, "^second: expected one other component for each of 3 records, found 0$"),
        ({"measure": "PGAA", "scale_to": ["0.1 g"]}, "^measure: expected "),
        ({"scale": [1.0, 1.0]}, "^scale: expected factors that differ, found 1 twice$"),
        ({"vary": {"slider.radios": ["1 m"]}, "method": "grid"}, '^vary.slider.radios: .*nearest is "slider.radius"$'),
        ({"vary": {"slider.radius": ["1 m"]}, "samples": 0}, "^samples: expected "),
    ]:
        with pytest.raises(ss.InputError, match=message):
            ss.study(ss.Plan(block(), **{"records": records, **wrong}))  # type: ignore[arg-type]


def test_levels_are_text_or_a_list() -> None:
    model, records = ss.Model.read(EXAMPLES / "taft.toml"), suite()
    text, listed = "0.1, 0.2 g", ["0.1 g", "0.2 g"]
    by_text, by_list = (ss.ida(model, records, scale_to=levels) for levels in (text, listed))
    assert by_text.table == by_list.table
    plans = [ss.Plan(model, records, measure="PGA", scale_to=levels) for levels in (text, listed)]
    by_text, by_list = (ss.study(plan).table for plan in plans)
    assert by_text == by_list
    ranged = ss.Plan(model, records, measure="PGA", scale_to="0.1..0.3 g:3", bounds="nominal")
    assert ss.study(ranged).runs == 9


def test_a_folder_is_a_source_and_knows_its_limit(tmp_path: Path) -> None:
    path = tmp_path / "ida.csv"
    model = ss.Model.read(EXAMPLES / "taft.toml")
    ida = ss.ida(model, suite(), scale_to="0.2..0.27 g:29", limit="40 mm", bounds="nominal")
    path.write_text(ida.table.to_csv())
    (tmp_path / "summary.json").write_text(json.dumps(ida.summary))
    curve = ss.fragility(path)
    assert curve.summary["limit"] == 0.04
    assert curve.summary["median"] == ss.fragility(ida, limit="40 mm").summary["median"]
    ida = ss.ida(model, suite(), scale_to="0.2..0.27 g:8", limit="40 mm")
    by = ss.fragility(ida, by="friction", where=["friction=upper"], floor="1 mm", fit_to="cloud")
    assert by.summary["by"] == "friction" and len(by.summary["curves"]) == 1
    with pytest.raises(ss.RecordError, match="a folder without runs"):
        ss.fragility(tmp_path)


def test_spectra_over_a_suite(tmp_path: Path) -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    found = ss.spectrum(
        model, suite(), {"slider.radius": ["1 m", "2 m"]}, friction=[0.03, 0.05], scale_to="0.3 g"
    )
    assert len(found.tables["runs"]) == 36
    page = found.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and "slider" in str(found)


def test_a_design_keeps_the_gap() -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    found = ss.design(
        model, suite(), {"slider.radius": "1..4 m:4"}, friction="0.02..0.1:5", gap="80 mm", sensitivity=0
    )
    assert list(found.tables) == ["front", "runs"] and len(found.tables["front"]) > 0
    with pytest.raises(ss.InputError, match="vary"):
        ss.design(model, suite(), gap="80 mm")
    with pytest.raises(ss.InputError, match="confidence"):
        ss.design(model, suite(), {"slider.radius": "1..4 m:4"}, confidence=1.0)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda m, r: ss.ida(m, r, demand="sliding_path_m"), "limit"),
        (lambda m, r: ss.ida(m, r, scale_to="0.1 m"), "scale_to"),
        (lambda m, r: ss.ida(m, r, scale_to="0.1 g", demand="peak_sliding"), "demand"),
        (lambda m, r: ss.ida(m, r, scale_to="0.1 g", limit="3 kg"), "limit"),
        (lambda m, r: ss.ida(m, r, scale_to="0.1 g", measure="Sb(1 s)"), "measure"),
        (lambda m, r: ss.spectrum(m, r, {"slider.radus": "1..2 m:3"}), "slider.radus"),
        (lambda m, r: ss.spectrum(m, r, {"slider.radius": "1..2 kg:3"}), "kg"),
    ],
)
def test_choices_that_cannot_be_are_told(call: object, told: str) -> None:
    with pytest.raises(ss.InputError, match=told):
        call(ss.Model.read(EXAMPLES / "taft.toml"), suite())  # type: ignore[operator]


def test_the_animation_has_its_frames(tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    for name in ["taft.toml", "el-centro.toml"]:
        response = ss.run(ss.Model.read(EXAMPLES / name))
        animation = response.plot.animation(frames_per_s=2, speed=10.0)
        animation.save(tmp_path / "slide.gif", writer="pillow")
    matplotlib.pyplot.close("all")


def test_motions_of_other_packages() -> None:
    values, delta = np.array([0.0, 0.2, -0.2, 0.0]), np.float64(0.5)
    trace = SimpleNamespace(data=values, stats=SimpleNamespace(delta=delta))
    assert ss.Motion.from_obspy(trace, units="g") == pulse()
    accelerations = SimpleNamespace(values=values * 9.80665, dt=delta)
    assert ss.Motion.from_eqsig(accelerations) == pulse()


def test_tables_of_pandas_and_xarray() -> None:
    response = ss.run(block(), pulse())
    pandas = pytest.importorskip("pandas")
    assert isinstance(response.to_pandas(), pandas.DataFrame)
    pytest.importorskip("xarray")
    data = response.to_xarray()
    assert data["sliding_displacement_m"].attrs["units"] == "m"


def test_pint_passes() -> None:
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    model = block().with_({"slider.radius": 2.0 * unit.m, "block.mass": 300 * unit.kg})
    assert model.value("slider.radius") == 2.0 and model.value("block.mass") == 300.0


def test_examples_of_the_extension_run() -> None:
    import doctest

    import slipstick._core as core

    objects = [core.Model, core.Motion]
    methods = [getattr(core.Model, name) for name in ["with_", "to_opensees", "from_modes"]]
    methods += [core.Motion.rotated, core.Motion.at]
    finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner()
    for at in [*objects, *methods]:
        for test in finder.find(at, at.__name__, module=False, globs={}):
            runner.run(test)
    assert runner.summarize().failed == 0 and runner.tries >= 10


def test_responses_and_studies_pickle(tmp_path: Path) -> None:
    response = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    back = pickle.loads(pickle.dumps(response))
    assert back == response and hash(back) == hash(response)
    assert back._core._summary_json() == response._core._summary_json()
    assert back != ss.run(response.model, response.motion.scaled(0.5))
    study = ss.study(plan(tmp_path))
    assert pickle.loads(pickle.dumps(study)) == study


def test_the_analysis_takes_nearly_the_whole_call() -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    motion = ss.run(model).motion
    start = time.perf_counter()
    response = ss.run(model, motion)
    seconds = time.perf_counter() - start
    assert 0.0 < response._core._took_s() < seconds


def test_the_loop_is_that_of_the_whole_slider() -> None:
    response = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    force, knots = response.slider_force_n, response.knots
    spring = 526 * 9.80665 / 2.0 * knots["sliding_displacement_m"]
    assert np.allclose(force, spring - knots["friction_force_n"], atol=1e-9 * np.abs(force).max())
    assert np.abs(force).max() == pytest.approx(response.summary["peak_slider_force_n"], rel=1e-6)
    with pytest.raises(ValueError, match="read-only"):
        force[0] = 1.0
