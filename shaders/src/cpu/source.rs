//! Twin of `vtex/source_*.wgsl`: the colour of an entry.

use super::{Lookup, Sampler, color, gradient, image, paint};
use crate::layout::{item, paint as layout};

/// A colour, premultiplied.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// sRGB-encoded, as colours are composited.
    pub(super) encoded: [f32; 4],
    /// In linear light; its alpha is negative where it is not known.
    pub(super) linear: [f32; 4],
}

/// Linear light that is not known.
const UNKNOWN: [f32; 4] = [0.0, 0.0, 0.0, -1.0];

pub(super) fn source(sampler: &Sampler<'_>, head: u32, uv: [f32; 2], lookup: &Lookup) -> Shown {
    let index = head & item::INDEX_MASK;
    if head & item::KIND_MASK == item::IMAGE {
        let linear = image::entry(sampler, index, uv, lookup);
        return Shown {
            encoded: color::encode_premultiplied(linear),
            linear,
        };
    }
    let [first, second, third, fourth] = paint::words(sampler, index);
    let varies = second == layout::GRADIENT;
    let straight = if varies {
        gradient::gradient(sampler, first, uv)
    } else {
        paint::unpack([third, fourth])
    };
    let [r, g, b, a] = straight;
    Shown {
        encoded: [r * a, g * a, b * a, a],
        linear: if varies {
            UNKNOWN
        } else {
            paint::unpack([first, second])
        },
    }
}
