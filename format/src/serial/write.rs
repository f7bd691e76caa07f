//! Value to bytes: the same value gives the same bytes.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::levels::mip_sections;
use super::{canonical, offsets, planes};
use crate::check;
use crate::container::error::WriteError;
use crate::container::header::{Header, field};
use crate::container::issue::{self, Issue, IssueKind, Issues};
use crate::container::layout::{HASH_BYTES, MAX_SECTIONS, header, tile_texels};
use crate::container::section::{BundleEntry, Codec, SectionEntry};
use crate::container::tag::Tag;
use crate::container::words::words_to_little_endian;
use crate::curves::outlines::stream;
use crate::file::texture::VtexFile;
use crate::packing::pack::pack;
use crate::records::image::ImageRecord;
use crate::records::layer::LayerRecord;

/// Layers are gathered until their tiles reach this many bytes in memory: large enough to pack well, small
/// enough to be a useful part.
const TILE_PART_BYTES: u64 = 4 << 20;

/// Runs jobs: calls its second argument once for every number below the first.
pub type Executor<'a> = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + 'a;

/// Sections share a bundle up to this many raw bytes. Larger ones pack better by themselves
/// (docs/decisions/0018).
const SHARED_BYTES: usize = 32 << 10;

/// A section before it is packed.
struct Part<'a> {
    tag: Tag,
    raw: Cow<'a, [u8]>,
}

impl<'a> Part<'a> {
    fn new(tag: Tag, raw: impl Into<Cow<'a, [u8]>>) -> Self {
        Self {
            tag,
            raw: raw.into(),
        }
    }
}

/// Sections that are stored together.
struct Bundle<'a> {
    sections: Vec<SectionEntry>,
    raw: Cow<'a, [u8]>,
}

impl VtexFile {
    /// The whole file. The same value gives the same bytes with the same version of zstd.
    ///
    /// # Errors
    /// [`WriteError::Invalid`] for a value that reading would refuse; that is a fault of the
    /// program that made it.
    pub fn to_bytes(&self) -> Result<Vec<u8>, WriteError> {
        self.to_bytes_by(&|count, job| (0..count).for_each(job))
    }

    /// As [`VtexFile::to_bytes`], with the caller's threads: `run(count, job)` calls `job` once for
    /// every number below `count`, in any order and at once if it likes. The bytes are the same.
    ///
    /// # Errors
    /// As [`VtexFile::to_bytes`].
    ///
    /// # Panics
    /// If `run` leaves out a number.
    pub fn to_bytes_by(&self, run: &Executor<'_>) -> Result<Vec<u8>, WriteError> {
        let mut issues = Issues::default();
        check::file(self, &mut issues);
        issues.accept(Some(()))?;
        let bundles = bundles(self.parts()?)?;
        // Each job has a slot of its own, so the order of the jobs does not show in the bytes.
        let slots: Vec<OnceLock<_>> = bundles.iter().map(|_| OnceLock::new()).collect();
        run(bundles.len(), &|index| {
            let Bundle { sections, raw } = &bundles[index];
            let tag = sections.first().map_or(Tag::META, |section| section.tag);
            slots[index].get_or_init(|| pack(tag, raw));
        });
        let stored = slots.into_iter().map(|slot| {
            let packed = slot.into_inner().expect("the caller runs every job");
            packed.map_err(WriteError::Compress)
        });
        Ok(assemble(&bundles, &stored.collect::<Result<Vec<_>, _>>()?))
    }

    /// All sections in file order, those without bytes left out.
    fn parts(&self) -> Result<Vec<Part<'_>>, Issue> {
        let shader = self.shader.encode().ok_or_else(|| {
            refuse(
                issue::SHADER_LENGTH,
                Tag::SHDR,
                format_args!("4 GiB or more"),
            )
        })?;
        let provenance = self.provenance.as_ref().map(canonical::encode);
        let spec = self.spec.encode();
        let records = ImageRecord::all(&self.images);
        let cells = offsets::stored_cells(&self.cells, &self.entries);
        let entries = offsets::stored_entries(&self.entries, &self.curves);
        // In the order of `SECTIONS`, on which a reader insists.
        let mut parts = vec![
            Part::new(Tag::META, canonical::encode(&self.meta)),
            Part::new(Tag::SPEC, words_to_little_endian(&spec).into_owned()),
            Part::new(Tag::PROV, provenance.unwrap_or_default()),
            Part::new(Tag::PANT, words_to_little_endian(&self.paints)),
            Part::new(Tag::GRAD, words_to_little_endian(&self.gradients)),
            Part::new(Tag::SHAP, words_to_little_endian(&self.shapes)),
            Part::new(Tag::LAYR, words_to_little_endian(&self.layers)),
            Part::new(Tag::IMAG, words_to_little_endian(&records).into_owned()),
            Part::new(Tag::CELL, words_to_little_endian(&cells).into_owned()),
            Part::new(Tag::ENTR, words_to_little_endian(&entries).into_owned()),
            self.curve_part(),
            Part::new(Tag::SHDR, shader),
            Part::new(Tag::FINE, words_to_little_endian(&self.fine)),
        ];
        parts.extend(self.tile_parts());
        parts.extend(self.mip_parts(&records));
        // A section without content is left out (V2011).
        parts.retain(|part| !part.raw.is_empty());
        if parts.len() > MAX_SECTIONS as usize {
            let message = format_args!("{} sections, {MAX_SECTIONS} at most", parts.len());
            return Err(refuse(issue::SECTION_COUNT, Tag::HEAD, message));
        }
        Ok(parts)
    }

    /// The outlines where there are some, else the records.
    fn curve_part(&self) -> Part<'_> {
        match &self.outlines {
            Some(outlines) => Part::new(Tag::OUTL, stream::encode(outlines, &self.curves)),
            None => Part::new(Tag::CURV, words_to_little_endian(&self.curves)),
        }
    }

    /// Ranges of whole layers.
    fn tile_parts(&self) -> Vec<Part<'_>> {
        let tile_bytes = 4 * tile_texels(self.meta.grid.texels_per_cell);
        let bytes = |layer: &LayerRecord| tile_bytes * u64::from(layer.tile_count);
        let mut ranges: Vec<u64> = Vec::new();
        for bytes in self.layers.iter().map(bytes) {
            match ranges.last_mut() {
                Some(total) if *total < TILE_PART_BYTES => *total += bytes,
                _ => ranges.push(bytes),
            }
        }
        let mut rest = self.tiles.as_slice();
        let cut = ranges.into_iter().map(|total| {
            let (texels, behind) = rest.split_at(usize::try_from(total).unwrap_or(rest.len()));
            rest = behind;
            Part::new(Tag::TILE, planes::planes_from_texels(texels))
        });
        cut.collect()
    }

    fn mip_parts(&self, records: &[ImageRecord]) -> impl Iterator<Item = Part<'_>> {
        mip_sections(records).into_iter().map(|part| {
            let mips = &self.images[part.image].mips;
            let level = |level: u32| mips[level as usize].as_slice();
            let raw = match part.levels.len() {
                1 => Cow::Borrowed(level(part.levels.start)),
                _ => part.stored_levels().flat_map(level).copied().collect(),
            };
            Part::new(Tag::MIPS, raw)
        })
    }
}

fn refuse(kind: IssueKind, tag: Tag, message: std::fmt::Arguments<'_>) -> Issue {
    let mut issues = Issues::default();
    issues.add(kind, tag, 0, message);
    issues.into_vec().remove(0)
}

/// The length of a section, which its entry has 32 bits for.
fn section_length(tag: Tag, bytes: usize) -> Result<u32, Issue> {
    u32::try_from(bytes).map_err(|_| {
        let message = format_args!("{bytes} bytes");
        refuse(issue::SECTION_LENGTH, tag, message)
    })
}

/// Puts sections that follow each other together while they are small.
fn bundles(parts: Vec<Part<'_>>) -> Result<Vec<Bundle<'_>>, Issue> {
    let mut bundles: Vec<Bundle<'_>> = Vec::new();
    for part in parts {
        let length = section_length(part.tag, part.raw.len())?;
        let entry = |shared| SectionEntry::new(part.tag, length, shared);
        match bundles.last_mut() {
            Some(bundle) if bundle.raw.len() + part.raw.len() <= SHARED_BYTES => {
                bundle.sections.push(entry(true));
                bundle.raw.to_mut().extend_from_slice(&part.raw);
            }
            _ => bundles.push(Bundle {
                sections: vec![entry(false)],
                raw: part.raw,
            }),
        }
    }
    Ok(bundles)
}

/// Places packed bundles behind header and table.
fn assemble(bundles: &[Bundle<'_>], stored: &[(Codec, Vec<u8>)]) -> Vec<u8> {
    let mut table = Vec::new();
    for (bundle, (codec, payload)) in bundles.iter().zip(stored) {
        let [first, others @ ..] = bundle.sections.as_slice() else {
            continue;
        };
        let head = BundleEntry {
            codec: *codec,
            // No longer than the raw bytes, whose lengths have been checked.
            stored_bytes: u32::try_from(payload.len()).unwrap_or(u32::MAX),
            hash: hash(&bundle.raw),
        };
        table.extend(first.encode());
        table.extend(head.encode());
        table.extend(others.iter().flat_map(|section| section.encode()));
    }
    let sections: usize = bundles.iter().map(|bundle| bundle.sections.len()).sum();
    let payload: usize = stored.iter().map(|(_, payload)| payload.len()).sum();
    let length = header::BYTES + table.len() + payload;
    let mut head = Header::new(u32::try_from(sections).unwrap_or(u32::MAX), length as u64);
    head.checksum = head.checksum_with(&table);
    let mut bytes = Vec::with_capacity(length);
    bytes.extend(head.encode());
    bytes.extend(table);
    for (_, payload) in stored {
        bytes.extend(payload);
    }
    bytes
}

fn hash(raw: &[u8]) -> [u8; HASH_BYTES] {
    field(blake3::hash(raw).as_bytes(), 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::container::layout::MAX_SHARED_BYTES;

    #[test]
    fn a_section_has_less_than_4_gib() {
        assert_eq!(section_length(Tag::TILE, 0xFFFF_FFFF), Ok(u32::MAX));
        let issue = section_length(Tag::TILE, 1 << 32).unwrap_err();
        assert_eq!(issue.code, issue::SECTION_LENGTH.code);
    }

    #[test]
    fn small_neighbours_share_a_bundle() {
        const { assert!(SHARED_BYTES as u64 <= MAX_SHARED_BYTES) };
        let part = |bytes| Part::new(Tag::MIPS, vec![7; bytes]);
        let lengths = [10, 20, SHARED_BYTES - 29, 29, SHARED_BYTES + 1, 5];
        let parts: Vec<_> = lengths.into_iter().map(part).collect();
        let found: Vec<usize> = bundles(parts)
            .unwrap()
            .iter()
            .map(|bundle| bundle.sections.len())
            .collect();
        assert_eq!(found, [2, 2, 1, 1]);
    }
}
