//! What control entries of a list carry: blend modes, kinds of masks.

/// [`crate::Entry::data`] of an [`crate::EntryKind::Open`] whose group starts from nothing instead
/// of from what lies behind it.
pub const OPEN_ISOLATED: u32 = 1;

/// How a group meets what lies behind it: Compositing and Blending Level 1, on sRGB-encoded values.
/// Numbers are stable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum BlendMode {
    /// Source-over; the only one for a group that is not isolated.
    #[default]
    Normal = 0,
    /// Product.
    Multiply = 1,
    /// Product of the complements, complemented.
    Screen = 2,
    /// Hard light with the layers swapped.
    Overlay = 3,
    /// The lesser of both.
    Darken = 4,
    /// The greater of both.
    Lighten = 5,
    /// The backdrop brightened by the group.
    ColorDodge = 6,
    /// The backdrop darkened by the group.
    ColorBurn = 7,
    /// Product or screen, as the group's colour says.
    HardLight = 8,
    /// Darkens or lightens, as the group's colour says.
    SoftLight = 9,
    /// Absolute difference.
    Difference = 10,
    /// Difference of less contrast.
    Exclusion = 11,
    /// Hue of the group, saturation and luminosity of the backdrop.
    Hue = 12,
    /// Saturation of the group, hue and luminosity of the backdrop.
    Saturation = 13,
    /// Hue and saturation of the group, luminosity of the backdrop.
    Color = 14,
    /// Luminosity of the group, hue and saturation of the backdrop.
    Luminosity = 15,
    /// Sum, of colour and of alpha: `plus-lighter` of Compositing and Blending Level 2.
    PlusLighter = 16,
}

impl BlendMode {
    /// All of them; each stands at its own number.
    pub const ALL: [Self; 17] = [
        Self::Normal,
        Self::Multiply,
        Self::Screen,
        Self::Overlay,
        Self::Darken,
        Self::Lighten,
        Self::ColorDodge,
        Self::ColorBurn,
        Self::HardLight,
        Self::SoftLight,
        Self::Difference,
        Self::Exclusion,
        Self::Hue,
        Self::Saturation,
        Self::Color,
        Self::Luminosity,
        Self::PlusLighter,
    ];
}

/// How a mask's content becomes a weight. Numbers are stable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum MaskKind {
    /// Luminance of the sRGB-encoded colour, premultiplied by alpha.
    #[default]
    Luminance = 0,
    /// Alpha.
    Alpha = 1,
    /// Luminance of the colour in linear light, premultiplied by alpha.
    LinearLuminance = 2,
}

impl MaskKind {
    /// All of them; each stands at its own number.
    pub const ALL: [Self; 3] = [Self::Luminance, Self::Alpha, Self::LinearLuminance];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_places() {
        for (place, mode) in BlendMode::ALL.into_iter().enumerate() {
            assert_eq!(mode as usize, place, "{mode:?}");
        }
        for (place, kind) in MaskKind::ALL.into_iter().enumerate() {
            assert_eq!(kind as usize, place, "{kind:?}");
        }
    }
}
