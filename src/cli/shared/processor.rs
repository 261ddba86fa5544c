//! Whether the processor has the instructions that the program was built for, and whether it has better ones.
//! It chooses nothing: the width of the SIMD lanes is set when the program is built.

/// Instructions for the SIMD lanes: four numbers of 64 bits in one register with fused multiply and add, or what every processor
/// of its kind has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Instructions {
    Every,
    Avx2,
}

/// The instructions that the program was built for.
const BUILT_FOR: Instructions =
    if cfg!(all(target_feature = "avx2", target_feature = "fma")) { Instructions::Avx2 } else { Instructions::Every };

/// The instructions that this processor has. It is asked itself: what the compiler may assume is no answer here.
#[cfg(target_arch = "x86_64")]
fn available() -> Instructions {
    use std::arch::x86_64::{__cpuid, __cpuid_count};
    const FMA: u32 = 1 << 12;
    const AVX2: u32 = 1 << 5;
    let enough = __cpuid(0).eax >= 7 && __cpuid(1).ecx & FMA != 0 && __cpuid_count(7, 0).ebx & AVX2 != 0;
    if enough { Instructions::Avx2 } else { Instructions::Every }
}

#[cfg(not(target_arch = "x86_64"))]
fn available() -> Instructions {
    Instructions::Every
}

/// What a user has to know of the program's build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// It fits the processor.
    Suits,
    /// It would stop at the first instruction that the processor lacks.
    TooNew,
    /// It gives the same results, but takes several times as long as it could.
    TooOld,
}

/// How the program's build and this processor go together.
pub fn build() -> Build {
    judge(BUILT_FOR, available())
}

fn judge(built_for: Instructions, available: Instructions) -> Build {
    match (built_for, available) {
        (Instructions::Avx2, Instructions::Every) => Build::TooNew,
        (Instructions::Every, Instructions::Avx2) => Build::TooOld,
        _ => Build::Suits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_suits_only_processors_with_its_instructions() {
        use Instructions::{Avx2, Every};
        assert_eq!(judge(Avx2, Avx2), Build::Suits);
        assert_eq!(judge(Every, Every), Build::Suits);
        assert_eq!(judge(Avx2, Every), Build::TooNew);
        assert_eq!(judge(Every, Avx2), Build::TooOld);
        // The test itself ran up to here.
        assert_ne!(build(), Build::TooNew);
    }
}
