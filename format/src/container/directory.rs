//! Header and section table: what a file says about itself before a section is unpacked.

use super::error::ReadError;
use super::header::Header;
use super::issue::{self, Issues};
use super::layout::{
    self, MAGIC, MAX_SECTIONS, MAX_SHARED_BYTES, VERSION_MAJOR, bundle, entry, header,
};
use super::limits::Limits;
use super::section::{BundleEntry, BundleInfo, Codec, SectionEntry, SectionInfo};
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
    /// All bundles in file order.
    pub bundles: Vec<BundleInfo>,
    /// All sections in file order, unknown ones included.
    pub sections: Vec<SectionInfo>,
}

impl Directory {
    /// The sections of a bundle.
    pub fn bundle_sections(&self, bundle: &BundleInfo) -> &[SectionInfo] {
        &self.sections[bundle.section_first..][..bundle.section_count]
    }

    /// Raw bytes of all bundles that a reader of this version unpacks.
    pub(crate) fn read_bytes(&self) -> u64 {
        let read = self.bundles.iter().filter(|bundle| self.is_read(bundle));
        read.map(|bundle| bundle.raw_bytes).sum()
    }

    /// Whether a reader of this version unpacks a bundle: it holds a section that is known.
    fn is_read(&self, bundle: &BundleInfo) -> bool {
        let mut sections = self.bundle_sections(bundle).iter();
        sections.any(|section| section.tag.kind().is_some())
    }
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

/// An entry of the section table.
struct TableEntry {
    offset_bytes: u64,
    section: SectionEntry,
    /// Absent where the section shares the bundle of the one before it.
    bundle: Option<BundleEntry>,
}

/// As [`directory`], noting all issues; `None` when there are any.
pub(crate) fn read_directory(
    bytes: &[u8],
    limits: &Limits,
    issues: &mut Issues,
) -> Option<Directory> {
    let (header, table) = read_header(bytes, issues)?;
    let mut directory = Directory {
        version_major: header.major,
        version_minor: header.minor,
        file_bytes: header.file_bytes,
        checksum: header.checksum,
        bundles: Vec::new(),
        sections: Vec::new(),
    };
    let mut end = table_end(&table);
    for entry in &table {
        check_entry(entry, issues);
        end = directory.add(entry, end, issues)?;
    }
    if end < header.file_bytes {
        let extra = header.file_bytes - end;
        let message = format_args!("{extra} bytes too many");
        issues.add(issue::TRAILING, Tag::HEAD, end, message);
    }
    check_bundles(&directory, issues);
    check_order(&directory.sections, issues);
    check_budget(&directory, limits, issues);
    issues.is_empty().then_some(directory)
}

/// Where the table ends and the first bundle begins.
fn table_end(table: &[TableEntry]) -> u64 {
    let bundles = table.iter().filter(|entry| entry.bundle.is_some()).count();
    (header::BYTES + table.len() * entry::BYTES + bundles * bundle::BYTES) as u64
}

impl Directory {
    /// Adds a section, given where the bundles before it end; returns where its own ends. `None` for a
    /// section without a bundle.
    fn add(&mut self, entry: &TableEntry, end: u64, issues: &mut Issues) -> Option<u64> {
        let TableEntry {
            offset_bytes,
            section: SectionEntry { tag, raw_bytes, .. },
            ..
        } = *entry;
        let mut end = end;
        if let Some(bundle) = entry.bundle {
            self.bundles.push(BundleInfo {
                codec: bundle.codec,
                offset_bytes: end,
                stored_bytes: u64::from(bundle.stored_bytes),
                raw_bytes: 0,
                hash: bundle.hash,
                section_first: self.sections.len(),
                section_count: 0,
            });
            // At most MAX_SECTIONS numbers of 32 bits: no sum overflows.
            end += u64::from(bundle.stored_bytes);
            if end > self.file_bytes {
                let message = format_args!("{tag}: the bundle ends at {end:#x}");
                issues.add(issue::BEYOND_END, Tag::SECT, offset_bytes, message);
            }
        }
        let index = self.bundles.len().checked_sub(1);
        let Some(index) = index else {
            let message = format_args!("{tag}: there is no bundle before it");
            issues.add(issue::FLAGS, Tag::SECT, offset_bytes, message);
            return None;
        };
        let bundle = &mut self.bundles[index];
        self.sections.push(SectionInfo {
            tag,
            critical: entry.section.is_critical(),
            bundle: index,
            start_bytes: bundle.raw_bytes,
            raw_bytes: u64::from(raw_bytes),
            entry_offset_bytes: offset_bytes,
        });
        bundle.raw_bytes += u64::from(raw_bytes);
        bundle.section_count += 1;
        Some(end)
    }
}

/// The header and the entries behind it, once both are known to be undamaged.
fn read_header(bytes: &[u8], issues: &mut Issues) -> Option<(Header, Vec<TableEntry>)> {
    let mut refuse = |kind, offset: usize, message: std::fmt::Arguments<'_>| {
        issues.add(kind, Tag::HEAD, offset as u64, message);
        None
    };
    let length = bytes.len() as u64;
    let Some(head) = bytes.first_chunk::<{ header::BYTES }>() else {
        let least = header::BYTES;
        let message = format_args!("{length} bytes are less than the header's {least}");
        return refuse(issue::HEADER_SHORT, 0, message);
    };
    // From here on the order decides what a damaged file is called: no vtex file, then a version
    // whose fields may lie elsewhere, then a transfer that broke off, then damage.
    if head[..MAGIC.len()] != MAGIC {
        return refuse(issue::MAGIC, 0, describe_magic(head));
    }
    let header = Header::decode(head);
    if header.major != VERSION_MAJOR {
        let earlier = header.major < VERSION_MAJOR;
        let kind = if earlier {
            issue::EARLIER_MAJOR
        } else {
            issue::MAJOR
        };
        let message = format_args!("version {}.{}", header.major, header.minor);
        return refuse(kind, header::MAJOR, message);
    }
    if header.file_bytes != length {
        let says = header.file_bytes;
        let message = format_args!("{length} bytes where the header says {says}");
        return refuse(issue::FILE_LENGTH, header::FILE_BYTES, message);
    }
    let count = header.section_count;
    let table = (count <= MAX_SECTIONS).then(|| read_table(bytes, count));
    let Some(table) = table.flatten() else {
        let message = format_args!("{count} sections");
        return refuse(issue::SECTION_COUNT, header::SECTION_COUNT, message);
    };
    let stored = slice(bytes, header::BYTES as u64, table_end(&table));
    if header.checksum != header.checksum_with(stored) {
        let message = format_args!("header or section table is damaged");
        return refuse(issue::CHECKSUM, header::CHECKSUM, message);
    }
    Some((header, table))
}

/// The entries of the table; `None` when they do not fit the file.
fn read_table(bytes: &[u8], count: u32) -> Option<Vec<TableEntry>> {
    let mut table = Vec::new();
    let mut rest = bytes.get(header::BYTES..)?;
    for _ in 0..count {
        let offset_bytes = (bytes.len() - rest.len()) as u64;
        let (section, behind) = rest.split_first_chunk()?;
        let section = SectionEntry::decode(section);
        rest = behind;
        let mut bundle = None;
        if !section.is_shared() {
            let (stored, behind) = rest.split_first_chunk()?;
            bundle = Some(BundleEntry::decode(stored));
            rest = behind;
        }
        table.push(TableEntry {
            offset_bytes,
            section,
            bundle,
        });
    }
    Some(table)
}

/// Says whether the bytes look like a .vtex file that a text-mode transfer damaged.
fn describe_magic(head: &[u8; header::BYTES]) -> std::fmt::Arguments<'static> {
    if head[1..4] == MAGIC[1..4] {
        format_args!("damaged as by a text-mode transfer")
    } else {
        format_args!("not a .vtex file")
    }
}

/// Tag, flags and length of a section.
fn check_entry(table: &TableEntry, issues: &mut Issues) {
    let SectionEntry {
        tag,
        flags,
        raw_bytes,
    } = table.section;
    let mut note = |kind, field: usize, message: std::fmt::Arguments<'_>| {
        let offset = table.offset_bytes + field as u64;
        issues.add(kind, Tag::SECT, offset, format_args!("{tag}: {message}"));
    };
    if !tag.is_well_formed() {
        note(issue::TAG, entry::TAG, format_args!("not a tag"));
    }
    let critical = table.section.is_critical();
    let known = tag.kind();
    if known.is_none() && critical {
        let message = format_args!("unknown to version {VERSION_MAJOR}");
        note(issue::UNKNOWN_CRITICAL, entry::TAG, message);
    }
    let stray = flags & !(layout::FLAG_CRITICAL | layout::FLAG_SHARED) != 0;
    if stray || known.is_some_and(|kind| kind.critical != critical) {
        note(issue::FLAGS, entry::FLAGS, format_args!("flags {flags:#x}"));
    }
    if raw_bytes == 0 {
        note(
            issue::EMPTY_SECTION,
            entry::RAW_BYTES,
            format_args!("no bytes"),
        );
    }
}

/// Codecs and lengths of bundles.
fn check_bundles(directory: &Directory, issues: &mut Issues) {
    for bundle in &directory.bundles {
        let first = &directory.sections[bundle.section_first];
        let mut note = |kind, message: std::fmt::Arguments<'_>| {
            let (tag, offset) = (first.tag, first.entry_offset_bytes);
            issues.add(kind, Tag::SECT, offset, format_args!("{tag}: {message}"));
        };
        let (stored, raw) = (bundle.stored_bytes, bundle.raw_bytes);
        match bundle.codec {
            Codec::Unknown(number) if directory.is_read(bundle) => {
                note(issue::CODEC, format_args!("codec {number}"));
            }
            Codec::Raw if stored != raw => {
                let message = format_args!("{stored} bytes stored, {raw} raw");
                note(issue::RAW_LENGTH, message);
            }
            _ => {}
        }
        if stored == 0 {
            note(issue::EMPTY_SECTION, format_args!("no stored bytes"));
        }
        let count = bundle.section_count;
        if count > 1 && raw > MAX_SHARED_BYTES {
            let message = format_args!("{count} sections of {raw} raw bytes");
            note(issue::SHARED_BYTES, message);
        }
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
    for section in sections {
        let Some((rank, kind)) = section.tag.rank().zip(section.tag.kind()) else {
            continue;
        };
        if previous.is_some_and(|before| rank < before || (rank == before && !kind.repeats)) {
            let message = format_args!("{} is out of order or repeated", section.tag);
            issues.add(issue::ORDER, Tag::SECT, section.entry_offset_bytes, message);
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
fn check_budget(directory: &Directory, limits: &Limits, issues: &mut Issues) {
    let total = directory.read_bytes();
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
    for section in &directory.sections {
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
            let offset = section.entry_offset_bytes + entry::RAW_BYTES as u64;
            let raw = section.raw_bytes;
            let message = format_args!("{raw} raw bytes, {name} is {budget}");
            issues.add(kind, Tag::SECT, offset, message);
        }
    }
}
