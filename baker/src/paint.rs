//! What fills a shape.

/// A colour, or colours that depend on the place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Straight alpha, sRGB-encoded, every opacity folded in.
    Solid([f32; 4]),
}

impl Paint {
    /// Opaque black.
    pub(crate) const BLACK: Self = Self::Solid([0.0, 0.0, 0.0, 1.0]);

    /// Whether it hides what lies behind it, everywhere.
    pub(crate) fn is_opaque(&self) -> bool {
        let Self::Solid([.., alpha]) = self;
        *alpha >= 1.0
    }

    /// With every colour changed, straight alpha, sRGB-encoded.
    pub(crate) fn mapped(self, change: impl Fn([f32; 4]) -> [f32; 4]) -> Self {
        match self {
            Self::Solid(color) => Self::Solid(change(color)),
        }
    }

    /// Whether anything of it can be seen.
    pub(crate) fn shows(&self) -> bool {
        let Self::Solid([.., alpha]) = self;
        *alpha > 0.0
    }
}
