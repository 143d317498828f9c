"""How far other ways to analyse sliding are from the exact answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._arguments import checked
from ._response import Response, run

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes

    from . import _core

__all__ = ["Attempt", "Regularisation", "regularisation"]

#: Sliding displacements in m over which friction builds up, if nothing else is said
YIELDS_M = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)


@dataclass(frozen=True)
class Attempt:
    """An analysis with a spring in place of stick; SI."""

    #: Stiffness of the spring that stands for stick
    k_init_n_per_m: float
    #: None where a step did not converge
    peak_sliding_displacement_m: float | None
    #: None where a step did not converge
    residual_sliding_displacement_m: float | None
    #: Why there is no answer; None where there is one
    failure: str | None


@dataclass(frozen=True)
class Regularisation:
    """How peak and residual sliding displacement depend on the spring that stands for stick."""

    #: The exact answer
    exact: Response
    #: One for each stiffness, from soft to stiff
    attempts: tuple[Attempt, ...]

    def errors(self) -> list[tuple[float, float | None, float | None]]:
        """Stiffness in N/m, and the errors of peak and residual over the exact peak."""
        summary = self.exact.summary
        peak: float = summary["peak_sliding_displacement_m"]
        residual: float = summary["residual_sliding_displacement_m"]

        def error(value: float | None, truth: float) -> float | None:
            return None if value is None else (value - truth) / (peak or 1.0)

        return [
            (
                attempt.k_init_n_per_m,
                error(attempt.peak_sliding_displacement_m, peak),
                error(attempt.residual_sliding_displacement_m, residual),
            )
            for attempt in self.attempts
        ]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the errors of peak and residual over the stiffness; crosses where nothing converged.

        Parameters
        ----------
        ax
            Where to draw; a figure of its own if left out.

        Returns
        -------
        Axes
            Errors in percent of the exact peak.
        """
        from ._plot import axes_or_new

        ax = axes_or_new(ax)
        errors = self.errors()
        for column, label in [(1, "peak"), (2, "residual")]:
            told = [row for row in errors if row[column] is not None]
            ax.plot(
                [1e-3 * row[0] for row in told],
                [100.0 * float(row[column] or 0.0) for row in told],
                "o-",
                ms=4,
                label=label,
            )
        failed = [1e-3 * row[0] for row in errors if row[1] is None]
        if failed:
            ax.plot(failed, [0.0] * len(failed), "kx", label="does not converge")
        ax.axhline(0.0, color="0.5", lw=0.8)
        ax.set_xscale("log")
        ax.set(xlabel="k_init (kN/m)", ylabel="Error over the exact peak (%)")
        ax.legend(frameon=False)
        return ax


@checked
def regularisation(
    model: _core.Model,
    motion: _core.Motion,
    k_init: Iterable[str] | None = None,
    *,
    steps: int = 1,
) -> Regularisation:
    """Analyse a model in OpenSees with ever stiffer springs in place of stick.

    Runs the script of ``model.to_opensees`` in this process; needs openseespy.

    Parameters
    ----------
    model, motion
        What ``model.to_opensees`` can express; static as large as kinetic friction above all.
    k_init
        The stiffnesses, ``["1 kN/mm", "10 kN/mm"]``; those over which friction builds up in 10 mm to 1 µm if
        left out.
    steps
        Steps of the analysis for each sample of the motion.

    Returns
    -------
    Regularisation
        The exact response and one attempt a stiffness; ``plot()`` draws them.

    Raises
    ------
    InputError
        For a model that OpenSees cannot express.
    ImportError
        Without openseespy.
    """
    exact = run(model, motion)
    force_n = exact.summary["peak_friction_force_n"]
    chosen = [f"{force_n / y!r} N/m" for y in YIELDS_M] if k_init is None else list(k_init)
    scripts = [model.to_opensees(motion, stiffness) for stiffness in chosen]
    _load_opensees()
    attempts = sorted((_attempt(script, steps) for script in scripts), key=lambda a: a.k_init_n_per_m)
    return Regularisation(exact, tuple(attempts))


def _attempt(script: str, steps: int) -> Attempt:
    names: dict[str, Any] = {"__name__": "slipstick.opensees"}
    exec(compile(script, "<model.to_opensees>", "exec"), names)
    try:
        _, sliding = names["analyse"](parts=steps)
    except ArithmeticError as error:
        return Attempt(names["K_INIT"], None, None, str(error))
    return Attempt(names["K_INIT"], max(map(abs, sliding)), sliding[-1], None)


def _load_opensees() -> Any:
    """The module, silenced. Its wheel's own BLAS comes first: on Linux it is not found alone."""
    import ctypes
    import importlib.util
    import os
    from pathlib import Path

    found = importlib.util.find_spec("openseespylinux")
    for folder in (found.submodule_search_locations or []) if found else []:
        for pattern in ("libquadmath*", "libgfortran*", "libblas*", "liblapack*"):
            for library in sorted(Path(folder, "lib").glob(pattern)):
                ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        import openseespy.opensees as ops
    except ImportError as error:
        raise ImportError("audit.regularisation needs openseespy: pip install openseespy") from error
    ops.logFile(os.devnull, "-noEcho")
    return ops
