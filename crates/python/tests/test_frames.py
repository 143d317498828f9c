"""Results as frames of every library, and frames of every library as what goes in."""

import pickle

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse, suite


def response() -> ss.Response:
    # The tail starts with a jump: the last sample is not 0.
    return ss.run(block().with_({"analysis.tail": "1 s"}), ss.Motion([0.0, 0.2, -0.2], dt=0.5, units="g"))


def test_times_stand_once_in_frames() -> None:
    found = response()
    time = found.history["time_s"]
    assert (np.diff(time) == 0.0).sum() == 1
    pytest.importorskip("pandas")
    frame = found.to_pandas()
    assert frame.index.is_unique and len(frame) == len(time) - 1
    assert frame.loc[1.0, "table_acceleration_m_per_s2"] == 0.0
    assert frame.reindex([0.5, 1.0]).notna().all(axis=None)
    pytest.importorskip("xarray")
    data = found.to_xarray()
    assert float(data.interp(time_s=1.25)["sliding_displacement_m"]) == pytest.approx(
        np.interp(1.25, time, found.history["sliding_displacement_m"]))
    assert data.sel(time_s=1.0)["table_acceleration_m_per_s2"] == 0.0
    assert data["time_s"].attrs["units"] == "s" and len(found.knots.to_pandas()) == len(found.knots)


def tables() -> dict[str, ss.Table]:
    found = response()
    ida = ss.ida(block(), {"a": pulse()}, scale_to="0.1..0.6 g:4", limit="9 mm")
    study = ss.study(ss.Plan(block(), {"a": pulse()}))
    of = {"history": found.history, "knots": found.knots, "energy": found.energy, "events": found.events.table}
    return of | {"ida": ida.table, "study": study.table, "summary": study.summary}


@pytest.mark.parametrize("name", tables())
def test_a_table_is_a_frame_everywhere(name: str) -> None:
    table = tables()[name]
    names, rows = list(table), len(table)
    assert table.columns == names == table._ipython_key_completions_() and names[0] in table
    assert "nothing" not in table and table.get("nothing") is None
    with pytest.raises(KeyError):
        table["nothing"]
    with pytest.raises(TypeError):
        table[names[0]] = 1  # type: ignore[index]
    assert pickle.loads(pickle.dumps(table)) == table and dict(table).keys() == set(names)
    assert table._repr_html_().startswith("<table>")
    pandas = pytest.importorskip("pandas")
    once = table.to_pandas()
    if isinstance(table, dict):
        direct = pandas.DataFrame(table)
    else:
        direct = pandas.DataFrame(dict(table))
        with pytest.raises(TypeError, match="to_pandas"):
            pandas.DataFrame(table)
    assert direct.shape == (rows, len(names)) and list(direct) == names
    assert list(once.reset_index() if once.index.name else once) == names
    assert once.attrs["units"] == dict(table.units)
    assert ss.Table(once).units == table.units and ss.Table(once).columns == names
    assert ss.Table(dict(table), table.units) == table
    polars = pytest.importorskip("polars")
    assert polars.DataFrame(table).columns == names and ss.Table(polars.DataFrame(table)).columns == names
    pyarrow = pytest.importorskip("pyarrow")
    assert ss.Table(pyarrow.table(table), table.units) == table
    xarray = pytest.importorskip("xarray")
    data = table.to_xarray()
    assert isinstance(data, xarray.Dataset) and set(data.variables) == set(names)


def test_an_assessment_has_its_tables() -> None:
    ida = ss.ida(block(), {"a": pulse(), "b": pulse().scaled(0.8)}, scale_to="0.1..0.6 g:4", limit="9 mm")
    assert list(ida) == ["ida", "capacities"] == ida._ipython_key_completions_()
    assert "ida" in ida and ida["capacities"] == ida.tables["capacities"]
    pandas = pytest.importorskip("pandas")
    assert ida.table.columns == list(ida.to_pandas())
    with pytest.raises(TypeError, match="to_pandas"):
        pandas.DataFrame(ida)
    assert list(ida.to_xarray().variables) and list(pytest.importorskip("polars").DataFrame(ida)) is not None


def test_a_table_draws_its_columns() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    table = ss.demands(block(), pulse(), {"slider.kinetic_friction": [0.05, 0.06, 0.08]})
    axes = table.plot("slider.kinetic_friction", color="C3")
    assert axes.get_ylabel() == "Peak sliding displacement (mm)" and axes.lines[0].get_color() == "C3"
    assert response().history.plot("time_s", "sliding_displacement_m", ax=axes) is axes
    with pytest.raises(ss.InputError, match="^y: expected a column among run, "):
        table.plot("slider.kinetic_friction", "nothing")


def test_events_are_a_list_and_a_table() -> None:
    events = response().events
    assert isinstance(events, list) and events[0].kind == "slip" and events[0] in events
    assert "kind" in events._ipython_key_completions_() and "kind" in events and "nothing" not in events
    assert events["kind"] == [event.kind for event in events] == events.table["kind"] and events[1:] == list(events)[1:]
    pandas = pytest.importorskip("pandas")
    assert list(events.to_pandas()["kind"]) == list(pandas.DataFrame(events)["kind"])
    assert pytest.importorskip("polars").DataFrame(events.table)["time_s"][0] == events[0].time_s
    quiet = ss.run(block(), pulse().scaled(0.01)).events
    assert quiet == [] and len(quiet.table) == 0


def test_frames_go_in() -> None:
    found = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    frames = [found.history, found.to_pandas(), found.to_xarray()]
    polars, pyarrow = pytest.importorskip("polars"), pytest.importorskip("pyarrow")
    frames += [polars.DataFrame(found.history), pyarrow.table(found.history)]
    compared = [ss.compare(frame, found.model).summary["quantities"] for frame in frames]
    assert len(compared) == 5 and all(len(quantities) == 7 for quantities in compared)
    assert all(not ss.compare(frame, found.model).warnings for frame in frames[:3])
    # In frames the time at the start of the tail stands once.
    assert all(each["peak_ratio"] == pytest.approx(1.0, rel=1e-9) for each in sum(compared, []))
    motion = found.motion
    column = found.to_pandas()["table_acceleration_m_per_s2"].to_numpy()[: len(motion)]
    assert len(ss.Motion(polars.Series(column), dt=motion.dt_s, units="m/s2")) == len(motion)
    ida = ss.ida(found.model, suite(), scale_to="0.2..0.27 g:29", limit="40 mm", bounds="nominal")
    frames = [ida, ida.table, ida.to_pandas(), polars.DataFrame(ida.table), pyarrow.table(ida.table)]
    curves = [ss.fragility(frame, limit="40 mm", measure="PGA", units="m/s2") for frame in frames]
    assert len({curve.summary["median"] for curve in curves}) == 1
    study = ss.study(ss.Plan(found.model, suite(), measure="PGA", scale_to="0.2..0.27 g:29", bounds="nominal"))
    assert ss.fragility(study, limit="40 mm", measure="PGA").summary["median"] == curves[0].summary["median"]
