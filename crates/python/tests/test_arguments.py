"""Every argument of every public call: what cannot be is told in the caller's words, never by what stumbles over it."""

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipstick as ss
from slipstick._core import Model, Motion
from support import EXAMPLES

Call = tuple[Callable[..., Any], dict[str, Any]]

KEYS = {"block.mass": "325 kg", "slider.static_friction": 0.1, "slider.kinetic_friction": 0.08, "slider.radius": "2 m"}
TOLD = (ss.InputError, ss.RecordError, ss.StudyError, ss.SolveError, OSError)
#: How Python and its extensions speak of types
FOREIGN = re.compile(r"NoneType|not an instance|has no attribute|interpreted as an integer|not iterable|<class|os\.PathLike")


def calls(folder: Path) -> dict[str, Call]:
    """Calls that have an answer, by the names of what is called."""
    model, taft = Model(KEYS), EXAMPLES / "records" / "taft-111.txt"
    motion = Motion([0.0, 0.2, -0.2, 0.0], dt=0.1, units="g")
    pair = Motion([0.0, 0.2, 0.0], y=[0.0, 0.1, 0.0], dt=0.1, units="g")
    records = {"a": motion, "b": motion.scaled(0.5)}
    ida = ss.ida(model, records, scale_to="0.1..0.6 g:4", limit="1 mm")
    t = np.arange(0.0, 3.0, 0.01)
    response = ss.run(model, Motion(2.0 * np.sin(6.0 * t), dt=0.01, units="m/s2"))
    measured = {n: response.history[n] for n in ["time_s", "table_acceleration_m_per_s2", "sliding_displacement_m"]}
    noise = np.random.default_rng(1).normal(0.0, 1.0, t.size)
    force = 150.0 * np.sign(np.cos(6.0 * t)) + 20.0 * np.sin(6.0 * t) + noise
    cyclic = {"time_s": t, "displacement_m": 0.02 * np.sin(6.0 * t), "force_n": force}
    free = {"time_s": t, "storey1_acceleration_m_per_s2": np.exp(-0.1 * t) * np.cos(10.0 * t) + 0.01 * noise}
    study = ss.study(ss.Plan(model, records))
    record = {"path": taft, "units": "g", "dt": 0.01}
    varied = {"slider.radius": [1.0, 2.0]}
    plain = model.with_({"slider.static_friction": 0.08})
    return {
        "run": (ss.run, {"model": model, "motion": motion}),
        "suite": (ss.suite, {"models": model, "records": records}),
        "spectrum": (ss.spectrum, {"model": model, "records": records, "over": varied}),
        "sensitivity": (ss.sensitivity, {"model": model, "records": motion, "vary": "block.mass"}),
        "ida": (ss.ida, {"model": model, "records": records, "scale_to": 2.0}),
        "fragility": (ss.fragility, {"source": ida}),
        "design": (ss.design, {"model": model, "records": records, "vary": varied, "gap": 0.5, "sensitivity": 0}),
        "demands": (ss.demands, {"model": model, "records": motion, "vary": {"block.mass": [300.0]}}),
        "study": (ss.study, {"plan": ss.Plan(model, records), "out": folder / "study"}),
        "Plan": (ss.Plan, {"model": model, "records": records, "vary": {"block.mass": [300.0]}}),
        "Suite": (ss.Suite, {"records": records}),
        "compare": (ss.compare, {"measured": measured, "model": model}),
        "identify.cyclic": (ss.identify.cyclic, {"tests": cyclic, "mass": "100 kg"}),
        "identify.free_vibration": (ss.identify.free_vibration, {"measured": free}),
        "read_record": (ss.read_record, record),
        "read_channels": (ss.read_channels, record),
        "read_suite": (ss.read_suite, {"patterns": taft, "units": "g", "dt": 0.01}),
        "schema": (ss.schema, {}),
        "units": (ss.units, {}),
        "Model": (Model, {"values": KEYS}),
        "Model.read": (Model.read, {"path": EXAMPLES / "taft.toml"}),
        "Model.from_toml": (Model.from_toml, {"text": model.toml}),
        "Model.example": (Model.example, {"name": "block"}),
        "Model.with_": (model.with_, {"values": {"block.mass": "1 t"}}),
        "Model.value": (model.value, {"path": "block.mass"}),
        "Model.to_opensees": (plain.to_opensees, {"motion": motion, "k_init": 1e6}),
        "Model.from_opensees": (
            Model.from_opensees,
            {"ops": None, "values": KEYS, "mass_unit": "1 t", "nodes": {"Roof": 1}, "damping_ratio": 0.02},
        ),
        "Model.from_modes": (
            Model.from_modes,
            {"phi": np.eye(1), "omega": [10.0], "damping": 0.02, "mass": [200.0], "values": KEYS, "points": {"Roof": 0}},
        ),
        "Motion": (Motion, {"acceleration": [0.0, 0.2, 0.0], "dt": 0.1, "units": "g"}),
        "Motion.read": (Motion.read, record),
        "Motion.from_obspy": (Motion.from_obspy, {"stream": None}),
        "Motion.from_eqsig": (Motion.from_eqsig, {"signal": None}),
        "Motion.scaled": (motion.scaled, {"factor": 2.0}),
        "Motion.rotated": (pair.rotated, {"angle": "10 deg"}),
        "Motion.at": (motion.at, {"time": "0.1 s"}),
        "Motion.measures": (lambda name: motion.measures(name), {"name": "PGA"}),
        "Motion.spectrum": (motion.spectrum, {"periods": [0.5, 1.0]}),
        "Motion.fourier": (motion.fourier, {"step": 1.0}),
        "Motion.processed": (lambda step: motion.processed(step), {"step": "remove mean"}),
        "Motion.filter": (response.motion.filter, {"high_pass": 0.5}),
        "Motion.baseline": (motion.baseline, {"degree": 0}),
        "Motion.resample": (motion.resample, {"dt": 0.05}),
        "Motion.write": (motion.write, {"path": folder / "motion.csv"}),
        "Response.save": (response.save, {"folder": folder / "response"}),
        "Response.read": (ss.Response.read, {"folder": folder / "none"}),
        "Response.report": (response.report, {"path": folder / "report.html"}),
        "Assessment.plot": (ida.plot, {"x": "level"}),
        "Assessment.report": (ida.report, {"path": folder / "ida.html"}),
        "Study.plot": (study.plot, {}),
        "Study.read": (ss.Study.read, {"folder": folder / "none"}),
        "Table": (ss.Table, {"frame": {"a": [1.0]}}),
        "Table.read": (ss.Table.read, {"path": folder / "none.csv"}),
        "Table.plot": (ida.table.plot, {"x": "level"}),
        "Table.write": (ida.table.write, {"path": folder / "table.csv"}),
        "Block": (ss.Block, {"mass": "1 t"}),
        "Slider": (ss.Slider, {"static_friction": 0.1}),
    }


#: What someone may hand in for something else
WRONG: dict[str, Any] = {
    "None": None, "object": object(), "complex": 3 + 4j, "number": 3.5, "negative": -1, "flag": True, "text": "nonsense",
    "path": Path("a.txt"), "bytes": b"a", "unknown key": {"no_such": 1.0}, "key that is no text": {1: 2},
    "array": np.zeros(3), "matrix": np.zeros((2, 2)), "NaN": float("nan"), "list with NaN": [1.0, float("nan")],
    "mask": np.ma.masked, "masked array": np.ma.array([1.0, 2.0], mask=[False, True]), "list of objects": [object()],
    "empty": [], "set": {1.0}, "motion": Motion([0.0, 1.0, 0.0], dt=0.1, units="m/s2"), "model": Model(KEYS),
}


@pytest.mark.filterwarnings("ignore")
def test_what_cannot_be_is_told_of_every_argument(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(tmp_path)
    unlike: list[str] = []
    for name, (call, valid) in calls(tmp_path).items():
        for argument in inspect.signature(call).parameters.values():
            # What a library of others takes is not ours to tell.
            if argument.name in ("ax", "dtype", "copy") or argument.kind in (argument.VAR_KEYWORD, argument.VAR_POSITIONAL):
                continue
            for what, value in WRONG.items():
                try:
                    call(**{**valid, argument.name: value})
                except TOLD as error:
                    if FOREIGN.search(str(error)) and not isinstance(error, OSError):
                        unlike.append(f"{name}({argument.name}={what}): {error}")
                except Exception as error:
                    unlike.append(f"{name}({argument.name}={what}): {type(error).__name__}: {error}")
        pyplot.close("all")
    assert unlike == []


def test_every_public_function_is_called(tmp_path: Path) -> None:
    functions = {name for name in ss.__all__ if inspect.isfunction(getattr(ss, name))} - {"widget"}
    functions |= {"Model", "Motion", "Plan", "Suite", "Table"}
    for of in (Model, Motion):
        methods = {name for name, value in vars(of).items() if callable(value) or isinstance(value, staticmethod)}
        functions |= {f"{of.__name__}.{name}" for name in methods if not name.startswith("_")}
    assert functions - set(calls(tmp_path)) == {"Motion.plot", "Motion.to_obspy"}
