"""One analysis and what came of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, overload

from . import _core
from ._arguments import checked
from ._obspy import is_stream
from ._records import named
from ._request import wrong
from ._result import figures_of, in_a_line, in_html, warn_of
from ._table import Columns, Event, Events, Table

if TYPE_CHECKING:
    from os import PathLike

    import numpy as np
    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from ._assessment import Assessment
    from ._obspy import Stream, Trace
    from ._plot import Plotter
    from ._records import Recorded, Records


@overload
def run(
    model: _core.Model,
    motion: _core.Motion | None = None,
    *,
    floor_spectrum: bool = False,
    history: bool = True,
    check: bool = True,
) -> Response: ...
@overload
def run(
    model: _core.Model,
    motion: Mapping[str, Recorded] | Sequence[Recorded],
    *,
    floor_spectrum: bool = False,
    check: bool = True,
) -> Assessment: ...
@overload
def run(
    model: _core.Model,
    motion: Trace | Stream,
    *,
    floor_spectrum: bool = False,
    history: bool = True,
    check: bool = True,
) -> Response | Assessment: ...
@checked
def run(
    model: _core.Model,
    motion: Records | None = None,
    *,
    floor_spectrum: bool = False,
    history: bool = True,
    check: bool = True,
) -> Response | Assessment:
    """Analyse a model on a motion, exactly, and judge the answer.

    Parameters
    ----------
    model
        The model; its ``analysis.method`` and ``analysis.tail`` hold.
    motion
        The motion of the table, or a trace of ObsPy, or a stream of one station; the model's own if left out. Several
        by name, in a list or in a stream are a suite, of which the answer is that of ``suite``.
    floor_spectrum
        Whether response spectra of table, block and floors are wanted in ``summary``; in two directions RotD100,
        and those along x and along y.
    history
        Whether histories are kept. Demands, counts and events are the same without, bit for bit.
    check
        Whether the answer is judged. Without history and check a call takes hardly longer than the analysis.

    Returns
    -------
    Response
        Peaks, history, events and the certificate, with those of lower- and upper-bound friction in
        ``summary`` where the model has ``slider.bounds``.

    Raises
    ------
    InputError
        Where neither model nor caller gives a motion.
    SolveError
        Where there is no answer, with the time.

    Warns
    -----
    SlipstickWarning
        For what makes figures void: a check that fails, a gap that is passed, contact that is lost.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.1,
    ...                   "slider.kinetic_friction": 0.08})
    >>> response = ss.run(model, ss.Motion([0.0, 0.2, -0.2, 0.0], dt=0.1, units="g"))
    >>> response.holds, response.summary["samples"]
    (True, 4)
    >>> float(abs(response.knots["friction_force_n"]).max()) == 0.1 * 325 * 9.80665
    True
    """
    if motion is not None and not isinstance(motion, _core.Motion):
        of = named("motion", motion)
        if is_stream(motion) and len(of) == 1:
            return run(model, *of.values(), floor_spectrum=floor_spectrum, history=history, check=check)
        from ._assessment import suite

        if history is not True:
            raise wrong("history", "one motion beside it", f"{history} with several")
        return suite(model, of, floor_spectrum=floor_spectrum, check=check)
    core = _core.run(model, motion, floor_spectrum=floor_spectrum, history=history, check=check)
    warn_of(core._noticed())
    return Response(core, model, (floor_spectrum, history, check))


#: Columns of the samples of a motion that is saved
_SAMPLES = ("time_s", "acceleration_m_per_s2", "acceleration_y_m_per_s2", "vertical_acceleration_m_per_s2")


class Response:
    """What came of one analysis; everything in SI.

    Two are equal where model and motion are. A response pickles as those, and is computed again.
    """

    def __init__(self, core: _core.Response, model: _core.Model, asked: tuple[bool, bool, bool]) -> None:
        self._core = core
        self._model = model
        #: Floor spectra, history, check
        self._asked = asked

    @property
    def model(self) -> _core.Model:
        """The model."""
        return self._model

    @cached_property
    def motion(self) -> _core.Motion:
        """The motion of the table, without a tail."""
        return self._core.motion

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._model, self.motion, *self._asked)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Response):
            return NotImplemented
        same = self._model == other._model and self._asked == other._asked
        return same and self.motion == other.motion

    def __hash__(self) -> int:
        return hash(self._model)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Peaks, residuals, counts and all other figures, as ``slipstick run --json`` prints them."""
        return figures_of(self._core._summary_json())

    @property
    def certificate(self) -> dict[str, Any]:
        """The figures that certify the answer, and their bound."""
        checks: dict[str, Any] = self.summary["checks"]
        return checks

    @property
    def holds(self) -> bool | None:
        """Whether the certificate holds; None of the stepwise method and of ``run(check=False)``, which are not judged."""
        return self._core.holds

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What may change a decision, the gravest first."""
        warnings: list[dict[str, Any]] = self.summary["warnings"]
        return warnings

    @property
    def notes(self) -> list[dict[str, Any]]:
        """How something was read."""
        notes: list[dict[str, Any]] = self.summary["notes"]
        return notes

    @cached_property
    def history(self) -> Columns:
        """Histories by column, one row a sample, as in ``history.csv``; in two directions along x and y."""
        return Columns(self._core._history(knots=False), "time_s")

    @cached_property
    def knots(self) -> Columns:
        """Histories with both sides of every event; ``direction`` is 0 stuck, 1 or -1 sliding."""
        columns = self._core._history(knots=True)
        columns["direction"] = self._core._modes()
        return Columns(columns, "knot")

    @cached_property
    def energy(self) -> Columns:
        """Energies in J at ``knots``: input, kinetic, strain, and spent in dampers and friction."""
        return Columns(self._core._energy(), "knot")

    @cached_property
    def slider_force_n(self) -> NDArray[np.float64]:
        """Force of the whole slider at ``knots`` in N, friction, spring, damper and stop together.

        It rises with the sliding displacement, as a data sheet draws it.
        """
        force = self._core._slider_force()
        force.flags.writeable = False
        return force

    @cached_property
    def slider_force_y_n(self) -> NDArray[np.float64]:
        """The same along y in two directions; empty in one."""
        force = self._core._slider_force_y()
        force.flags.writeable = False
        return force

    @cached_property
    def events(self) -> Events:
        """All events in order."""
        return Events(Event(t, kind, int(sign), s, at) for t, kind, sign, s, at in self._core._events())

    @property
    def plot(self) -> Plotter:
        """Figures in Matplotlib: ``r.plot()``, ``r.plot.loop(ax=ax)``, ``r.plot.history()``."""
        from ._plot import Plotter

        return Plotter(self)

    @cached_property
    def figures(self) -> Mapping[str, str]:
        """The figures of the report as SVG by name; a notebook shows the first."""
        return MappingProxyType(dict(self._core._figures()))

    def to_pandas(self) -> pd.DataFrame:
        """The history as a data frame with the time as its index."""
        return self.history.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """The history as a dataset over ``time_s``, units as attributes."""
        return self.history.to_xarray()

    @checked
    def report(self, path: str | PathLike[str], *, units: str = "si") -> Path:
        """Write the report of ``slipstick run --out`` as one HTML page.

        Parameters
        ----------
        path
            The file.
        units
            ``"si"``, ``"si-g"``, ``"kN-mm"`` or ``"us"``.
        """
        target = Path(path)
        target.write_text(self._core._report_html(units), encoding="utf-8")
        return target

    @checked
    def save(self, folder: str | PathLike[str]) -> Path:
        """Write the files of ``slipstick run --out`` into a folder, and model and motion beside them.

        Parameters
        ----------
        folder
            The folder for ``summary.json``, ``history.csv``, ``events.csv`` and ``report.html``, which are those of the
            command, and for ``model.toml``, ``motion.json`` and ``motion.parquet``, from which ``Response.read`` computes the
            same response again.

        Raises
        ------
        ValueError
            For a response without history and check.
        OSError
            For files that cannot be written.
        """
        import json

        _, parts = self.motion.__reduce__()
        columns, told = parts[:4], parts[4:]
        named = {name: of for name, of in zip(_SAMPLES, columns, strict=True) if of is not None}
        beside = {"model.toml": self._model.toml, "motion.json": json.dumps([told, self._asked[0]], ensure_ascii=False)}
        self._core._save(folder, list(beside.items()))
        Table(named, {"time_s": "s", **{name: "m/s2" for name in _SAMPLES[1:] if name in named}}).write(Path(folder) / "motion.parquet")
        return Path(folder)

    @classmethod
    @checked
    def read(cls, folder: str | PathLike[str]) -> Response:
        """Compute the response anew that ``save`` has written into a folder.

        Parameters
        ----------
        folder
            The folder.

        Raises
        ------
        OSError, RecordError
            For files that are not there, or are not those of ``save``.
        """
        import json

        folder = Path(folder)
        told, floor_spectrum = json.loads((folder / "motion.json").read_text(encoding="utf-8"))
        table = Table.read(folder / "motion.parquet")
        description, warnings, (factor, along_x, along_y) = told
        time_s, x, y, up = (table.get(name) for name in _SAMPLES)
        origin = (factor, tuple(along_x), None if along_y is None else tuple(along_y))
        warned = [(kind, time, message) for kind, time, message in warnings]
        motion = _core.Motion._from_parts(time_s, x, y, up, description, warned, origin)
        model = _core.Model.from_toml((folder / "model.toml").read_text(encoding="utf-8"), "")
        return run(model, motion, floor_spectrum=floor_spectrum)

    def _repr_html_(self) -> str:
        from html import escape

        peak = 1e3 * self.summary["peak_sliding_displacement_m"]
        said = in_html(self.holds, self._core._noticed(), "The certificate")
        picture = next(iter(self.figures.values())) if self._asked[1:] == (True, True) else ""
        told = f"<p><b>{escape(self._core.name)}</b>: peak sliding displacement {peak:.4g} mm</p>"
        return said + told + picture

    def __repr__(self) -> str:
        said = in_a_line(self.holds, self._core._noticed())
        return f"<slipstick.Response {said}{self._core.name!r}, {len(self.events)} events>"


def _again(
    model: _core.Model, motion: _core.Motion, floor_spectrum: bool, history: bool, check: bool
) -> Response:
    return run(model, motion, floor_spectrum=floor_spectrum, history=history, check=check)

