//! What two evaluators answer to the same lookups.

/// Positions of the lookups of which a channel differs by more than `tolerance`, or is no number.
///
/// # Panics
/// When one side answers more lookups than the other.
pub fn differing(a: &[[f32; 4]], b: &[[f32; 4]], tolerance: f32) -> Vec<usize> {
    assert_eq!(a.len(), b.len(), "one colour a query");
    let same = |(a, b): (&f32, &f32)| (a - b).abs() <= tolerance;
    let pairs = a.iter().zip(b).enumerate();
    pairs
        .filter(|(_, (a, b))| !a.iter().zip(*b).all(same))
        .map(|(index, _)| index)
        .collect()
}
