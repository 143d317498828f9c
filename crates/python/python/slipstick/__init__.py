"""Exact seismic response of structures on sliding bearings.

Everything is SI; a number with a dimension is text with its unit, ``"0.3 g"``, unless the
argument's name ends in its unit.

Examples
--------
>>> import slipstick as ss
>>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.1,
...                   "slider.kinetic_friction": 0.08})
>>> motion = ss.Motion([0.0, 0.2, -0.2, 0.0], dt=0.1, units="g")
>>> response = ss.run(model, motion)
>>> response.holds
True
>>> [event.kind for event in response.events]
['slip', 'reversal']
>>> round(1e3 * response.summary["residual_sliding_displacement_m"], 2)
0.42
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core, identify
from ._arguments import checked
from ._assessment import (
    Assessment,
    Sensitivity,
    design,
    fragility,
    ida,
    read_suite,
    sensitivity,
    spectrum,
    suite,
)
from ._core import Model, Motion, __version__
from ._demands import demands
from ._errors import InputError, RecordError, SlipstickWarning, SolveError, StudyError
from ._laboratory import Comparison, Estimate, Identified, compare
from ._parts import (
    Analysis,
    Block,
    Contents,
    Frame,
    Initial,
    Mode,
    Point,
    Pulse,
    Sine,
    Slider,
    Stop,
    Storey,
    Structure,
    Surface,
    Sweep,
)
from ._records import Suite
from ._response import Response, run
from ._study import Plan, Study, study
from ._table import Event, Events, Table
from ._widget import widget

if TYPE_CHECKING:
    from os import PathLike

    from . import audit

__all__ = [
    "Analysis",
    "Assessment",
    "Block",
    "Comparison",
    "Contents",
    "Estimate",
    "Event",
    "Events",
    "Frame",
    "Identified",
    "Initial",
    "InputError",
    "Mode",
    "Model",
    "Motion",
    "Plan",
    "Point",
    "Pulse",
    "RecordError",
    "Response",
    "Sensitivity",
    "Sine",
    "Slider",
    "SlipstickWarning",
    "SolveError",
    "Stop",
    "Storey",
    "Structure",
    "Study",
    "StudyError",
    "Suite",
    "Surface",
    "Sweep",
    "Table",
    "__version__",
    "audit",
    "compare",
    "demands",
    "design",
    "fragility",
    "ida",
    "identify",
    "read_channels",
    "read_record",
    "read_suite",
    "run",
    "schema",
    "sensitivity",
    "spectrum",
    "study",
    "suite",
    "units",
    "widget",
]


if not TYPE_CHECKING:  # A name that is none does not type-check.

    def __getattr__(name):
        """What is seldom wanted is imported when it is."""
        if name == "audit":
            import importlib

            return importlib.import_module("slipstick.audit")
        raise AttributeError(f"module 'slipstick' has no attribute {name!r}")


@checked
def read_record(
    path: str | PathLike[str],
    *,
    y: str | PathLike[str] | None = None,
    channel: str | int | None = None,
    units: str | None = None,
    dt: float | str | None = None,
    vertical: str | PathLike[str] | None = None,
) -> Motion:
    """Read a record of any format that ``slipstick record info`` knows.

    Parameters
    ----------
    path
        The file.
    y
        The file of the other horizontal component, along y, which takes the same channel, units and time step.
    channel
        Name or number (from 1) of the channel, where the file has several of acceleration.
    units
        Units of the values, such as ``"g"``, where the file does not state them.
    dt
        Time step, in s or with its unit, where the file does not state it.
    vertical
        A file with the vertical component.

    Returns
    -------
    Motion
        The motion as recorded.

    Raises
    ------
    RecordError
        For content that is no record, with line and column.
    OSError
        For a file that cannot be read: ``FileNotFoundError`` and its kin.
    """
    return Motion.read(path, y=y, channel=channel, units=units, dt=dt, vertical=vertical)


@checked
def read_channels(
    path: str | PathLike[str], *, units: str | None = None, dt: float | str | None = None
) -> dict[str, Motion]:
    """Read all channels of acceleration of a record.

    Parameters
    ----------
    path
        The file.
    units, dt
        As in ``read_record``.

    Returns
    -------
    dict
        The motions by the names of their channels.

    Raises
    ------
    RecordError
        For content that is no record, with line and column, and a file without acceleration.
    OSError
        For a file that cannot be read: ``FileNotFoundError`` and its kin.
    """
    return _core.read_channels(Path(path), units=units, dt=dt)


@checked
def schema(*, plan: bool = False) -> dict[str, Any]:
    """Give the JSON schema of the model file, as ``slipstick schema`` prints it.

    Parameters
    ----------
    plan
        That of the plan of a study instead.
    """
    import json

    found: dict[str, Any] = json.loads(_core.schema(plan))
    return found


def units() -> Table:
    """Give all units that values may have, and what one of each is in SI.

    Examples
    --------
    >>> import slipstick as ss
    >>> units = ss.units()
    >>> float(dict(zip(units["unit"], units["in_si"]))["kip"])
    4448.2216152605
    """
    rows = list(zip(*_core.units(), strict=True))
    return Table(dict(zip(("unit", "measures", "in_si", "si_unit"), map(list, rows), strict=True)))
