//! The warning about a texture that takes much of a GPU's memory.

use vtex_format::{
    COVERAGE_IMAGE, EMBEDDED_SOURCE, Image, ShapeRecord, VtexFile, Warning, WarningCode,
};
use vtex_shaders::{PackOptions, pack, page_bytes};

use crate::{Mode, raster::canvas::LookedUp, warning};

/// Words of a texture, as loaders pack it, are at most this many times those that the lookups for mips
/// read: of 276 drawings at most 2.03 times, of those with more than a megabyte 1.71 times. A drawing that is
/// off by more gets no warning only if it is that close to its budget.
const SPREAD: usize = 2;
/// The same for drawings whose mips are made without lookups: at most this many times what cells,
/// lists, curves, tiles and paints take in the file. The most of 276 drawings is 12.9.
const UNPACKED_SPREAD: usize = 16;

/// Notes in the file's provenance that it takes more than `budget` bytes, if it does.
///
/// Packing a texture to count its bytes may take half the time of a bake, so it is done only where a bound
/// on them does not decide. The note says what was counted.
pub(super) fn warn(file: &mut VtexFile, read: Option<LookedUp>, mode: Mode, budget: u64) {
    let texels = page_bytes(&file.images);
    let over = |words: usize| (words + texels) as u64 > budget;
    if !over(most_word_bytes(file, read)) {
        return;
    }
    let words = pack(file, &PackOptions::default()).word_bytes();
    if !over(words) {
        return;
    }
    let message = message(&parts(file, mode, words), budget);
    if let Some(provenance) = &mut file.provenance {
        let warning: Warning = warning::plain(WarningCode::GpuBytes, "gpu-budget", "", message);
        // Others may be many, and tools show the first few.
        provenance.warnings.insert(0, warning);
    }
}

/// A bound on the bytes of a texture's words.
fn most_word_bytes(file: &VtexFile, read: Option<LookedUp>) -> usize {
    match read {
        // A halving doubles the number of cells that hold a segment.
        Some(read) => SPREAD * (read.word_bytes << read.fewer_halvings),
        None => {
            let words = file.cells.len() + file.entries.len() + file.curves.len();
            let paints = size_of_val(&*file.paints) + size_of_val(&*file.gradients);
            UNPACKED_SPREAD * (4 * words + file.tiles.len() + paints)
        }
    }
}

/// A part of a texture: its name, its bytes, and how to make it smaller.
type Part = (&'static str, usize, &'static str);

/// What a texture of this mode with so many bytes of words consists of, the largest part first.
fn parts(file: &VtexFile, mode: Mode, words: usize) -> Vec<Part> {
    let is_embedded = embedded(file);
    let images = |embedded: bool| {
        let chosen = is_embedded.iter().filter(move |(_, is)| *is == embedded);
        match chosen.clone().count() {
            0 => 0,
            _ => page_bytes(chosen.map(|&(image, _)| image)),
        }
    };
    let mut parts = vec![
        (
            "raster patches",
            images(false),
            match mode {
                Mode::Raster => "--mode auto keeps as shapes what can be",
                _ => "the warnings about raster patches name what no shape can be",
            },
        ),
        (
            "embedded images",
            images(true),
            "embed them with fewer pixels",
        ),
        (
            "mips",
            page_bytes(&file.images[..1.min(file.images.len())]),
            "a smaller --size makes fewer of them",
        ),
        (
            "MSDF tiles",
            file.tiles.len(),
            "a smaller --msdf-size makes fewer of them",
        ),
        (
            "cells and segments",
            words.saturating_sub(file.tiles.len()),
            "outlines with fewer segments make fewer of them",
        ),
    ];
    parts.retain(|&(_, bytes, _)| bytes > 0);
    parts.sort_by_key(|&(_, bytes, _)| std::cmp::Reverse(bytes));
    parts
}

/// The images besides mips, and whether the SVG embeds them.
fn embedded(file: &VtexFile) -> Vec<(&Image, bool)> {
    let reports = file.provenance.iter().flat_map(|told| &told.shapes);
    let is_image = |shape: &ShapeRecord| shape.coverage == COVERAGE_IMAGE;
    file.shapes
        .iter()
        .zip(reports)
        .filter(|(shape, _)| is_image(shape))
        .filter_map(|(shape, report)| {
            let image = file.images.get(shape.layer_or_image as usize)?;
            Some((image, report.source == EMBEDDED_SOURCE))
        })
        .collect()
}

fn message(parts: &[Part], budget: u64) -> String {
    let all: usize = parts.iter().map(|(_, bytes, _)| bytes).sum();
    let each = parts
        .iter()
        .map(|&(name, bytes, _)| format!("{name} {}", size(bytes as u64)));
    let each: Vec<String> = each.collect();
    let advice = parts.first().map_or("", |&(_, _, advice)| advice);
    format!(
        "takes about {} on a GPU, more than the budget of {}: {}; {advice}",
        size(all as u64),
        size(budget),
        each.join(", ")
    )
}

/// Bytes for people.
fn size(bytes: u64) -> String {
    match bytes {
        0..0x400 => format!("{bytes} B"),
        0x400..0x10_0000 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BakeConfig, Resources, bake};

    const CURVES: &str = "<path d='M5 5C90 10 10 90 95 95L60 5Z'/>";
    const BLURRED: &str = "<filter id='f'><feTurbulence baseFrequency='.4'/></filter>\
        <path d='M5 5H95V95H5Z' filter='url(#f)'/>";

    fn warnings(content: &str, mode: Mode, budget: u64) -> (usize, Vec<Warning>) {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{content}</svg>"
        );
        let config = BakeConfig {
            mode,
            gpu_budget_bytes: budget,
            ..BakeConfig::default()
        };
        let file = bake(svg.as_bytes(), &config, &Resources::default()).unwrap();
        let bytes = pack(&file, &PackOptions::default()).bytes();
        let told = file.provenance.unwrap().warnings.into_iter();
        let told = told.filter(|warning| warning.code == WarningCode::GpuBytes);
        (bytes, told.collect())
    }

    #[test]
    fn only_textures_beyond_the_budget_are_told_of() {
        for mode in [Mode::Auto, Mode::Msdf, Mode::Raster] {
            let (bytes, none) = warnings(CURVES, mode, u64::MAX);
            assert_eq!(none, [], "{mode:?}");
            // Exact where the bounds do not decide, as here.
            for (budget, count) in [(bytes, 0), (bytes - 1, 1), (100, 1)] {
                let (_, told) = warnings(CURVES, mode, budget as u64);
                assert_eq!(told.len(), count, "{mode:?}: {budget} of {bytes}");
            }
        }
    }

    #[test]
    fn the_largest_part_comes_first() {
        for (content, mode, part) in [
            (CURVES, Mode::Auto, "mips"),
            (CURVES, Mode::Msdf, "MSDF tiles"),
            (BLURRED, Mode::Auto, "raster patches"),
        ] {
            let (_, told) = warnings(content, mode, 1000);
            let text = &told[0].message;
            assert!(text.contains(&format!("1000 B: {part} ")), "{text}");
        }
    }
}
