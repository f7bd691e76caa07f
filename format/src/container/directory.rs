//! Header and section table: what a file says about itself before a section is unpacked.

use super::error::ReadError;
use super::header::Header;
use super::issue::{self, Issues};
use super::layout::{self, ALIGNMENT_BYTES, MAGIC, MAX_SECTIONS, VERSION_MAJOR, entry, header};
use super::limits::Limits;
use super::section::{Codec, SectionInfo, flags};
use super::tag::{SECTIONS, Tag};

/// Header and section table of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Directory {
    /// Major version of the format.
    pub version_major: u16,
    /// Minor version of the format.
    pub version_minor: u16,
    /// Length of the file.
    pub file_bytes: u64,
    /// First 16 bytes of the blake3 of header and section table.
    pub checksum: [u8; 16],
    /// All sections in file order, unknown ones included.
    pub sections: Vec<SectionInfo>,
}

/// Reads header and section table of a whole file and unpacks nothing.
///
/// # Errors
/// The first issue of the header or the table.
pub fn directory(bytes: &[u8], limits: &Limits) -> Result<Directory, ReadError> {
    let mut issues = Issues::default();
    let directory = read_directory(bytes, limits, &mut issues);
    Ok(issues.accept(directory)?)
}

/// Offset in the file of a table entry.
pub(crate) fn entry_offset(index: usize) -> u64 {
    (header::BYTES + index * entry::BYTES) as u64
}

/// As [`directory`], noting all issues; `None` when there are any.
pub(crate) fn read_directory(
    bytes: &[u8],
    limits: &Limits,
    issues: &mut Issues,
) -> Option<Directory> {
    let (header, table) = read_header(bytes, issues)?;
    let mut end = entry_offset(table.len());
    for (index, bytes_of_entry) in table.iter().enumerate() {
        let section = SectionInfo::decode(bytes_of_entry);
        let mut at = EntryCheck {
            issues,
            section: &section,
            offset: entry_offset(index),
        };
        at.name(bytes_of_entry);
        at.storage();
        end = at.place(bytes, end);
    }
    if end < bytes.len() as u64 {
        let extra = bytes.len() as u64 - end;
        let message = format_args!("{extra} bytes too many");
        issues.add(issue::TRAILING, Tag::HEAD, end, message);
    }
    let sections: Vec<_> = table.iter().map(SectionInfo::decode).collect();
    check_order(&sections, issues);
    check_budget(&sections, limits, issues);
    issues.is_empty().then_some(Directory {
        version_major: header.major,
        version_minor: header.minor,
        file_bytes: header.file_bytes,
        checksum: header.checksum,
        sections,
    })
}

/// The header and the entries behind it, once both are known to be undamaged.
fn read_header<'a>(
    bytes: &'a [u8],
    issues: &mut Issues,
) -> Option<(Header, &'a [[u8; entry::BYTES]])> {
    let mut refuse = |kind, offset: usize, message: std::fmt::Arguments<'_>| {
        issues.add(kind, Tag::HEAD, offset as u64, message);
        None
    };
    let length = bytes.len() as u64;
    let Some((head, body)) = bytes.split_first_chunk::<{ header::BYTES }>() else {
        let message = format_args!("{length} bytes are less than the header's 64");
        return refuse(issue::HEADER_SHORT, 0, message);
    };
    // From here on the order decides what a damaged file is called: no vtex file, then a version
    // whose fields may lie elsewhere, then a transfer that broke off, then damage.
    if head[..MAGIC.len()] != MAGIC {
        return refuse(issue::MAGIC, 0, describe_magic(head));
    }
    let header = Header::decode(head);
    if header.major != VERSION_MAJOR {
        let message = format_args!("version {}.{}", header.major, header.minor);
        return refuse(issue::MAJOR, header::MAJOR, message);
    }
    if header.file_bytes != length {
        let says = header.file_bytes;
        let message = format_args!("{length} bytes where the header says {says}");
        return refuse(issue::FILE_LENGTH, header::FILE_BYTES, message);
    }
    let count = header.section_count;
    let (entries, _) = body.as_chunks::<{ entry::BYTES }>();
    let Some(table) = entries
        .get(..count as usize)
        .filter(|_| count <= MAX_SECTIONS)
    else {
        let message = format_args!("{count} sections");
        return refuse(issue::SECTION_COUNT, header::SECTION_COUNT, message);
    };
    if header.checksum != header.checksum_with(table.as_flattened()) {
        let message = format_args!("header or section table is damaged");
        return refuse(issue::CHECKSUM, header::CHECKSUM, message);
    }
    // The checksum takes these bytes as zero, so it does not notice them.
    if head[header::RESERVED..].iter().any(|&byte| byte != 0) {
        return refuse(
            issue::HEADER_RESERVED,
            header::RESERVED,
            format_args!("not zero"),
        );
    }
    Some((header, table))
}

/// Says whether the bytes look like a .vtex file that a text-mode transfer damaged.
fn describe_magic(head: &[u8; header::BYTES]) -> std::fmt::Arguments<'static> {
    if head[1..4] == MAGIC[1..4] {
        format_args!("damaged as by a text-mode transfer")
    } else {
        format_args!("not a .vtex file")
    }
}

/// Checks on one entry of the table.
struct EntryCheck<'a> {
    issues: &'a mut Issues,
    section: &'a SectionInfo,
    offset: u64,
}

impl EntryCheck<'_> {
    fn note(&mut self, kind: issue::IssueKind, field: usize, message: std::fmt::Arguments<'_>) {
        let tag = self.section.tag;
        let offset = self.offset + field as u64;
        self.issues
            .add(kind, Tag::SECT, offset, format_args!("{tag}: {message}"));
    }

    /// Tag, flags and reserved bytes.
    fn name(&mut self, bytes: &[u8; entry::BYTES]) {
        let SectionInfo { tag, critical, .. } = *self.section;
        if !tag.is_well_formed() {
            self.note(issue::TAG, entry::TAG, format_args!("not a tag"));
        }
        let known = tag.kind();
        if known.is_none() && critical {
            let message = format_args!("unknown to version {VERSION_MAJOR}");
            self.note(issue::UNKNOWN_CRITICAL, entry::TAG, message);
        }
        let flags = flags(bytes);
        let stray = flags & !layout::FLAG_CRITICAL != 0;
        if stray || known.is_some_and(|kind| kind.critical != critical) {
            self.note(issue::FLAGS, entry::FLAGS, format_args!("flags {flags:#x}"));
        }
        if bytes[entry::RESERVED..].iter().any(|&byte| byte != 0) {
            self.note(
                issue::ENTRY_RESERVED,
                entry::RESERVED,
                format_args!("not zero"),
            );
        }
    }

    /// Codec, lengths and part numbers.
    fn storage(&mut self) {
        let section = *self.section;
        if let (Codec::Unknown(number), Some(_)) = (section.codec, section.tag.kind()) {
            self.note(issue::CODEC, entry::CODEC, format_args!("codec {number}"));
        }
        let (stored, raw) = (section.stored_bytes, section.raw_bytes);
        if stored == 0 || raw == 0 {
            self.note(
                issue::EMPTY_SECTION,
                entry::STORED_BYTES,
                format_args!("no bytes"),
            );
        }
        if section.codec == Codec::Raw && stored != raw {
            let message = format_args!("{stored} bytes stored, {raw} raw");
            self.note(issue::RAW_LENGTH, entry::RAW_BYTES, message);
        }
        let image_part = section.tag == Tag::MIPS || (section.image, section.mip) == (0, 0);
        let layer_part =
            section.tag == Tag::TILE || (section.layer_first, section.layer_count) == (0, 0);
        if section.tag.kind().is_some() && !(image_part && layer_part) {
            self.note(issue::STRAY_PART, entry::IMAGE, format_args!("not zero"));
        }
    }

    /// Place in the file, given where what precedes it ends; returns its own end.
    fn place(&mut self, bytes: &[u8], previous_end: u64) -> u64 {
        let SectionInfo {
            offset_bytes: start,
            stored_bytes,
            ..
        } = *self.section;
        if start % ALIGNMENT_BYTES != 0 {
            self.note(
                issue::ALIGNMENT,
                entry::OFFSET,
                format_args!("starts at {start:#x}"),
            );
        }
        if start < previous_end {
            let message = format_args!("starts at {start:#x}, before {previous_end:#x}");
            self.note(issue::OVERLAP, entry::OFFSET, message);
        }
        let length = bytes.len() as u64;
        let end = start.checked_add(stored_bytes).filter(|&end| end <= length);
        let Some(end) = end else {
            let message = format_args!("{stored_bytes} bytes at {start:#x}");
            self.note(issue::BEYOND_END, entry::OFFSET, message);
            return length;
        };
        if layout::align_up(previous_end) < Some(start) {
            // More padding than alignment asks for would be a hiding place.
            let message = format_args!("a gap before {start:#x}");
            self.note(issue::PADDING, entry::OFFSET, message);
        } else if slice(bytes, previous_end, start)
            .iter()
            .any(|&byte| byte != 0)
        {
            let message = format_args!("before {start:#x}");
            self.note(issue::PADDING, entry::OFFSET, message);
        }
        end.max(previous_end)
    }
}

/// The bytes from `start` to `end`; empty when they do not exist.
pub(crate) fn slice(bytes: &[u8], start: u64, end: u64) -> &[u8] {
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    range
        .and_then(|(start, end)| bytes.get(start..end))
        .unwrap_or_default()
}

/// Known sections stand in the order of [`SECTIONS`], single ones once, required ones surely.
fn check_order(sections: &[SectionInfo], issues: &mut Issues) {
    let mut previous = None;
    for (index, section) in sections.iter().enumerate() {
        let Some((rank, kind)) = section.tag.rank().zip(section.tag.kind()) else {
            continue;
        };
        if previous.is_some_and(|before| rank < before || (rank == before && !kind.repeats)) {
            let message = format_args!("{} is out of order or repeated", section.tag);
            issues.add(issue::ORDER, Tag::SECT, entry_offset(index), message);
        }
        // The highest so far: one section that comes too late is one issue.
        previous = previous.max(Some(rank));
    }
    for kind in SECTIONS.iter().filter(|kind| kind.required) {
        if !sections.iter().any(|section| section.tag == kind.tag) {
            let message = format_args!("there is no {}", kind.tag);
            issues.add(issue::MISSING, Tag::SECT, header::BYTES as u64, message);
        }
    }
}

/// What will be unpacked is within the budgets.
fn check_budget(sections: &[SectionInfo], limits: &Limits, issues: &mut Issues) {
    let known = || {
        let all = sections.iter().enumerate();
        all.filter(|(_, section)| section.tag.kind().is_some())
    };
    let total = known().fold(0_u64, |sum, (_, section)| {
        // Lengths are what the file claims; their sum may pass 2^64.
        sum.saturating_add(section.raw_bytes)
    });
    if total > limits.total_raw_bytes {
        let budget = limits.total_raw_bytes;
        let message = format_args!("{total} raw bytes, total_raw_bytes is {budget}");
        issues.add(
            issue::TOTAL_BUDGET,
            Tag::SECT,
            header::BYTES as u64,
            message,
        );
    }
    for (index, section) in known() {
        let (kind, name, budget) = match section.tag {
            Tag::META => (issue::META_BUDGET, "meta_bytes", limits.meta_bytes),
            Tag::SHDR => (issue::SHADER_BUDGET, "shader_bytes", limits.shader_bytes),
            Tag::PROV => (
                issue::PROV_BUDGET,
                "provenance_bytes",
                limits.provenance_bytes,
            ),
            _ => continue,
        };
        if section.raw_bytes > budget {
            let offset = entry_offset(index) + entry::RAW_BYTES as u64;
            let raw = section.raw_bytes;
            let message = format_args!("{raw} raw bytes, {name} is {budget}");
            issues.add(kind, Tag::SECT, offset, message);
        }
    }
}
