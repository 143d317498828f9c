//! What a block needs to know of a system and a time step, made once.
//!
//! All tables hold the state in the order `s, ṡ, η, η̇`; a rigid block has zeros for the structure.
//! They depend neither on friction nor on the motion.

use super::lanes::{BLOCK, Eight, Four};
use crate::linear::polynomial::DEGREE;
use crate::linear::{MAX_RATE_STEP, PerStorey, System};
use crate::solver::extremes::{Extremes, tracked};

/// Samples in a stretch of quiet stick.
pub(super) const QUIET: usize = 32;

/// Most pieces a sample is cut into for the Taylor series.
const MOST_PIECES: f64 = 16.0;

/// The equations of a rigid block (with zeros) or a block with one storey.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plant {
    pub(super) block_mass_kg: f64,
    pub(super) per_block_mass: f64,
    pub(super) stiffness_n_per_m: f64,
    pub(super) damper_n_s_per_m: f64,
    /// `Ω`, 1 for a rigid block.
    pub(super) omega2: f64,
    /// `D`.
    pub(super) decay: f64,
    /// `L`.
    pub(super) participation: f64,
    /// `√M_tot`.
    pub(super) root_mass: f64,
    /// `1/√M1`.
    pub(super) per_root_block: f64,
}

/// Tables of a system and a step.
#[derive(Debug)]
pub(in crate::solver) struct Tables {
    pub(super) plant: Plant,
    /// Equal pieces into which a sample is cut for its Taylor series.
    pub(super) pieces: usize,
    pub(super) piece_s: f64,
    pub(super) stick: Phase,
    pub(super) slip: Phase,
    pub(super) quiet: Quiet,
}

/// Tables of stick or slip.
#[derive(Debug)]
pub(super) struct Phase {
    /// Taylor coefficients from the first on over a piece, order by order: what one unit of each
    /// component of the state, of the acceleration, of its change over the piece and of the friction
    /// force adds to the state.
    pub(super) series: [[Four; 7]; DEGREE],
    /// `E^k`, column by column.
    pub(super) power: [[Four; 4]; BLOCK + 1],
    /// What a unit of acceleration at the first sample leaves after `k`.
    pub(super) first: [Four; BLOCK + 1],
    /// What a unit of acceleration at a sample leaves `j` samples later.
    pub(super) tap: [Four; BLOCK],
    /// What a unit of friction force leaves after `k` samples.
    pub(super) force: [Four; BLOCK + 1],
    /// The same for one value at all samples of a block: `s`, `ṡ`, `η`, `f`.
    pub(super) rows: [Row; 4],
    /// The tracked quantities.
    pub(super) view: View,
    /// How far chords may be off.
    pub(super) bend: Bend,
}

/// One value at the samples `1 … 8` after a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) state: [Eight; 4],
    pub(super) first: Eight,
    pub(super) tap: [Eight; BLOCK],
    pub(super) force: Eight,
}

/// The tracked quantities in the order of [`tracked`] with the drift, which is the displacement,
/// left out: the sum of columns times `s, ṡ, η, f` and of the acceleration and the friction force
/// times theirs, less the slope's pull in accelerations.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) columns: [Eight; 4],
    pub(super) of_acceleration: Eight,
    pub(super) of_force: Eight,
    pub(super) slope: Eight,
    /// Sizes of what the state `s, ṡ, η, η̇` adds.
    pub(super) sizes: [Eight; 4],
}

/// Bound on what a chord hides of the tracked quantities: the sum of these times the norm of the
/// state at the start, the largest acceleration, its largest rate, and the friction force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    pub(super) of_norm: Eight,
    pub(super) of_acceleration: Eight,
    pub(super) of_rate: Eight,
    pub(super) of_force: Eight,
}

/// Stick over many samples.
#[derive(Debug)]
pub(super) struct Quiet {
    pub(super) power: [Four; 4],
    pub(super) first: Four,
    pub(super) tap: [Four; QUIET],
    /// Bounds on the tracked quantities over a block and over the stretch: of the norm of the state
    /// at the start, of the largest acceleration, and of |s|.
    pub(super) of_norm: Eight,
    pub(super) of_acceleration: [Eight; 2],
    pub(super) of_s: Eight,
    /// What the slope adds to them.
    pub(super) of_slope: Eight,
}

impl Plant {
    fn new<V: PerStorey>(system: &System<V>) -> Self {
        let one_storey = system.storeys() == 1;
        let of = |x: f64, v: f64| {
            if one_storey { system.restoring(&[x], &[v]).as_ref()[0] } else { x }
        };
        let participation = if one_storey { system.participation.as_ref()[0] } else { 0.0 };
        let total_kg = system.block_mass_kg + participation * participation;
        Self {
            block_mass_kg: system.block_mass_kg,
            per_block_mass: system.per_block_mass,
            stiffness_n_per_m: system.stiffness_n_per_m,
            damper_n_s_per_m: system.damper_n_s_per_m,
            omega2: of(1.0, 0.0),
            decay: of(0.0, 1.0),
            participation,
            root_mass: total_kg.sqrt(),
            per_root_block: 1.0 / system.block_mass_kg.sqrt(),
        }
    }

    /// `f = D η̇ + Ω η`.
    #[inline(always)]
    pub(super) fn restoring(&self, x: &[f64; 4]) -> f64 {
        self.omega2 * x[2] + self.decay * x[3]
    }

    /// `u` in slip under a friction force.
    #[inline(always)]
    pub(super) fn block_acceleration(&self, x: &[f64; 4], f: f64, force: f64) -> f64 {
        ((force - self.damper_n_s_per_m * x[1])
            + (self.participation * f - self.stiffness_n_per_m * x[0]))
            * self.per_block_mass
    }

    /// The force that keeps the block stuck under an acceleration.
    #[inline(always)]
    pub(super) fn demand_n(&self, x: &[f64; 4], a: f64) -> f64 {
        (self.block_mass_kg * a + self.stiffness_n_per_m * x[0])
            - self.participation * self.restoring(x)
    }

    /// Energy norm of a state.
    #[inline(always)]
    pub(super) fn norm(&self, x: &[f64; 4]) -> f64 {
        let momentum = x[3] + self.participation * x[1];
        let of_block = self.stiffness_n_per_m * (x[0] * x[0]) + self.block_mass_kg * (x[1] * x[1]);
        (of_block + (self.omega2 * (x[2] * x[2]) + momentum * momentum)).sqrt()
    }

    /// Largest value of a row on states of norm 1; in stick on those of the structure alone.
    fn dual_norm(&self, slip: bool, c: [f64; 4]) -> f64 {
        let of_structure = c[2] * c[2] / self.omega2 + c[3] * c[3];
        let of_block = if slip {
            let of_s = if c[0] == 0.0 { 0.0 } else { c[0] * c[0] / self.stiffness_n_per_m };
            let momentum = c[1] - c[3] * self.participation;
            of_s + momentum * momentum * self.per_block_mass
        } else {
            0.0
        };
        (of_block + of_structure).sqrt()
    }

    /// Derivative of a state under an acceleration and a friction force.
    fn rate(&self, slip: bool, x: [f64; 4], a: f64, force: f64) -> [f64; 4] {
        let f = self.restoring(&x);
        if slip {
            let u = self.block_acceleration(&x, f, force);
            [x[1], u - a, x[3], -f - self.participation * u]
        } else {
            [0.0, 0.0, x[3], -f - self.participation * a]
        }
    }
}

impl Tables {
    /// Tables of a system with at most one storey, unless the step is too long for its rates.
    pub(in crate::solver) fn new<V: PerStorey>(
        system: &System<V>,
        extremes: &Extremes<V>,
        dt_s: f64,
    ) -> Option<Self> {
        let pieces = (dt_s * system.slip_rate_rad_per_s / MAX_RATE_STEP).ceil().max(1.0);
        if !(system.storeys() <= 1 && pieces <= MOST_PIECES) {
            return None;
        }
        let plant = Plant::new(system);
        let piece_s = dt_s / pieces;
        let shape = system.shapes.as_ref().first().copied().unwrap_or(0.0);
        let tracked = TrackedRows::new(&plant, shape, extremes);
        let (stick, quiet_taps) = Phase::new(&plant, &tracked, false, [dt_s, piece_s], pieces);
        let (slip, _) = Phase::new(&plant, &tracked, true, [dt_s, piece_s], pieces);
        let quiet = Quiet::new(&plant, &tracked, &stick, quiet_taps, dt_s);
        Some(Self { plant, pieces: pieces as usize, piece_s, stick, slip, quiet })
    }
}

/// Coefficients of the tracked quantities.
struct TrackedRows {
    stick: [[f64; 8]; 6],
    slip: [[f64; 8]; 6],
    /// Lanes from which the slope's pull is taken.
    slope: Eight,
}

/// Rows of [`TrackedRows`]: of `s`, `ṡ`, `η`, `f`, the acceleration, the friction force.
const OF_A: usize = 4;
const OF_FORCE: usize = 5;

impl TrackedRows {
    fn new<V: PerStorey>(plant: &Plant, shape: f64, extremes: &Extremes<V>) -> Self {
        let (k1, c1) = (plant.stiffness_n_per_m, plant.damper_n_s_per_m);
        let (l, per_mass) = (plant.participation, plant.per_block_mass);
        let [arm, half] = extremes.one_storey_arm();
        let mut slip = [[0.0; 8]; 6];
        slip[1][tracked::VELOCITY] = 1.0;
        let u = [-k1 * per_mass, -c1 * per_mass, 0.0, l * per_mass, 0.0, per_mass];
        for (column, u) in slip.iter_mut().zip(u) {
            column[tracked::BLOCK] = u;
            column[tracked::OVERTURNING] = half * u;
        }
        (slip[0][tracked::SLIDER], slip[1][tracked::SLIDER]) = (-k1, -c1);
        slip[OF_FORCE][tracked::SLIDER] = 1.0;
        slip[OF_FORCE][tracked::FRICTION] = 1.0;
        let mut stick = [[0.0; 8]; 6];
        stick[OF_A][tracked::BLOCK] = 1.0;
        stick[OF_A][tracked::OVERTURNING] = half;
        stick[0][tracked::FRICTION] = k1;
        for j in [tracked::SLIDER, tracked::FRICTION] {
            stick[OF_A][j] = plant.block_mass_kg;
            stick[3][j] = -l;
        }
        for columns in [&mut slip, &mut stick] {
            columns[3][tracked::BASE_SHEAR] = l;
            columns[3][tracked::OVERTURNING] -= arm;
            columns[2][DISPLACEMENT] = shape;
            columns[3][ACCELERATION] = -shape;
        }
        let mut slope = [0.0; 8];
        slope[tracked::BLOCK] = extremes.slope();
        // A rigid block has no floor whose acceleration could be told.
        slope[ACCELERATION] = if l == 0.0 { 0.0 } else { extremes.slope() };
        Self { stick, slip, slope: Eight(slope) }
    }

    fn columns(&self, slip: bool) -> &[[f64; 8]; 6] {
        if slip { &self.slip } else { &self.stick }
    }

    /// Row of a quantity over the state.
    fn over_state(&self, plant: &Plant, slip: bool, j: usize) -> [f64; 4] {
        let c = self.columns(slip);
        [c[0][j], c[1][j], c[2][j] + plant.omega2 * c[3][j], plant.decay * c[3][j]]
    }
}

/// Place of the storey's displacement, and drift, among the tracked quantities of a block.
pub(in crate::solver) const DISPLACEMENT: usize = 6;
/// Place of the floor's acceleration.
pub(in crate::solver) const ACCELERATION: usize = 7;

type Matrix = [[f64; 4]; 4];

/// What unit inputs leave at the end of one sample: of the state, of a constant acceleration, of
/// one that rises from 0 to 1, of a friction force.
struct Sample {
    state: Matrix,
    constant: [f64; 4],
    ramp: [f64; 4],
    force: [f64; 4],
}

impl Phase {
    fn new(
        plant: &Plant,
        tracked: &TrackedRows,
        slip: bool,
        [dt_s, piece_s]: [f64; 2],
        pieces: f64,
    ) -> (Self, [Four; QUIET]) {
        let series = series(plant, slip, piece_s);
        let sample = Sample::new(&series, slip, pieces as usize);
        let e = &sample.state;
        let before: [f64; 4] = core::array::from_fn(|i| sample.constant[i] - sample.ramp[i]);
        // What a unit at a sample leaves behind: it ramps down in the next sample, and up before.
        let mut taps = [Four::ZERO; QUIET];
        taps[0] = Four(sample.ramp);
        for j in 1..if slip { BLOCK } else { QUIET } {
            let from = taps[j - 1].0;
            taps[j] = Four(times(e, from));
            if j == 1 {
                taps[1] = Four(core::array::from_fn(|i| taps[1].0[i] + before[i]));
            }
        }
        let tap: [Four; BLOCK] = core::array::from_fn(|j| taps[j]);
        let identity: [Four; 4] =
            core::array::from_fn(|j| Four(core::array::from_fn(|i| f64::from(u8::from(i == j)))));
        let mut power = [identity; BLOCK + 1];
        let mut first = [Four::ZERO; BLOCK + 1];
        let mut force = [Four::ZERO; BLOCK + 1];
        for k in 1..=BLOCK {
            power[k] = power[k - 1].map(|column| Four(times(e, column.0)));
            first[k] = Four(if k == 1 { before } else { times(e, first[k - 1].0) });
            let moved = times(e, force[k - 1].0);
            force[k] = Four(core::array::from_fn(|i| moved[i] + sample.force[i]));
        }
        let row = |of: [f64; 4]| Row::new(of, &power, &first, &tap, &force);
        let rows = [
            row([1.0, 0.0, 0.0, 0.0]),
            row([0.0, 1.0, 0.0, 0.0]),
            row([0.0, 0.0, 1.0, 0.0]),
            row([0.0, 0.0, plant.omega2, plant.decay]),
        ];
        let columns = tracked.columns(slip);
        let column = |j: usize| Eight(columns[j]);
        let rows_of_state: [[f64; 4]; 8] =
            core::array::from_fn(|j| tracked.over_state(plant, slip, j));
        let sizes =
            core::array::from_fn(|i| Eight(core::array::from_fn(|j| rows_of_state[j][i].abs())));
        let view = View {
            columns: core::array::from_fn(column),
            of_acceleration: column(OF_A),
            of_force: column(OF_FORCE),
            slope: tracked.slope,
            sizes,
        };
        // In slip a chord spans a block, in stick a sample.
        let span_s = if slip { BLOCK as f64 * dt_s } else { dt_s };
        let bend = Bend::new(plant, slip, &rows_of_state, span_s, dt_s);
        (Self { series, power, first, tap, force, rows, view, bend }, taps)
    }
}

impl Bend {
    /// Over `span_s`, within a block: `g″` of `g = c·x` is
    /// `c A² x + c A b a + c A d T + c b ȧ`, and the norm of the state grows in the block by no more
    /// than its duration times `√M_tot |a| + |T|/√M1`.
    fn new(plant: &Plant, slip: bool, rows: &[[f64; 4]; 8], span_s: f64, dt_s: f64) -> Self {
        let a: Matrix = core::array::from_fn(|j| {
            let unit = core::array::from_fn(|i| f64::from(u8::from(i == j)));
            plant.rate(slip, unit, 0.0, 0.0)
        });
        let on_a = plant.rate(slip, [0.0; 4], 1.0, 0.0);
        let on_force = if slip { plant.rate(slip, [0.0; 4], 0.0, 1.0) } else { [0.0; 4] };
        let reach = 0.125 * span_s * span_s;
        let block_s = BLOCK as f64 * dt_s;
        let growth = if slip { plant.root_mass } else { plant.participation };
        let mut bend = Self {
            of_norm: Eight::ZERO,
            of_acceleration: Eight::ZERO,
            of_rate: Eight::ZERO,
            of_force: Eight::ZERO,
        };
        for (j, row) in rows.iter().enumerate() {
            let once: [f64; 4] = core::array::from_fn(|i| dot(row, &a[i]));
            let twice: [f64; 4] = core::array::from_fn(|i| dot(&once, &a[i]));
            let on_norm = plant.dual_norm(slip, twice);
            bend.of_norm.0[j] = reach * on_norm;
            bend.of_acceleration.0[j] =
                reach * (dot(&once, &on_a).abs() + on_norm * (block_s * growth));
            bend.of_rate.0[j] = reach * dot(row, &on_a).abs();
            bend.of_force.0[j] =
                reach * (dot(&once, &on_force).abs() + on_norm * (block_s * plant.per_root_block));
        }
        bend
    }
}

impl Quiet {
    fn new(
        plant: &Plant,
        tracked: &TrackedRows,
        stick: &Phase,
        tap: [Four; QUIET],
        dt_s: f64,
    ) -> Self {
        let square = |m: &[Four; 4]| m.map(|column| Four(times(&m.map(|c| c.0), column.0)));
        let power = square(&square(&stick.power[BLOCK]));
        // The first sample's ramp down has the whole stretch before it.
        let by_16 = square(&stick.power[BLOCK]).map(|c| c.0);
        let by_8 = stick.power[BLOCK].map(|c| c.0);
        let first = Four(times(&by_16, times(&by_8, stick.first[BLOCK].0)));
        let columns = tracked.columns(false);
        let mut of_norm = [0.0; 8];
        let mut of_acceleration = [[0.0; 8]; 2];
        let mut of_slope = [0.0; 8];
        let slope = tracked.slope.0;
        for j in 0..8 {
            of_norm[j] = plant.dual_norm(false, tracked.over_state(plant, false, j));
            for (of_acceleration, samples) in of_acceleration.iter_mut().zip([BLOCK, QUIET]) {
                let growth = samples as f64 * dt_s * plant.participation;
                of_acceleration[j] = of_norm[j] * growth + columns[OF_A][j].abs();
            }
            of_slope[j] = slope[j].abs();
        }
        // The block's own acceleration in stick is the table's, which is the load less the slope.
        of_slope[tracked::BLOCK] = -of_slope[tracked::BLOCK];
        Self {
            power,
            first,
            tap,
            of_norm: Eight(of_norm),
            of_acceleration: of_acceleration.map(Eight),
            of_s: Eight(columns[0].map(f64::abs)),
            of_slope: Eight(of_slope),
        }
    }
}

impl Row {
    fn new(
        of: [f64; 4],
        power: &[[Four; 4]; BLOCK + 1],
        first: &[Four; BLOCK + 1],
        tap: &[Four; BLOCK],
        force: &[Four; BLOCK + 1],
    ) -> Self {
        let lanes = |value: &dyn Fn(usize) -> f64| Eight(core::array::from_fn(|k| value(k + 1)));
        Self {
            state: core::array::from_fn(|j| lanes(&|k| dot(&of, &power[k][j].0))),
            first: lanes(&|k| dot(&of, &first[k].0)),
            tap: {
                let taps: [f64; BLOCK] = core::array::from_fn(|j| dot(&of, &tap[j].0));
                core::array::from_fn(|m| lanes(&|k| if k > m { taps[k - 1 - m] } else { 0.0 }))
            },
            force: lanes(&|k| dot(&of, &force[k].0)),
        }
    }
}

impl Sample {
    fn new(series: &[[Four; 7]; DEGREE], slip: bool, pieces: usize) -> Self {
        let sum = |input: usize| {
            let mut end = [0.0; 4];
            for order in series.iter().rev() {
                for (end, c) in end.iter_mut().zip(order[input].0) {
                    *end += c;
                }
            }
            end
        };
        let mut piece: Matrix = core::array::from_fn(sum);
        for (j, column) in piece.iter_mut().enumerate() {
            column[j] += 1.0;
        }
        let (of_a, of_change) = (sum(4), sum(5));
        let of_force = if slip { sum(6) } else { [0.0; 4] };
        let per_piece = 1.0 / pieces as f64;
        let run = |mut x: [f64; 4], a: [f64; 2], force: f64| {
            for i in 0..pieces {
                let start = a[0] + (a[1] - a[0]) * (per_piece * i as f64);
                let change = (a[1] - a[0]) * per_piece;
                let moved = times(&piece, x);
                x = core::array::from_fn(|i| {
                    moved[i] + (of_a[i] * start + of_change[i] * change) + of_force[i] * force
                });
            }
            x
        };
        let unit = |j: usize| core::array::from_fn(|i| f64::from(u8::from(i == j)));
        Self {
            state: core::array::from_fn(|j| run(unit(j), [0.0; 2], 0.0)),
            constant: run([0.0; 4], [1.0, 1.0], 0.0),
            ramp: run([0.0; 4], [0.0, 1.0], 0.0),
            force: run([0.0; 4], [0.0; 2], 1.0),
        }
    }
}

/// Taylor coefficients of the state from the first on, over a piece, of every unit input.
fn series(plant: &Plant, slip: bool, piece_s: f64) -> [[Four; 7]; DEGREE] {
    let mut table = [[Four::ZERO; 7]; DEGREE];
    for input in 0..7 {
        let mut x: [f64; 4] = core::array::from_fn(|i| f64::from(u8::from(i == input)));
        if !slip {
            (x[0], x[1]) = (0.0, 0.0);
        }
        for (k, order) in table.iter_mut().enumerate() {
            // The acceleration counts at the start, its change in the order after.
            let a = f64::from(u8::from(input == 4 + k));
            let force = f64::from(u8::from(input == 6 && k == 0));
            let step = piece_s / (k + 1) as f64;
            x = plant.rate(slip, x, if k < 2 { a } else { 0.0 }, force).map(|rate| step * rate);
            order[input] = Four(x);
        }
    }
    table
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

fn times(columns: &Matrix, x: [f64; 4]) -> [f64; 4] {
    core::array::from_fn(|i| {
        (columns[0][i] * x[0] + columns[1][i] * x[1])
            + (columns[2][i] * x[2] + columns[3][i] * x[3])
    })
}
