//! Random numbers that are the same every time.

use std::f64::consts::TAU;

use kurbo::{BezPath, Circle, Point, Shape as _, Vec2};

/// `SplitMix64` (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in \[low, high).
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in \[0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.within(0.0, 1.0)
    }

    /// A uniform index of a list of `len`.
    pub(crate) fn index(&mut self, len: usize) -> usize {
        usize::try_from(self.below(len as u64)).unwrap()
    }

    /// Uniform below `count`.
    pub(crate) fn below(&mut self, count: u64) -> u64 {
        self.next_u64() % count
    }
}

/// A circle, star, ring, blob with crossings or polygon inside \[0, `size`\]^2 or a little outside.
pub(crate) fn random_outline(random: &mut Random, size: f64) -> BezPath {
    let center = Point::new(random.within(0.0, size), random.within(0.0, size));
    let radius = random.within(0.01, 0.2) * size;
    match random.below(5) {
        0 => Circle::new(center, radius).to_path(1e-4),
        1 => polygon(5, |k| {
            let angle = 2.0 * f64::from(k) * TAU / 5.0;
            center + radius * Vec2::from_angle(angle)
        }),
        2 => {
            let mut ring = Circle::new(center, radius).to_path(1e-4);
            ring.extend(
                Circle::new(center, 0.9 * radius)
                    .to_path(1e-4)
                    .reverse_subpaths(),
            );
            ring
        }
        3 => {
            let mut near = || {
                center
                    + Vec2::new(
                        random.within(-radius, radius),
                        random.within(-radius, radius),
                    )
            };
            let mut blob = BezPath::new();
            blob.move_to(near());
            for _ in 0..4 {
                blob.curve_to(near(), near(), near());
            }
            let start = blob.elements()[0].end_point().unwrap();
            blob.quad_to(near(), start);
            blob.close_path();
            blob
        }
        _ => {
            let corners = 3 + u32::try_from(random.below(6)).unwrap();
            let mut near = || {
                center
                    + Vec2::new(
                        random.within(-radius, radius),
                        random.within(-radius, radius),
                    )
            };
            polygon(corners, |_| near())
        }
    }
}

fn polygon(corners: u32, mut corner: impl FnMut(u32) -> Point) -> BezPath {
    let mut path = BezPath::new();
    let start = corner(0);
    path.move_to(start);
    for k in 1..corners {
        path.line_to(corner(k));
    }
    path.line_to(start);
    path.close_path();
    path
}
