//! Vector instructions, chosen when the program runs.

use fearless_simd::Level;
use fearless_simd::prelude::*;

/// Vector instructions of the processor, as found when the program runs: AVX2, or those that every
/// processor of its kind has.
#[derive(Clone, Copy, Debug)]
pub struct InstructionSet(Level);

/// Work that an instruction set does.
pub(super) trait Job {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

impl InstructionSet {
    /// The best of this machine.
    #[must_use]
    pub fn best() -> Self {
        let level = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some(avx2) = level.as_avx2() {
            return Self(Level::Avx2(avx2));
        }
        Self(portable(level))
    }

    /// All of this machine that a response can be computed by; with the feature `scalar` also no
    /// vector instructions at all.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let all = [Self::best(), Self(portable(Level::new()))];
        #[cfg(feature = "scalar")]
        let all = all.into_iter().chain([Self(Level::fallback())]);
        all.into_iter().collect()
    }

    #[inline(always)]
    pub(super) fn run<J: Job>(self, job: J) -> J::Output {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            #[cfg(feature = "scalar")]
            if let Level::Fallback(simd) = self.0 {
                return job.run(simd);
            }
            if let Level::Avx2(simd) = self.0 {
                return simd.vectorize(
                    #[inline(always)]
                    || job.run(simd),
                );
            }
            if let Some(simd) = self.0.as_sse2() {
                return simd.vectorize(
                    #[inline(always)]
                    || job.run(simd),
                );
            }
            unreachable!("every processor that this is built for has SSE2")
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            fearless_simd::dispatch!(self.0, simd => job.run(simd))
        }
    }
}

/// What every processor of this kind has.
fn portable(level: Level) -> Level {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(sse2) = level.as_sse2() {
        return Level::Sse2(sse2);
    }
    level
}
