"""Motions wherever motions go: one, a list, a dict by name, a stream of ObsPy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import check_arguments
from ._obspy import Stream, Trace, is_stream, motion as of_stream, motions
from ._request import wrong

if TYPE_CHECKING:
    from ._request import Values

    Recorded = _core.Motion | Trace | Stream
    #: What an argument of motions takes
    Records = Recorded | Mapping[str, Recorded] | Iterable[Recorded]
    Named = list[tuple[str, _core.Motion]]


@dataclass(frozen=True)
class Suite:
    """Records with how they are scaled: one object in place of ``records`` and its arguments.

    Parameters
    ----------
    records
        Motions by name, in a list, one, or a stream of ObsPy.
    second
        Other components of records in one direction, as many and in the same order.
    measure, scale_to
        All records, or pairs, are scaled so that the measure takes this value, or in ``ida`` and ``Plan`` each of these.
    scale
        A factor on all records instead.
    pairs
        How pairs are run: ``"together"`` or ``"separate"``.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "1 t", "slider.static_friction": 0.06, "slider.kinetic_friction": 0.05})
    >>> records = {"pulse": ss.Motion([0.0, 0.3, -0.3, 0.0], dt=0.1, units="g")}
    >>> suite = ss.Suite(records, scale_to="0.2 g")
    >>> ss.suite(model, suite) == ss.suite(model, records, scale_to="0.2 g")
    True
    """

    records: Records
    second: Records | None = None
    measure: str | None = None
    scale_to: Values | None = None
    scale: float | None = None
    pairs: str | None = None

    def __post_init__(self) -> None:
        check_arguments(type(self).__annotations__, vars(self))
        for name, of in zip(("records", "second"), components("records", self.records, self.second), strict=True):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, dict(of))

    def __len__(self) -> int:
        return len(self.records)  # type: ignore[arg-type]

    def fill(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """What is asked of an analysis, with what stands here."""
        filled = dict(asked)
        for name in ("second", "measure", "scale_to", "scale", "pairs"):
            value = getattr(self, name)
            if value is None:
                continue
            if filled.get(name) is not None:
                raise wrong(name, "one value, of the Suite or beside it", "both")
            filled[name] = value
        return filled


#: What is expected where several motions may stand
EXPECTED = "motions: a Motion, a list, a dict by name or a stream of ObsPy"


def _found(value: object) -> str:
    """What stands in place of a motion, and how it becomes one."""
    if isinstance(value, (str, PathLike)):
        return f"the path {str(value)!r} (read_record or read_suite reads it)"
    if hasattr(value, "dtype"):
        return "an array (Motion(array, dt=..., units=...) is a motion)"
    return _core.described(value)


def one(argument: str, value: object, expected: str = "a motion") -> _core.Motion:
    """One motion."""
    if isinstance(value, _core.Motion):
        return value
    if is_stream(value):
        return of_stream(value)  # type: ignore[arg-type]
    raise wrong(argument, expected, _found(value))


def named(argument: str, given: Records) -> dict[str, _core.Motion]:
    """Motions by their names: of a list these are their numbers from 1, of a stream its stations."""
    if isinstance(given, Suite):
        raise wrong(argument, "motions", "a Suite, whose scaling is not taken here")
    if isinstance(given, _core.Motion):
        return {"motion": given}
    if is_stream(given):
        return motions(given)  # type: ignore[arg-type]
    if isinstance(given, Mapping):
        for key in given:
            if not isinstance(key, str):
                raise wrong(argument, "names that are text", repr(key))
        return {key: one(argument, value, f"a motion as {key!r}") for key, value in given.items()}
    if isinstance(given, (str, PathLike)) or hasattr(given, "dtype") or not isinstance(given, Iterable):
        raise wrong(argument, EXPECTED, _found(given))
    return {str(i): one(argument, value, f"a motion in place {i}") for i, value in enumerate(given, 1)}


def components(argument: str, records: Records, second: Records | None = None) -> tuple[Named, Named]:
    """Motions with their names, at least one, all in one direction or all in two, and their other components."""
    of = list(named(argument, records).items())
    others = [] if second is None else list(named("second", second).items())
    if not of:
        raise wrong(argument, "at least one motion", "none")
    if second is not None and len(others) != len(of):
        raise wrong("second", f"one other component for each of {len(of)} records", str(len(others)))
    in_one, in_two = list[str](), list[str]()
    for key, motion in of + others:
        (in_one if motion.acceleration_y_m_per_s2 is None else in_two).append(key)
    if in_two and second is not None:
        raise wrong("second", "records in one direction beside it", f'"{in_two[0]}" in two')
    if in_two and in_one:
        raise wrong(argument, "motions all in one direction or all in two", f'"{in_one[0]}" in one')
    return of, others


def of_suite(argument: str, records: Records | Suite, asked: Mapping[str, Any]) -> tuple[Named, Named, Mapping[str, Any]]:
    """Motions, their other components, and what is asked of them, of a suite with its scaling."""
    if isinstance(records, Suite):
        asked, records = records.fill(asked), records.records
    return *components(argument, records, asked.get("second")), asked
