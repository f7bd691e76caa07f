//! How much of the canvas raster patches cover.

use std::ops::Range;

use vtex_format::{COVERAGE_IMAGE, EMBEDDED_SOURCE, Image, VtexFile};

/// Points along each side of the canvas at which patches are looked up: a share is right to about 1
/// in 512.
const SIDE: u32 = 512;

/// The raster patches of a file. Images embedded in the SVG keep their own texels and do not count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchCover {
    /// Number of patches.
    pub count: usize,
    /// Share of the canvas where at least one patch is not transparent, in \[0, 1\].
    pub area: f64,
}

/// What the patches of `file` cover together.
pub fn patch_cover(file: &VtexFile) -> PatchCover {
    let mut covered = vec![false; (SIDE * SIDE) as usize];
    let mut count = 0;
    let reports = file.provenance.iter().flat_map(|told| &told.shapes);
    let embedded = reports.map(|report| report.source == EMBEDDED_SOURCE);
    for (shape, embedded) in file
        .shapes
        .iter()
        .zip(embedded.chain(std::iter::repeat(false)))
    {
        if shape.coverage != COVERAGE_IMAGE || embedded {
            continue;
        }
        count += 1;
        if let Some(image) = file.images.get(shape.layer_or_image as usize) {
            mark(image, &mut covered);
        }
    }
    let shown = covered.iter().filter(|&&place| place).count();
    PatchCover {
        count,
        area: shown as f64 / covered.len() as f64,
    }
}

/// Marks the places where level 0 of `image` has alpha above 0.
fn mark(image: &Image, covered: &mut [bool]) {
    let [left, top, right, bottom] = image.rect_uv;
    let Some(texels) = image.mips.first() else {
        return;
    };
    for y in places(top, bottom) {
        let row = texel(y, [top, bottom], image.size[1]) * image.size[0];
        for x in places(left, right) {
            let at = row + texel(x, [left, right], image.size[0]);
            let alpha = texels.get(at as usize * 4 + 3).copied().unwrap_or(0);
            if let Some(place) = covered.get_mut((y * SIDE + x) as usize) {
                *place |= alpha > 0;
            }
        }
    }
}

/// Places whose centres lie between two edges.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the places there are"
)]
fn places(low: f32, high: f32) -> Range<u32> {
    let first = |edge: f32| (edge * SIDE as f32 - 0.5).ceil().clamp(0.0, SIDE as f32) as u32;
    first(low)..first(high)
}

/// The texel under a place's centre, of `count` between two edges.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the texels there are"
)]
fn texel(place: u32, [low, high]: [f32; 2], count: u32) -> u32 {
    let along = ((place as f32 + 0.5) / SIDE as f32 - low) / (high - low);
    ((along * count as f32) as u32).min(count.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use vtex_baker::{BakeConfig, Mode, Resources, bake};

    use super::*;

    fn cover(content: &str, mode: Mode) -> PatchCover {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'>\
             <filter id='f' x='0' y='0' width='1' height='1'><feOffset/></filter>{content}</svg>"
        );
        let config = BakeConfig {
            mode,
            ..BakeConfig::default()
        };
        patch_cover(&bake(svg.as_bytes(), &config, &Resources::default()).unwrap())
    }

    #[test]
    fn patches_that_overlap_count_once() {
        let one = "<path d='M10 10H60V40H10Z' filter='url(#f)'/>";
        let other = "<path d='M35 10H85V40H35Z' filter='url(#f)'/>";
        for (content, count, area) in [
            ("<path d='M0 0H50V50H0Z'/>".to_owned(), 0, 0.0),
            (one.to_owned(), 1, 0.3),
            ([one, other].concat(), 2, 0.45),
        ] {
            let found = cover(&content, Mode::Auto);
            assert_eq!(found.count, count, "{content}");
            // A patch may reach a texel further than what it shows.
            assert!((found.area - area).abs() < 0.012, "{content}: {found:?}");
        }
    }

    #[test]
    fn a_warning_says_the_area_that_shows() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
             <filter id='f'><feOffset/></filter>\
             <g id='two' filter='url(#f)'><path d='M10 10H30V30H10Z M70 70H90V90H70Z'/></g></svg>";
        let config = BakeConfig {
            gpu_budget_bytes: u64::MAX,
            ..BakeConfig::default()
        };
        let file = bake(svg.as_bytes(), &config, &Resources::default()).unwrap();
        let warnings = &file.provenance.as_ref().unwrap().warnings;
        assert_eq!((warnings.len(), warnings[0].element.as_str()), (1, "two"));
        // Two squares, not the box around both.
        assert!((warnings[0].area - 0.08).abs() < 0.004, "{warnings:?}");
        let found = patch_cover(&file).area;
        assert!(
            (found - f64::from(warnings[0].area)).abs() < 0.004,
            "{found}"
        );
    }
}
