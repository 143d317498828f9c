"""The page in a notebook; what it shows is tested with the page itself."""

from __future__ import annotations

import base64
import builtins
from pathlib import Path
from typing import Any

import pytest
import slipstick as ss
from slipstick import _widget

EXAMPLES = Path(__file__).parents[3] / "examples"


def test_without_anywidget_it_says_what_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == "anywidget":
            raise ModuleNotFoundError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="pip install anywidget"):
        ss.widget(EXAMPLES / "taft.toml")


def test_motion_becomes_the_columns_that_need_no_key() -> None:
    motion = ss.Motion([0.0, 0.25, -0.25], dt=0.5, units="m/s2")
    text = "time_s,acceleration_m_per_s2\n0.0,0.0\n0.5,0.25\n1.0,-0.25\n"
    assert _widget._csv(motion) == text
    up = ss.Motion([0.0, 1.0], dt=0.5, units="m/s2", vertical=[0.0, 2.0])
    assert _widget._csv(up).splitlines()[2] == "0.5,1.0,2.0"


def test_records_of_the_model_are_read_beside_it() -> None:
    text = (EXAMPLES / "taft.toml").read_text()
    records = _widget._own_records(text, EXAMPLES)
    assert records == {"records/taft-111.txt": (EXAMPLES / "records/taft-111.txt").read_bytes()}
    with pytest.raises(ValueError, match="expected a Motion beside a model whose record is"):
        _widget._own_records(text, None)
    assert _widget._own_records('[motion]\nsine = "x"\n', None) == {}


def test_widget_holds_model_and_records(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("anywidget")
    bundle = tmp_path / "page.js"
    bundle.write_text("export default { render() {} };")
    monkeypatch.setattr(_widget, "_BUNDLE", bundle)
    shown = ss.widget(EXAMPLES / "taft.toml")
    assert shown.model == (EXAMPLES / "taft.toml").read_text()
    own = (EXAMPLES / "records/taft-111.txt").read_bytes()
    assert base64.b64decode(shown.records["records/taft-111.txt"]) == own
    moved = ss.widget(ss.Model.read(EXAMPLES / "taft.toml"), ss.Motion([0.0, 1.0], dt=0.5, units="g"))
    assert (moved.motion, list(moved.records)) == ("motion.csv", ["motion.csv"])
