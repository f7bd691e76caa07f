//! Tiles and raster images.

use crate::container::issue::{self, Issues};
use crate::container::layout::tile_texels;
use crate::container::tag::Tag;
use crate::file::spec::Features;
use crate::file::texture::VtexFile;
use crate::records::image::{Image, ImageRecord, MAX_IMAGE_SIDE};

/// The tiles are as many bytes as the layers say, and every texel's alpha is 255.
pub(super) fn tiles(file: &VtexFile, issues: &mut Issues) {
    let count: u64 = file
        .layers
        .iter()
        .map(|layer| u64::from(layer.tile_count))
        .sum();
    let expected = (4 * tile_texels(file.meta.grid.texels_per_cell)).saturating_mul(count);
    if file.tiles.len() as u64 != expected {
        let message = format_args!(
            "{} bytes for {count} tiles, not {expected}",
            file.tiles.len()
        );
        issues.add(issue::TILE_BYTES, Tag::TILE, 0, message);
    }
    // Alpha is not stored: another value would not come back.
    let (texels, _) = file.tiles.as_chunks::<4>();
    if let Some(index) = texels.iter().position(|texel| texel[3] != u8::MAX) {
        let message = format_args!("texel {index} has {}", texels[index][3]);
        issues.add(issue::TILE_ALPHA, Tag::TILE, 4 * index as u64 + 3, message);
    }
}

/// Whether the records are sound, so that their levels' sizes can be computed.
pub(crate) fn image_records(records: &[ImageRecord], issues: &mut Issues) -> bool {
    let mut sound = true;
    for (index, record) in records.iter().enumerate() {
        let mut require = |holds: bool, kind, field: u64, found: &dyn std::fmt::Debug| {
            if !holds {
                sound = false;
                let offset = (index * size_of::<ImageRecord>()) as u64 + field;
                issues.add(
                    kind,
                    Tag::IMAG,
                    offset,
                    format_args!("image {index}: {found:?}"),
                );
            }
        };
        let [left, top, right, bottom] = record.rect_uv;
        let finite = record.rect_uv.iter().all(|edge| edge.is_finite());
        let area = finite && left < right && top < bottom;
        require(area, issue::IMAGE_RECT, 0, &record.rect_uv);
        let side = |texels: &u32| (1..=MAX_IMAGE_SIDE).contains(texels);
        require(
            record.size.iter().all(side),
            issue::IMAGE_SIZE,
            16,
            &record.size,
        );
        let levels = (1..=Image::level_count(record.size)).contains(&record.level_count);
        require(levels, issue::IMAGE_LEVELS, 24, &record.level_count);
        let texels = has_texels(records, index);
        require(texels, issue::IMAGE_TEXELS, 28, &record.texels_of);
    }
    sound
}

/// Whether the image has texels of its own or those of an earlier image that does, of the same size.
fn has_texels(records: &[ImageRecord], index: usize) -> bool {
    let record = &records[index];
    let place = record.texels_of as usize;
    let earlier = |owner: &ImageRecord| {
        owner.texels_of == record.texels_of
            && owner.size == record.size
            && owner.level_count == record.level_count
    };
    place == index || place < index && earlier(&records[place])
}

/// Every image has the texels of its levels, and image 0 is the canvas where the key says so.
pub(super) fn images(file: &VtexFile, issues: &mut Issues) {
    let records = ImageRecord::all(&file.images);
    image_records(&records, issues);
    for (index, (image, record)) in file.images.iter().zip(&records).enumerate() {
        if record.texels_of as usize != index {
            continue;
        }
        for (level, texels) in (0..record.level_count).zip(image.mips.iter()) {
            let expected = Image::level_bytes(image.size, level);
            if texels.len() as u64 != expected {
                let length = texels.len();
                let message =
                    format_args!("image {index} level {level}: {length} bytes, not {expected}");
                issues.add(issue::MIP_BYTES, Tag::MIPS, 0, message);
            }
        }
    }
    if file.spec.features & Features::MIPS != 0 {
        canvas_image(records.first(), issues);
    }
}

/// The canvas image covers the canvas and has all its levels: nothing else shows a canvas that is
/// smaller than a pixel.
fn canvas_image(record: Option<&ImageRecord>, issues: &mut Issues) {
    let rect_uv = record.map(|record| record.rect_uv);
    if rect_uv != Some([0.0, 0.0, 1.0, 1.0]) {
        let message = format_args!("its rectangle is {rect_uv:?}");
        issues.add(issue::CANVAS_IMAGE, Tag::IMAG, 0, message);
    }
    if let Some(record) = record
        && record.level_count < Image::level_count(record.size)
    {
        let message = format_args!("the canvas image has {} levels", record.level_count);
        issues.add(issue::IMAGE_LEVELS, Tag::IMAG, 24, message);
    }
}
