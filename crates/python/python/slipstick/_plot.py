"""Figures in Matplotlib; each returns its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._response import Response

G = 9.80665


class Plotter:
    """The figures of a response."""

    def __init__(self, response: Response) -> None:
        self._response = response

    def __call__(self) -> NDArray[np.object_]:
        """Displacement, acceleration and the friction loop on one page."""
        import matplotlib.pyplot as plt

        _, axes = plt.subplot_mosaic(
            [["sliding", "loop"], ["acceleration", "loop"]], figsize=(10, 5), layout="constrained"
        )
        self.history(ax=axes["sliding"])
        self.acceleration(ax=axes["acceleration"])
        self.loop(ax=axes["loop"])
        axes["acceleration"].sharex(axes["sliding"])
        return np.array([axes["sliding"], axes["acceleration"], axes["loop"]], dtype=object)

    def history(self, ax: Axes | None = None) -> Axes:
        """Sliding displacement over time, sliding shaded, the peak marked."""
        knots, ax = self._response.knots, _axes(ax)
        time, s = knots["time_s"], 1e3 * knots["sliding_displacement_m"]
        slides = knots["direction"] != 0
        ax.fill_between(
            time, 0, 1, where=slides, transform=ax.get_xaxis_transform(), color="0.92", lw=0
        )
        ax.plot(time, s)
        at = int(np.argmax(np.abs(s)))
        ax.plot(time[at], s[at], "o", ms=4, color="C3", label=f"peak {s[at]:.4g} mm")
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel="time [s]", ylabel="sliding displacement [mm]")
        ax.margins(x=0)
        return ax

    def acceleration(self, ax: Axes | None = None) -> Axes:
        """Accelerations of table, block and top floor over time."""
        knots, ax = self._response.knots, _axes(ax)
        time = knots["time_s"]
        ax.plot(time, knots["table_acceleration_m_per_s2"] / G, color="0.7", lw=0.8, label="table")
        ax.plot(time, knots["block_acceleration_m_per_s2"] / G, lw=0.8, label="block")
        floors = [name for name in knots if name.startswith("storey") and "acceleration" in name]
        if floors:
            ax.plot(time, knots[floors[-1]] / G, lw=0.8, label=f"floor {len(floors)}")
        ax.legend(loc="best", frameon=False)
        ax.set(xlabel="time [s]", ylabel="acceleration [g]")
        ax.margins(x=0)
        return ax

    def loop(self, ax: Axes | None = None) -> Axes:
        """Friction force on the table over sliding displacement: the loop as data sheets draw it."""
        knots, ax = self._response.knots, _axes(ax)
        ax.plot(1e3 * knots["sliding_displacement_m"], -1e-3 * knots["friction_force_n"], lw=0.8)
        ax.set(xlabel="sliding displacement [mm]", ylabel="friction force [kN]")
        return ax

    def energy(self, ax: Axes | None = None) -> Axes:
        """What became of the energy put in, over time."""
        energy, ax = self._response.energy, _axes(ax)
        time = self._response.knots["time_s"]
        parts = ["friction_j", "damping_j", "strain_j", "kinetic_j"]
        labels = ["friction", "damping", "strain", "kinetic"]
        ax.stackplot(time, *[1e-3 * energy[part] for part in parts], labels=labels, alpha=0.7)
        ax.plot(time, 1e-3 * energy["input_j"], "k", lw=0.8, label="input")
        ax.legend(loc="upper left", frameon=False)
        ax.set(xlabel="time [s]", ylabel="energy [kJ]")
        ax.margins(x=0)
        return ax


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.figure(layout="constrained").add_subplot()
