"""Motions: what is noticed of them, in one and in two directions."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse, quick_pulse, suite

G = 9.80665


def kinds(motion: ss.Motion) -> list[str]:
    return [kind for kind, _ in motion.warnings]


def test_arrays_are_judged_as_files_are(tmp_path: Path) -> None:
    values = [0.1, -0.4, 0.1]
    path = tmp_path / "record.txt"
    path.write_text("\n".join(map(str, values)))
    read, made = ss.read_record(path, units="g", dt=0.05), ss.Motion(values, dt=0.05, units="g")
    assert kinds(made) == kinds(read) == ["first_sample_not_zero", "record_drift"]
    assert made.warnings == read.warnings and made == read
    with pytest.warns(ss.SlipstickWarning, match="is 30.0000 g: check"):
        strong = ss.Motion([0.0, 30.0, -30.0, 0.0], dt=0.05, units="g")
    assert kinds(strong)[0] == "absurd_peak" and "absurd peak" in repr(strong)
    assert strong._repr_html_().startswith("<p><b>Severe:</b>")
    with pytest.warns(ss.SlipstickWarning, match="check the units"):
        counts = ss.Motion([0, 81_000, -80_000, 0], dt=0.01, units="m/s2")
    with pytest.warns(ss.SlipstickWarning):
        assert kinds(ss.run(block(), counts).motion)[0] == "absurd_peak"
    assert kinds(ss.Motion([0, 81_000, -81_000, 0], dt=0.01, units="4.67e-6 m/s2")) == []


def test_what_is_noticed_is_that_of_the_scaled_motion() -> None:
    motion = ss.Motion([0.1, -0.4, 0.1], dt=0.05, units="m/s2")
    half = motion.scaled(0.5)
    assert (half.factor, half.scaled(pga="0.4 m/s2").factor) == (0.5, pytest.approx(1.0))
    assert "0.1000 m/s²" in motion.warnings[0][1] and "0.0500 m/s²" in half.warnings[0][1]
    assert kinds(half) == kinds(motion) and half.description == motion.description
    assert "0.5000 ×" in repr(half)
    assert pickle.loads(pickle.dumps(half)).warnings == half.warnings
    for wrong, told in [
        (lambda: motion.scaled(np.nan), "^factor: expected a finite factor"),
        (lambda: motion.scaled(pga="-1 g"), "^pga: expected a finite peak > 0"),
        (lambda: ss.Motion([0, 0], dt=0.1, units="g").scaled(pga="1 g"), "^pga: expected a motion that is not zero"),
    ]:
        with pytest.raises(ss.InputError, match=told):
            wrong()


def test_what_no_earthquake_has_is_told_however_it_comes() -> None:
    motion = ss.Motion(0.18 * np.sin(0.3 * np.arange(400)) * np.sin(np.pi * np.arange(400) / 399), dt=0.01, units="g")
    assert not {"absurd_motion", "long_step"} & set(kinds(motion))
    with pytest.warns(ss.SlipstickWarning, match="as no earthquake has"):
        strong = motion.scaled(300)
    assert "absurd_motion" in kinds(strong) and "absurd_motion" not in kinds(strong.scaled(1 / 300))
    with pytest.warns(ss.SlipstickWarning, match="10 s apart"):
        assert "long_step" in kinds(ss.Motion([0.0, 0.1, -0.1, 0.0], dt=10, units="g"))


def test_arrays_that_have_gaps_or_units() -> None:
    masked = np.ma.array([0.0, 1.0, 0.0], mask=[False, True, False])
    with pytest.raises(ss.InputError, match="^acceleration: expected an array without a mask"):
        ss.Motion(masked, dt=0.1, units="g")
    with pytest.raises(ss.InputError, match="^units: expected units of the values"):
        ss.Motion([0.0, 1.0], dt=0.1)
    assert ss.Motion(pulse().acceleration_m_per_s2, dt=np.array(0.5), units="m/s2") == pulse()
    unit = pytest.importorskip("pint").UnitRegistry()
    values = np.array([0.0, 20.0, -20.0, 0.0])
    quantity = ss.Motion(values * unit("cm/s**2"), dt=50 * unit.ms)
    assert quantity == ss.Motion(values, dt=0.05, units="cm/s2")
    with pytest.raises(ss.InputError, match="^units: expected none beside a quantity"):
        ss.Motion(values * unit("cm/s**2"), dt=0.05, units="g")


def test_a_suite_takes_what_a_record_takes() -> None:
    path = EXAMPLES / "records" / "taft-021.txt"
    one = ss.read_record(path, units="g", dt="10 ms")
    (name, same), = ss.read_suite(path, units="g", dt="10 ms").items()
    assert (name, same, same.warnings) == ("taft-021", one, one.warnings)
    assert kinds(one) and same.description == one.description
    model = ss.Model.read(EXAMPLES / "taft.toml")
    ida = ss.ida(model, suite(), scale_to="0.2 g", limit="40 mm")
    spectrum = ss.spectrum(model, suite(), {"slider.radius": "2 m"})
    design = ss.design(model, suite(), friction="0.03", gap="80 mm", sensitivity=0)
    for found in [ida, spectrum, design]:
        assert "first_sample_not_zero" in [warning["kind"] for warning in found.summary["warnings"]]


def pair() -> ss.Motion:
    t = np.arange(0.0, 8.0, 0.01)
    x, y = 3.0 * np.sin(6 * t), 2.0 * np.sin(4 * t)
    return ss.Motion(x, y=y, dt=0.01, units="m/s2")


def test_motions_in_two_directions(tmp_path: Path) -> None:
    both = pair()
    y = both.acceleration_y_m_per_s2
    assert y is not None and y[100] == pytest.approx(2.0 * np.sin(4.0))
    assert pickle.loads(pickle.dumps(both)) == both != ss.Motion(both.acceleration_m_per_s2, dt=0.01, units="m/s2")
    turned = both.rotated("90 deg")
    assert np.array_equal(turned.acceleration_m_per_s2, -y)
    assert np.array_equal(turned.acceleration_y_m_per_s2, both.acceleration_m_per_s2)
    assert both.rotated(angle_deg=90) == turned and both.rotated(angle_deg=np.float64(30)) == both.rotated("30 deg")
    halved = both.rotated("0 deg", scale_y=0.5).acceleration_y_m_per_s2
    assert np.array_equal(halved, 0.5 * y)
    assert both.scaled(2.0).acceleration_y_m_per_s2 is not None
    for name, values in [("x", both.acceleration_m_per_s2), ("y", y)]:
        (tmp_path / f"{name}.txt").write_text("\n".join(map(repr, values.tolist())))
    read = ss.read_record(tmp_path / "x.txt", y=tmp_path / "y.txt", units="m/s2", dt=0.01)
    assert read == both
    for wrong, told in [
        (lambda: pulse().rotated("30 deg"), "two horizontal directions"),
        (lambda: both.rotated(30), "^angle: expected an angle with its unit"),
        (lambda: both.rotated("30 deg", angle_deg=30), "^angle: expected one of angle and angle_deg, found both$"),
        (lambda: both.rotated(), "^angle: expected one of angle and angle_deg, found neither$"),
        (lambda: both.rotated(angle_deg=float("nan")), "^angle_deg: "),
        (lambda: ss.Motion([0.0, 1.0], y=[0.0], dt=0.1, units="g"), "^y: expected 2 values"),
    ]:
        with pytest.raises(ss.InputError, match=told):
            wrong()


def test_responses_in_two_directions() -> None:
    response = ss.run(block(), pair())
    assert response.holds
    history = response.history
    x, y = history["sliding_displacement_m"], history["sliding_displacement_y_m"]
    peak = response.summary["peak_sliding_displacement_m"]
    assert 0.9 * peak < np.hypot(x, y).max() <= peak * (1 + 1e-12)
    assert len(response.events) > 0
    assert set(response.to_xarray()) >= {"block_acceleration_y_m_per_s2", "friction_force_y_n"}
    assert pickle.loads(pickle.dumps(response)) == response
    assert "ops.element" in block().with_({"slider.static_friction": 0.08}).to_opensees(pair(), "10 kN/mm")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    bounded = ss.run(block().with_({"slider.gap": "2 m"}), pair())
    assert len(bounded.plot.orbit().lines) == 3
    with pytest.raises(ValueError, match="two directions"):
        ss.run(block(), pulse()).plot.orbit()
    matplotlib.pyplot.close("all")


def test_what_a_result_is_worth_comes_first() -> None:
    model = block().with_({"slider.gap": "1 mm"})
    with pytest.warns(ss.SlipstickWarning, match="gap") as caught:
        response = ss.run(model, quick_pulse())
    assert [warning.filename for warning in caught] == [__file__]
    assert repr(response).startswith("<slipstick.Response holds; severe: gap exceeded; ")
    page = response._repr_html_()
    assert page.startswith("<p><b>The certificate holds</b></p><p><b>Severe:</b> ")
    quiet = ss.run(block(), quick_pulse())
    assert repr(quiet) == "<slipstick.Response holds; 'model', 2 events>"
    found = ss.suite(block(), {"a": ss.Motion([0.1, -0.1, 0.1], dt=0.05, units="g")})
    assert repr(found).startswith("<slipstick.Assessment warning: ") and "first sample not zero" in repr(found)
    assert found._repr_html_().startswith("<p><b>Warning:</b> ")
