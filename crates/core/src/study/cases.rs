//! The cases of a study in their order.

/// Numbers of records, levels and samples: runs go through all of them, the last fastest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cases {
    /// Number of records, ≥ 1; a made motion counts as one.
    pub records: u64,
    /// Number of levels, ≥ 1.
    pub levels: u64,
    /// Number of samples, ≥ 1.
    pub samples: u64,
    /// Number of bounds of friction that each sample is run with, ≥ 1.
    pub bounds: u64,
}

/// Indices of one run, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// Which record.
    pub record: u64,
    /// Which level.
    pub level: u64,
    /// Which sample.
    pub sample: u64,
    /// Which bound of friction.
    pub bound: u64,
}

impl Cases {
    /// Number of runs; `None` where it is beyond counting.
    #[must_use]
    pub fn runs(&self) -> Option<u64> {
        let motions = self.records.checked_mul(self.levels)?;
        motions.checked_mul(self.samples)?.checked_mul(self.bounds)
    }

    /// Number of models: samples times bounds. Their runs of one record at one level stand together.
    #[must_use]
    pub fn models(&self) -> u64 {
        self.samples * self.bounds
    }

    /// The case of a run.
    #[must_use]
    pub fn case(&self, run: u64) -> Case {
        let (motion, model) = (run / self.models(), run % self.models());
        Case {
            record: motion / self.levels,
            level: motion % self.levels,
            sample: model / self.bounds,
            bound: model % self.bounds,
        }
    }

    /// The run of a case.
    #[must_use]
    pub fn run(&self, case: Case) -> u64 {
        let motion = case.record * self.levels + case.level;
        (motion * self.samples + case.sample) * self.bounds + case.bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_runs_count_bounds_and_samples_fastest() {
        let cases = Cases { records: 3, levels: 2, samples: 5, bounds: 2 };
        let case = |record, level, sample, bound| Case { record, level, sample, bound };
        assert_eq!((cases.runs(), cases.models()), (Some(60), 10));
        assert_eq!(cases.case(0), case(0, 0, 0, 0));
        assert_eq!(cases.case(1), case(0, 0, 0, 1));
        assert_eq!(cases.case(9), case(0, 0, 4, 1));
        assert_eq!(cases.case(10), case(0, 1, 0, 0));
        assert_eq!(cases.case(20), case(1, 0, 0, 0));
        assert_eq!(cases.case(59), case(2, 1, 4, 1));
        for run in 0..60 {
            assert_eq!(cases.run(cases.case(run)), run);
        }
        let many = Cases { records: 1 << 30, levels: 1 << 30, samples: 1 << 30, bounds: 1 };
        assert_eq!(many.runs(), None);
    }
}
