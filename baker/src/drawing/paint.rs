//! What fills a shape.

use std::sync::Arc;

use vtex_format::Gradient;

/// A colour, or colours that depend on the place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Straight alpha, sRGB-encoded, every opacity folded in.
    Solid([f32; 4]),
    /// In uv of the canvas, every opacity folded in.
    Gradient(Arc<Gradient>),
}

impl Paint {
    /// Opaque black.
    pub(crate) const BLACK: Self = Self::Solid([0.0, 0.0, 0.0, 1.0]);

    /// Whether it hides what lies behind it, everywhere.
    #[cfg(test)]
    pub(crate) fn is_opaque(&self) -> bool {
        match self {
            Self::Solid([.., alpha]) => *alpha >= 1.0,
            Self::Gradient(gradient) => gradient.is_opaque(),
        }
    }

    /// With every colour changed, straight alpha, sRGB-encoded.
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

    /// Whether anything of it can be seen.
    pub(crate) fn shows(&self) -> bool {
        match self {
            Self::Solid([.., alpha]) => *alpha > 0.0,
            Self::Gradient(gradient) => gradient.stops.iter().any(|stop| stop.color[3] > 0.0),
        }
    }
}
