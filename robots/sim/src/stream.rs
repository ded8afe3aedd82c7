use crate::Random;

/// Random numbers of a seed for one purpose, so that no purpose changes the numbers of another.
pub const fn stream(seed: u64, purpose: u64) -> Random {
    Random::new(Random::new(seed).bits() ^ Random::new(purpose.wrapping_mul(0x9e37_79b9)).bits())
}
