//! Numbered issues: the one table of everything that can be wrong with a file.

use std::fmt;

use super::tag::Tag;

/// Who must act on an issue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The file is broken: bake or fetch it again.
    Malformed,
    /// The file needs a newer reader.
    Unsupported,
    /// The file is of an earlier version of the format, which is not read any more: bake it again.
    Outdated,
    /// The file asks for more than [`crate::Limits`] grants.
    Limits,
}

/// One row of the issue table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IssueKind {
    /// Stable number, never reused: 10xx header, 20xx section table and storage, 30xx settings,
    /// 40xx paints, shapes and layers, 50xx cells and entries, 60xx tiles and images.
    pub code: u16,
    /// Who must act.
    pub fault: Fault,
    /// The rule that was broken, in words.
    pub summary: &'static str,
}

/// One thing wrong with a file or with a value about to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issue {
    /// Row of [`ISSUES`].
    pub code: u16,
    /// Who must act.
    pub fault: Fault,
    /// Where: [`Tag::HEAD`] and [`Tag::SECT`] stand for header and section table.
    pub section: Tag,
    /// For `HEAD` and `SECT` from the file's start, otherwise from the start of the section's raw
    /// bytes.
    pub offset_bytes: u64,
    /// What was found there.
    pub message: String,
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            code,
            section,
            offset_bytes,
            message,
            ..
        } = self;
        write!(f, "V{code:04} {section} @{offset_bytes:#x}: {message}")
    }
}

/// Most issues that are collected: a broken file can hold millions, and nobody reads them.
pub(crate) const MAX_ISSUES: usize = 256;

impl Issue {
    /// The issue of a file whose [`VtexFile::fine`](crate::VtexFile::fine) words are not those that packing
    /// makes of it. Only a packer can tell.
    pub fn fine_cells() -> Self {
        Self {
            code: FINE_CELLS.code,
            fault: FINE_CELLS.fault,
            section: Tag::FINE,
            offset_bytes: 0,
            message: FINE_CELLS.summary.to_owned(),
        }
    }
}

/// Collects issues up to [`MAX_ISSUES`].
#[derive(Debug, Default)]
pub(crate) struct Issues {
    found: Vec<Issue>,
}

impl Issues {
    /// Notes an issue; the message is formatted only when it is kept.
    pub(crate) fn add(
        &mut self,
        kind: IssueKind,
        section: Tag,
        offset_bytes: u64,
        message: fmt::Arguments<'_>,
    ) {
        if self.found.len() < MAX_ISSUES {
            self.found.push(Issue {
                code: kind.code,
                fault: kind.fault,
                section,
                offset_bytes,
                message: message.to_string(),
            });
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// What was read, unless something is wrong with it.
    pub(crate) fn accept<T>(self, value: Option<T>) -> Result<T, Issue> {
        match (value, self.found.into_iter().next()) {
            (Some(value), None) => Ok(value),
            (_, Some(issue)) => Err(issue),
            // Invariant: whoever gives up has said why.
            (None, None) => unreachable!("nothing was read and no issue says why"),
        }
    }

    pub(crate) fn into_vec(self) -> Vec<Issue> {
        self.found
    }
}

macro_rules! issue_table {
    ($($name:ident = $code:literal $fault:ident $summary:literal;)*) => {
        $(
            pub(crate) const $name: IssueKind = IssueKind {
                code: $code,
                fault: Fault::$fault,
                summary: $summary,
            };
        )*
        /// Every issue there is, by ascending code. `docs/format.md` lists the same; a test
        /// compares them.
        pub const ISSUES: &[IssueKind] = &[$($name),*];
    };
}

issue_table! {
    HEADER_SHORT = 1001 Malformed "the file is shorter than a header";
    MAGIC = 1002 Malformed "the magic bytes differ";
    MAJOR = 1003 Unsupported "the major version is later than 2";
    FILE_LENGTH = 1004 Malformed "the file's length differs from the one in its header";
    SECTION_COUNT = 1006 Malformed "the section table does not fit the file or has too many entries";
    CHECKSUM = 1007 Malformed "the checksum of header and section table differs";
    EARLIER_MAJOR = 1008 Outdated "the major version is earlier than 2";

    TAG = 2001 Malformed "a tag is not four upper-case letters or digits";
    UNKNOWN_CRITICAL = 2002 Unsupported "a critical section is unknown";
    CODEC = 2003 Unsupported "the codec is unknown";
    FLAGS = 2004 Malformed "the flags of a section are wrong";
    BEYOND_END = 2007 Malformed "a bundle reaches beyond the end of the file";
    TRAILING = 2009 Malformed "there are bytes after the last bundle";
    EMPTY_SECTION = 2011 Malformed "a section is empty instead of absent";
    RAW_LENGTH = 2012 Malformed "the stored and raw lengths of a raw bundle differ";
    ORDER = 2013 Malformed "sections are out of order or repeated";
    MISSING = 2014 Malformed "a required section is missing";
    TOTAL_BUDGET = 2016 Limits "the raw bytes exceed the budget";
    FRAME = 2017 Malformed "the stored bytes are not one plain zstd frame of the raw length";
    HASH = 2018 Malformed "the zstd blocks do not decode, or the hash of the raw bytes differs";
    MEMORY = 2019 Limits "memory for the raw bytes cannot be allocated";
    OUTLINE_BUDGET = 2020 Limits "making curve records from the outlines exceeds the budget";
    SHARED_BYTES = 2021 Malformed "several sections in a bundle have more than 65,536 raw bytes";
    SECTION_LENGTH = 2022 Malformed "a section has 2^32 raw bytes or more";
    DICTIONARY = 2023 Unsupported "the dictionary is unknown";

    META_BUDGET = 3001 Limits "META exceeds its budget";
    PROV_BUDGET = 3002 Limits "PROV exceeds its budget";
    SHADER_BUDGET = 3003 Limits "SHDR exceeds its budget";
    BINCODE = 3004 Malformed "the bincode does not decode, has bytes left over or is not canonical";
    CANVAS_SIZE = 3010 Malformed "the canvas size is not finite and positive";
    GRID_SIZE = 3011 Malformed "the grid has no cells or too many";
    GRID_TRANSFORM = 3012 Malformed "the grid's scale or offset is out of range";
    GRID_COVER = 3013 Malformed "the grid does not cover the canvas";
    GRID_ASPECT = 3014 Malformed "cells are not square in user units";
    TEXELS_PER_CELL = 3015 Malformed "the texels per cell are out of range";
    DISTANCE_RANGE = 3016 Malformed "the distance range is not finite and positive";
    MAX_ZOOM = 3017 Malformed "the largest zoom is not finite and positive";
    TEXTURE_MATRIX = 3018 Malformed "the texture matrix is not finite";
    SMOOTHING = 3019 Malformed "the smoothing is not in (0, 0.5]";
    OUTLINE_WIDTH = 3020 Malformed "the width of the distance outline is not between 0 and half the distance range";
    OUTLINE_PAINT = 3021 Malformed "the distance outline's paint does not exist";
    CURVE_LATTICE = 3022 Malformed "a box of the curve lattice is empty or exceeds 16 bits";
    CURVE_LATTICE_USE = 3023 Malformed "there is a curve lattice without curve records, or records without a lattice";
    OUTLINE_SOLID = 3024 Malformed "the distance outline's paint is not a single colour";
    SPEC_LENGTH = 3030 Malformed "SPEC is not 32 bytes";
    SPEC_ABI = 3031 Unsupported "the ABI of the spec key is not known";
    SPEC_FEATURES = 3032 Unsupported "the spec key has unknown features";
    SPEC_FEATURE_MISSING = 3033 Malformed "the spec key lacks a feature that the content needs";
    SPEC_FEATURE_STRAY = 3034 Malformed "the spec key has a feature that META rules out";
    SPEC_RESERVED = 3038 Malformed "reserved words of the spec key are not zero";
    SHADER_LENGTH = 3040 Malformed "SHDR's lengths do not add up";
    SHADER_TEXT = 3041 Malformed "the shader's text is not UTF-8";
    SHADER_RESERVED = 3042 Malformed "reserved bytes or padding of SHDR are not zero";
    PROV_SHAPES = 3050 Malformed "the number of reports differs from the number of shapes";
    PROV_OPTIONS = 3051 Malformed "options are not in ascending order of distinct names";
    PROV_ERROR = 3052 Malformed "the error of an MSDF is out of range";
    PROV_AREA = 3053 Malformed "the area of a warning is not in [0, 1]";

    RECORD_LENGTH = 4001 Malformed "a section is not a whole number of records";
    RECORD_COUNT = 4002 Malformed "there are more records than an index can name";
    PAINT_KIND = 4003 Unsupported "the kind of a paint is unknown";
    PAINT_RESERVED = 4004 Malformed "unused words or bits of a paint are not zero";
    PAINT_COLOR = 4005 Malformed "a colour is not in [0, 1]";
    GRADIENT_PART = 4006 Malformed "the numbers of gradients do not fill GRAD in order, or a gradient has the wrong count of them";
    GRADIENT_NUMBER = 4007 Malformed "a number of a gradient is not finite or out of its range";
    GRADIENT_STOPS = 4008 Malformed "the offsets of a gradient's stops are not in [0, 1] or not ascending";
    PAINT_OPAQUE = 4009 Malformed "the opaque flag of a gradient is wrong";
    SHAPE_COVERAGE = 4010 Unsupported "the coverage of a shape is unknown";
    SHAPE_FILL_RULE = 4011 Malformed "the fill rule of a shape is unknown";
    SHAPE_TARGET = 4012 Malformed "the layer or image of a shape does not exist";
    SHAPE_PAINT = 4013 Malformed "the paint of a shape does not exist";
    SHAPE_BOUNDS = 4014 Malformed "the bounds of a shape are not finite or reversed";
    SHAPE_RESERVED = 4015 Malformed "the reserved word of a shape is not zero";
    LAYER_TILES = 4020 Malformed "the tiles of a layer do not follow those of the layer before it";
    LAYER_SHAPES = 4021 Malformed "the number of shapes in a layer is wrong";
    LAYER_RESERVED = 4022 Malformed "the reserved word of a layer is not zero";

    CELL_COUNT = 5001 Malformed "the number of cell words differs from the number of cells";
    CELL_WORD = 5002 Malformed "a cell's word has no meaning";
    CELL_PAINT = 5003 Malformed "the paint of a cell does not exist";
    LIST_OFFSET = 5004 Malformed "a list starts outside the entries or inside an entry";
    LIST_END = 5005 Malformed "a list has no last entry within 4,096 entries";
    LIST_COMMANDS = 5006 Malformed "a list has more than 32,768 commands";
    ALL_COMMANDS = 5007 Malformed "all lists together have more than 2^23 commands";
    ENTRY_COUNT = 5010 Malformed "an entry is incomplete";
    ENTRY_WORD = 5011 Malformed "an entry has no meaning";
    ENTRY_PAINT = 5012 Malformed "the paint of an entry does not exist";
    ENTRY_TILE = 5013 Malformed "the tile of an entry does not exist";
    ENTRY_IMAGE = 5014 Malformed "the image of an entry does not exist";
    ENTRY_OPAQUE = 5015 Malformed "an entry is marked opaque but its paint or image is not";
    ENTRY_CURVES = 5016 Malformed "the curve record of an entry does not exist or reaches beyond the end of its section";
    CURVE_HEADER = 5020 Malformed "the header of a curve record has no meaning";
    OUTLINES = 5021 Malformed "no curve records can be made from the outlines";
    OUTLINE_RECORDS = 5022 Malformed "the curve records differ from those made from the outlines";
    OUTLINE_TWICE = 5023 Malformed "CURV and OUTL are both present";

    LIST_BRANCH = 5030 Malformed "a branch in a list has an invalid target";
    LIST_GROUP = 5031 Malformed "a group in a list lacks its open or its close";
    LIST_MASK = 5032 Malformed "a mask in a list is not followed by its group";
    LIST_BLEND = 5033 Malformed "a group that is not isolated has a blend mode";
    LIST_BLEND_DEPTH = 5034 Malformed "a list needs more than 32 levels of the blend stack";
    FINE_CELLS = 5040 Malformed "the fine cells are not those that packing makes of the file";

    TILE_BYTES = 6002 Malformed "the length of the tiles differs from what the layers require";
    TILE_ALPHA = 6003 Malformed "the alpha of a tile's texel is not 255";
    TILE_LAYERS = 6004 Malformed "the TILE sections do not hold the tiles of all layers, each in one section";
    IMAGE_SIZE = 6010 Malformed "an image has no texels or too many";
    IMAGE_LEVELS = 6011 Malformed "an image has no levels or too many, or the canvas image lacks some";
    IMAGE_RECT = 6012 Malformed "the rectangle of an image is not finite or empty";
    MIP_PARTS = 6014 Malformed "the MIPS sections are incomplete or out of order";
    MIP_BYTES = 6015 Malformed "the length of a level differs from what its size requires";
    CANVAS_IMAGE = 6016 Malformed "the spec key has the feature MIPS, but image 0 is not the canvas";
    IMAGE_TEXELS = 6017 Malformed "the image whose texels another one shares is unsuitable";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_ascend() {
        assert!(
            ISSUES.is_sorted_by(|a, b| a.code < b.code),
            "codes must be unique and ascending"
        );
    }

    #[test]
    fn an_issue_reads_as_documented() {
        let mut issues = Issues::default();
        issues.add(FLAGS, Tag::SECT, 0x2c, format_args!("flags 0x7"));
        assert_eq!(
            issues.into_vec()[0].to_string(),
            "V2004 SECT @0x2c: flags 0x7"
        );
    }

    #[test]
    fn the_specification_lists_the_same_issues() {
        let text = include_str!("../../../docs/format.md");
        let rows: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("| V"))
            .collect();
        let expected: Vec<String> = ISSUES
            .iter()
            .map(|kind| {
                let fault = format!("{:?}", kind.fault).to_lowercase();
                format!("| V{:04} | {fault} | {} |", kind.code, kind.summary)
            })
            .collect();
        assert_eq!(
            rows, expected,
            "docs/format.md section 1.5 and ISSUES differ"
        );
    }
}
