"""Scripts of a day's work as users write them: all that they ask is answered, in the words of today."""

import runpy
import sys
import warnings
from pathlib import Path

import pytest

import slipstick as ss
from support import EXAMPLES

DAY = Path(__file__).resolve().parent / "day"


@pytest.mark.parametrize("who", ["engineer", "researcher", "analyst"])
def test_a_day_of_work_is_answered(who: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("polars")
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [f"{who}.py", str(EXAMPLES)])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ss.SlipstickWarning)
        warnings.filterwarnings("error", ".* is called .* now", DeprecationWarning)
        runpy.run_path(str(DAY / f"{who}.py"))
    pytest.importorskip("matplotlib.pyplot").close("all")


def test_every_script_of_a_day_is_run() -> None:
    assert {script.stem for script in DAY.glob("*.py")} == {"engineer", "researcher", "analyst"}
