"""Tests of a laboratory: a prediction beside a measurement, and parameters from tests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

import numpy as np

from . import _core
from ._arguments import checked
from ._request import given, wrong
from ._result import UNITS, Result, write
from ._table import columns_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._request import Columns
    from ._table import Frame, Table
    from ._result import Key

    Measured = str | PathLike[str] | Frame
    Bound = str | tuple[float | None, float | None]


class Estimate(NamedTuple):
    """What an identification says of one parameter; in SI."""

    #: Path of the key in a model, such as ``slider.kinetic_friction``
    parameter: str
    #: SI unit, empty for a ratio
    unit: str
    #: The value that fits best; None where the data do not determine it
    value: float | None
    #: Lower end of the 95 % confidence interval
    low: float | None
    #: Upper end
    high: float | None
    #: Why the data do not determine it
    cannot_tell: str | None


class _Test(Result):
    """What comparisons and identifications have in common."""

    _KEYS = (*Result._KEYS, ("curves",), ("holds",), ("verdict",))

    def _keys(self) -> Iterator[Key]:
        yield from self._KEYS
        for units in UNITS:
            yield from [("_text", units), ("_report_html", units)]

    @property
    def curves(self) -> Mapping[str, Table]:
        """What was measured beside what was computed, by quantity or test; columns in SI."""
        return self._tabled("curves")

    @property
    def verdict(self) -> list[str]:
        """The result in a few sentences."""
        return list(self._tell("verdict"))

    @checked
    def text(self, units: str = "si") -> str:
        """The table that the command prints.

        Parameters
        ----------
        units
            ``"si"``, ``"si-g"``, ``"kN-mm"`` or ``"us"``.
        """
        return str(self._tell("_text", units))

    @checked
    def report(self, path: str | PathLike[str], *, units: str = "si") -> Path:
        """Write the result as one HTML page.

        Parameters
        ----------
        path
            The file.
        units
            ``"si"``, ``"si-g"``, ``"kN-mm"`` or ``"us"``.
        """
        return write(path, self._tell("_report_html", units))

    @overload
    def plot(self, name: str, *, ax: Axes | None = None, **kwargs: Any) -> Axes: ...
    @overload
    def plot(self, name: str | None = None, *, ax: Axes, **kwargs: Any) -> Axes: ...
    @overload
    def plot(self, name: None = None, *, ax: None = None, **kwargs: Any) -> NDArray[np.object_]: ...
    def plot(
        self, name: str | None = None, *, ax: Axes | None = None, **kwargs: Any
    ) -> NDArray[np.object_] | Axes:
        """Draw measured and computed values in Matplotlib.

        Parameters
        ----------
        name
            One of ``curves``; all of them below one another if left out.
        ax
            Where one of them is drawn.
        kwargs
            What lines take: ``color``, ``lw``.

        Returns
        -------
        Axes or array of Axes
            One for each curve.
        """
        from ._plot import draw_curve, draw_curves

        if name is None and ax is None:
            return draw_curves(self.curves, **kwargs)
        chosen = next(iter(self.curves)) if name is None else name
        return draw_curve(chosen, self.curves[chosen], ax, **kwargs)

    def __str__(self) -> str:
        return self.text()


class Comparison(_Test):
    """A prediction beside what was measured.

    ``tables["figures"]`` has one row a quantity; ``curves`` has ``time_s``, ``measured`` and ``predicted``
    of each quantity.
    """

    _KEYS = (*_Test._KEYS, ("motion",))

    @property
    def holds(self) -> bool:
        """Whether every bound of ``within`` is kept."""
        return bool(self._tell("holds"))

    @property
    def motion(self) -> _core.Motion:
        """The measured table acceleration; ``run(model, comparison.motion)`` is the prediction in full."""
        motion: _core.Motion = self._tell("motion")
        return motion

    def _names(self) -> str:
        return ", ".join(self.curves)


class Identified(_Test):
    """Parameters identified from tests.

    ``tables["estimates"]`` has one row a parameter. Of cyclic tests, ``tables["cycles"]`` has one row a
    cycle and ``curves`` displacement, force and fitted force by test; where friction follows the speed,
    ``tables["friction_by_speed"]`` has what every cycle tells and ``tables["friction_curve"]`` the fitted
    curve with its interval; where it follows the pressure, those are ``tables["friction_by_pressure"]`` and
    ``tables["pressure_curve"]``. Of a shaking-table record ``tables["agreement"]`` and ``curves`` are those of
    the comparison with the best values.
    """

    _KEYS = (*_Test._KEYS, ("_estimates",), ("model",))

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The estimates by parameter."""
        return {parts[0]: Estimate(*parts) for parts in self._tell("_estimates")}

    @property
    def holds(self) -> bool:
        """Whether the data determine every parameter."""
        return bool(self._tell("holds"))

    @property
    def model(self) -> _core.Model | None:
        """The given model with what was determined; None without one, or where nothing was."""
        model: _core.Model | None = self._tell("model")
        return model

    def _names(self) -> str:
        return ", ".join(self.estimates)


def _test(measured: Measured, argument: str = "measured") -> Any:
    """A file, or columns by name as the extension takes them."""
    if isinstance(measured, (str, PathLike)):
        return Path(fspath(measured))
    given = columns_of(measured, argument)
    for name, values in given:
        if np.ma.is_masked(values):
            raise wrong(f"{argument} {name}", "values without a mask (a gap is no measurement)", "a masked array")
    columns = ((name, np.asarray(values)) for name, values in given)
    numbers = [(name, values) for name, values in columns if values.dtype.kind in "fiu"]
    return [(name, np.ascontiguousarray(values, dtype="f8")) for name, values in numbers]


@checked
def compare(
    measured: Measured,
    model: _core.Model,
    *,
    mapping: Columns | None = None,
    method: Literal["exact", "stepwise"] | None = None,
    within: Mapping[str, Bound] | None = None,
) -> Comparison:
    """Compare what a model predicts with what was measured on a shaking table.

    The prediction is driven by the measured table acceleration, from the model's initial state at its first
    sample. Measured values are neither filtered nor resampled.

    Parameters
    ----------
    measured
        A file of columns (text or Parquet), or columns by name: a dict of arrays, a data frame. Columns named
        as in ``history.csv``, perhaps in another unit (``block_acceleration_g``), need no mapping.
    model
        The model; its own motion and tail play no part.
    mapping
        Which column is which quantity: ``{"sliding_displacement": "X1 - U [mm]"}``, or a mapping file.
    method
        ``"exact"`` or ``"stepwise"``; that of the model if left out.
    within
        Bounds on figures, in SI: ``{"peak_ratio.sliding_displacement": (0.9, 1.1)}``; None leaves an end
        open.

    Returns
    -------
    Comparison
        Figures, curves, warnings; ``holds`` says whether all bounds are kept.

    Raises
    ------
    InputError
        For a mapping or a bound that cannot be.
    RecordError
        For a file that is no table of finite numbers, or lacks the table acceleration or anything to
        compare.

    Examples
    --------
    >>> import numpy as np
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.1,
    ...                   "slider.kinetic_friction": 0.08})
    >>> truth = ss.run(model, ss.Motion(2 * np.sin(np.arange(0, 9, 0.1)), dt=0.1, units="m/s2"))
    >>> names = ["time_s", "table_acceleration_m_per_s2", "sliding_displacement_m"]
    >>> comparison = ss.compare({name: truth.history[name] for name in names}, model)
    >>> comparison.summary["quantities"][0]["peak_ratio"]
    1.0
    """
    if within is not None and not isinstance(within, Mapping):
        raise wrong("within", "bounds by figure, {figure: (least, most)}", _core.described(within))
    ranges = {figure: _range(figure, bound) for figure, bound in (within or {}).items()}
    asked = given("compare", {"method": method, "within": ranges, "mapping": mapping})
    return Comparison(_core.compare_with(_test(measured), model, asked))


def _range(figure: object, bound: Bound) -> str:
    if isinstance(bound, str):
        return bound
    of_ends = isinstance(bound, Sequence) and len(bound) == 2
    if not of_ends or not all(end is None or isinstance(end, (int, float)) for end in bound):
        raise wrong(f"within {figure}", "two numbers, of which None leaves an end open", _core.described(bound))
    return "..".join("" if end is None else repr(float(end)) for end in bound)


def several(tests: Measured | Sequence[Measured], argument: str) -> list[Any]:
    """One test or several."""
    if isinstance(tests, Sequence) and not isinstance(tests, (str, bytes)):
        return [_test(test, argument) for test in tests]
    return [_test(tests, argument)]
