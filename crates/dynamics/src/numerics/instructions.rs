//! Vector instructions, chosen when the program runs.

use fearless_simd::Level;

/// Vector instructions of the processor, as found when the program runs: AVX2, or those that every
/// processor of its kind has.
#[derive(Clone, Copy, Debug)]
pub struct InstructionSet(Level);

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

    pub fn level(self) -> Level {
        self.0
    }
}

/// Work by the instructions of a set, all that is inlined into it included: `vectorize!(set, simd => work)`.
macro_rules! vectorize {
    ($set:expr, $simd:ident => $work:expr) => {{
        let level = $crate::numerics::InstructionSet::level($set);
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            match level {
                #[cfg(feature = "scalar")]
                fearless_simd::Level::Fallback($simd) => $work,
                fearless_simd::Level::Avx2($simd) => fearless_simd::Simd::vectorize(
                    $simd,
                    #[inline(always)]
                    || $work,
                ),
                level => match level.as_sse2() {
                    Some($simd) => fearless_simd::Simd::vectorize(
                        $simd,
                        #[inline(always)]
                        || $work,
                    ),
                    None => unreachable!("every processor that this is built for has SSE2"),
                },
            }
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            fearless_simd::dispatch!(level, $simd => $work)
        }
    }};
}
pub(crate) use vectorize;

/// What every processor of this kind has.
fn portable(level: Level) -> Level {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(sse2) = level.as_sse2() {
        return Level::Sse2(sse2);
    }
    level
}
