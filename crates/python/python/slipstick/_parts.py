"""Tables of the model file as calls with keywords. Written by parts.py from the schema of the model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, SupportsFloat

from ._part import Part, Quantity


class Block(Part):
    """The rigid block that slides on the table.

    Parameters
    ----------
    mass
        Mass of the block, without the storeys.
        Such as ``"325 kg"``.
    weight
        Weight of the block instead of its mass: M1 = weight / g.
        Such as ``"12 kN"``.
    name
        Name of the block in results.
        Such as ``"Base mat"``.
    width
        Width along the direction of sliding; with the storeys' heights the ratio of overturning is
        reported.
        Such as ``"150 mm"``.
    width_y
        Width along y, of a motion in two directions.
        Such as ``"150 mm"``.
    height
        Height of the block: its own inertia then counts for overturning. Without it the block is taken as
        thin.
        Such as ``"150 mm"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "block"

    def __init__(
        self,
        *,
        mass: str | Quantity | SupportsFloat | None = None,
        weight: str | Quantity | SupportsFloat | None = None,
        name: str | None = None,
        width: str | Quantity | SupportsFloat | None = None,
        width_y: str | Quantity | SupportsFloat | None = None,
        height: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Slider(Part):
    """The bearing between table and block.

    Parameters
    ----------
    static_friction
        Coefficient of friction that must be overcome before the block slides. Needed, but with surfaces in
        series.
        Such as ``"6 %"``.
    kinetic_friction
        Coefficient of friction while the block slides; at rest at most the static one. Needed, but with
        surfaces in series.
        Such as ``"6 %"``.
    pressure
        How both coefficients of friction follow the pressure: they fall as it grows, μ(p) = μ
        (p/reference)^(-exponent).
    static_ratio
        Static over kinetic friction of surfaces in series, at least 1; default 1.
        Such as ``"6 %"``.
    surface
        Sliding surfaces in series, as of a double pendulum; instead of friction, spring and radius.
    triple
        A triple pendulum, its four surfaces from the bottom up; instead of friction, spring and radius.
    spring
        Stiffness K1 of the spring between table and block.
        Such as ``"143 kN/m"``.
    radius
        Radius R of a pendulum slider: the spring K1 = M_tot g cos θ / R.
        Such as ``"150 mm"``.
    period
        Period T of sliding on the spring or pendulum: the spring K1 = M_tot (2 π / T)².
        Such as ``"0.01 s"``.
    damper
        Damper C1 between table and block.
        Such as ``"250 N s/m"``.
    damping_ratio
        Damper as a ratio ξ of critical damping: C1 = 2 ξ √(K1 M_tot). Needs spring, radius or period.
        Such as ``"6 %"``.
    tilt
        Tilt of the sliding surface, positive uphill towards +x: the angle that its x axis makes with the
        horizontal.
        Such as ``"1 mrad"``.
    tilt_y
        The same along y, positive uphill towards +y; default 0.
        Such as ``"1 mrad"``.
    asymmetry
        Both coefficients of friction times 1 + asymmetry for sliding towards +x, times 1 - asymmetry
        towards -x.
        Such as ``"6 %"``.
    gap
        Sliding displacement that the detailing allows: its use is reported, passing it is a warning.
        Such as ``"150 mm"``.
    stop
        What the block strikes at the end of its travel; excludes gap, which only reports.
    bounds
        Run also with both coefficients of friction times these factors.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "slider"

    def __init__(
        self,
        *,
        static_friction: SupportsFloat | str | Mapping[str, Any] | None = None,
        kinetic_friction: SupportsFloat | str | Mapping[str, Any] | None = None,
        pressure: Mapping[str, Any] | None = None,
        static_ratio: SupportsFloat | str | None = None,
        surface: Sequence[Any] | None = None,
        triple: Mapping[str, Any] | None = None,
        spring: str | Quantity | SupportsFloat | None = None,
        radius: str | Quantity | SupportsFloat | None = None,
        period: str | Quantity | SupportsFloat | None = None,
        damper: str | Quantity | SupportsFloat | None = None,
        damping_ratio: SupportsFloat | str | None = None,
        tilt: str | Quantity | SupportsFloat | None = None,
        tilt_y: str | Quantity | SupportsFloat | None = None,
        asymmetry: SupportsFloat | str | None = None,
        gap: str | Quantity | SupportsFloat | None = None,
        stop: Mapping[str, Any] | None = None,
        bounds: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(locals())


class Stop(Part):
    """What the block strikes at the end of its travel: ``Slider(stop=...)``.

    Parameters
    ----------
    gap
        Sliding displacement at which the block reaches the stop; 0 where it stands against it.
        Such as ``"150 mm"``.
    stiffness
        Stiffness k of an elastic stop.
        Such as ``"143 kN/m"``.
    damper
        Damper C beside the stop's spring; default none. The stop pushes, it never pulls.
        Such as ``"250 N s/m"``.
    damping_ratio
        Damper as a ratio ξ of critical damping of the block on the stop: C = 2 ξ √(k M1).
        Such as ``"6 %"``.
    restitution
        Coefficient of restitution e of a rigid stop, from 0 to 1: after an impact the block moves back with
        e times its speed.
        Such as ``"6 %"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "slider.stop"

    def __init__(
        self,
        *,
        gap: str | Mapping[str, Any] | Quantity | SupportsFloat | None = None,
        stiffness: str | Quantity | SupportsFloat | None = None,
        damper: str | Quantity | SupportsFloat | None = None,
        damping_ratio: SupportsFloat | str | None = None,
        restitution: SupportsFloat | str | None = None,
    ) -> None:
        super().__init__(locals())


class Surface(Part):
    """A sliding surface of several in series: ``Slider(surface=[...])``.

    Parameters
    ----------
    radius
        Radius of the surface; a flat one has none.
        Such as ``"150 mm"``.
    friction
        Kinetic coefficient of friction, a number: on surfaces in series it cannot follow the speed.
        Such as ``"6 %"``.
    travel
        Displacement at which the surface reaches its end; default none.
        Such as ``"150 mm"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "slider.surface"

    def __init__(
        self,
        *,
        radius: str | Quantity | SupportsFloat | None = None,
        friction: SupportsFloat | str | Mapping[str, Any] | None = None,
        travel: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Storey(Part):
    """A storey of the structure on the block.

    Parameters
    ----------
    mass
        Mass of the floor.
        Such as ``"325 kg"``.
    weight
        Weight of the floor instead of its mass: mass = weight / g.
        Such as ``"12 kN"``.
    name
        Name of the storey in results.
        Such as ``"Roof"``.
    frequency
        Fixed-base frequency of a structure of one storey.
        Such as ``"1.6 Hz"``.
    period
        Fixed-base period of a structure of one storey.
        Such as ``"0.01 s"``.
    stiffness
        Stiffness between this floor and the one below; where ``frame`` gives a period only the ratios
        between the storeys count.
        Such as ``"143 kN/m"``.
    damping_ratio
        Ratio of critical damping in every fixed-base mode; the same for all storeys.
        Such as ``"6 %"``.
    damper
        Damper between this floor and the one below.
        Such as ``"250 N s/m"``.
    frequency_y
        Fixed-base frequency along y, where it is another.
        Such as ``"1.6 Hz"``.
    period_y
        Fixed-base period along y, where it is another.
        Such as ``"0.01 s"``.
    stiffness_y
        Stiffness along y, where it is another.
        Such as ``"143 kN/m"``.
    damping_ratio_y
        Ratio of critical damping along y, where it is another.
        Such as ``"6 %"``.
    damper_y
        Damper along y, where it is another.
        Such as ``"250 N s/m"``.
    height
        Height of the storey: drift ratio and overturning are reported.
        Such as ``"150 mm"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "storey"

    def __init__(
        self,
        *,
        mass: str | Quantity | SupportsFloat | None = None,
        weight: str | Quantity | SupportsFloat | None = None,
        name: str | None = None,
        frequency: str | Quantity | SupportsFloat | None = None,
        period: str | Quantity | SupportsFloat | None = None,
        stiffness: str | SupportsFloat | None = None,
        damping_ratio: SupportsFloat | str | None = None,
        damper: str | Quantity | SupportsFloat | None = None,
        frequency_y: str | Quantity | SupportsFloat | None = None,
        period_y: str | Quantity | SupportsFloat | None = None,
        stiffness_y: str | SupportsFloat | None = None,
        damping_ratio_y: SupportsFloat | str | None = None,
        damper_y: str | Quantity | SupportsFloat | None = None,
        height: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Contents(Part):
    """What stands unfastened on the block or on a floor and may slide there.

    Parameters
    ----------
    floor
        Number of the storey on whose floor it stands; 0: on the block.
    mass
        Its mass.
        Such as ``"325 kg"``.
    weight
        Its weight instead of its mass: mass = weight / g.
        Such as ``"12 kN"``.
    static_friction
        Coefficient of friction that must be overcome before it slides.
        Such as ``"6 %"``.
    kinetic_friction
        Coefficient of friction while it slides, at most the static one.
        Such as ``"6 %"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "contents"

    def __init__(
        self,
        *,
        floor: int | None = None,
        mass: str | Quantity | SupportsFloat | None = None,
        weight: str | Quantity | SupportsFloat | None = None,
        static_friction: SupportsFloat | str | None = None,
        kinetic_friction: SupportsFloat | str | None = None,
    ) -> None:
        super().__init__(locals())


class Frame(Part):
    """What the storeys have in common.

    Parameters
    ----------
    period
        First fixed-base period to which the storeys' stiffnesses are scaled.
        Such as ``"0.01 s"``.
    period_y
        First fixed-base period along y, where it is another.
        Such as ``"0.01 s"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "frame"

    def __init__(
        self,
        *,
        period: str | Quantity | SupportsFloat | None = None,
        period_y: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Structure(Part):
    """A structure by its modes, instead of storeys: ``Model(structure=...)``; ``Model.from_modes`` makes one of matrices.

    Parameters
    ----------
    mass
        All of its mass.
        Such as ``"325 kg"``.
    weight
        Its weight instead of its mass: mass = weight / g.
        Such as ``"12 kN"``.
    modes
        Table of the modes, relative to the model file: period_s or frequency_hz, damping_ratio,
        participation_x``, participation_y``, and the shape at each point, NAME_x``, NAME_y``.
        Such as ``"modes.csv"``.
    normalisation
        "mass": shapes of unit modal mass (default); or the name of a point: shapes that are 1 there, with
        effective masses.
        Such as ``"mass"``.
    damping_ratio
        Ratio of critical damping of all modes, instead of their own.
        Such as ``"6 %"``.
    period_factor
        Factor on the periods of all modes; default 1.
        Such as ``"6 %"``.
    along_y
        "as-x": modes and points do along y what they do along x, as in a round tank or tower, instead of
        what each says of y.
    mode
        Modes on a fixed base, the longest period first.
    point
        Points whose motion is wanted, from the block up.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "structure"

    def __init__(
        self,
        *,
        mass: str | Quantity | SupportsFloat | None = None,
        weight: str | Quantity | SupportsFloat | None = None,
        modes: str | None = None,
        normalisation: str | None = None,
        damping_ratio: SupportsFloat | str | None = None,
        period_factor: SupportsFloat | str | None = None,
        along_y: Literal["as-x"] | None = None,
        mode: Sequence[Any] | None = None,
        point: Sequence[Any] | None = None,
    ) -> None:
        super().__init__(locals())


class Mode(Part):
    """A mode of a structure: ``Structure(mode=[...])``.

    Parameters
    ----------
    period
        Its period.
        Such as ``"0.01 s"``.
    frequency
        Its frequency.
        Such as ``"1.6 Hz"``.
    damping_ratio
        Ratio of critical damping; needed unless that of all modes is given.
        Such as ``"6 %"``.
    effective_mass
        Effective mass, L² of a shape of unit modal mass.
        Such as ``"325 kg"``.
    effective_mass_ratio
        Effective mass over the mass of the structure.
        Such as ``"6 %"``.
    participation
        Participation L = φᵀ M 1 of a shape of unit modal mass, in √kg; of shapes that are 1 at a point the
        participation factor, beside the effective mass.
        Such as ``"6 %"``.
    effective_mass_y
        Effective mass along y.
        Such as ``"325 kg"``.
    effective_mass_ratio_y
        Effective mass along y over the mass of the structure.
        Such as ``"6 %"``.
    participation_y
        Participation along y, with the sign that belongs to the shape.
        Such as ``"6 %"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "structure.mode"

    def __init__(
        self,
        *,
        period: str | Quantity | SupportsFloat | None = None,
        frequency: str | Quantity | SupportsFloat | None = None,
        damping_ratio: SupportsFloat | str | None = None,
        effective_mass: str | Quantity | SupportsFloat | None = None,
        effective_mass_ratio: SupportsFloat | str | None = None,
        participation: SupportsFloat | str | None = None,
        effective_mass_y: str | Quantity | SupportsFloat | None = None,
        effective_mass_ratio_y: SupportsFloat | str | None = None,
        participation_y: SupportsFloat | str | None = None,
    ) -> None:
        super().__init__(locals())


class Point(Part):
    """A point of a structure whose motion is wanted: ``Structure(point=[...])``.

    Parameters
    ----------
    name
        Its name in results.
        Such as ``"roof"``.
    height
        Height above the block: drift ratio and overturning are reported.
        Such as ``"150 mm"``.
    mass
        Its share of the mass, of whose inertia the overturning moment is made.
        Such as ``"325 kg"``.
    shape
        Shapes of the modes at this point, one a mode.
    shape_y
        The same along y.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "structure.point"

    def __init__(
        self,
        *,
        name: str | None = None,
        height: str | Quantity | SupportsFloat | None = None,
        mass: str | Quantity | SupportsFloat | None = None,
        shape: Sequence[Any] | None = None,
        shape_y: Sequence[Any] | None = None,
    ) -> None:
        super().__init__(locals())


class Sine(Part):
    """A sine as the motion of a model: ``Model(motion=Sine(...))``.

    Parameters
    ----------
    frequency
        Its frequency.
        Such as ``"1.6 Hz"``.
    amplitude
        Peak acceleration.
        Such as ``"0.3 g"``.
    duration
        How long it lasts.
        Such as ``"0.01 s"``.
    dt
        Time step at which it is sampled.
        Such as ``"0.01 s"``.
    phase
        Its phase at the start; default 0 deg.
        Such as ``"1 mrad"``.
    ramp
        Time in which the amplitude grows from zero; default 0 s.
        Such as ``"0.01 s"``.
    decay
        Time at the end in which the amplitude falls to zero; default 0 s.
        Such as ``"0.01 s"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "motion.sine"

    def __init__(
        self,
        *,
        frequency: str | Quantity | SupportsFloat | None = None,
        amplitude: str | Quantity | SupportsFloat | None = None,
        duration: str | Quantity | SupportsFloat | None = None,
        dt: str | Quantity | SupportsFloat | None = None,
        phase: str | Quantity | SupportsFloat | None = None,
        ramp: str | Quantity | SupportsFloat | None = None,
        decay: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Sweep(Part):
    """A sine of changing frequency as the motion of a model.

    Parameters
    ----------
    from_
        Frequency at the start.
        Such as ``"1.6 Hz"``.
    to
        Frequency at the end.
        Such as ``"1.6 Hz"``.
    kind
        How the frequency changes.
    amplitude
        Peak acceleration.
        Such as ``"0.3 g"``.
    duration
        How long it lasts.
        Such as ``"0.01 s"``.
    dt
        Time step at which it is sampled.
        Such as ``"0.01 s"``.
    ramp
        Time in which the amplitude grows from zero; default 0 s.
        Such as ``"0.01 s"``.
    decay
        Time at the end in which the amplitude falls to zero; default 0 s.
        Such as ``"0.01 s"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "motion.sweep"

    def __init__(
        self,
        *,
        from_: str | Quantity | SupportsFloat | None = None,
        to: str | Quantity | SupportsFloat | None = None,
        kind: Literal["linear", "logarithmic"] | None = None,
        amplitude: str | Quantity | SupportsFloat | None = None,
        duration: str | Quantity | SupportsFloat | None = None,
        dt: str | Quantity | SupportsFloat | None = None,
        ramp: str | Quantity | SupportsFloat | None = None,
        decay: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Pulse(Part):
    """A single pulse as the motion of a model.

    Parameters
    ----------
    shape
        Its shape; the edges of a rectangle are jumps.
    amplitude
        Peak acceleration.
        Such as ``"0.3 g"``.
    duration
        How long it lasts.
        Such as ``"0.01 s"``.
    start
        When it starts; default 0 s.
        Such as ``"0.01 s"``.
    dt
        Time step at which it is sampled.
        Such as ``"0.01 s"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "motion.pulse"

    def __init__(
        self,
        *,
        shape: Literal["half-sine", "rectangular", "triangular"] | None = None,
        amplitude: str | Quantity | SupportsFloat | None = None,
        duration: str | Quantity | SupportsFloat | None = None,
        start: str | Quantity | SupportsFloat | None = None,
        dt: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())


class Initial(Part):
    """State at the start; each key replaces its own default.

    Parameters
    ----------
    sliding_displacement
        Displacement of the block relative to the table; the spring is unstressed at 0. A list of two is
        along x and along y.
        Such as ``"150 mm"``.
    sliding_velocity
        Velocity of the block relative to the table.
        Such as ``"0.2 m/s"``.
    storey_displacement
        Displacements of the floors relative to the block, one a storey.
    storey_velocity
        Velocities of the floors relative to the block, one a storey.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "initial"

    def __init__(
        self,
        *,
        sliding_displacement: str | Sequence[Any] | Quantity | SupportsFloat | None = None,
        sliding_velocity: str | Sequence[Any] | Quantity | SupportsFloat | None = None,
        storey_displacement: Sequence[Any] | None = None,
        storey_velocity: Sequence[Any] | None = None,
    ) -> None:
        super().__init__(locals())


class Analysis(Part):
    """How the response is computed.

    Parameters
    ----------
    method
        Events located and linear phases solved exactly (default), or the paper's own program.
    gravity
        Acceleration of gravity; default 9.80665 m/s².
        Such as ``"0.3 g"``.
    tail
        Free vibration after the motion ends; default none.
        Such as ``"0.01 s"``.

    Raises
    ------
    InputError
        For a value of another kind or unit.
    """

    _PATH = "analysis"

    def __init__(
        self,
        *,
        method: Literal["exact", "stepwise"] | None = None,
        gravity: str | Quantity | SupportsFloat | None = None,
        tail: str | Quantity | SupportsFloat | None = None,
    ) -> None:
        super().__init__(locals())
