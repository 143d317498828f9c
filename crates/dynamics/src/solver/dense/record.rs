//! Rows of a history: a batch by rows, each number at all its samples at once.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::ahead::Ahead;
use super::lanes::{BATCH, eight};
use crate::linear::{QUIET, Window};
use crate::response::Mode;
use crate::slider::Contact;
use crate::solver::recorder::Knot;

impl<S: Simd> Ahead<'_, '_, S> {
    /// Records samples of a batch, if a history is wanted.
    #[inline(always)]
    pub(super) fn record<const SLIP: bool>(
        &mut self,
        sample: usize,
        steps: usize,
        x: f64x4<S>,
        force_n: f64,
    ) {
        if self.shared.recorder.is_some() {
            self.record_batch::<SLIP>(sample, steps, x.to_array(), force_n);
        }
    }

    /// The same of many samples of stick.
    #[inline(always)]
    pub(super) fn record_quiet(&mut self, sample: usize, mut x: f64x4<S>) {
        if self.shared.recorder.is_some() {
            for from in (sample..sample + QUIET).step_by(BATCH) {
                self.record_batch::<false>(from, BATCH, x.to_array(), 0.0);
                x = self.after::<false>(BATCH, x, self.window(from), 0.0);
            }
        }
    }

    #[inline(never)]
    fn record_batch<const SLIP: bool>(
        &mut self,
        sample: usize,
        steps: usize,
        x: [f64; 4],
        force_n: f64,
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let (storey, shape) = (&self.of.tables.storey, self.of.tables.shape);
                let (a, rows) = (self.window(sample), &self.phase::<SLIP>().rows);
                let (k, c, l) = (
                    eight(simd, storey.stiffness_n_per_m),
                    eight(simd, storey.damper_n_s_per_m),
                    eight(simd, storey.participation),
                );
                let (slope, f0) = (shape.slope, storey.restoring(&x));
                let has_storey = shape.floor != 0.0;
                let (mut eta, mut rate) = (eight(simd, 0.0), eight(simd, 0.0));
                if has_storey {
                    eta = self.row::<SLIP>(&rows[2], x, a, force_n);
                    rate = self.row::<SLIP>(&rows[4], x, a, force_n);
                }
                let f = eight(simd, storey.omega2) * eta + eight(simd, storey.decay) * rate;
                let [s, w, block, friction];
                if SLIP {
                    let of_s = self.row::<SLIP>(&rows[0], x, a, force_n);
                    let of_w = self.row::<SLIP>(&rows[1], x, a, force_n);
                    let u = ((eight(simd, force_n) - c * of_w) + (l * f - k * of_s))
                        * eight(simd, storey.per_block_mass);
                    let first = storey.block_acceleration(&x, f0, force_n) - slope;
                    (s, w) = (window(x[0], of_s), window(x[1], of_w));
                    block = window(first, u - eight(simd, slope));
                    friction = [force_n; BATCH + 1];
                } else {
                    let of_spring = storey.stiffness_n_per_m * x[0];
                    let demand = self.row::<SLIP>(&rows[0], x, a, force_n);
                    (s, w) = ([x[0]; BATCH + 1], [0.0; BATCH + 1]);
                    let table = self.of.ground.table[sample..].first_chunk();
                    block = *table.unwrap_or(&[0.0; BATCH + 1]);
                    let first = storey.required_friction_n(&x, a[0]);
                    friction = window(first, demand + eight(simd, of_spring));
                }
                let mut of_storey = None;
                if has_storey {
                    let floor = eight(simd, shape.floor);
                    let acceleration = -(floor * f) - eight(simd, slope);
                    of_storey = Some([
                        window(shape.floor * x[2], floor * eta),
                        window(shape.floor * x[3], floor * rate),
                        window(-(shape.floor * f0) - slope, acceleration),
                    ]);
                }
                let (ground, mode) = (&self.of.ground, self.shared.course.block.mode);
                let samples = sample..sample + steps;
                let times = [&ground.times_s[samples.clone()], &ground.table[samples]];
                if let Some(recorder) = &mut self.shared.recorder {
                    recorder.store_samples(times, mode, Contact::Free);
                    recorder.store_batch(steps, [&s, &w, &block, &friction], of_storey.as_ref());
                }
            },
        );
    }

    /// Records the present state in a mode so long after a sample, if a history is wanted; as a row at the
    /// sample itself.
    #[inline(always)]
    pub(super) fn record_now(&mut self, sample: usize, at_s: f64, mode: Mode) {
        if self.shared.recorder.is_some() {
            self.record_knot(sample, at_s, mode);
        }
    }

    #[inline(never)]
    fn record_knot(&mut self, sample: usize, at_s: f64, mode: Mode) {
        let (x, ground) = (*self.shared.x, &self.of.ground);
        let length_s = ground.times_s[sample + 1] - ground.times_s[sample];
        let stretch = ground.stretch(sample, 0.0, length_s);
        let is_row = at_s == 0.0;
        let friction_n = self.force_n(mode);
        let knot = Knot {
            time_s: ground.times_s[sample] + at_s,
            mode,
            contact: Contact::Free,
            table: if is_row { ground.table[sample] } else { ground.table_at(sample, at_s) },
            acceleration: stretch.acceleration_at(at_s),
            state: &x,
            friction_n,
            force_n: match mode {
                Mode::Stick => self.shared.course.slider.hold(x[0]).force_n,
                Mode::Slip(_) => friction_n,
            },
        };
        if let Some(recorder) = &mut self.shared.recorder {
            recorder.knot(self.of.system, &knot, is_row);
        }
    }
}

/// A number at a sample and at the eight after it.
#[inline(always)]
fn window<S: Simd>(first: f64, later: f64x8<S>) -> Window {
    let mut all = [first; BATCH + 1];
    later.store_slice(&mut all[1..]);
    all
}
