//! Four-letter names of sections and what this version knows about each.

use std::fmt;

/// Name of a section: four upper-case ASCII letters or digits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tag(pub [u8; 4]);

impl Tag {
    /// The fixed header; names it in issues, never a section.
    pub const HEAD: Self = Self(*b"HEAD");
    /// The section table; names it in issues, never a section.
    pub const SECT: Self = Self(*b"SECT");
    /// [`crate::Meta`] as bincode.
    pub const META: Self = Self(*b"META");
    /// [`crate::SpecKey`].
    pub const SPEC: Self = Self(*b"SPEC");
    /// [`crate::ShaderBlob`].
    pub const SHDR: Self = Self(*b"SHDR");
    /// [`crate::Provenance`] as bincode.
    pub const PROV: Self = Self(*b"PROV");
    /// [`crate::PaintRecord`]s.
    pub const PANT: Self = Self(*b"PANT");
    /// The numbers of [`crate::Gradient`]s.
    pub const GRAD: Self = Self(*b"GRAD");
    /// [`crate::ShapeRecord`]s.
    pub const SHAP: Self = Self(*b"SHAP");
    /// [`crate::LayerRecord`]s.
    pub const LAYR: Self = Self(*b"LAYR");
    /// Image records.
    pub const IMAG: Self = Self(*b"IMAG");
    /// [`crate::CellWord`]s.
    pub const CELL: Self = Self(*b"CELL");
    /// [`crate::Entry`]s, two words each.
    pub const ENTR: Self = Self(*b"ENTR");
    /// Curve records.
    pub const CURV: Self = Self(*b"CURV");
    /// Outlines that curve records are cut from: [`crate::StoredOutlines`].
    pub const OUTL: Self = Self(*b"OUTL");
    /// Fine cells of one filter mode: [`crate::VtexFile::fine`].
    pub const FINE: Self = Self(*b"FINE");
    /// MSDF tiles of a range of layers.
    pub const TILE: Self = Self(*b"TILE");
    /// Texels of one level of one image, or of all its small levels.
    pub const MIPS: Self = Self(*b"MIPS");

    /// Whether every byte is an upper-case letter or a digit.
    pub(crate) fn is_well_formed(self) -> bool {
        self.0
            .iter()
            .all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit())
    }

    /// What this version knows about the section; `None` for an unknown one.
    pub(crate) fn kind(self) -> Option<&'static SectionKind> {
        SECTIONS.iter().find(|kind| kind.tag == self)
    }

    /// Place of a known section in the file's order.
    pub(crate) fn rank(self) -> Option<usize> {
        SECTIONS.iter().position(|kind| kind.tag == self)
    }
}

impl fmt::Display for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.escape_ascii())
    }
}

impl fmt::Debug for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Tag({self})")
    }
}

/// A section of this version.
#[derive(Debug)]
pub(crate) struct SectionKind {
    /// Its name.
    pub(crate) tag: Tag,
    /// A reader that does not know it must refuse the file.
    pub(crate) critical: bool,
    /// Every file has it.
    pub(crate) required: bool,
    /// May occur more than once.
    pub(crate) repeats: bool,
}

/// All sections of this version in file order: what bounds the others comes first, texels last. Small
/// ones stand together, so that they share a bundle.
pub(crate) const SECTIONS: [SectionKind; 16] = [
    section(Tag::META, true, true, false),
    section(Tag::SPEC, true, true, false),
    // PROV, SHAP, SHDR and FINE are not critical: lookups do without them.
    section(Tag::PROV, false, false, false),
    section(Tag::PANT, true, false, false),
    section(Tag::GRAD, true, false, false),
    section(Tag::SHAP, false, false, false),
    section(Tag::LAYR, true, false, false),
    section(Tag::IMAG, true, false, false),
    section(Tag::CELL, true, true, false),
    section(Tag::ENTR, true, false, false),
    section(Tag::CURV, true, false, false),
    section(Tag::OUTL, true, false, false),
    section(Tag::SHDR, false, true, false),
    section(Tag::FINE, false, false, false),
    section(Tag::TILE, true, false, true),
    section(Tag::MIPS, true, false, true),
];

const fn section(tag: Tag, critical: bool, required: bool, repeats: bool) -> SectionKind {
    SectionKind {
        tag,
        critical,
        required,
        repeats,
    }
}
