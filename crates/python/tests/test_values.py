"""Values that go in: of NumPy, pint and the standard library; changed, compared, asked for."""

import os
import pickle
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block


@pytest.mark.parametrize(
    "value",
    [0.05, np.float64(0.05), np.array(0.05), Fraction(1, 20), Decimal("0.05"), "0.05", np.str_("0.05")],
    ids=lambda value: type(value).__name__,
)
def test_numbers_of_every_kind_are_the_same(value: object) -> None:
    model = block().with_({"slider.kinetic_friction": value})
    assert model.value("slider.kinetic_friction") == 0.05
    assert model == block().with_({"slider.kinetic_friction": 0.05})
    made = {"block.mass": "325 kg", "slider.static_friction": 0.1, "slider.kinetic_friction": value}
    assert ss.Model(made) == model
    counted = model.with_({"contents": [dict(floor=np.int64(0), mass="1 kg", static_friction=np.float32(0.5),
                                             kinetic_friction=np.float16(0.25))]})
    assert counted.value("contents.1.static_friction") == 0.5


def test_quantities_of_pint_are_texts() -> None:
    unit = pytest.importorskip("pint").UnitRegistry()
    for number in [2.0, np.float64(2.0), Fraction(2), np.array(2.0)]:
        assert block().with_({"slider.radius": number * unit.m}).value("slider.radius") == 2.0


@pytest.mark.parametrize(
    "value", [np.ma.masked, np.ma.array(0.05, mask=True), np.array([0.05]), [0.05], object(), 1j, np.nan]
)
def test_what_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(ss.InputError, match="slider.kinetic_friction"):
        block().with_({"slider.kinetic_friction": value})


def test_one_key_twice_is_refused() -> None:
    keys = {"slider.static_friction": 0.1, "slider.kinetic_friction": 0.1}
    with pytest.raises(ss.InputError, match="^block.mass: expected one value, found two$"):
        ss.Model({"block.mass": "1 t", "block": {"mass": "2 t"}, **keys})
    with pytest.raises(ss.InputError, match="^slider.radius: expected one value, found two$"):
        block().with_({"slider.radius": "1 m", "slider": {"radius": "2 m"}})


def test_equal_values_are_equal_models() -> None:
    metres, millimetres = (block().with_({"slider.radius": text}) for text in ["2.1 m", "2100 mm"])
    assert metres == millimetres and hash(metres) == hash(millimetres)
    assert metres != block().with_({"slider.radius": "2.2 m"})
    assert ss.Model.from_toml(metres.toml) == metres


def test_keys_are_removed_and_storeys_added() -> None:
    model = block().with_({"slider.radius": "2 m", "slider.damping_ratio": 0.02})
    assert model.with_({"slider.radius": None, "slider.damping_ratio": None}) == block()
    with pytest.raises(ss.InputError, match="slider.gap: expected a key that stands in the model"):
        model.with_({"slider.gap": None})
    storey = {"mass": "1 t", "stiffness": "4 kN/mm", "damping_ratio": 0.02}
    one = model.with_({"storey": [storey]})
    two = one.with_({f"storey.2.{key}": value for key, value in storey.items()})
    assert (one.storeys, two.storeys) == (1, 2) and two.with_({"storey.2": None}) == one
    assert two.with_({"storey": None}) == model
    with pytest.raises(ss.InputError, match="storey.4.mass: expected a number from 1 to 3"):
        two.with_({"storey.4.mass": "1 t"})


def test_a_path_that_no_model_has_is_told() -> None:
    with pytest.raises(ss.InputError, match='slider.raduis.*nearest is "slider.radius"'):
        block().value("slider.raduis")
    assert block().value("slider.radius") is None


def test_a_model_finds_its_record_from_everywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    monkeypatch.chdir(EXAMPLES)
    read = ss.Model.read("taft.toml")
    text = ss.Model.from_toml(Path("taft.toml").read_text(encoding="utf-8"))
    monkeypatch.chdir(tmp_path)
    for model in [read, text, pickle.loads(pickle.dumps(read))]:
        assert ss.run(model).events == expected.events
    assert read == expected.model and os.getcwd() == str(tmp_path)
