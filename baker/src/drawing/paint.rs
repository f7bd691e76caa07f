//! What fills a shape.

use std::sync::Arc;

use vtex_format::Gradient;

/// A colour, or a gradient.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Straight alpha, sRGB-encoded, with every opacity folded in.
    Solid([f32; 4]),
    /// A gradient in uv, with every opacity folded in.
    Gradient(Arc<Gradient>),
}

impl Paint {
    /// Opaque black.
    pub(crate) const BLACK: Self = Self::Solid([0.0, 0.0, 0.0, 1.0]);

    /// Whether it is opaque everywhere.
    #[cfg(test)]
    pub(crate) fn is_opaque(&self) -> bool {
        match self {
            Self::Solid([.., alpha]) => *alpha >= 1.0,
            Self::Gradient(gradient) => gradient.is_opaque(),
        }
    }

    /// The paint with `change` applied to every colour: straight alpha, sRGB-encoded.
    pub(crate) fn mapped(self, change: impl Fn([f32; 4]) -> [f32; 4]) -> Self {
        match self {
            Self::Solid(color) => Self::Solid(change(color)),
            Self::Gradient(gradient) => {
                let mut gradient = Arc::unwrap_or_clone(gradient);
                for stop in &mut gradient.stops {
                    stop.color = change(stop.color);
                }
                Self::Gradient(Arc::new(gradient))
            }
        }
    }

    /// Whether it paints anything: some alpha is above 0.
    pub(crate) fn shows(&self) -> bool {
        match self {
            Self::Solid([.., alpha]) => *alpha > 0.0,
            Self::Gradient(gradient) => gradient.stops.iter().any(|stop| stop.color[3] > 0.0),
        }
    }
}
