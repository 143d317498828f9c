"""Figures in Matplotlib; each returns its axes.

What axes and lines are called, in which units and colours, the core says to this module as to the reports.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from . import _core

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._core import Motion
    from ._response import Response
    from ._table import Table


class Axis(NamedTuple):
    """What stands along an axis: its label with the unit, the unit, and what one of it is in SI."""

    label: str
    symbol: str
    in_si: float

    @classmethod
    def of(cls, quantity: str, *values: Any, along: str = "") -> Axis:
        """That of a quantity with these values, perhaps along ``x``, ``y`` or the ``resultant``."""
        return cls(*_core.axis(quantity, _largest(values), along))

    @classmethod
    def of_column(cls, table: Table, name: str, measure: str | None = None) -> Axis:
        """That of a column of a table, of an intensity by its name; of what the core does not know as it is."""
        unit = table.units.get(name, "")
        values = (table[name],) if isinstance(table[name], np.ndarray) else ()
        known = _core.axis_of_column(name, unit, _largest(values), measure)
        return cls(*known) if known is not None else cls(f"{name} ({unit})" if unit else name, unit, 1.0)

    def shown(self, values: Any) -> NDArray[np.float64]:
        """Values in its unit."""
        return np.asarray(values, dtype=float) / self.in_si


def _largest(values: Iterable[Any]) -> float:
    """The largest of finite values in size."""
    finite = [np.abs(of[np.isfinite(of)]) for of in (np.asarray(one, dtype=float) for one in values)]
    return max((float(of.max()) for of in finite if of.size), default=0.0)


@cache
def _lines() -> dict[str, tuple[str, str, float, str]]:
    return dict(_core.lines())


def _of_line(line: tuple[str, str, float, str], given: Mapping[str, Any], **usual: Any) -> dict[str, Any]:
    """How a line of the core is drawn, but for what is given."""
    label, colour, width, dashes = line
    pattern = (0.0, tuple(float(part) for part in dashes.split())) if dashes else "-"
    return style(given, **{"label": label or None, "color": colour, "lw": width, "ls": pattern, **usual})


def _line(name: str, given: Mapping[str, Any], **usual: Any) -> dict[str, Any]:
    """The same of a line by its name."""
    return _of_line(_lines()[name], given, **usual)


class Plotter:
    """The figures of a response."""

    def __init__(self, response: Response) -> None:
        self._response = response

    def __call__(self, ax: Axes | None = None, **kwargs: Any) -> NDArray[np.object_] | Axes:
        """Displacement, acceleration and the friction loop on one page, on axes of one's own the displacement alone.

        Lines take what is given besides.
        """
        import matplotlib.pyplot as plt

        if ax is not None:
            return self.history(ax, **kwargs)

        _, axes = plt.subplot_mosaic(
            [["sliding", "loop"], ["acceleration", "loop"]], figsize=(10, 5), layout="constrained"
        )
        self.history(ax=axes["sliding"], **kwargs)
        self.acceleration(ax=axes["acceleration"], **kwargs)
        self.loop(ax=axes["loop"], **kwargs)
        axes["acceleration"].sharex(axes["sliding"])
        return np.array([axes["sliding"], axes["acceleration"], axes["loop"]], dtype=object)

    def _along(self, along: str | None, usual: str) -> list[str]:
        """What is drawn of a response: nothing said of one direction, in two ``x``, ``y`` or ``resultant``."""
        if "sliding_displacement_y_m" not in self._response.knots:
            if along not in (None, "x"):
                raise ValueError(f"along: expected a response in two directions beside {along!r}, found one in one")
            return [""]
        chosen = usual if along is None else along
        known = {"x": ["x"], "y": ["y"], "both": ["x", "y"], "resultant": ["resultant"]}
        if chosen not in known:
            raise ValueError(f"along: expected one of {', '.join(known)}, found {along!r}")
        return known[chosen]

    def history(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Sliding displacement over time, sliding shaded, the peak marked.

        In two directions along x and along y, of which each is a line; ``along`` may be ``"x"``, ``"y"``, ``"both"`` or
        ``"resultant"``.
        """
        knots, ax = self._response.knots, axes_or_new(ax)
        time = knots["time_s"]
        _shade(ax, knots)
        axes = self._along(along, "both")
        drawn = [_of_axis(knots, "sliding_displacement_m", axis) for axis in axes]
        upwards = Axis.of("sliding", *drawn, along=axes[0] if len(axes) == 1 else "")
        for axis, moved, colour in zip(axes, drawn, distinct(len(axes))):
            s = upwards.shown(moved)
            said = _core.along(axis)
            ax.plot(time, s, **_line("main", kwargs, color=colour, label=said if len(axes) > 1 else None))
            at = int(np.argmax(np.abs(s)))
            peak = f"peak {said} {s[at]:.4g} {upwards.symbol}" if len(axes) > 1 else f"peak {s[at]:.4g} {upwards.symbol}"
            ax.plot(time[at], s[at], "o", ms=4, color=colour if len(axes) > 1 else _lines()["limit"][1], label=peak)
        ax.legend(loc="best", frameon=False)
        return _over_time(ax, upwards)

    def acceleration(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Accelerations of table, block and top floor, or last point of a structure by its modes, over time.

        In two directions along x; ``along`` may be ``"x"``, ``"y"`` or ``"resultant"``.
        """
        knots, ax = self._response.knots, axes_or_new(ax)
        (axis,) = self._along("x" if along == "both" else along, "x")
        block, _ = self._response._core._places()
        parts: list[tuple[str, str, dict[str, Any]]] = [
            ("ground", "table_acceleration_m_per_s2", {}),
            ("block", "block_acceleration_m_per_s2", {"label": block}),
        ]
        for label, name in self._points("acceleration_m_per_s2")[-1:]:
            parts.append(("main", name, {"label": label, "color": distinct(2)[1]}))
        drawn = [(line, _of_axis(knots, name, axis), usual) for line, name, usual in parts]
        upwards = Axis.of("acceleration", *(values for _, values, _ in drawn), along=axis)
        for line, values, usual in drawn:
            ax.plot(knots["time_s"], upwards.shown(values), **_line(line, kwargs, **usual))
        return _over_time(ax, upwards)

    def _points(self, quantity: str) -> list[tuple[str, str]]:
        """Names of storeys, or of points of a structure by its modes, with the column of a quantity of each."""
        part = "point" if self._response.summary.get("points") else "storey"
        _, names = self._response._core._places()
        return [(name, f"{part}{i}_{quantity}") for i, name in enumerate(names, 1)]

    def loop(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Force of the whole slider over sliding displacement: the loop as data sheets draw it.

        With a spring, damper or stop its friction alone is drawn beside it, thin. In two directions along x and along
        y, each over the displacement along it; ``along`` may be ``"x"``, ``"y"`` or ``"both"``.
        """
        response, ax = self._response, axes_or_new(ax)
        if along == "resultant":
            raise ValueError("along: expected one of x, y, both, found 'resultant': a loop has a direction")
        axes = self._along(along, "both")
        moved = [_of_axis(response.knots, "sliding_displacement_m", axis) for axis in axes]
        forces = [response.slider_force_y_n if axis == "y" else response.slider_force_n for axis in axes]
        direction = axes[0] if len(axes) == 1 else ""
        across, upwards = Axis.of("sliding", *moved, along=direction), Axis.of("slider_force", *forces, along=direction)
        for axis, sliding, force, colour in zip(axes, moved, forces, distinct(len(axes))):
            friction = -_of_axis(response.knots, "friction_force_n", axis)
            # Without them the two are one, but for rounding.
            apart = np.abs(force - friction).max(initial=0.0) > 1e-9 * np.abs(force).max(initial=0.0)
            if apart and len(axes) == 1:
                ax.plot(across.shown(sliding), upwards.shown(friction), **_line("friction_part", {}))
            usual = {"label": _core.along(axis)} if len(axes) > 1 else {} if apart else {"label": None}
            ax.plot(across.shown(sliding), upwards.shown(force), **_line("slider", kwargs, color=colour, **usual))
        if ax.get_legend_handles_labels()[0]:
            ax.legend(loc="best", frameon=False)
        ax.set(xlabel=across.label, ylabel=upwards.label)
        return ax

    def orbit(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Sliding displacement along y over that along x, inside the circle of the gap where there is one.

        Raises
        ------
        ValueError
            For a response in one direction.
        """
        response, ax = self._response, axes_or_new(ax)
        knots = response.knots
        if "sliding_displacement_y_m" not in knots:
            raise ValueError("expected a response in two directions, found one in one")
        x, y = (knots[f"sliding_displacement{axis}_m"] for axis in ("", "_y"))
        across, upwards = (Axis.of("sliding", x, y, along=along) for along in ("x", "y"))
        ax.plot(across.shown(x), upwards.shown(y), **_line("main", kwargs))
        at = int(np.argmax(np.hypot(x, y)))
        peak = f"peak {across.shown(np.hypot(x[at], y[at])):.4g} {across.symbol}"
        ax.plot(across.shown(x[at]), upwards.shown(y[at]), "o", ms=4, color=_lines()["limit"][1], label=peak)
        gap = response.model.value("slider.gap")
        if gap is not None:
            around = across.shown(gap) * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 181))
            ax.plot(around.real, around.imag, **_line("gap", {}))
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel=across.label, ylabel=upwards.label, aspect="equal")
        return ax

    def energy(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """What became of the energy put in, over time."""
        energy, ax = self._response.energy, axes_or_new(ax)
        columns, labels, colours = zip(*_core.energies())
        upwards = Axis.of("energy", *(energy[column] for column in (*columns, "input_j")))
        areas = [upwards.shown(energy[column]) for column in columns]
        time = self._response.knots["time_s"]
        ax.stackplot(time, *areas, **{"labels": labels, "colors": colours, "edgecolor": "0.1", "lw": 0.3, **kwargs})
        ax.plot(time, upwards.shown(energy["input_j"]), **_line("input", {}))
        return _over_time(ax, upwards, "upper left")

    def drift(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Drift of every storey over time, of a point of a structure by its modes over the point before it.

        In two directions along x; ``along`` may be ``"x"``, ``"y"`` or ``"resultant"``.
        """
        return self._of_points("drift", ax, along, **kwargs)

    def displacement(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Displacement over the block of every floor, or point of a structure by its modes, over time.

        In two directions along x; ``along`` may be ``"x"``, ``"y"`` or ``"resultant"``.
        """
        return self._of_points("over_block", ax, along, **kwargs)

    def _of_points(self, quantity: str, ax: Axes | None, along: str | None, **kwargs: Any) -> Axes:
        knots, ax = self._response.knots, axes_or_new(ax)
        (axis,) = self._along("x" if along == "both" else along, "x")
        parts = ("x", "y") if axis == "resultant" else (axis,)
        points = self._points("displacement_m")
        if not points:
            raise ValueError("expected a model with storeys or points, found one without")
        moved = np.array([[_of_axis(knots, column, part) for part in parts] for _, column in points])
        if quantity == "drift":
            moved = np.diff(moved, axis=0, prepend=0.0)
        sizes = np.hypot(moved[:, 0], moved[:, 1]) if len(parts) > 1 else moved[:, 0]
        upwards = Axis.of(quantity, sizes, along=axis)
        for (label, _), values, colour in zip(points, sizes, distinct(len(points))):
            ax.plot(knots["time_s"], upwards.shown(values), **_line("main", kwargs, color=colour, label=label))
        return _over_time(ax, upwards)

    def surfaces(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Displacement of every surface in series over time, and of all together."""
        knots, ax = self._response.knots, axes_or_new(ax)
        together, surfaces = knots["sliding_displacement_m"], _numbered(knots, "surface")
        upwards = Axis.of("displacement", together, *surfaces)
        ax.plot(knots["time_s"], upwards.shown(together), **_line("together", kwargs))
        names = (f"surface {number}" for number in range(1, len(surfaces) + 1))
        return self._numbered_lines(ax, upwards, names, surfaces, **kwargs)

    def contents(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Displacement of what slides on the floors over time, each over its floor."""
        contents, ax = _numbered(self._response.knots, "contents"), axes_or_new(ax)
        names = self._response._core._contents()
        return self._numbered_lines(ax, Axis.of("over_floor", *contents), names, contents, **kwargs)

    def _numbered_lines(
        self, ax: Axes, upwards: Axis, names: Iterable[str], lines: list[NDArray[np.float64]], **kwargs: Any
    ) -> Axes:
        time = self._response.knots["time_s"]
        for name, values, colour in zip(names, lines, distinct(len(lines))):
            ax.plot(time, upwards.shown(values), **_line("main", kwargs, color=colour, label=name))
        return _over_time(ax, upwards)

    def demand(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Friction force over time between its bounds: static dashed, kinetic dotted, sliding shaded.

        The bounds are those of a level normal force; they are left out under vertical motion and in two directions.
        """
        response, ax = self._response, axes_or_new(ax)
        knots = response.knots
        _shade(ax, knots)
        (axis,) = self._along(None, "x")
        force = knots["friction_force_n"]
        level = not axis and response.motion.vertical_m_per_s2 is None
        bounds = response._core._friction_bounds() if level else []
        upwards = Axis.of("friction_force", force, [bound for bound, _ in bounds], along=axis)
        ax.plot(knots["time_s"], upwards.shown(force), **_line("main", kwargs))
        for bound, line in bounds:
            ax.axhline(float(upwards.shown(bound)), **_of_line(line, {}))
        return _over_time(ax, upwards)

    def floor_spectra(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Response spectra of table, block and floors, of ``run(..., floor_spectrum=True)``.

        In two directions RotD100, the largest over all directions; ``along`` may be ``"x"`` or ``"y"``.

        Raises
        ------
        ValueError
            For a response without them.
        """
        told, ax = self._response.summary.get("floor_spectrum"), axes_or_new(ax)
        if told is None:
            raise ValueError("expected a response of run(..., floor_spectrum=True), found one without")
        if along is not None and along not in ("x", "y"):
            raise ValueError(f"along: expected one of x, y, found {along!r}")
        # In one direction what is along x is all there is.
        (axis,) = self._along(along or "x", "x")
        spectra = told if not axis or along is None else told[axis]
        block, points = self._response._core._places()
        lines: list[tuple[str, list[float], dict[str, Any]]] = [
            ("ground", spectra["table_acceleration_m_per_s2"], {}),
            ("block", spectra["block_acceleration_m_per_s2"], {"label": block}),
        ]
        colours = distinct(len(points) + 1)[1:]
        for name, values, colour in zip(points, spectra["storeys_acceleration_m_per_s2"], colours):
            lines.append(("main", values, {"label": name, "color": colour}))
        upwards = Axis.of("spectral_acceleration", *(values for _, values, _ in lines))
        for line, values, usual in lines:
            if values:
                ax.plot(told["period_s"], upwards.shown(values), **_line(line, kwargs, **usual))
        ax.set_xscale("log")
        in_direction = f", {_core.along(axis) if along else 'RotD100'}" if axis else ""
        ax.set(xlabel=Axis.of("period").label, ylabel=upwards.label + in_direction)
        ax.legend(loc="best", frameon=False)
        return ax

    def animation(
        self, *, frames_per_s: float = 25.0, speed: float = 1.0, magnify: float | None = None
    ) -> FuncAnimation:
        """Block and storeys as they move over the table, in an animation of Matplotlib.

        Parameters
        ----------
        frames_per_s
            Frames a second.
        speed
            Seconds of the motion in one second.
        magnify
            Factor on all displacements; one that shows the largest well if left out.

        Returns
        -------
        FuncAnimation
            ``animation.to_jshtml()`` shows it in a notebook, ``animation.save("slide.gif")`` writes it.
        """
        import matplotlib.pyplot as plt
        from matplotlib.animation import FuncAnimation
        from matplotlib.patches import Rectangle

        knots = self._response.knots
        time = knots["time_s"]
        sliding = knots["sliding_displacement_m"]
        floors = _numbered(knots, "storey")
        # Of a frame every storey counts as one unit of height.
        largest = max(float(np.abs(sliding + floor).max()) for floor in [0.0 * sliding, *floors])
        factor = magnify if magnify is not None else (0.6 / largest if largest > 0.0 else 1.0)
        frame_s = np.arange(0.0, time[-1], speed / frames_per_s)
        at = [factor * np.interp(frame_s, time, sliding)]
        at += [factor * np.interp(frame_s, time, sliding + floor) for floor in floors]
        figure, ax = plt.subplots(figsize=(4, 2.5 + 0.6 * len(floors)), layout="constrained")
        ax.set(xlim=(-1.6, 1.6), ylim=(-0.25, 0.6 + len(floors)), aspect="equal")
        ax.axis("off")
        ax.axhspan(-0.15, 0.0, color="0.8")
        ax.plot([0.0, 0.0], [-0.15, -0.05], color="0.4")
        block = Rectangle((-0.5, 0.0), 1.0, 0.3, color="C0")
        ax.add_patch(block)
        heights = np.array([0.3, *(0.3 + np.arange(1.0, len(floors) + 1.0))])
        (frame,) = ax.plot([], [], "o-", color="C1", ms=9, lw=2)
        clock = ax.text(-1.55, -0.12, "")

        def draw(i: int) -> list[Artist]:
            block.set_x(-0.5 + at[0][i])
            frame.set_data([x[i] for x in at] if floors else [], heights if floors else [])
            clock.set_text(f"{frame_s[i]:.2f} s, displacements × {factor:.3g}")
            return [block, frame, clock]

        return FuncAnimation(figure, draw, frames=len(frame_s), interval=1e3 / frames_per_s, blit=True)


def _of_axis(knots: Table, name: str, axis: str) -> NDArray[np.float64]:
    """A column of a history along an axis, or the size of both: ``name`` is that along x."""
    x: NDArray[np.float64] = knots[name]
    if axis in ("", "x"):
        return x
    unit = next(unit for unit in ("_m_per_s2", "_m_per_s", "_m", "_n") if name.endswith(unit))
    y: NDArray[np.float64] = knots[f"{name.removesuffix(unit)}_y{unit}"]
    return y if axis == "y" else np.hypot(x, y)


def _numbered(knots: Table, part: str) -> list[NDArray[np.float64]]:
    """Displacements of storeys, surfaces or contents in their order."""
    found = [v for k, v in knots.items() if k.startswith(part) and k.endswith("_displacement_m")]
    if not found and part != "storey":
        raise ValueError(f"expected a model with {part}, found one without")
    return found


def _shade(ax: Axes, knots: Table) -> None:
    """Grey where the slider slides."""
    slides, across = knots["direction"] != 0, ax.get_xaxis_transform()
    ax.fill_between(knots["time_s"], 0, 1, where=slides, transform=across, color="0.92", lw=0)


def _over_time(ax: Axes, upwards: Axis, legend: Literal["best", "upper left"] = "best") -> Axes:
    ax.set(xlabel=Axis.of("time").label, ylabel=upwards.label)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc=legend, frameon=False)
    ax.margins(x=0)
    return ax


def draw_motion(motion: Motion, ax: Axes | None = None, **kwargs: Any) -> NDArray[np.object_] | Axes:
    """Acceleration of all components over time; velocity and displacement below it on a figure of its own."""
    parts = motion.components
    drawn = [("acceleration", "acceleration_m_per_s2")]
    if ax is None:
        import matplotlib.pyplot as plt

        drawn += [("velocity", "velocity_m_per_s"), ("displacement", "displacement_m")]
        _, all_axes = plt.subplots(3, 1, figsize=(9, 6), layout="constrained", sharex=True)
        axes = list(all_axes)
    else:
        axes = [ax]
    for at, (quantity, name) in zip(axes, drawn):
        upwards = Axis.of(quantity, *(getattr(one, name) for one in parts.values()))
        for (component, one), colour in zip(parts.items(), distinct(len(parts))):
            said = _core.along(component) if component in ("x", "y") else component
            at.plot(one.time_s, upwards.shown(getattr(one, name)), **_line("main", kwargs, color=colour, label=said))
        at.set(ylabel=upwards.label)
        at.margins(x=0)
    if len(parts) > 1:
        axes[0].legend(loc="best", frameon=False)
    axes[-1].set(xlabel=Axis.of("time").label)
    return axes[0] if ax is not None else np.array(axes, dtype=object)


def draw_tornado(
    table: Table, demand: str, ax: Axes | None = None, most: int = 20, **kwargs: Any
) -> Axes:
    """Bars of what 1 % more of each key changes, medians over the records, the longest on top."""
    ax = axes_or_new(ax)
    of_key: dict[str, list[float]] = {}
    for path, of, change in zip(table["path"], table["demand"], table["relative"]):
        if of == demand:
            of_key.setdefault(path, []).append(change)
    medians = {path: float(np.nanmedian(changes)) for path, changes in of_key.items() if np.isfinite(changes).any()}
    ranked = sorted(medians.items(), key=lambda one: abs(one[1]))[-most:]
    names, changes = [_core.words_of_key(path) for path, _ in ranked], [change for _, change in ranked]
    rises, falls = distinct(2)
    ax.barh(names, changes, **{"color": [rises if change >= 0.0 else falls for change in changes], **kwargs})
    ax.axvline(0.0, color="k", lw=0.8)
    ax.set(xlabel=_core.change(demand))
    return ax


def _groups(table: Table, names: list[str]) -> list[tuple[str, NDArray[np.bool_]]]:
    """The rows of each set of values of some columns, and what tells it apart."""
    rows = list(zip(*(table[name] for name in names))) if names else [()] * len(table)
    found = []
    for values in dict.fromkeys(rows):
        pairs = [(name, v, table.units.get(name, "")) for name, v in zip(names, values)]
        said = ", ".join(f"{name} {v if isinstance(v, str) else f'{v:.4g}'} {unit}".rstrip() for name, v, unit in pairs)
        found.append((said, np.array([row == values for row in rows])))
    return found


def draw_fragility(table: Table, summary: Mapping[str, Any], ax: Axes | None = None, **kwargs: Any) -> Axes:
    """The probability of exceedance over intensity, with its confidence band."""
    ax = axes_or_new(ax)
    names = [name for name in table if name not in ("level", "probability", "band_low", "band_high")]
    across = Axis.of_column(table, "level", str(summary.get("measure", "intensity")))
    level, groups = across.shown(table["level"]), _groups(table, names)
    for (said, rows), colour in zip(groups, distinct(len(groups))):
        usual = {"color": colour, "label": said} if said else {}
        (line,) = ax.plot(level[rows], table["probability"][rows], **_line("fitted", kwargs, **usual))
        low, high = table["band_low"][rows], table["band_high"][rows]
        band = None if said else _core.band(float(summary["confidence"]))
        ax.fill_between(level[rows], low, high, alpha=0.2, lw=0.0, color=line.get_color(), label=band)
    ax.set(xlabel=across.label, ylabel=Axis.of("probability").label)
    ax.set_ylim(0.0, 1.0)
    ax.legend(loc="best", frameon=False)
    return ax


def draw_front(table: Table, summary: Mapping[str, Any], ax: Axes | None = None, **kwargs: Any) -> Axes:
    """Designs that no other beats: acceleration over displacement; with bounds of friction those beside them; the gap."""
    ax = axes_or_new(ax)
    found = [
        (line, table[f"displacement_m{suffix}"], table[f"acceleration_m_per_s2{suffix}"], marker)
        for line, suffix, marker in [
            ("front", "", "o"), ("lower_friction", "_lower_friction", "v"), ("upper_friction", "_upper_friction", "^")
        ]
        if f"displacement_m{suffix}" in table
    ]
    gap = float(summary["gap_m"])
    largest = _largest([gap, *(x for _, x, _, _ in found)])
    across = Axis(*_core.axis_of_share("displacement", summary["probability"], largest))
    largest = _largest(y for _, _, y, _ in found)
    upwards = Axis(*_core.axis_of_share("acceleration", summary["acceleration_share"], largest))
    for line, x, y, marker in found:
        usual = {} if line == "front" else {"ls": ""}
        ax.plot(across.shown(x), upwards.shown(y), **_line(line, kwargs, marker=marker, ms=4, **usual))
    ax.axvline(gap / across.in_si, **_line("gap", {}))
    ax.set(xlabel=across.label, ylabel=upwards.label)
    ax.legend(loc="best", frameon=False)
    return ax


def draw_fractiles(table: Table, demand: str | None, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """Fractiles of 16, 50 and 84 % of a demand over what is varied last; a colour for each of other values."""
    ax = axes_or_new(ax)
    demands = [name.removesuffix("_p50") for name in table if name.endswith("_p50")]
    chosen = demands[0] if demand is None else demand.removesuffix("_p50")
    if chosen not in demands:
        raise ValueError(f"y: expected one of {', '.join(demands)}, found {demand!r}")
    varied = [name for name in table if not name.endswith(("_p16", "_p50", "_p84"))]
    along = [name for name in varied if table.units.get(name) is not None or not isinstance(table[name][0], str)]
    x = along[-1]
    names = [name for name in varied if name != x and len(set(table[name])) > 1]
    groups = _groups(table, names)
    shares = ("p16", "p50", "p84")
    across = Axis.of_column(table, x)
    largest = _largest(table[f"{chosen}_{share}"] for share in shares)
    upwards = Axis(*_core.axis_of_words(chosen, table.units.get(f"{chosen}_p50", ""), largest))
    for (said, rows), colour in zip(groups, distinct(len(groups))):
        for share in shares:
            y = upwards.shown(table[f"{chosen}_{share}"])[rows]
            of_group = {"label": said if share == "p50" else None, "color": colour} if said else {}
            ax.plot(across.shown(table[x])[rows], y, **_line(share, kwargs, **of_group))
    ax.set(xlabel=across.label, ylabel=upwards.label)
    ax.legend(loc="best", frameon=False, title="dotted 16 %, dashed 84 %" if names else None)
    return ax


def draw_ida(table: Table, summary: Mapping[str, Any], ax: Axes | None = None, **kwargs: Any) -> Axes:
    """The intensity over the demand that it makes, a line a record and design, and the limit."""
    ax = axes_or_new(ax)
    demand = str(summary["demand"])
    across = Axis.of_column(table, demand)
    upwards = Axis.of_column(table, "level", str(summary.get("measure", "intensity")))
    names = [name for name in table if name in ("record", "friction") or name in _paths_of(table)]
    for i, (_, rows) in enumerate(_groups(table, names)):
        usual = {"lw": 0.8} if i == 0 else {"lw": 0.8, "label": None}
        x, y = across.shown(table[demand])[rows], upwards.shown(table["level"])[rows]
        ax.plot(np.abs(x), y, **_line("record", kwargs, **usual))
    limit = summary.get("limit")
    if limit is not None:
        ax.axvline(limit / across.in_si, **_line("limit", {}))
    ax.legend(loc="best", frameon=False)
    ax.set(xlabel=across.label, ylabel=upwards.label)
    return ax


def draw_runs(table: Table, x: str, y: str, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """A demand over what was varied, a point a run."""
    ax = axes_or_new(ax)
    across, upwards = Axis.of_column(table, x), Axis.of_column(table, y)
    of_names = isinstance(table[x][0], str)
    places = np.asarray(table[x]) if of_names else across.shown(table[x])
    groups = _groups(table, [name for name in ("model", "friction") if name in table and len(set(table[name])) > 1])
    for (said, rows), colour in zip(groups, distinct(len(groups))):
        usual = {"ls": "", "marker": ".", "color": colour, "label": said or None}
        ax.plot(places[rows], upwards.shown(table[y])[rows], **_line("main", kwargs, **usual))
    if len(ax.lines) > 1:
        ax.legend(loc="best", frameon=False)
    if of_names:
        ax.tick_params(axis="x", rotation=90)
    ax.set(xlabel=across.label, ylabel=upwards.label)
    return ax


def _paths_of(table: Table) -> list[str]:
    """Columns that are keys of the model."""
    return [name for name in table if _core.is_key(name)]


def varied(table: Table) -> str:
    """What was varied: a path with several values, else the level, the factor, the record."""
    several = [name for name in [*_paths_of(table), "level", "scale"] if name in table]
    several = [name for name in several if len(set(v for v in table[name] if v == v)) > 1]
    return next(iter(several), "record")


def draw_table(table: Table, x: str, y: str, by: str | None = None, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """One column over another: points, or lines where x rises for each value of a third."""
    ax = axes_or_new(ax)
    across, upwards = Axis.of_column(table, x), Axis.of_column(table, y)
    groups = [None] if by is None else list(dict.fromkeys(table[by]))
    for group, colour in zip(groups, distinct(len(groups))):
        rows = [True] * len(table) if by is None else [value == group for value in table[by]]
        one, other = (axis.shown(table[name])[rows] for axis, name in ((across, x), (upwards, y)))
        rises = len(one) > 1 and bool((np.diff(one) > 0.0).all())
        kind = {"ls": "-"} if rises else {"ls": "", "marker": "."}
        of_group = {"label": None if by is None else str(group), "color": colour}
        ax.plot(one, other, **_line("main", kwargs, **kind, **of_group))
    ax.set(xlabel=across.label, ylabel=upwards.label)
    if by is not None and len(groups) <= 12:
        ax.legend(loc="best", frameon=False, title=by)
    return ax


def draw_curve(name: str, curve: Table, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """One measured quantity beside what was computed; a cyclic test as its loop."""
    ax = axes_or_new(ax)
    columns = curve.columns
    loop = "force_n" in columns
    x, first, second = columns[1:4] if loop else columns[:3]
    across = Axis.of("displacement", curve[x]) if loop else Axis.of("time")
    if loop:
        upwards = Axis.of("force", curve[first])
    else:
        largest = _largest([curve[first], curve[second]])
        upwards = Axis(*_core.axis_of_words(name, curve.units.get(first, ""), largest))
    ax.plot(across.shown(curve[x]), upwards.shown(curve[first]), **_line("measured", kwargs))
    computed = "fitted" if second.removesuffix("_n") == "fitted" else "predicted"
    ax.plot(across.shown(curve[x]), upwards.shown(curve[second]), **_line(computed, kwargs))
    ax.set(xlabel=across.label, ylabel=upwards.label)
    if loop:
        ax.set_title(name)
    ax.legend(loc="best", frameon=False)
    return ax


def draw_curves(curves: Mapping[str, Table], **kwargs: Any) -> NDArray[np.object_]:
    """All of them below one another."""
    import matplotlib.pyplot as plt

    count = len(curves)
    _, grid = plt.subplots(
        count, 1, figsize=(7, 2.6 * count), layout="constrained", squeeze=False, sharex=True
    )
    axes = [draw_curve(name, curve, ax, **kwargs) for (name, curve), ax in zip(curves.items(), grid[:, 0])]
    return np.array(axes, dtype=object)


def style(given: Mapping[str, Any], **usual: Any) -> dict[str, Any]:
    """How a line is drawn: as usual but for what is given, in whichever of Matplotlib's words (``lw``, ``linewidth``)."""
    from matplotlib.cbook import normalize_kwargs
    from matplotlib.lines import Line2D

    merged = {**normalize_kwargs(usual, Line2D), **normalize_kwargs(dict(given), Line2D)}
    return {name: value for name, value in merged.items() if name != "label" or value is not None}


def distinct(count: int) -> list[str]:
    """Colours that differ, as many as there are lines."""
    return _core.colours(count)


def axes_or_new(ax: Axes | None) -> Axes:
    """The axes, or those of a new figure."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.figure(layout="constrained").add_subplot()
