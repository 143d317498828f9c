"""Where things are. SLIPSTICK_ROOT is the checkout, SLIPSTICK_COMMAND the program."""

import os
import subprocess
from pathlib import Path

import pytest

import slipstick as ss

ROOT = Path(os.environ.get("SLIPSTICK_ROOT", Path(__file__).resolve().parents[3]))
EXAMPLES = ROOT / "examples"


def command(*arguments: object, status: int = 0) -> str:
    """What the command prints."""
    program = os.environ.get("SLIPSTICK_COMMAND")
    if program is None:
        pytest.skip("SLIPSTICK_COMMAND is not set")
    words = [str(Path(program).absolute()), *map(str, arguments)]
    ended = subprocess.run(words, capture_output=True, text=True)
    assert ended.returncode == status, ended.stderr
    return ended.stdout


def block() -> ss.Model:
    return ss.Model(
        {"block": {"mass": "325 kg"}, "slider": {"static_friction": 0.1, "kinetic_friction": 0.08}}
    )


def pulse() -> ss.Motion:
    return ss.Motion([0.0, 0.2, -0.2, 0.0], dt=0.5, units="g")


def quick_pulse() -> ss.Motion:
    """The same with steps that nothing is noticed of."""
    return ss.Motion([0.0, 0.2, -0.2, 0.0], dt=0.1, units="g")


def suite() -> dict[str, ss.Motion]:
    records = EXAMPLES / "records"
    return ss.read_suite([records / "taft-*.txt", records / "el-centro-180.txt"], units="g", dt=0.01)
