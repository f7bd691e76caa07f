//! Value to bytes: the same value gives the same bytes.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::levels::level_order;
use super::pack::pack;
use super::{canonical, offsets, planes};
use crate::check;
use crate::container::error::WriteError;
use crate::container::header::{Header, put};
use crate::container::issue::{self, Issue, Issues};
use crate::container::layout::{self, MAX_SECTIONS, entry, header, tile_texels};
use crate::container::section::{Codec, SectionInfo};
use crate::container::tag::Tag;
use crate::container::words::words_to_little_endian;
use crate::curves::outlines::stream;
use crate::file::texture::VtexFile;
use crate::records::image::ImageRecord;
use crate::records::layer::LayerRecord;

/// Layers are gathered until their tiles reach this many bytes in memory: large enough to pack well, small
/// enough to be a useful part.
const TILE_PART_BYTES: u64 = 4 << 20;

/// Runs jobs: calls its second argument once for every number below the first.
pub type Executor<'a> = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + 'a;

/// A section before it is packed.
struct Part<'a> {
    tag: Tag,
    /// Image and level.
    image: (u32, u32),
    /// First layer and number of layers.
    layers: (u32, u32),
    raw: Cow<'a, [u8]>,
}

impl<'a> Part<'a> {
    fn whole(tag: Tag, raw: impl Into<Cow<'a, [u8]>>) -> Self {
        Self {
            tag,
            image: (0, 0),
            layers: (0, 0),
            raw: raw.into(),
        }
    }
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
        let parts = self.parts()?;
        // Each job has a slot of its own, so the order of the jobs does not show in the bytes.
        let slots: Vec<OnceLock<_>> = parts.iter().map(|_| OnceLock::new()).collect();
        run(parts.len(), &|index| {
            slots[index].get_or_init(|| pack(&parts[index].raw));
        });
        let stored = slots.into_iter().map(|slot| {
            let packed = slot.into_inner().expect("the caller runs every job");
            packed.map_err(WriteError::Compress)
        });
        Ok(assemble(&parts, &stored.collect::<Result<Vec<_>, _>>()?))
    }

    /// All sections in file order, those without bytes left out.
    fn parts(&self) -> Result<Vec<Part<'_>>, Issue> {
        let refuse = |kind, tag, message: std::fmt::Arguments<'_>| {
            let mut issues = Issues::default();
            issues.add(kind, tag, 0, message);
            issues.into_vec().remove(0)
        };
        let shader = self.shader.encode().ok_or_else(|| {
            refuse(
                issue::SHADER_LENGTH,
                Tag::SHDR,
                format_args!("4 GiB or more"),
            )
        })?;
        let provenance = self.provenance.as_ref().map(canonical::encode);
        let spec = self.spec.encode();
        let records: Vec<_> = self.images.iter().map(ImageRecord::of).collect();
        let cells = offsets::stored_cells(&self.cells, &self.entries);
        let entries = offsets::stored_entries(&self.entries, &self.curves);
        // In the order of `SECTIONS`, on which a reader insists.
        let mut parts = vec![
            Part::whole(Tag::META, canonical::encode(&self.meta)),
            Part::whole(Tag::SPEC, words_to_little_endian(&spec).into_owned()),
            Part::whole(Tag::SHDR, shader),
            Part::whole(Tag::PROV, provenance.unwrap_or_default()),
            Part::whole(Tag::PANT, words_to_little_endian(&self.paints)),
            Part::whole(Tag::GRAD, words_to_little_endian(&self.gradients)),
            Part::whole(Tag::SHAP, words_to_little_endian(&self.shapes)),
            Part::whole(Tag::LAYR, words_to_little_endian(&self.layers)),
            Part::whole(Tag::IMAG, words_to_little_endian(&records).into_owned()),
            Part::whole(Tag::CELL, words_to_little_endian(&cells).into_owned()),
            Part::whole(Tag::ENTR, words_to_little_endian(&entries).into_owned()),
            self.curve_part(),
        ];
        parts.extend(self.tile_parts());
        parts.extend(self.mip_parts());
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
            Some(outlines) => Part::whole(Tag::OUTL, stream::encode(outlines, &self.curves)),
            None => Part::whole(Tag::CURV, words_to_little_endian(&self.curves)),
        }
    }

    /// Ranges of whole layers; trailing layers without tiles join the last one.
    fn tile_parts(&self) -> Vec<Part<'_>> {
        let tile_bytes = 4 * tile_texels(self.meta.grid.texels_per_cell);
        let bytes = |layer: &LayerRecord| tile_bytes * u64::from(layer.tile_count);
        let mut ranges: Vec<(u32, u32, u64)> = Vec::new();
        for (index, layer) in (0_u32..).zip(&self.layers) {
            // A layer without tiles joins any range: it adds no bytes.
            match ranges.last_mut() {
                Some((_, count, total)) if *total < TILE_PART_BYTES || bytes(layer) == 0 => {
                    *count += 1;
                    *total += bytes(layer);
                }
                _ => ranges.push((index, 1, bytes(layer))),
            }
        }
        let mut rest = self.tiles.as_slice();
        let cut = ranges.into_iter().map(|(first, count, total)| {
            let (texels, behind) = rest.split_at(usize::try_from(total).unwrap_or(rest.len()));
            rest = behind;
            Part {
                layers: (first, count),
                ..Part::whole(Tag::TILE, planes::planes_from_texels(texels))
            }
        });
        cut.collect()
    }

    fn mip_parts(&self) -> impl Iterator<Item = Part<'_>> {
        let counts = self
            .images
            .iter()
            .map(|image| ImageRecord::of(image).level_count);
        level_order(counts).map(|(level, image)| Part {
            // The caller refuses more than MAX_SECTIONS parts, so the index fits.
            image: (u32::try_from(image).unwrap_or(u32::MAX), level),
            ..Part::whole(
                Tag::MIPS,
                self.images[image].mips[level as usize].as_slice(),
            )
        })
    }
}

/// Places packed sections behind header and table.
fn assemble(parts: &[Part<'_>], stored: &[(Codec, Vec<u8>)]) -> Vec<u8> {
    // Room for header and table, which are written last.
    let mut bytes = vec![0; header::BYTES + parts.len() * entry::BYTES];
    let mut table = Vec::with_capacity(parts.len() * entry::BYTES);
    for (part, (codec, payload)) in parts.iter().zip(stored) {
        bytes.resize(bytes.len().next_multiple_of(header::BYTES), 0);
        let section = SectionInfo {
            tag: part.tag,
            critical: part.tag.kind().is_some_and(|kind| kind.critical),
            codec: *codec,
            offset_bytes: bytes.len() as u64,
            stored_bytes: payload.len() as u64,
            raw_bytes: part.raw.len() as u64,
            hash: *blake3::hash(&part.raw).as_bytes(),
            image: part.image.0,
            mip: part.image.1,
            layer_first: part.layers.0,
            layer_count: part.layers.1,
        };
        table.extend(section.encode());
        bytes.extend(payload);
    }
    let count = u32::try_from(parts.len()).unwrap_or(u32::MAX);
    let mut head = Header::new(count, bytes.len() as u64);
    head.checksum = head.checksum_with(&table);
    put(&mut bytes, 0, &head.encode());
    put(&mut bytes, header::BYTES, &table);
    bytes
}

const _: () = assert!(
    header::BYTES as u64 == layout::ALIGNMENT_BYTES,
    "sections are padded to the header's size"
);
