//! The chi-squared test of a sampling routine, as in Mitsuba and PBRT: directions are counted in bins of the
//! sphere, and each bin should have what the density, integrated over it, promises.

use super::Probe;

/// Rings and sectors of the sphere.
const RINGS: usize = 16;
const SECTORS: usize = 32;
const BINS: usize = RINGS * SECTORS;
/// Samples: workgroups of 64 with as many each as the shader says.
const GROUPS: u32 = 512;
const SAMPLES: u32 = GROUPS * 64 * 8;

/// Kernels around `subject_sample(stream) -> vec4f`, a direction and its density or 0 for none, and
/// `subject_pdf(direction) -> f32`.
pub(super) const KERNELS: &str = "
const RINGS: u32 = 16u;
const SECTORS: u32 = 32u;

// Directions that are no direction are counted behind all bins, and those whose density is not what
// subject_pdf says behind these.
@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    var stream = rng_stream(7u, id.x, 3u);
    for (var i = 0u; i < 8u; i++) {
        let sample = subject_sample(&stream);
        if sample.w <= 0.0 {
            atomicAdd(&proof_output[RINGS * SECTORS], 1u);
            continue;
        }
        let around = atan2(sample.y, sample.x) / 6.2831853 + 0.5;
        let ring = min(u32((0.5 - 0.5 * sample.z) * f32(RINGS)), RINGS - 1u);
        let sector = min(u32(around * f32(SECTORS)), SECTORS - 1u);
        atomicAdd(&proof_output[ring * SECTORS + sector], 1u);
        let pdf = subject_pdf(sample.xyz);
        if abs(pdf - sample.w) > 0.01 * sample.w {
            atomicAdd(&proof_output[RINGS * SECTORS + 1u], 1u);
        }
    }
}

// Few places each: lavapipe ends the loops of an invocation after 65,535 rounds together.
@compute @workgroup_size(64)
fn expect(@builtin(global_invocation_id) id: vec3u) {
    let bin = id.x / 512u;
    var sum = 0.0;
    for (var i = 0u; i < 8u; i++) {
        let place = id.x % 512u * 8u + i;
        let at = (vec2f(f32(place / 64u), f32(place % 64u)) + 0.5) / 64.0;
        let height = 1.0 - 2.0 * (f32(bin / SECTORS) + at.x) / f32(RINGS);
        let angle = 6.2831853 * ((f32(bin % SECTORS) + at.y) / f32(SECTORS) - 0.5);
        let radius = sqrt(max(1.0 - height * height, 0.0));
        sum += subject_pdf(vec3f(radius * cos(angle), radius * sin(angle), height));
    }
    let area = 12.5663706 / f32(RINGS * SECTORS);
    atomicStore(&proof_output[id.x], bitcast<u32>(sum * area / 4096.0));
}
";

/// How exact a test can be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slack {
    /// Share of samples whose density may differ from what it is computed as, by rounding at edges.
    pub(super) apart: f64,
    /// By which share of it and of its neighbours a bin may be off, where densities have edges that 64 by 64
    /// places a bin do not resolve.
    pub(super) edges: f64,
}

/// Runs the test for one input, and panics where it fails.
pub(super) fn check(probe: &Probe, name: &str, input: &[f32], slack: Slack) {
    let counted = probe.run("count", input, BINS + 2, GROUPS);
    let bins = u32::try_from(BINS).unwrap();
    let expected = probe.run("expect", input, BINS * 512, 8 * bins);
    let samples = f64::from(SAMPLES);
    let sum = |row: &[u32]| -> f64 { row.iter().map(|&w| f64::from(f32::from_bits(w))).sum() };
    let mut expected: Vec<f64> = expected.chunks(512).map(|row| sum(row) * samples).collect();
    let whole: f64 = expected.iter().sum();
    assert!(
        whole <= 1.002 * samples,
        "{name}: the density integrates to {}",
        whole / samples
    );
    // What is missing are samples that are no direction.
    expected.push((samples - whole).max(0.0));
    let apart = f64::from(counted[BINS + 1]) / samples;
    assert!(
        apart <= slack.apart,
        "{name}: {apart} of the densities are others"
    );
    let near = |index: usize| -> f64 {
        let (ring, sector) = (index / SECTORS, index % SECTORS);
        let rings = ring.saturating_sub(1)..RINGS.min(ring + 2);
        let sectors = [SECTORS - 1, 0, 1].map(|step| (sector + step) % SECTORS);
        let bins = rings.flat_map(|ring| sectors.map(|sector| expected[ring * SECTORS + sector]));
        bins.fold(0.0, f64::max)
    };
    let mut off: Vec<f64> = (0..BINS).map(|index| slack.edges * near(index)).collect();
    off.push(slack.edges * samples);
    let score = score(&counted[..=BINS], &expected, &off);
    assert!(score.abs() < 5.0, "{name}: {score} standard deviations");
}

/// The statistic as a number of standard deviations: Wilson and Hilferty 1931.
fn score(counted: &[u32], expected: &[f64], off: &[f64]) -> f64 {
    // Bins that expect little are taken together, least first.
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|&a, &b| expected[a].total_cmp(&expected[b]));
    let (mut statistic, mut freedom) = (0.0, -1.0);
    let mut pool = (0.0, 0.0, 0.0);
    for index in order {
        let square = off[index] * off[index];
        pool = (
            pool.0 + f64::from(counted[index]),
            pool.1 + expected[index],
            pool.2 + square,
        );
        if pool.1 >= 10.0 {
            statistic += (pool.0 - pool.1) * (pool.0 - pool.1) / (pool.1 + pool.2);
            freedom += 1.0;
            pool = (0.0, 0.0, 0.0);
        }
    }
    // What is left over must be little.
    let most = pool.1 + 4.0 * (10.0 + pool.2).sqrt();
    assert!(pool.0 <= most, "{} samples where none are expected", pool.0);
    if freedom < 1.0 {
        return 0.0;
    }
    let spread = 2.0 / (9.0 * freedom);
    ((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

#[test]
fn the_score_knows_chance_from_bias() {
    let even = vec![1000.0; 256];
    let alike: Vec<u32> = (0..256).map(|i| 1000 + i * 37 % 63 - 31).collect();
    assert!(score(&alike, &even, &[0.0; 256]) < 3.0);
    let off: Vec<u32> = (0..256).map(|i| 1000 + 2 * (i * 37 % 63)).collect();
    assert!(score(&off, &even, &[0.0; 256]) > 5.0);
}
