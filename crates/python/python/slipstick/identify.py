"""Parameters of a model from tests: cyclic tests, free vibration, shaking-table records.

Every parameter comes with its 95 % confidence interval, or with the reason why the data cannot determine it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from . import _core
from ._arguments import checked
from ._laboratory import Identified, several
from ._progress import following
from ._request import given

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ._laboratory import Measured
    from ._progress import Progress
    from ._request import Columns

__all__ = ["cyclic", "free_vibration", "shaking_table"]


@checked
def cyclic(
    tests: Measured | Sequence[Measured],
    *,
    mass: str | float | None = None,
    normal_force: str | float | Sequence[str] | Sequence[float] | None = None,
    area: str | float | None = None,
    reference_pressure: str | float | None = None,
    model: _core.Model | None = None,
    law: Literal["coulomb", "slow-fast-rate"] | None = None,
    without: Sequence[Literal["spring", "damper"]] = (),
    slack: str | float | None = None,
    mapping: Columns | None = None,
) -> Identified:
    """Identify friction, spring and damper from cyclic tests: displacement and force over time.

    Parameters
    ----------
    tests
        One test or several: files, patterns, or columns by name (``time_s``, ``displacement_m``,
        ``force_n``). Several frequencies are compared; a test may hold several.
    mass
        Mass of the block, ``"124 kg"``: friction becomes a coefficient, and ``model`` of the result a block
        with it.
    normal_force
        Force that presses the block on its surface, ``"1200 N"``, where it is not the weight; or one for each
        test, ``["400 kN", "800 kN"]``.
    area
        Area of the bearing, ``"0.04 m2"``: from tests under several normal forces the exponent by which friction
        follows the pressure.
    reference_pressure
        Pressure at which coefficients are told, ``"20 MPa"``; that of the tests next to the geometric mean of the
        least and the largest if left out.
    model
        A model that takes what was found, in place of ``mass``.
    law
        How kinetic friction follows the sliding speed: ``"coulomb"``, not at all, which it is if left out;
        ``"slow-fast-rate"``, by slow and fast coefficients and the rate between them, which takes tests at
        several speeds and leaves out the damper.
    without
        What is not fitted beside friction: ``"spring"``, ``"damper"``.
    slack
        Travel after each reversal that is left out, ``"0.5 mm"`` (backlash); found from the force if left
        out.
    mapping
        As in ``compare``.

    Returns
    -------
    Identified
        Friction as a coefficient, or as a force in N where no normal force is known.

    Raises
    ------
    InputError, RecordError
        For an argument or a file that cannot be.
    StudyError
        For a test in which nothing slides, or with fewer than three cycles.

    Examples
    --------
    >>> import numpy as np
    >>> import slipstick as ss
    >>> t = np.arange(0.0, 10.0, 0.002)
    >>> x, v = 0.02 * np.sin(2 * np.pi * t), np.cos(2 * np.pi * t)
    >>> force = 150.0 * np.sign(v) + 1e3 * x + np.random.default_rng(1).normal(0.0, 1.0, t.size)
    >>> found = ss.identify.cyclic({"time_s": t, "displacement_m": x, "force_n": force}, mass="100 kg")
    >>> round(found.estimates["slider.kinetic_friction"].value, 3)  # 150 N over the weight
    0.153
    """
    return _identified("cyclic", tests, model, locals())


@checked
def free_vibration(
    measured: Measured,
    *,
    channel: str | None = None,
    start: str | float | None = None,
    end: str | float | None = None,
    model: _core.Model | None = None,
    mapping: Columns | None = None,
) -> Identified:
    """Identify frequency and damping ratio of a storey that vibrates freely.

    Parameters
    ----------
    measured
        A file, or columns by name.
    channel
        The quantity to fit, ``"storey1_acceleration"``; may be left out where there is one only.
    start, end
        The stretch to fit, ``"2 s"``: of one mode that is left alone.
    model
        A model that takes what was found.
    mapping
        As in ``compare``.

    Returns
    -------
    Identified
        ``storey.1.frequency`` in Hz and ``storey.1.damping_ratio``.

    Raises
    ------
    InputError, RecordError
        For an argument or a file that cannot be.

    Examples
    --------
    >>> import numpy as np
    >>> import slipstick as ss
    >>> t = np.arange(0.0, 12.0, 0.01)
    >>> noise = np.random.default_rng(1).normal(0.0, 0.01, t.size)
    >>> a = np.exp(-0.1 * t) * np.cos(2 * np.pi * 1.6 * t) + noise
    >>> found = ss.identify.free_vibration({"time_s": t, "storey1_acceleration_m_per_s2": a})
    >>> round(found.estimates["storey.1.frequency"].value, 2)
    1.6
    """
    return _identified("free-vibration", measured, model, locals())


@checked
def shaking_table(
    measured: Measured,
    model: _core.Model,
    fit: Sequence[str] | Mapping[str, str | tuple[float, float] | None],
    *,
    using: Sequence[str] = (),
    instrument: Sequence[str] = (),
    seed: int | None = None,
    mapping: Columns | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Identified:
    """Identify keys of a model from a shaking-table record.

    Parameters
    ----------
    measured
        A file, or columns by name, the table acceleration among them.
    model
        The model; its values are where the search begins.
    fit
        Paths of the keys to fit; in a dict each with its range, ``{"slider.spring": "100 kN/m..200 kN/m"}``, or
        None.
    using
        Measured quantities to fit; all that the model has if left out.
    instrument
        What is not known of the sensors, standard deviations such as ``"gain=2 %"``,
        ``"sliding_displacement.lag=10 ms"`` or ``"sliding_displacement.drift=1 mm"``; ``"exact"`` where all is.
    seed
        Of the random starts.
    mapping
        As in ``compare``.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Identified
        One estimate a key, and ``model`` with them.

    Raises
    ------
    InputError, RecordError
        For a key, a range, a quantity or a file that cannot be.
    StudyError
        For too few measured values, or where no values give a response.
    KeyboardInterrupt
        At Ctrl-C.
    """
    return _identified("shaking-table", measured, model, locals(), jobs, progress)


def _identified(
    kind: str,
    tests: Measured | Sequence[Measured],
    model: _core.Model | None,
    asked: Mapping[str, object],
    jobs: int | None = 1,
    progress: Progress | None = None,
) -> Identified:
    asked_for = given(kind, asked)
    with following(progress) as on:
        return Identified(_core.identify(kind, several(tests, "tests" if "tests" in asked else "measured"), model, asked_for, jobs=jobs, progress=on))
