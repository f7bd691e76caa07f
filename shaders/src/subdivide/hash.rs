//! Hashes of commands. They need not stand up to an adversary: lists with equal ones are compared, or
//! the number of lists is an estimate.

const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

/// The hash of nothing.
pub(super) const START: u64 = FACTOR;

pub(super) fn mix(hash: u64, word: u64) -> u64 {
    (hash ^ word).wrapping_mul(FACTOR).rotate_left(29)
}

/// Of one command.
pub(super) fn of([a, c, b, tag]: [u32; 4]) -> u64 {
    let pair = |low: u32, high: u32| u64::from(high) << 32 | u64::from(low);
    mix(mix(START, pair(a, c)), pair(b, tag))
}

/// Of several.
pub(super) fn of_all(commands: &[[u32; 4]]) -> u64 {
    let hashes = commands.iter().map(|&command| of(command));
    hashes.fold(START, mix)
}
