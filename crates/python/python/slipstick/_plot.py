"""Figures in Matplotlib; each returns its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._core import Motion
    from ._response import Response
    from ._table import Table

G = 9.80665


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
        for i, axis in enumerate(self._along(along, "both")):
            s = 1e3 * _of_axis(knots, "sliding_displacement_m", axis)
            ax.plot(time, s, **style(kwargs, label=_said(axis) or None))
            at = int(np.argmax(np.abs(s)))
            peak = f"peak{_said(axis, ' ')} {s[at]:.4g} mm"
            ax.plot(time[at], s[at], "o", ms=4, color=f"C{3 + i}", label=peak)
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel="time [s]", ylabel="sliding displacement [mm]")
        ax.margins(x=0)
        return ax

    def acceleration(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Accelerations of table, block and top floor, or last point of a structure by its modes, over time.

        In two directions along x; ``along`` may be ``"x"``, ``"y"`` or ``"resultant"``.
        """
        knots, ax = self._response.knots, axes_or_new(ax)
        (axis,) = self._along("x" if along == "both" else along, "x")
        time = knots["time_s"]
        parts = [("table", "table_acceleration_m_per_s2"), ("block", "block_acceleration_m_per_s2")]
        parts += self._points("acceleration_m_per_s2")[-1:]
        for label, name in parts:
            of_table = {"color": "0.7"} if label == "table" else {}
            ax.plot(time, _of_axis(knots, name, axis) / G, **style(kwargs, lw=0.8, label=label, **of_table))
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel="time [s]", ylabel=f"acceleration{_said(axis, ' ')} [g]")
        ax.margins(x=0)
        return ax

    def _points(self, quantity: str) -> list[tuple[str, str]]:
        """Names of floors, or of points of a structure by its modes, with the column of a quantity of each."""
        knots, summary = self._response.knots, self._response.summary
        of_structure = bool(summary.get("points"))
        part, called = ("point", "point") if of_structure else ("storey", "floor")
        told = summary.get("points" if of_structure else "storeys") or []
        columns = [f"{part}{i}_{quantity}" for i in range(1, len(knots.columns) + 1)]
        found = [name for name in columns if name in knots]
        names = [one.get("name") if isinstance(one, dict) else None for one in told]
        names += [None] * (len(found) - len(names))
        return [(name or f"{called} {i}", column) for i, (name, column) in enumerate(zip(names, found), 1)]

    def loop(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Force of the whole slider over sliding displacement: the loop as data sheets draw it.

        With a spring, damper or stop its friction alone is drawn beside it, thin. In two directions along x and along
        y, each over the displacement along it; ``along`` may be ``"x"``, ``"y"`` or ``"both"``.
        """
        response, ax = self._response, axes_or_new(ax)
        if along == "resultant":
            raise ValueError("along: expected one of x, y, both, found 'resultant': a loop has a direction")
        axes = self._along(along, "both")
        for i, axis in enumerate(axes):
            sliding = 1e3 * _of_axis(response.knots, "sliding_displacement_m", axis)
            force = response.slider_force_y_n if axis == "y" else response.slider_force_n
            friction = -_of_axis(response.knots, "friction_force_n", axis)
            # Without them the two are one, but for rounding.
            apart = np.abs(force - friction).max(initial=0.0) > 1e-9 * np.abs(force).max(initial=0.0)
            if apart and len(axes) == 1:
                ax.plot(sliding, 1e-3 * friction, lw=0.6, color="0.6", label="friction alone")
            label = _said(axis) if len(axes) > 1 else "slider"
            said = label if apart or len(axes) > 1 else None
            ax.plot(sliding, 1e-3 * force, **style(kwargs, lw=0.9, color=f"C{i}", label=said))
        if ax.get_legend_handles_labels()[0]:
            ax.legend(loc="best", frameon=False)
        said = _said(axes[0], " ") if len(axes) == 1 else ""
        ax.set(xlabel=f"sliding displacement{said} [mm]", ylabel=f"slider force{said} [kN]")
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
        x, y = (1e3 * knots[f"sliding_displacement{axis}_m"] for axis in ("", "_y"))
        ax.plot(x, y, **style(kwargs, lw=0.9))
        at = int(np.argmax(np.hypot(x, y)))
        ax.plot(x[at], y[at], "o", ms=4, color="C3", label=f"peak {np.hypot(x[at], y[at]):.4g} mm")
        gap = response.model.value("slider.gap")
        if gap is not None:
            around = np.linspace(0.0, 2.0 * np.pi, 181)
            ax.plot(1e3 * gap * np.cos(around), 1e3 * gap * np.sin(around), "k--", lw=0.8, label="gap")
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel="sliding along x [mm]", ylabel="sliding along y [mm]", aspect="equal")
        return ax

    def energy(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """What became of the energy put in, over time."""
        energy, ax = self._response.energy, axes_or_new(ax)
        time = self._response.knots["time_s"]
        parts = ["friction_j", "damping_j", "strain_j", "kinetic_j"]
        labels = ["friction", "damping", "strain", "kinetic"]
        ax.stackplot(time, *[1e-3 * energy[part] for part in parts], **{"labels": labels, "alpha": 0.7, **kwargs})
        ax.plot(time, 1e-3 * energy["input_j"], "k", lw=0.8, label="input")
        ax.legend(loc="upper left", frameon=False)
        ax.set(xlabel="time [s]", ylabel="energy [kJ]")
        ax.margins(x=0)
        return ax

    def drift(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Drift of every storey over time, or displacement over the block of the points of a structure by its modes.

        In two directions along x; ``along`` may be ``"x"``, ``"y"`` or ``"resultant"``.
        """
        knots, ax = self._response.knots, axes_or_new(ax)
        (axis,) = self._along("x" if along == "both" else along, "x")
        of_structure = bool(self._response.summary.get("points"))
        below = {part: 0.0 * knots["time_s"] for part in ("x", "y")}
        for number, (label, column) in enumerate(self._points("displacement_m"), 1):
            parts = ("x", "y") if axis == "resultant" else (axis,)
            moved = []
            for part in parts:
                floor = _of_axis(knots, column, part)
                moved.append(floor - below[part or "x"])
                if not of_structure:
                    below[part or "x"] = floor
            drift = moved[0] if len(moved) == 1 else np.hypot(*moved)
            called = label if of_structure or not label.startswith("floor ") else f"storey {number}"
            ax.plot(knots["time_s"], 1e3 * drift, **style(kwargs, lw=0.8, label=called))
        if not ax.lines:
            raise ValueError("expected a model with storeys or points, found one without")
        what = "displacement over the block" if of_structure else "drift"
        return _over_time(ax, f"{what}{_said(axis, ' ')} [mm]")

    def surfaces(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Displacement of every surface in series over time, and of all together."""
        knots, ax = self._response.knots, axes_or_new(ax)
        together = style(kwargs, color="0.7", lw=2, label="together")
        ax.plot(knots["time_s"], 1e3 * knots["sliding_displacement_m"], **together)
        for number, surface in enumerate(_numbered(knots, "surface"), 1):
            ax.plot(knots["time_s"], 1e3 * surface, **style(kwargs, lw=0.8, label=f"surface {number}"))
        return _over_time(ax, "displacement [mm]")

    def contents(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Displacement of what slides on the floors over time, each over its floor."""
        knots, ax = self._response.knots, axes_or_new(ax)
        for number, contents in enumerate(_numbered(knots, "contents"), 1):
            ax.plot(knots["time_s"], 1e3 * contents, **style(kwargs, lw=0.8, label=f"contents {number}"))
        return _over_time(ax, "displacement over the floor [mm]")

    def demand(self, ax: Axes | None = None, **kwargs: Any) -> Axes:
        """Friction force over time between its bounds: static dashed, kinetic dotted, sliding shaded.

        The bounds are those of a level normal force; they are left out under vertical motion.
        """
        response, ax = self._response, axes_or_new(ax)
        knots = response.knots
        _shade(ax, knots)
        (axis,) = self._along(None, "x")
        ax.plot(knots["time_s"], 1e-3 * knots["friction_force_n"], **style(kwargs, lw=0.8))
        if not axis and response.motion.vertical_m_per_s2 is None:
            fixed, kinetic = response._core._friction_limits()
            for (positive, negative), dashes in [(fixed, "--"), (kinetic, ":")]:
                for value in [-positive, negative]:
                    ax.axhline(1e-3 * value, color="0.4", ls=dashes, lw=0.8)
        return _over_time(ax, f"friction force{_said(axis, ' ')} [kN]")

    def floor_spectra(self, ax: Axes | None = None, *, along: str | None = None, **kwargs: Any) -> Axes:
        """Response spectra of table, block and floors, of ``run(..., floor_spectrum=True)``.

        In two directions RotD100, the largest over all directions; ``along`` may be ``"x"`` or ``"y"``.

        Raises
        ------
        ValueError
            For a response without them.
        """
        spectra, ax = self._response.summary.get("floor_spectrum"), axes_or_new(ax)
        if spectra is None:
            raise ValueError("expected a response of run(..., floor_spectrum=True), found one without")
        if along is not None and along not in ("x", "y"):
            raise ValueError(f"along: expected one of x, y, found {along!r}")
        # In one direction what is along x is all there is.
        (axis,) = self._along(along or "x", "x")
        said = ""
        if axis:
            said = " RotD100" if along is None else _said(axis, " ")
            spectra = spectra if along is None else spectra[axis]
        periods = self._response.summary["floor_spectrum"]["period_s"]
        lines = [("table", spectra["table_acceleration_m_per_s2"]), ("block", spectra["block_acceleration_m_per_s2"])]
        called = [label for label, _ in self._points("acceleration_m_per_s2")]
        lines += list(zip(called, spectra["storeys_acceleration_m_per_s2"]))
        for label, values in lines:
            if values:
                ax.plot(periods, np.asarray(values) / G, **style(kwargs, label=label))
        ax.set_xscale("log")
        ax.set(xlabel="period [s]", ylabel=f"spectral acceleration{said} [g]")
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


def _said(axis: str, before: str = "") -> str:
    """An axis in words; nothing in one direction."""
    return before + (axis if axis == "resultant" else f"along {axis}") if axis else ""


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


def _over_time(ax: Axes, label: str) -> Axes:
    ax.set(xlabel="time [s]", ylabel=label)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="best", frameon=False)
    ax.margins(x=0)
    return ax


def draw_motion(motion: Motion, ax: Axes | None = None, **kwargs: Any) -> NDArray[np.object_] | Axes:
    """Acceleration of all components over time; velocity and displacement below it on a figure of its own."""
    parts = motion.components
    drawn = [("acceleration [g]", "acceleration_m_per_s2", G)]
    if ax is None:
        import matplotlib.pyplot as plt

        drawn += [("velocity [m/s]", "velocity_m_per_s", 1.0), ("displacement [mm]", "displacement_m", 1e-3)]
        _, all_axes = plt.subplots(3, 1, figsize=(9, 6), layout="constrained", sharex=True)
        axes = list(all_axes)
    else:
        axes = [ax]
    for at, (label, name, unit) in zip(axes, drawn):
        for component, one in parts.items():
            said = f"along {component}" if component != "vertical" else component
            at.plot(one.time_s, getattr(one, name) / unit, **style(kwargs, lw=0.8, label=said))
        at.set(ylabel=label)
        at.margins(x=0)
    if len(parts) > 1:
        axes[0].legend(loc="best", frameon=False)
    axes[-1].set(xlabel="time [s]")
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
    paths, changes = [path for path, _ in ranked], [change for _, change in ranked]
    colours = ["C0" if change >= 0.0 else "C1" for change in changes]
    ax.barh(paths, changes, **{"color": colours, **kwargs})
    ax.axvline(0.0, color="k", lw=0.8)
    ax.set(xlabel=f"{demand}: change in % for 1 % of the key")
    return ax


def _in_units(table: Table, name: str) -> tuple[NDArray[np.float64], str]:
    """A column in the units of figures, and its label without them."""
    unit = table.units.get(name, "")
    shown, in_si = _SHOWN.get(unit, (unit, 1.0))
    return np.asarray(table[name], dtype=float) / in_si, shown


def _labelled(words: str, unit: str) -> str:
    return f"{words} [{unit}]" if unit else words


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
    level, unit = _in_units(table, "level")
    for said, rows in _groups(table, names):
        (line,) = ax.plot(level[rows], table["probability"][rows], **style(kwargs, label=said or "fitted"))
        low, high = table["band_low"][rows], table["band_high"][rows]
        band = None if said else _band_of(summary)
        ax.fill_between(level[rows], low, high, alpha=0.2, lw=0.0, color=line.get_color(), label=band)
    ax.set(xlabel=_labelled(str(summary.get("measure", "intensity")), unit), ylabel="probability of exceedance")
    ax.set_ylim(0.0, 1.0)
    ax.legend(loc="best", frameon=False)
    return ax


def _band_of(summary: Mapping[str, Any]) -> str:
    confidence = summary.get("confidence")
    return f"{100.0 * confidence:.3g} % confidence" if isinstance(confidence, float) else "confidence band"


def draw_front(table: Table, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """Designs that no other beats: acceleration over displacement; with bounds of friction those beside them."""
    ax = axes_or_new(ax)
    for suffix, words, marker in [
        ("", "nominal friction", "o"), ("_lower_friction", "lower friction", "v"), ("_upper_friction", "upper friction", "^")
    ]:
        if f"displacement_m{suffix}" in table:
            x, across = _in_units(table, f"displacement_m{suffix}")
            y, up = _in_units(table, f"acceleration_m_per_s2{suffix}")
            ax.plot(x, y, **style(kwargs, marker=marker, ls="-" if not suffix else "", label=words, ms=4, lw=0.8))
            ax.set(xlabel=f"sliding displacement [{across}]", ylabel=f"floor acceleration [{up}]")
    if len(ax.lines) > 1:
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
    colours = distinct(len(groups))
    for i, (said, rows) in enumerate(groups):
        for share, dashes in [("16", ":"), ("50", "-"), ("84", "--")]:
            y, up = _in_units(table, f"{chosen}_p{share}")
            label = f"{share} %" if not said else said if share == "50" else None
            ax.plot(table[x][rows], y[rows], **style(kwargs, ls=dashes, color=colours[i], label=label))
    ax.set(xlabel=_titled(table, x), ylabel=_labelled(_words(chosen), up))
    ax.legend(loc="best", frameon=False, title="dotted 16 %, dashed 84 %" if names else None)
    return ax


def draw_ida(table: Table, summary: Mapping[str, Any], ax: Axes | None = None, **kwargs: Any) -> Axes:
    """The intensity over the demand that it makes, a line a record and design, and the limit."""
    ax = axes_or_new(ax)
    demand = str(summary["demand"])
    x, across = _in_units(table, demand)
    y, up = _in_units(table, "level")
    names = [name for name in table if name in ("record", "friction") or name in _paths_of(table)]
    for _, rows in _groups(table, names):
        ax.plot(np.abs(x[rows]), y[rows], **style(kwargs, color="0.5", lw=0.8))
    limit = summary.get("limit")
    if limit is not None:
        ax.axvline(limit / _SHOWN.get(table.units.get(demand, ""), ("", 1.0))[1], color="C3", ls="--", label="limit")
        ax.legend(loc="best", frameon=False)
    ax.set(xlabel=_labelled(_words(demand), across), ylabel=_labelled(str(summary.get("measure", "intensity")), up))
    return ax


def draw_runs(table: Table, x: str, y: str, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """A demand over what was varied, a point a run."""
    ax = axes_or_new(ax)
    values, up = _in_units(table, y)
    for said, rows in _groups(table, [name for name in ("model", "friction") if name in table and len(set(table[name])) > 1]):
        ax.plot(np.asarray(table[x])[rows], values[rows], **style(kwargs, ls="", marker=".", label=said or None))
    if len(ax.lines) > 1:
        ax.legend(loc="best", frameon=False)
    if isinstance(table[x][0], str):
        ax.tick_params(axis="x", rotation=90)
    ax.set(xlabel=_titled(table, x), ylabel=_labelled(_words(y), up))
    return ax


def _words(key: str) -> str:
    """A key without its unit, in words."""
    units = ("_m_per_s2", "_m_per_s", "_m", "_n", "_s", "_rad")
    unit = next((unit for unit in units if key.endswith(unit)), "")
    return key.removesuffix(unit).replace("_", " ")


#: Tables of a model whose keys are varied
_TABLES = ("block", "slider", "frame", "storey", "structure", "contents", "motion", "record", "records", "isolator")


def _paths_of(table: Table) -> list[str]:
    """Columns that are varied paths of a model."""
    def is_path(name: str) -> bool:
        first, dot, rest = name.partition(".")
        return dot == "." and first in _TABLES and not rest.startswith(("peak_", "residual_", "max_", "min_"))

    return [name for name in table if is_path(name)]


def varied(table: Table) -> str:
    """What was varied: a path with several values, else the level, the factor, the record."""
    several = [name for name in [*_paths_of(table), "level", "scale"] if name in table]
    several = [name for name in several if len(set(v for v in table[name] if v == v)) > 1]
    return next(iter(several), "record")


def draw_table(table: Table, x: str, y: str, by: str | None = None, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """One column over another: points, or lines where x rises for each value of a third."""
    ax = axes_or_new(ax)
    groups = [None] if by is None else list(dict.fromkeys(table[by]))
    for group, colour in zip(groups, distinct(len(groups))):
        rows = [True] * len(table) if by is None else [value == group for value in table[by]]
        one, other = (np.asarray(table[name])[rows] for name in (x, y))
        rises = len(one) > 1 and bool((np.diff(np.asarray(one, dtype=float)) > 0.0).all())
        kind = {"ls": "-"} if rises else {"ls": "", "marker": "."}
        of_group = {} if by is None else {"label": str(group), "color": colour}
        ax.plot(one, other, **style(kwargs, **kind, **of_group))
    ax.set(xlabel=_titled(table, x), ylabel=_titled(table, y))
    if by is not None and len(groups) <= 12:
        ax.legend(loc="best", frameon=False, title=by)
    return ax


def _titled(table: Table, name: str) -> str:
    return f"{name} [{table.units[name]}]" if name in table.units else name


#: Units of measured quantities as figures show them, with what one of them is in SI
_SHOWN = {"m": ("mm", 1e-3), "m/s²": ("g", G), "N": ("kN", 1e3)}


def draw_curve(name: str, curve: Table, ax: Axes | None = None, **kwargs: Any) -> Axes:
    """One measured quantity beside what was computed; a cyclic test as its loop."""
    ax = axes_or_new(ax)
    columns = curve.columns
    loop = "force_n" in columns
    x, first, second = columns[1:4] if loop else columns[:3]
    unit, in_si = _SHOWN.get(curve.units.get(first, ""), (curve.units.get(first, ""), 1.0))
    across = 1e3 * curve[x] if loop else curve[x]
    ax.plot(across, curve[first] / in_si, **style(kwargs, color="0.7", lw=2.5, label="measured"))
    computed = style(kwargs, color="C0", lw=0.9, label=second.removesuffix("_n"))
    ax.plot(across, curve[second] / in_si, **computed)
    quantity = "force" if loop else name.replace("_", " ")
    ax.set(xlabel="displacement [mm]" if loop else "time [s]", ylabel=f"{quantity} [{unit}]")
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


def distinct(count: int) -> list[Any]:
    """Colours that differ, as many as there are lines."""
    if count <= 10:
        return [f"C{i}" for i in range(count)]
    from matplotlib import colormaps

    return [colormaps["turbo"](0.05 + 0.9 * i / (count - 1)) for i in range(count)]


def axes_or_new(ax: Axes | None) -> Axes:
    """The axes, or those of a new figure."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.figure(layout="constrained").add_subplot()
