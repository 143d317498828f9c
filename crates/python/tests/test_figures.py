"""What the figures of the gallery draw, say and measure is what the results hold: the notebook's own figures."""

import html
import json
import os
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, quick_pulse, suite

G = 9.80665
PEAK = "peak_sliding_displacement_m"

matplotlib = pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def drawn() -> Iterator[dict[str, Any]]:
    """What the cells of the gallery leave, run in their folder."""
    matplotlib.use("Agg")
    notebook = json.loads((EXAMPLES / "notebooks" / "figures.ipynb").read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    names: dict[str, Any] = {}
    folder = os.getcwd()
    os.chdir(EXAMPLES / "notebooks")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for cell in cells:
                exec(compile(cell, "figures.ipynb", "exec"), names)
        yield names
    finally:
        os.chdir(folder)
        matplotlib.pyplot.close("all")


def labels(ax: Any) -> tuple[str, str]:
    return ax.get_xlabel(), ax.get_ylabel()


def lines(ax: Any) -> list[tuple[str, np.ndarray, np.ndarray]]:
    found = [(line.get_label(), *map(np.asarray, line.get_data())) for line in ax.lines]
    return [("" if label.startswith("_") else label, x, y) for label, x, y in found]


def test_every_kind_of_figure_stands_in_the_gallery(drawn: dict[str, Any]) -> None:
    from slipstick._plot import Plotter

    source = (EXAMPLES / "notebooks" / "figures.ipynb").read_text(encoding="utf-8")
    kinds = {name for name in vars(Plotter) if not name.startswith("_")} - {"animation"}
    assert {name for name in kinds if f"plot.{name}(" not in source} == set()


def test_figures_of_one_analysis(drawn: dict[str, Any]) -> None:
    response = drawn["response"]
    knots, summary, t = response.knots, response.summary, response.knots["time_s"]
    ax = drawn["history"]
    (_, x, y), (peak, x_peak, y_peak) = lines(ax)
    assert labels(ax) == ("Time (s)", "Sliding displacement s (mm)")
    assert np.array_equal(x, t) and np.allclose(y, 1e3 * knots["sliding_displacement_m"], rtol=1e-15)
    assert abs(y_peak[0]) == pytest.approx(1e3 * summary[PEAK], rel=1e-12) and peak == f"peak {y_peak[0]:.4g} mm"
    assert x_peak[0] == summary["peak_sliding_displacement_time_s"]
    ax = drawn["acceleration"]
    assert labels(ax) == ("Time (s)", "Acceleration (g)")
    columns = {"ground": "table_acceleration_m_per_s2", "block": "block_acceleration_m_per_s2", "storey 2": "storey2_acceleration_m_per_s2"}
    assert [label for label, *_ in lines(ax)] == list(columns)
    for label, x, y in lines(ax):
        assert np.array_equal(x, t) and np.allclose(y * G, knots[columns[label]], rtol=1e-14)
    ax = drawn["loop"]
    assert labels(ax) == ("Sliding displacement s (mm)", "Slider force (kN)")
    (friction, x, y), (slider, x_of, y_of) = lines(ax)
    assert (friction, slider) == ("friction force alone", "slider") and np.array_equal(x, x_of)
    assert np.allclose(1e-3 * x, knots["sliding_displacement_m"]) and np.allclose(-1e3 * y, knots["friction_force_n"])
    # By hand: a pendulum slider of 2 m under 626 t.
    spring = 626e3 * G / 2.0 * knots["sliding_displacement_m"]
    assert np.allclose(1e3 * y_of, spring - knots["friction_force_n"], atol=1e-9 * np.abs(spring).max())
    ax = drawn["energy"]
    assert labels(ax) == ("Time (s)", "Energy (kJ)")
    ((label, x, y),) = lines(ax)
    assert label == "input" and np.allclose(1e3 * y, response.energy["input_j"])
    assert [of.get_label() for of in ax.collections] == ["friction", "dampers", "strain", "kinetic"]
    # What is stacked is what was put in.
    top = ax.collections[-1].get_paths()[0].vertices[:, 1].max()
    assert top == pytest.approx(y.max(), rel=1e-6)
    ax = drawn["drift"]
    assert labels(ax) == ("Time (s)", "Drift (mm)") and [label for label, *_ in lines(ax)] == ["storey 1", "storey 2"]
    floors = [knots[f"storey{i}_displacement_m"] for i in (1, 2)]
    for (_, _, y), expected, of in zip(lines(ax), [floors[0], floors[1] - floors[0]], summary["storeys"], strict=True):
        assert np.allclose(1e-3 * y, expected, atol=1e-15)
        # Its peak may lie between two samples.
        assert 0.99 * of["peak_drift_m"] < np.abs(1e-3 * y).max() <= of["peak_drift_m"] * (1 + 1e-12)
    ax = drawn["demand"]
    assert labels(ax) == ("Time (s)", "Friction force T (kN)")
    (_, _, y), *bounds = lines(ax)
    assert np.allclose(1e3 * y, knots["friction_force_n"])
    weight_kn = 626e3 * G / 1e3
    told = sorted(float(of[2][0]) for of in bounds)
    assert told == pytest.approx([-0.06 * weight_kn, -0.05 * weight_kn, 0.05 * weight_kn, 0.06 * weight_kn], rel=1e-12)
    ax = drawn["floor_spectra"]
    spectra = summary["floor_spectrum"]
    assert labels(ax) == ("Period (s)", "Spectral acceleration (g)") and ax.get_xscale() == "log"
    expected = [spectra["table_acceleration_m_per_s2"], spectra["block_acceleration_m_per_s2"], *spectra["storeys_acceleration_m_per_s2"]]
    assert [label for label, *_ in lines(ax)] == ["ground", "block", "storey 1", "storey 2"]
    for (_, x, y), of in zip(lines(ax), expected, strict=True):
        assert x.tolist() == spectra["period_s"] and np.allclose(y * G, of)
    motion, taft = drawn["motion"], drawn["taft"]
    assert [ax.get_ylabel() for ax in motion] == ["Acceleration (g)", "Velocity (m/s)", "Displacement (mm)"]
    for ax, of, unit in zip(motion, [taft.acceleration_m_per_s2, taft.velocity_m_per_s, taft.displacement_m], [G, 1.0, 1e-3]):
        ((_, x, y),) = lines(ax)
        assert np.array_equal(x, taft.time_s) and np.allclose(y * unit, of)


def test_figures_of_two_directions(drawn: dict[str, Any]) -> None:
    both = drawn["both"]
    knots, summary = both.knots, both.summary
    x, y = knots["sliding_displacement_m"], knots["sliding_displacement_y_m"]
    assert labels(drawn["history_both"]) == ("Time (s)", "Sliding displacement s (mm)")
    along_x, peak_x, along_y, peak_y = lines(drawn["history_both"])
    assert (along_x[0], along_y[0]) == ("along x", "along y")
    assert np.allclose(1e-3 * along_x[2], x) and np.allclose(1e-3 * along_y[2], y)
    assert peak_x[0].startswith("peak along x ") and peak_y[0].startswith("peak along y ")
    for (_, _, peak), axis in ((peak_x, "x"), (peak_y, "y")):
        assert abs(peak[0]) == pytest.approx(1e3 * summary[axis][PEAK], rel=1e-3)
    ax = drawn["orbit"]
    assert labels(ax) == ("Sliding displacement s along x (mm)", "Sliding displacement s along y (mm)")
    (_, ox, oy), (peak, *_), (gap, gx, gy) = lines(ax)
    assert np.allclose(1e-3 * ox, x) and np.allclose(1e-3 * oy, y)
    assert gap == "gap" and np.allclose(np.hypot(gx, gy), 250.0) and (np.hypot(ox, oy) < 250.0).all()
    assert float(peak.split()[1]) == pytest.approx(1e3 * summary[PEAK], rel=1e-3)
    assert np.allclose(1e-3 * lines(drawn["resultant"])[0][2], np.hypot(x, y))
    ax = drawn["loop_y"]
    assert labels(ax) == ("Sliding displacement s along y (mm)", "Slider force along y (kN)")
    (_, lx, ly), *rest = [of for of in lines(ax) if of[0] in ("slider", "along y")]
    assert not rest and np.allclose(1e-3 * lx, y) and np.allclose(1e3 * ly, both.slider_force_y_n)


def test_figures_of_devices(drawn: dict[str, Any]) -> None:
    knots = drawn["with_contents"].knots
    found = lines(drawn["contents"])
    assert [label for label, *_ in found] == ["contents 1 on storey 2", "contents 2 on block"]
    for number, (_, _, y) in enumerate(found, 1):
        assert np.allclose(1e-3 * y, knots[f"contents{number}_displacement_m"])
    assert labels(drawn["contents"]) == ("Time (s)", "Displacement over the floor (mm)")
    knots = drawn["pendulum"].knots
    together, *surfaces = lines(drawn["surfaces"])
    assert together[0] == "together" and np.allclose(1e-3 * together[2], knots["sliding_displacement_m"])
    # Surfaces in series: their displacements add up to the whole.
    assert np.allclose(sum(y for _, _, y in surfaces), together[2], atol=1e-9 * np.abs(together[2]).max())
    by_modes = drawn["by_modes"]
    names = [point["name"] for point in by_modes.summary["points"]]
    found = lines(drawn["points"])
    assert [label for label, *_ in found] == names and labels(drawn["points"])[1] == "Displacement over the block (mm)"
    for number, (_, _, y) in enumerate(found, 1):
        assert np.allclose(1e-3 * y, by_modes.knots[f"point{number}_displacement_m"])
    # A drift is what the summary says it is: of a point over the one before it.
    found = lines(by_modes.plot.drift())
    assert [label for label, *_ in found] == names
    for (_, _, y), of in zip(found, by_modes.summary["points"], strict=True):
        assert 0.95 * of["peak_drift_m"] < np.abs(1e-3 * y).max() <= of["peak_drift_m"] * (1 + 1e-12)


def test_figures_of_many_runs(drawn: dict[str, Any]) -> None:
    suite, study = drawn["suite"], drawn["study"]
    ((_, x, y),) = lines(drawn["of_suite"])
    assert list(x) == suite.table["record"] and np.allclose(1e-3 * y, suite.table[PEAK])
    assert labels(drawn["of_suite"]) == ("record", "Peak sliding displacement (mm)")
    ax = drawn["of_study"]
    assert labels(ax) == ("radius (m)", "Peak sliding displacement (mm)")
    for label, x, y in lines(ax):
        rows = [record == label for record in study.table["record"]]
        assert np.array_equal(x, study.table["slider.radius"][rows]) and np.allclose(1e-3 * y, study.table[PEAK][rows])
    ax, table = drawn["of_spectrum"], drawn["spectrum"].table
    assert labels(ax) == ("radius (m)", "Peak sliding displacement (mm)")
    assert [label for label, *_ in lines(ax)] == ["16 %", "median", "84 %"]
    for label, x, y in lines(ax):
        assert np.array_equal(x, table["slider.radius"]) and np.allclose(1e-3 * y, table[f"{PEAK}_p{50 if label == 'median' else label[:2]}"])
    ax, ida = drawn["of_ida"], drawn["ida"]
    assert labels(ax) == ("Peak sliding displacement (mm)", "PGA (g)")
    *curves, (limit, at, _) = lines(ax)
    assert limit == "limit" and at[0] == pytest.approx(150.0) and len(curves) == 3
    for (_, x, y), record in zip(curves, dict.fromkeys(ida.table["record"]), strict=True):
        rows = [of == record for of in ida.table["record"]]
        assert np.allclose(1e-3 * x, np.abs(ida.table[PEAK][rows])) and np.allclose(G * y, ida.table["level"][rows])
    ax, fragility = drawn["of_fragility"], drawn["fragility"]
    assert labels(ax) == ("PGA (g)", "Probability of exceedance") and ax.get_ylim() == (0.0, 1.0)
    ((label, x, y),) = lines(ax)
    assert np.allclose(G * x, fragility.table["level"]) and np.array_equal(y, fragility.table["probability"])
    # Half of the systems have failed at the median.
    assert np.interp(fragility.summary["median"] / G, x, y) == pytest.approx(0.5, abs=0.01)
    ax, front = drawn["of_design"], drawn["design"].table
    assert labels(ax) == ("Displacement not exceeded in 90 % of the records (mm)", "Acceleration not exceeded in 50 % of the records (g)")
    (label, x, y), (gap, at, _) = lines(ax)
    assert (label, gap) == ("front", "gap") and at[0] == pytest.approx(250.0)
    assert np.allclose(1e-3 * x, front["displacement_m"]) and np.allclose(G * y, front["acceleration_m_per_s2"])
    ax, table = drawn["of_sensitivity"], drawn["sensitivity"].table
    first = table["demand"][0]
    assert first == PEAK and ax.get_xlabel() == "Peak sliding displacement: change in % for 1 % of the key"
    bars = {tick.get_text(): bar.get_width() for tick, bar in zip(ax.get_yticklabels(), ax.patches, strict=True)}
    keys = {"radius": "slider.radius", "kinetic friction": "slider.kinetic_friction", "storey 1 mass": "storey.1.mass"}
    assert set(bars) == set(keys)
    for words, width in bars.items():
        rows = [one == keys[words] and of == first for one, of in zip(table["path"], table["demand"], strict=True)]
        assert width == np.median(table["relative"][rows])
    assert list(np.abs(list(bars.values()))) == sorted(np.abs(list(bars.values())))


def words_of(svg: str) -> set[str]:
    """All that is written in drawings."""
    return {html.unescape(re.sub("<[^>]*>", "", text)) for text in re.findall("<text.*?</text>", svg, re.DOTALL)}


#: What Matplotlib alone says: of lines in one frame that reports have in frames of their own, or as a band
ALONE = {"slider", "together", "16 %", "Displacement over the floor (mm)"}


def unsaid(ax: Any, written: set[str]) -> list[str]:
    """What axes and legend say that no drawing says: of lines in frames of their own the axis has the name of each."""
    lines = [name for name in ax.get_legend_handles_labels()[1] if not name.startswith("peak ")]
    everything = " | ".join(written).lower()

    def is_said(label: str) -> bool:
        words, bracket, unit = label.partition(" (")
        parts = [f"{line} {label}" for line in lines] + [f"{words} {line}{bracket}{unit}" for line in lines]
        return label in ALONE or any(part.lower() in everything for part in [label, *parts])

    return [label for label in [*labels(ax), *lines] if not is_said(label)]


def test_reports_say_what_matplotlib_says(drawn: dict[str, Any], tmp_path: Path) -> None:
    results = {
        "response": ["history", "acceleration", "loop", "energy", "drift", "demand", "floor_spectra"],
        "both": ["orbit", "history_both"],
        "with_contents": ["contents"],
        "pendulum": ["surfaces"],
        "by_modes": [],
    }
    unlike = {}
    for name, figures in results.items():
        page = drawn[name].report(tmp_path / f"{name}.html", units="si-g")
        written = words_of(page.read_text(encoding="utf-8"))
        unlike.update({f"{name} {figure}": unsaid(drawn[figure], written) for figure in figures})
    unlike["drift of points"] = unsaid(drawn["by_modes"].plot.drift(), written)
    for name in ("spectrum", "ida", "fragility", "design", "sensitivity"):
        written = words_of("".join(drawn[name].figures.values()))
        # Reports of many runs have accelerations in m/s2 unless they are asked for others.
        written |= {text.replace("(m/s²)", "(g)") for text in written}
        unlike[name] = unsaid(drawn[f"of_{name}"], written)
    assert {name: told for name, told in unlike.items() if told} == {}


def test_colours_are_those_of_reports_and_differ() -> None:
    from slipstick._plot import distinct

    page = ss.run(block(), quick_pulse()).figures["sliding-displacement"]
    assert f'stroke="{distinct(1)[0]}"' in page
    for count in (2, 6, 7, 12, 50):
        assert len(set(distinct(count))) == count


def test_lines_take_what_users_of_matplotlib_write() -> None:
    matplotlib.use("Agg")
    response = ss.run(block().with_({"slider.radius": "2 m"}), quick_pulse())
    plot = response.plot
    for draw in [plot.history, plot.acceleration, plot.loop, plot.demand]:
        _, ax = matplotlib.pyplot.subplots()
        assert draw(ax=ax, linewidth=3, marker="x", label="mine", linestyle=":", c="r") is ax
        line = ax.lines[-1 if draw == plot.loop else 0]
        assert (line.get_linewidth(), line.get_marker(), line.get_color(), line.get_linestyle()) == (3, "x", "r", ":")
        assert line.get_label() == "mine"
    # Twelve records are told apart.
    motion = suite()["taft-111"]["2 s":"6 s"]  # type: ignore[misc]
    twelve = {f"record {i}": motion.scaled(1.0 + 0.05 * i) for i in range(12)}
    found = ss.study(ss.Plan(block(), twelve, {"slider.kinetic_friction": [0.05, 0.06, 0.07]}))
    axes = found.plot("slider.kinetic_friction", by="record")
    colours = {matplotlib.colors.to_hex(line.get_color()) for line in axes.lines}
    assert len(axes.lines) == len(colours) == 12
    assert {line.get_marker() for line in found.plot(marker="s").lines} == {"s"}
    matplotlib.pyplot.close("all")
