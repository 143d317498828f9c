"""One analysis without what it need not keep."""

import pickle
import time

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse, quick_pulse


def taft() -> tuple[ss.Model, ss.Motion]:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    return model, ss.run(model).motion


def without_checks(summary: dict[str, object]) -> dict[str, object]:
    bounds = summary.get("bounds")
    inner = {k: without_checks(v) for k, v in bounds.items()} if isinstance(bounds, dict) else bounds
    return {**{k: v for k, v in summary.items() if k != "checks"}, "bounds": inner}


@pytest.mark.parametrize("asked", [{"history": False}, {"check": False}, {"history": False, "check": False}])
def test_figures_are_the_same_without_history_and_check(asked: dict[str, bool]) -> None:
    model, motion = taft()
    whole, light = ss.run(model, motion), ss.run(model, motion, **asked)
    assert without_checks(light.summary) == without_checks(whole.summary)
    assert light.events == whole.events and light.motion == motion
    if asked.get("check", True):
        assert light.certificate == whole.certificate and light.holds
    else:
        assert light.holds is None and light.certificate["equilibrium_residual"] is None
    again = pickle.loads(pickle.dumps(light))
    assert again == light and again != whole and again.summary == light.summary
    own = ss.run(model, **asked)
    assert own.summary == light.summary


def test_what_was_not_kept_is_told() -> None:
    light = ss.run(block(), pulse(), history=False)
    for name in ["history", "knots", "energy", "slider_force_n"]:
        with pytest.raises(ValueError, match=r"expected a response of run\(..., history=True\), found one without"):
            getattr(light, name)
    unjudged = ss.run(block(), pulse(), check=False)
    assert len(unjudged.history["time_s"]) == 4 and len(unjudged.slider_force_n) == len(unjudged.knots)
    with pytest.raises(ValueError, match="check=True"):
        unjudged.energy
    with pytest.raises(ss.InputError, match="^floor_spectrum: expected False without a history"):
        ss.run(block(), pulse(), floor_spectrum=True, check=False)


def test_severe_warnings_come_without_history_too() -> None:
    model = block().with_({"slider.gap": "1 mm"})
    for asked in [{}, {"history": False, "check": False}]:
        with pytest.warns(ss.SlipstickWarning, match="past its gap"):
            response = ss.run(model, pulse(), **asked)
        assert "gap exceeded" in repr(response)


def test_a_call_costs_little_beside_the_analysis() -> None:
    model, motion = block(), quick_pulse()
    beyond = []
    for _ in range(2000):
        start = time.perf_counter()
        response = ss.run(model, motion, history=False, check=False)
        beyond.append(time.perf_counter() - start - response._core._took_s())
    # The bar is 20 µs; others on the machine only add to it.
    assert min(beyond) < 20e-6
    assert np.median(beyond) < 100e-6
