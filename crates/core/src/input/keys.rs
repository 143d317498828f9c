//! Every key of a model file.

use super::schema::{Exclusive, Key, Kind, Range, Section};
use crate::units::Dimension::{
    Acceleration, Angle, Damper, Force, Frequency, Length, Mass, Pressure, Slowness, Stiffness,
    Time, Velocity,
};

/// The most storeys a model may have: more than any building has, few enough that finding all their
/// modes takes a second.
pub const MAX_STOREYS: usize = 200;

/// The most modes of a structure, and points of it.
pub const MAX_MODES: usize = 200;

/// The most items of contents, surfaces in series, and points of friction by speed: several times what
/// anyone models, few enough that an analysis takes seconds.
pub const MAX_CONTENTS: usize = 50;
pub const MAX_SURFACES: usize = 10;
pub const MAX_SPEEDS: usize = 100;

/// The whole file.
pub static MODEL: Section = Section {
    keys: &[
        Key::optional("name", Kind::Text("Tank on sliders"), "Name of the model in results."),
        Key::required("block", Kind::Section(&BLOCK), "The rigid block that slides on the table."),
        Key::required("slider", Kind::Section(&SLIDER), "The bearing between table and block."),
        Key::optional(
            "storey",
            Kind::Sections(&STOREY, MAX_STOREYS),
            "Storeys of the structure on the block: none, one or many, from the block up.",
        ),
        Key::optional(
            "contents",
            Kind::Sections(&CONTENTS, MAX_CONTENTS),
            "What stands unfastened on the block or on a floor and may slide there.",
        ),
        Key::optional(
            "structure",
            Kind::Section(&STRUCTURE),
            "The structure on the block by its modes, instead of storeys.",
        ),
        Key::optional("frame", Kind::Section(&FRAME), "What the storeys have in common."),
        Key::optional("motion", Kind::Section(&MOTION), "How the table moves.").not_built(),
        Key::optional(
            "initial",
            Kind::Section(&INITIAL),
            "State at the start; each key replaces its own default.",
        )
        .not_built(),
        Key::optional("analysis", Kind::Section(&ANALYSIS), "How the response is computed.")
            .not_built(),
    ],
    choices: &[
        Exclusive::at_most(&["structure", "storey"]),
        Exclusive::at_most(&["structure", "frame"]),
    ],
};

static BLOCK: Section = Section {
    keys: &[
        Key::optional(
            "mass",
            Kind::Quantity(Mass, Range::Positive),
            "Mass of the block, without the storeys.",
        ),
        Key::optional(
            "weight",
            Kind::Quantity(Force, Range::Positive),
            "Weight of the block instead of its mass: M1 = weight / g.",
        ),
        Key::optional("name", Kind::Text("Base mat"), "Name of the block in results."),
        Key::optional(
            "width",
            Kind::Quantity(Length, Range::Positive),
            "Width along the direction of sliding; with the storeys' heights the ratio of overturning \
             is reported.",
        ).not_built(),
        Key::optional(
            "width_y",
            Kind::Quantity(Length, Range::Positive),
            "Width along y, of a motion in two directions.",
        ).not_built(),
        Key::optional(
            "height",
            Kind::Quantity(Length, Range::Positive),
            "Height of the block: its own inertia then counts for overturning. Without it the block \
             is taken as thin.",
        ).not_built(),
    ],
    choices: &[Exclusive::one_of(&["mass", "weight"])],
};

static SLIDER: Section = Section {
    keys: &[
        Key::optional(
            "static_friction",
            Kind::NumberOr(Range::NotNegative, &BY_DIRECTION),
            "Coefficient of friction that must be overcome before the block slides. Needed, but with \
             surfaces in series.",
        ),
        Key::optional(
            "kinetic_friction",
            Kind::NumberOr(Range::NotNegative, &KINETIC),
            "Coefficient of friction while the block slides; at rest at most the static one. Needed, \
             but with surfaces in series.",
        ),
        Key::optional(
            "pressure",
            Kind::Section(&PRESSURE),
            "How both coefficients of friction follow the pressure: they fall as it grows, \
             μ(p) = μ (p/reference)^(-exponent).",
        ),
        Key::optional(
            "static_ratio",
            Kind::Number(Range::Positive),
            "Static over kinetic friction of surfaces in series, at least 1; default 1.",
        ),
        Key::optional(
            "surface",
            Kind::Sections(&SURFACE, MAX_SURFACES),
            "Sliding surfaces in series, as of a double pendulum; instead of friction, spring and \
             radius.",
        ),
        Key::optional(
            "triple",
            Kind::Section(&TRIPLE),
            "A triple pendulum, its four surfaces from the bottom up; instead of friction, spring and \
             radius.",
        ),
        Key::optional(
            "spring",
            Kind::Quantity(Stiffness, Range::NotNegative),
            "Stiffness K1 of the spring between table and block.",
        ),
        Key::optional(
            "radius",
            Kind::Quantity(Length, Range::Positive),
            "Radius R of a pendulum slider: the spring K1 = M_tot g cos θ / R.",
        ),
        Key::optional(
            "period",
            Kind::Quantity(Time, Range::Positive),
            "Period T of sliding on the spring or pendulum: the spring K1 = M_tot (2 π / T)².",
        ),
        Key::optional(
            "damper",
            Kind::Quantity(Damper, Range::NotNegative),
            "Damper C1 between table and block.",
        ),
        Key::optional(
            "damping_ratio",
            Kind::Number(Range::NotNegative),
            "Damper as a ratio ξ of critical damping: C1 = 2 ξ √(K1 M_tot). Needs spring, radius or period.",
        ),
        Key::optional(
            "tilt",
            Kind::Quantity(Angle, Range::Tilt),
            "Tilt of the sliding surface, positive uphill towards +x: the angle that its x axis makes with the \
             horizontal.",
        ),
        Key::optional(
            "tilt_y",
            Kind::Quantity(Angle, Range::Tilt),
            "The same along y, positive uphill towards +y; default 0.",
        ),
        Key::optional(
            "asymmetry",
            Kind::Number(Range::Fraction),
            "Both coefficients of friction times 1 + asymmetry for sliding towards +x, times \
             1 - asymmetry towards -x.",
        ),
        Key::optional(
            "gap",
            Kind::Quantity(Length, Range::Positive),
            "Sliding displacement that the detailing allows: its use is reported, passing it is a \
             warning.",
        )
        .not_built(),
        Key::optional(
            "stop",
            Kind::Section(&STOP),
            "What the block strikes at the end of its travel; excludes gap, which only reports.",
        ),
        Key::optional(
            "bounds",
            Kind::Section(&BOUNDS),
            "Run also with both coefficients of friction times these factors.",
        )
        .not_built(),
    ],
    choices: &[
        Exclusive::at_most(&["spring", "radius", "period"]),
        Exclusive::at_most(&["damper", "damping_ratio"]),
        Exclusive::at_most(&["asymmetry", "static_friction.*"]),
        Exclusive::at_most(&["asymmetry", "kinetic_friction.*"]),
        Exclusive::at_most(&["gap", "stop"]),
        Exclusive::at_most(&["surface", "triple", "static_friction"]),
        Exclusive::at_most(&["surface", "triple", "kinetic_friction"]),
        Exclusive::at_most(&["surface", "triple", "pressure"]),
        Exclusive::at_most(&["surface", "triple", "spring"]),
        Exclusive::at_most(&["surface", "triple", "radius"]),
        Exclusive::at_most(&["surface", "triple", "period"]),
        Exclusive::at_most(&["surface", "triple", "damping_ratio"]),
        Exclusive::at_most(&["surface", "triple", "asymmetry"]),
        Exclusive::at_most(&["static_ratio", "static_friction"]),
    ],
};

static PRESSURE: Section = Section {
    keys: &[
        Key::required(
            "at_rest",
            Kind::Quantity(Pressure, Range::Positive),
            "Pressure under the weight alone; under vertical motion the pressure goes with the normal force.",
        ),
        Key::required(
            "reference",
            Kind::Quantity(Pressure, Range::Positive),
            "Pressure at which static_friction and kinetic_friction hold.",
        ),
        Key::required(
            "exponent",
            Kind::Number(Range::NotNegative),
            "Exponent of the pressure, from 0 to below 1.",
        ),
    ],
    choices: &[],
};

static SURFACE: Section = Section {
    keys: &[
        Key::optional(
            "radius",
            Kind::Quantity(Length, Range::Positive),
            "Radius of the surface; a flat one has none.",
        ),
        Key::required(
            "friction",
            Kind::NumberOr(Range::Positive, &KINETIC),
            "Kinetic coefficient of friction, a number: on surfaces in series it cannot follow the \
             speed.",
        ),
        Key::optional(
            "travel",
            Kind::Quantity(Length, Range::Positive),
            "Displacement at which the surface reaches its end; default none.",
        ),
    ],
    choices: &[],
};

static TRIPLE: Section = Section {
    keys: &[
        Key::required(
            "effective_radius",
            Kind::Quantities(Length, Range::Positive, 4),
            "Effective radii of the four surfaces, those of the outer ones the larger.",
        ),
        Key::required(
            "friction",
            Kind::Numbers(Range::Positive, 4),
            "Kinetic coefficients of friction of the four surfaces; the inner two are alike.",
        ),
        Key::required(
            "travel",
            Kind::Quantities(Length, Range::Positive, 4),
            "Displacement capacities of the four surfaces.",
        ),
    ],
    choices: &[],
};

static CONTENTS: Section = Section {
    keys: &[
        Key::required(
            "floor",
            Kind::Whole(0, MAX_STOREYS as u64),
            "Number of the storey on whose floor it stands; 0: on the block.",
        )
        .not_built(),
        Key::optional("mass", Kind::Quantity(Mass, Range::Positive), "Its mass."),
        Key::optional(
            "weight",
            Kind::Quantity(Force, Range::Positive),
            "Its weight instead of its mass: mass = weight / g.",
        ),
        Key::required(
            "static_friction",
            Kind::Number(Range::NotNegative),
            "Coefficient of friction that must be overcome before it slides.",
        ),
        Key::required(
            "kinetic_friction",
            Kind::Number(Range::NotNegative),
            "Coefficient of friction while it slides, at most the static one.",
        ),
    ],
    choices: &[Exclusive::one_of(&["mass", "weight"])],
};

static STOP: Section = Section {
    keys: &[
        Key::required(
            "gap",
            Kind::QuantityOr(Length, Range::NotNegative, &SIDES),
            "Sliding displacement at which the block reaches the stop; 0 where it stands against it.",
        ),
        Key::optional(
            "stiffness",
            Kind::Quantity(Stiffness, Range::Positive),
            "Stiffness k of an elastic stop.",
        ),
        Key::optional(
            "damper",
            Kind::Quantity(Damper, Range::NotNegative),
            "Damper C beside the stop's spring; default none. The stop pushes, it never pulls.",
        )
        .beside("stiffness"),
        Key::optional(
            "damping_ratio",
            Kind::Number(Range::NotNegative),
            "Damper as a ratio ξ of critical damping of the block on the stop: C = 2 ξ √(k M1).",
        )
        .beside("stiffness"),
        Key::optional(
            "restitution",
            Kind::Number(Range::NotNegative),
            "Coefficient of restitution e of a rigid stop, from 0 to 1: after an impact the block \
             moves back with e times its speed.",
        ),
    ],
    choices: &[
        Exclusive::at_most(&["damper", "damping_ratio"]),
        Exclusive::one_of(&["stiffness", "restitution"]),
    ],
};

static SIDES: Section = Section {
    keys: &[
        Key::optional("positive", Kind::Quantity(Length, Range::NotNegative), "Towards +x."),
        Key::optional("negative", Kind::Quantity(Length, Range::NotNegative), "Towards -x."),
    ],
    choices: &[],
};

static BY_DIRECTION: Section = Section {
    keys: &[
        Key::required("positive", Kind::Number(Range::NotNegative), "For sliding towards +x."),
        Key::required("negative", Kind::Number(Range::NotNegative), "For sliding towards -x."),
    ],
    choices: &[],
};

/// Kinetic friction by direction, or by speed.
static KINETIC: Section = Section {
    keys: &[
        Key::optional("positive", Kind::Number(Range::NotNegative), "For sliding towards +x."),
        Key::optional("negative", Kind::Number(Range::NotNegative), "For sliding towards -x.")
            .beside("positive"),
        Key::optional("slow", Kind::Number(Range::NotNegative), "Coefficient at rest."),
        Key::optional("fast", Kind::Number(Range::NotNegative), "Coefficient at high speed.")
            .beside("slow"),
        Key::optional(
            "rate",
            Kind::Quantity(Slowness, Range::NotNegative),
            "Rate α of μ = fast - (fast - slow) e^(-α |v|).",
        )
        .beside("slow"),
        Key::optional(
            "velocity",
            Kind::Quantities(Velocity, Range::NotNegative, MAX_SPEEDS),
            "Sliding velocities from 0 on, between which friction follows straight lines.",
        ),
        Key::optional(
            "coefficient",
            Kind::Numbers(Range::NotNegative, MAX_SPEEDS),
            "Coefficients at these velocities; beyond the last it stays.",
        )
        .beside("velocity"),
    ],
    choices: &[Exclusive::one_of(&["positive", "slow", "velocity"])],
};

static BOUNDS: Section = Section {
    keys: &[
        Key::required("lower", Kind::Number(Range::NotNegative), "Factor of the lower bound."),
        Key::required(
            "upper",
            Kind::Number(Range::NotNegative),
            "Factor of the upper bound, not below the lower one.",
        ),
    ],
    choices: &[],
};

static STOREY: Section = Section {
    keys: &[
        Key::optional("mass", Kind::Quantity(Mass, Range::Positive), "Mass of the floor."),
        Key::optional(
            "weight",
            Kind::Quantity(Force, Range::Positive),
            "Weight of the floor instead of its mass: mass = weight / g.",
        ),
        Key::optional("name", Kind::Text("Roof"), "Name of the storey in results."),
        Key::optional(
            "frequency",
            Kind::Quantity(Frequency, Range::Positive),
            "Fixed-base frequency of a structure of one storey.",
        ),
        Key::optional(
            "period",
            Kind::Quantity(Time, Range::Positive),
            "Fixed-base period of a structure of one storey.",
        ),
        Key::optional(
            "stiffness",
            Kind::QuantityOrRatio(Stiffness, Range::Positive),
            "Stiffness between this floor and the one below; where [frame] gives a period only the \
             ratios between the storeys count.",
        ),
        Key::optional(
            "damping_ratio",
            Kind::Number(Range::NotNegative),
            "Ratio of critical damping in every fixed-base mode; the same for all storeys.",
        ),
        Key::optional(
            "damper",
            Kind::Quantity(Damper, Range::NotNegative),
            "Damper between this floor and the one below.",
        ),
        Key::optional(
            "frequency_y",
            Kind::Quantity(Frequency, Range::Positive),
            "Fixed-base frequency along y, where it is another.",
        ),
        Key::optional(
            "period_y",
            Kind::Quantity(Time, Range::Positive),
            "Fixed-base period along y, where it is another.",
        ),
        Key::optional(
            "stiffness_y",
            Kind::QuantityOrRatio(Stiffness, Range::Positive),
            "Stiffness along y, where it is another.",
        ),
        Key::optional(
            "damping_ratio_y",
            Kind::Number(Range::NotNegative),
            "Ratio of critical damping along y, where it is another.",
        ),
        Key::optional(
            "damper_y",
            Kind::Quantity(Damper, Range::NotNegative),
            "Damper along y, where it is another.",
        ),
        Key::optional(
            "height",
            Kind::Quantity(Length, Range::Positive),
            "Height of the storey: drift ratio and overturning are reported.",
        )
        .not_built(),
    ],
    choices: &[
        Exclusive::one_of(&["mass", "weight"]),
        Exclusive::one_of(&["frequency", "period", "stiffness"]),
        Exclusive::one_of(&["damping_ratio", "damper"]),
        Exclusive::at_most(&["frequency_y", "period_y", "stiffness_y"]),
        Exclusive::at_most(&["damping_ratio_y", "damper_y"]),
    ],
};

static STRUCTURE: Section = Section {
    keys: &[
        Key::optional("mass", Kind::Quantity(Mass, Range::Positive), "All of its mass."),
        Key::optional(
            "weight",
            Kind::Quantity(Force, Range::Positive),
            "Its weight instead of its mass: mass = weight / g.",
        ),
        Key::optional(
            "modes",
            Kind::Text("modes.csv"),
            "Table of the modes, relative to the model file: period_s or frequency_hz, damping_ratio, \
             participation_x[, participation_y], and the shape at each point, NAME_x[, NAME_y].",
        ),
        Key::optional(
            "normalisation",
            Kind::Text("mass"),
            "\"mass\": shapes of unit modal mass (default); or the name of a point: shapes that are 1 \
             there, with effective masses.",
        ),
        Key::optional(
            "damping_ratio",
            Kind::Number(Range::NotNegative),
            "Ratio of critical damping of all modes, instead of their own.",
        ),
        Key::optional(
            "period_factor",
            Kind::Number(Range::Positive),
            "Factor on the periods of all modes; default 1.",
        ),
        Key::optional(
            "along_y",
            Kind::Word(&["as-x"]),
            "\"as-x\": modes and points do along y what they do along x, as in a round tank or tower, instead of what \
             each says of y.",
        ),
        Key::optional(
            "mode",
            Kind::Sections(&MODE, MAX_MODES),
            "Modes on a fixed base, the longest period first.",
        )
        .not_built(),
        Key::optional(
            "point",
            Kind::Sections(&POINT, MAX_MODES),
            "Points whose motion is wanted, from the block up.",
        )
        .not_built(),
    ],
    choices: &[Exclusive::one_of(&["mass", "weight"]), Exclusive::at_most(&["modes", "mode"])],
};

static MODE: Section = Section {
    keys: &[
        Key::optional("period", Kind::Quantity(Time, Range::Positive), "Its period."),
        Key::optional("frequency", Kind::Quantity(Frequency, Range::Positive), "Its frequency."),
        Key::optional(
            "damping_ratio",
            Kind::Number(Range::NotNegative),
            "Ratio of critical damping; needed unless that of all modes is given.",
        ),
        Key::optional(
            "effective_mass",
            Kind::Quantity(Mass, Range::NotNegative),
            "Effective mass, L² of a shape of unit modal mass.",
        ),
        Key::optional(
            "effective_mass_ratio",
            Kind::Number(Range::NotNegative),
            "Effective mass over the mass of the structure.",
        ),
        Key::optional(
            "participation",
            Kind::Number(Range::Any),
            "Participation L = φᵀ M 1 of a shape of unit modal mass, in √kg; of shapes that are 1 at a \
             point the participation factor, beside the effective mass.",
        ),
        Key::optional(
            "effective_mass_y",
            Kind::Quantity(Mass, Range::NotNegative),
            "Effective mass along y.",
        ),
        Key::optional(
            "effective_mass_ratio_y",
            Kind::Number(Range::NotNegative),
            "Effective mass along y over the mass of the structure.",
        ),
        Key::optional(
            "participation_y",
            Kind::Number(Range::Any),
            "Participation along y, with the sign that belongs to the shape.",
        ),
    ],
    choices: &[
        Exclusive::one_of(&["period", "frequency"]),
        Exclusive::at_most(&["effective_mass", "effective_mass_ratio"]),
        Exclusive::at_most(&["effective_mass_y", "effective_mass_ratio_y"]),
    ],
};

static POINT: Section = Section {
    keys: &[
        Key::required("name", Kind::Text("roof"), "Its name in results."),
        Key::optional(
            "height",
            Kind::Quantity(Length, Range::Positive),
            "Height above the block: drift ratio and overturning are reported.",
        ),
        Key::optional(
            "mass",
            Kind::Quantity(Mass, Range::Positive),
            "Its share of the mass, of whose inertia the overturning moment is made.",
        ),
        Key::optional(
            "shape",
            Kind::Numbers(Range::Any, MAX_MODES),
            "Shapes of the modes at this point, one a mode.",
        ),
        Key::optional("shape_y", Kind::Numbers(Range::Any, MAX_MODES), "The same along y."),
    ],
    choices: &[],
};

static FRAME: Section = Section {
    keys: &[
        Key::optional(
            "period",
            Kind::Quantity(Time, Range::Positive),
            "First fixed-base period to which the storeys' stiffnesses are scaled.",
        ),
        Key::optional(
            "period_y",
            Kind::Quantity(Time, Range::Positive),
            "First fixed-base period along y, where it is another.",
        ),
    ],
    choices: &[],
};

pub(super) const UNITS: Key = Key::optional(
    "units",
    Kind::UnitOf(Acceleration),
    "Unit of the record, where its file does not state it; of counts the value of one, \
     \"4.67e-6 m/s2\".",
);
pub(super) const RECORD_STEP: Key = Key::optional(
    "dt",
    Kind::Quantity(Time, Range::Positive),
    "Time step of the record, where its file does not state it.",
);
pub(super) const CHANNEL: Key = Key::optional(
    "channel",
    Kind::NameOrIndex,
    "Which of the record's channels, by name or counted from 1.",
);
pub(super) const VERTICAL_SCALE: Key = Key::optional(
    "vertical_scale",
    Kind::Number(Range::Any),
    "Factor on the vertical motion besides that of the horizontal one; default 1.",
)
.beside("vertical");

static MOTION: Section = Section {
    keys: &[
        Key::optional(
            "record",
            Kind::Text("records/taft.txt"),
            "File of a recorded ground motion, relative to the model file.",
        ),
        UNITS.beside("record"),
        RECORD_STEP.beside("record"),
        CHANNEL.beside("record"),
        Key::optional("scale", Kind::Number(Range::Any), "Factor on the record; may be negative.")
            .beside("record"),
        Key::optional(
            "scale_to",
            Kind::Quantity(Acceleration, Range::Positive),
            "Peak acceleration to which the record is scaled.",
        )
        .beside("record"),
        Key::optional(
            "vertical",
            Kind::Text("records/taft-up.txt"),
            "File of the vertical motion, which takes the factor of the horizontal one.",
        )
        .beside("record"),
        VERTICAL_SCALE,
        Key::optional(
            "record_y",
            Kind::Text("records/taft-y.txt"),
            "File of the motion along y, perhaps the same: the table then moves in two horizontal \
             directions.",
        )
        .beside("record"),
        Key::optional(
            "units_y",
            Kind::UnitOf(Acceleration),
            "Unit of the record along y, where it is not that of the record along x.",
        )
        .beside("record_y"),
        Key::optional(
            "dt_y",
            Kind::Quantity(Time, Range::Positive),
            "Time step of the record along y, where it is not that of the record along x.",
        )
        .beside("record_y"),
        Key::optional(
            "channel_y",
            Kind::NameOrIndex,
            "Which of the channels of the record along y, by name or counted from 1.",
        )
        .beside("record_y"),
        Key::optional(
            "scale_y",
            Kind::Number(Range::Any),
            "Factor on the motion along y besides that of both; default 1.",
        )
        .beside("record_y"),
        Key::optional(
            "rotate",
            Kind::Quantity(Angle, Range::Any),
            "Angle by which the motion in two directions is turned, x towards y, after scaling; \
             default 0 deg.",
        ),
        Key::optional("sine", Kind::Section(&SINE), "A sine of constant frequency."),
        Key::optional(
            "sine_y",
            Kind::Section(&SINE),
            "A sine along y: the table then moves in two horizontal directions.",
        )
        .beside("sine"),
        Key::optional("sweep", Kind::Section(&SWEEP), "A sine whose frequency changes."),
        Key::optional("pulse", Kind::Section(&PULSE), "A single pulse."),
    ],
    choices: &[
        Exclusive::one_of(&["record", "sine", "sweep", "pulse"]),
        Exclusive::at_most(&["scale", "scale_to"]),
    ],
};

const AMPLITUDE: Key =
    Key::required("amplitude", Kind::Quantity(Acceleration, Range::Any), "Peak acceleration.");
const DURATION: Key =
    Key::required("duration", Kind::Quantity(Time, Range::Positive), "How long it lasts.");
const STEP: Key =
    Key::required("dt", Kind::Quantity(Time, Range::Positive), "Time step at which it is sampled.");
const RAMP: Key = Key::optional(
    "ramp",
    Kind::Quantity(Time, Range::NotNegative),
    "Time in which the amplitude grows from zero; default 0 s.",
);
const DECAY: Key = Key::optional(
    "decay",
    Kind::Quantity(Time, Range::NotNegative),
    "Time at the end in which the amplitude falls to zero; default 0 s.",
);

static SINE: Section = Section {
    keys: &[
        Key::required("frequency", Kind::Quantity(Frequency, Range::Positive), "Its frequency."),
        AMPLITUDE,
        DURATION,
        STEP,
        Key::optional(
            "phase",
            Kind::Quantity(Angle, Range::Any),
            "Its phase at the start; default 0 deg.",
        ),
        RAMP,
        DECAY,
    ],
    choices: &[],
};

static SWEEP: Section = Section {
    keys: &[
        Key::required(
            "from",
            Kind::Quantity(Frequency, Range::Positive),
            "Frequency at the start.",
        ),
        Key::required("to", Kind::Quantity(Frequency, Range::Positive), "Frequency at the end."),
        Key::required("kind", Kind::Word(&["linear", "logarithmic"]), "How the frequency changes."),
        AMPLITUDE,
        DURATION,
        STEP,
        RAMP,
        DECAY,
    ],
    choices: &[],
};

static PULSE: Section = Section {
    keys: &[
        Key::required(
            "shape",
            Kind::Word(&["half-sine", "rectangular", "triangular"]),
            "Its shape; the edges of a rectangle are jumps.",
        ),
        AMPLITUDE,
        DURATION,
        Key::optional(
            "start",
            Kind::Quantity(Time, Range::NotNegative),
            "When it starts; default 0 s.",
        ),
        STEP,
    ],
    choices: &[],
};

static INITIAL: Section = Section {
    keys: &[
        Key::optional(
            "sliding_displacement",
            Kind::Vector(Length, Range::Any),
            "Displacement of the block relative to the table; the spring is unstressed at 0. A list of \
             two is along x and along y.",
        ),
        Key::optional(
            "sliding_velocity",
            Kind::Vector(Velocity, Range::Any),
            "Velocity of the block relative to the table.",
        ),
        Key::optional(
            "storey_displacement",
            Kind::Vectors(Length, Range::Any, MAX_STOREYS),
            "Displacements of the floors relative to the block, one a storey.",
        ),
        Key::optional(
            "storey_velocity",
            Kind::Vectors(Velocity, Range::Any, MAX_STOREYS),
            "Velocities of the floors relative to the block, one a storey.",
        ),
    ],
    choices: &[],
};

static ANALYSIS: Section = Section {
    keys: &[
        Key::optional(
            "method",
            Kind::Word(&["exact", "stepwise"]),
            "Events located and linear phases solved exactly (default), or the paper's own program.",
        ),
        Key::optional(
            "gravity",
            Kind::Quantity(Acceleration, Range::Positive),
            "Acceleration of gravity; default 9.80665 m/s².",
        ),
        Key::optional(
            "tail",
            Kind::Quantity(Time, Range::NotNegative),
            "Free vibration after the motion ends; default none.",
        ),
    ],
    choices: &[],
};
