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
}

impl Cases {
    /// Number of runs; `None` where it is beyond counting.
    #[must_use]
    pub fn runs(&self) -> Option<u64> {
        self.records.checked_mul(self.levels)?.checked_mul(self.samples)
    }

    /// The case of a run.
    #[must_use]
    pub fn case(&self, run: u64) -> Case {
        let group = run / self.samples;
        Case { record: group / self.levels, level: group % self.levels, sample: run % self.samples }
    }

    /// The run of a case.
    #[must_use]
    pub fn run(&self, case: Case) -> u64 {
        (case.record * self.levels + case.level) * self.samples + case.sample
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_runs_count_samples_fastest() {
        let cases = Cases { records: 3, levels: 2, samples: 5 };
        assert_eq!(cases.runs(), Some(30));
        assert_eq!(cases.case(0), Case { record: 0, level: 0, sample: 0 });
        assert_eq!(cases.case(4), Case { record: 0, level: 0, sample: 4 });
        assert_eq!(cases.case(5), Case { record: 0, level: 1, sample: 0 });
        assert_eq!(cases.case(10), Case { record: 1, level: 0, sample: 0 });
        assert_eq!(cases.case(29), Case { record: 2, level: 1, sample: 4 });
        for run in 0..30 {
            assert_eq!(cases.run(cases.case(run)), run);
        }
        let many = Cases { records: 1 << 30, levels: 1 << 30, samples: 1 << 30 };
        assert_eq!(many.runs(), None);
    }
}
