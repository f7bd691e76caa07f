//! Bytes to value: sections are unpacked in file order, each once its length is known to be what
//! the ones before it imply.

use std::sync::Arc;

use bytemuck::Pod;

use super::levels::mip_sections;
use super::{canonical, offsets, planes};
use crate::check::{self, images::image_records};
use crate::container::directory::{Directory, read_directory, slice};
use crate::container::error::ReadError;
use crate::container::issue::{self, Issue, Issues};
use crate::container::layout::{TILE_PLANES, entry, tile_texels};
use crate::container::limits::Limits;
use crate::container::section::SectionInfo;
use crate::container::tag::Tag;
use crate::container::words::words_from_little_endian;
use crate::curves::outlines::{OutlineError, StoredOutlines, stream};
use crate::file::spec::{OLDEST_ABI, SHADER_ABI, SpecKey};
use crate::file::texture::VtexFile;
use crate::packing::unpack::{Refusal, allocate, unpack};
use crate::records::image::{Image, ImageRecord};
use crate::records::layer::LayerRecord;
use crate::records::meta::Meta;
use crate::records::prov::Provenance;
use crate::records::shader::ShaderBlob;

impl VtexFile {
    /// Reads and checks a whole file: what this returns is safe to evaluate.
    ///
    /// # Errors
    /// The first issue, by who is at fault; [`validate`] finds the others.
    pub fn parse(bytes: &[u8], limits: &Limits) -> Result<Self, ReadError> {
        let mut issues = Issues::default();
        let file = read(bytes, limits, None, &mut issues);
        Ok(issues.accept(file)?)
    }

    /// As [`VtexFile::parse`], for loaders that need no lists. Where the file has [`VtexFile::fine`] cells
    /// it is shown to `suffices` without cells, entries, curves, outlines, shapes and provenance. If that
    /// says yes, none of them is read or checked. Else they are, and this does what `parse` does.
    ///
    /// # Errors
    /// As [`VtexFile::parse`], as far as the file is read.
    pub fn parse_unless(
        bytes: &[u8],
        limits: &Limits,
        suffices: &mut dyn FnMut(&Self) -> bool,
    ) -> Result<Self, ReadError> {
        let mut issues = Issues::default();
        let file = read(bytes, limits, Some(suffices), &mut issues);
        Ok(issues.accept(file)?)
    }
}

/// Everything wrong with a file, up to 256 issues. Header and table come first; with those broken
/// nothing else can be found, and the content is only looked at when every section unpacks.
pub fn validate(bytes: &[u8], limits: &Limits) -> Vec<Issue> {
    let mut issues = Issues::default();
    read(bytes, limits, None, &mut issues);
    issues.into_vec()
}

/// Whether a file does without its lists.
type Suffices<'a> = &'a mut dyn FnMut(&VtexFile) -> bool;

fn read(
    bytes: &[u8],
    limits: &Limits,
    suffices: Option<Suffices<'_>>,
    issues: &mut Issues,
) -> Option<VtexFile> {
    let directory = read_directory(bytes, limits, issues)?;
    let mut loader = Loader {
        bytes,
        directory: &directory,
        issues,
        shared: None,
    };
    // Lengths of the rest hang on these settings.
    let meta = loader.meta()?;
    if let Some(suffices) = suffices
        && !loader.all(Tag::FINE).is_empty()
    {
        let file = loader.without_lists(&meta)?;
        check::without_lists(&file, loader.issues);
        if !loader.issues.is_empty() || suffices(&file) {
            return Some(file);
        }
    }
    // No `?` before all have been tried: `validate` lists the issues of every section.
    let spec = loader.spec();
    let provenance = loader.provenance();
    let paints = loader.records(Tag::PANT);
    let gradients = loader.records(Tag::GRAD);
    let shapes = loader.records(Tag::SHAP);
    let layers = loader.records(Tag::LAYR);
    let images = loader.records(Tag::IMAG);
    let cells = loader.cells(&meta);
    let entries = loader.records(Tag::ENTR);
    let curves = loader.curves(&meta, limits);
    let shader = loader.shader();
    let fine = loader.records(Tag::FINE);
    let tiles = layers
        .as_deref()
        .and_then(|layers| loader.tiles(&meta, layers));
    let images = images.as_deref().and_then(|records| loader.images(records));
    let (curves, outlines) = curves?;
    let (mut cells, mut entries) = (cells?, entries?);
    // In this order: an entry is stored relative to the end of a record, a cell relative to the end
    // of a list.
    offsets::entries_from_stored(&mut entries, &curves);
    offsets::cells_from_stored(&mut cells, &entries);
    let file = VtexFile {
        meta,
        spec: spec?,
        shader: shader?,
        paints: paints?,
        gradients: gradients?,
        shapes: shapes?,
        layers: layers?,
        cells,
        entries,
        curves,
        outlines,
        fine: fine?,
        tiles: tiles?,
        images: images?,
        provenance: provenance?,
    };
    check::content(&file, issues);
    Some(file)
}

/// Unpacks sections. Every method notes why it returns `None`.
struct Loader<'a> {
    bytes: &'a [u8],
    directory: &'a Directory,
    issues: &'a mut Issues,
    /// The last bundle of several sections and its raw bytes, if it unpacks. Sections are read in
    /// file order, so each bundle is unpacked once.
    shared: Option<(usize, Option<Vec<u8>>)>,
}

impl Loader<'_> {
    /// All but lists, what they are made of, and what lookups do not need.
    fn without_lists(&mut self, meta: &Meta) -> Option<VtexFile> {
        let spec = self.spec()?;
        let paints = self.records(Tag::PANT)?;
        let gradients = self.records(Tag::GRAD)?;
        let layers: Vec<LayerRecord> = self.records(Tag::LAYR)?;
        let images: Vec<ImageRecord> = self.records(Tag::IMAG)?;
        let shader = self.shader()?;
        let fine = self.records(Tag::FINE)?;
        let tiles = self.tiles(meta, &layers)?;
        let images = self.images(&images)?;
        Some(VtexFile {
            meta: meta.clone(),
            spec,
            shader,
            paints,
            gradients,
            shapes: Vec::new(),
            layers,
            cells: Vec::new(),
            entries: Vec::new(),
            curves: Vec::new(),
            outlines: None,
            fine,
            tiles,
            images,
            provenance: None,
        })
    }

    fn section(&self, index: usize) -> &SectionInfo {
        &self.directory.sections[index]
    }

    /// All sections of a tag with their places in the table.
    fn all(&self, tag: Tag) -> Vec<(usize, SectionInfo)> {
        let sections = self.directory.sections.iter().copied().enumerate();
        sections.filter(|(_, section)| section.tag == tag).collect()
    }

    /// A section unpacked into memory of its raw length.
    fn unpack(&mut self, index: usize, raw: &mut [u8]) -> Option<()> {
        let section = *self.section(index);
        if self.directory.bundles[section.bundle].section_count == 1 {
            return self.unpack_bundle(section.bundle, raw);
        }
        if !matches!(self.shared, Some((bundle, _)) if bundle == section.bundle) {
            let content = self.shared_bundle(section.bundle);
            self.shared = Some((section.bundle, content));
        }
        let (_, content) = self.shared.as_ref()?;
        let end = section.start_bytes + section.raw_bytes;
        raw.copy_from_slice(slice(content.as_ref()?, section.start_bytes, end));
        Some(())
    }

    fn shared_bundle(&mut self, bundle: usize) -> Option<Vec<u8>> {
        let info = &self.directory.bundles[bundle];
        let memory = allocate(info.raw_bytes);
        let mut raw: Vec<u8> = self.accept(info.section_first, memory)?;
        self.unpack_bundle(bundle, &mut raw)?;
        Some(raw)
    }

    fn unpack_bundle(&mut self, bundle: usize, raw: &mut [u8]) -> Option<()> {
        let info = &self.directory.bundles[bundle];
        let start = info.offset_bytes;
        let stored = slice(self.bytes, start, start + info.stored_bytes);
        let result = unpack(info, stored, raw);
        self.accept(info.section_first, result)
    }

    fn accept<T>(&mut self, index: usize, result: Result<T, Refusal>) -> Option<T> {
        let SectionInfo {
            tag,
            entry_offset_bytes,
            ..
        } = *self.section(index);
        let note = |(kind, message): Refusal| {
            let message = format_args!("{tag}: {message}");
            self.issues
                .add(kind, Tag::SECT, entry_offset_bytes, message);
        };
        result.map_err(note).ok()
    }

    /// The elements of a section as they are stored.
    fn load<T: Pod>(&mut self, index: usize) -> Option<Vec<T>> {
        let memory = allocate(self.section(index).raw_bytes);
        let mut elements: Vec<T> = self.accept(index, memory)?;
        self.unpack(index, bytemuck::cast_slice_mut(&mut elements))?;
        Some(elements)
    }

    /// The raw bytes of a section that occurs once; empty when it is absent.
    fn raw(&mut self, tag: Tag) -> Option<Vec<u8>> {
        match self.all(tag).first() {
            Some(&(index, _)) => self.load(index),
            None => Some(Vec::new()),
        }
    }

    /// The records of a section that occurs once; empty when it is absent.
    fn records<T: Pod>(&mut self, tag: Tag) -> Option<Vec<T>> {
        let Some(&(index, _)) = self.all(tag).first() else {
            return Some(Vec::new());
        };
        let mut records = self.load(index)?;
        words_from_little_endian(&mut records);
        Some(records)
    }

    /// Notes a raw length that is not what earlier sections imply, before memory is asked for.
    fn expect_bytes(&mut self, index: usize, kind: issue::IssueKind, expected: u64) -> Option<()> {
        let section = *self.section(index);
        if section.raw_bytes == expected {
            return Some(());
        }
        let offset = section.entry_offset_bytes + entry::RAW_BYTES as u64;
        let message = format_args!(
            "{}: {} bytes, not {expected}",
            section.tag, section.raw_bytes
        );
        self.issues.add(kind, Tag::SECT, offset, message);
        None
    }

    fn meta(&mut self) -> Option<Meta> {
        let raw = self.raw(Tag::META)?;
        let meta = match canonical::decode(&raw) {
            Ok(meta) => meta,
            Err(message) => {
                self.issues
                    .add(issue::BINCODE, Tag::META, 0, format_args!("{message}"));
                return None;
            }
        };
        check::meta(&meta, self.issues).then_some(meta)
    }

    fn provenance(&mut self) -> Option<Option<Provenance>> {
        let raw = self.raw(Tag::PROV)?;
        if raw.is_empty() {
            return Some(None);
        }
        match canonical::decode(&raw) {
            Ok(provenance) => Some(Some(provenance)),
            Err(message) => {
                self.issues
                    .add(issue::BINCODE, Tag::PROV, 0, format_args!("{message}"));
                None
            }
        }
    }

    fn spec(&mut self) -> Option<SpecKey> {
        let &(index, _) = self.all(Tag::SPEC).first()?;
        self.expect_bytes(index, issue::SPEC_LENGTH, 4 * SpecKey::WORDS as u64)?;
        let words: Vec<u32> = self.records(Tag::SPEC)?;
        let &[abi, features, ref rest @ ..] = words.first_chunk::<{ SpecKey::WORDS }>()?;
        match abi {
            OLDEST_ABI..=SHADER_ABI => {
                if let Some(word) = rest.iter().position(|&word| word != 0) {
                    let message = format_args!("{:#x}", rest[word]);
                    let offset = 4 * (2 + word) as u64;
                    self.issues
                        .add(issue::SPEC_RESERVED, Tag::SPEC, offset, message);
                }
                Some(SpecKey { features })
            }
            _ => {
                let message = format_args!("{abi}; {OLDEST_ABI} to {SHADER_ABI} are known");
                self.issues.add(issue::SPEC_ABI, Tag::SPEC, 0, message);
                None
            }
        }
    }

    fn shader(&mut self) -> Option<ShaderBlob> {
        let raw = self.raw(Tag::SHDR)?;
        ShaderBlob::decode(&raw, self.issues)
    }

    fn cells(&mut self, meta: &Meta) -> Option<Vec<u32>> {
        let &(index, _) = self.all(Tag::CELL).first()?;
        let [columns, rows] = meta.grid.size_cells.map(u64::from);
        self.expect_bytes(index, issue::CELL_COUNT, 4 * columns * rows)?;
        self.records(Tag::CELL)
    }

    /// The curve records, stored or cut from outlines.
    fn curves(
        &mut self,
        meta: &Meta,
        limits: &Limits,
    ) -> Option<(Vec<u32>, Option<StoredOutlines>)> {
        let Some(&(index, _)) = self.all(Tag::OUTL).first() else {
            return Some((self.records(Tag::CURV)?, None));
        };
        if !self.all(Tag::CURV).is_empty() {
            let refusal = (issue::OUTLINE_TWICE, "beside CURV".to_owned());
            return self.accept(index, Err(refusal));
        }
        let raw: Vec<u8> = self.load(index)?;
        // What decoding takes counts as if it were stored.
        let spent = self.directory.read_bytes();
        let budget = limits.total_raw_bytes.saturating_sub(spent);
        let (words, outlines) = self.accept(index, cut_records(&raw, meta, budget))?;
        Some((words, Some(outlines)))
    }

    /// The tiles of all layers. Each section holds those of some layers, as its length tells.
    fn tiles(&mut self, meta: &Meta, layers: &[LayerRecord]) -> Option<Vec<u8>> {
        let parts = self.all(Tag::TILE);
        let tile_bytes = TILE_PLANES as u64 * tile_texels(meta.grid.texels_per_cell);
        let layer_bytes = |layer: &LayerRecord| tile_bytes.saturating_mul(layer.tile_count.into());
        let mut rest = layers.iter().map(layer_bytes).filter(|&bytes| bytes > 0);
        for (_, section) in &parts {
            let mut missing = section.raw_bytes;
            while missing > 0 {
                let Some(left) = rest.next().and_then(|bytes| missing.checked_sub(bytes)) else {
                    let offset = section.entry_offset_bytes + entry::RAW_BYTES as u64;
                    let message = format_args!("{missing} bytes do not fill a layer");
                    self.issues
                        .add(issue::TILE_LAYERS, Tag::SECT, offset, message);
                    return None;
                };
                missing = left;
            }
        }
        let left = rest.count();
        if left > 0 {
            let message = format_args!("{left} layers with tiles have no TILE");
            self.issues.add(issue::TILE_LAYERS, Tag::SECT, 0, message);
            return None;
        }
        self.texels(&parts)
    }

    /// The texels of several tile sections in one piece of memory.
    fn texels(&mut self, parts: &[(usize, SectionInfo)]) -> Option<Vec<u8>> {
        let Some(&(first, _)) = parts.first() else {
            return Some(Vec::new());
        };
        // The lengths are known to be what the layers imply, so they divide.
        let texel_bytes = |section: &SectionInfo| section.raw_bytes / TILE_PLANES as u64 * 4;
        let total = parts.iter().map(|(_, section)| texel_bytes(section)).sum();
        let memory = allocate(total);
        let mut all: Vec<u8> = self.accept(first, memory)?;
        let mut rest = all.as_mut_slice();
        for (index, section) in parts {
            let stored: Vec<u8> = self.load(*index)?;
            let length = usize::try_from(texel_bytes(section)).ok()?;
            let (texels, behind) = rest.split_at_mut(length);
            planes::texels_from_planes(&stored, texels);
            rest = behind;
        }
        Some(all)
    }

    /// Images with their levels, which are stored smallest first.
    fn images(&mut self, records: &[ImageRecord]) -> Option<Vec<Image>> {
        if !image_records(records, self.issues) {
            return None;
        }
        let (parts, expected) = (self.all(Tag::MIPS), mip_sections(records));
        // Counted first: the `zip` below ends with the shorter of the two.
        if parts.len() != expected.len() {
            let (found, wanted) = (parts.len(), expected.len());
            let message = format_args!("{found} sections, not {wanted}");
            self.issues.add(issue::MIP_PARTS, Tag::SECT, 0, message);
            return None;
        }
        let mut chains: Vec<Vec<Vec<u8>>> = vec![Vec::new(); records.len()];
        for ((index, _), part) in parts.into_iter().zip(expected) {
            let size = records[part.image].size;
            self.expect_bytes(index, issue::MIP_BYTES, part.bytes(size))?;
            let texels: Vec<u8> = self.load(index)?;
            let mips = &mut chains[part.image];
            if part.levels.len() == 1 {
                mips.push(texels);
                continue;
            }
            let mut rest = texels.as_slice();
            for level in part.stored_levels() {
                let length = usize::try_from(Image::level_bytes(size, level)).ok()?;
                let (texels, behind) = rest.split_at(length);
                mips.push(texels.to_vec());
                rest = behind;
            }
        }
        // The file has the smallest level first.
        chains.iter_mut().for_each(|levels| levels.reverse());
        let chains: Vec<_> = chains.into_iter().map(Arc::new).collect();
        let shared = |record: &ImageRecord| record.image(&chains[record.texels_of as usize]);
        Some(records.iter().map(shared).collect())
    }
}

/// The records that the bytes of `OUTL` make, in at most `budget` bytes of memory.
fn cut_records(
    raw: &[u8],
    meta: &Meta,
    budget: u64,
) -> Result<(Vec<u32>, StoredOutlines), Refusal> {
    let refuse = |error: OutlineError| {
        let kind = match error {
            OutlineError::Work => issue::OUTLINE_BUDGET,
            _ => issue::OUTLINES,
        };
        (kind, error.to_string())
    };
    let no_lattice = || (issue::CURVE_LATTICE_USE, "no lattice".to_owned());
    let lattice = meta.curve_lattice.ok_or_else(no_lattice)?;
    let head = stream::decode_head(raw).map_err(refuse)?;
    // Before anything is allocated: the counts are what the file claims.
    let needed = head.memory_bytes();
    if needed > budget {
        let message = format!("{needed} bytes, {budget} are left of total_raw_bytes");
        return Err((issue::OUTLINE_BUDGET, message));
    }
    let outlines = stream::decode(raw).map_err(refuse)?;
    let words = outlines
        .records_within(&meta.grid, lattice, u64::from(head.words))
        .map_err(refuse)?;
    // The checksum is of the words that the writer had. It shows a machine that rounds otherwise.
    if !head.vouches_for(&words) {
        let message = "the records are not those that the writer had".to_owned();
        return Err((issue::OUTLINE_RECORDS, message));
    }
    Ok((words, outlines))
}
