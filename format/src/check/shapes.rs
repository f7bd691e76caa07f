//! Shapes and layers.

use crate::container::issue::{self, Issues};
use crate::container::tag::Tag;
use crate::file::texture::VtexFile;
use crate::records::shape::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, FILL_EVEN_ODD, FILL_NON_ZERO, ShapeRecord,
};

/// Every shape names what exists.
pub(super) fn shapes(file: &VtexFile, issues: &mut Issues) {
    for (index, shape) in file.shapes.iter().enumerate() {
        let mut note = |holds: bool, kind, field: u64, found: &dyn std::fmt::Debug| {
            if !holds {
                let offset = offset_of::<ShapeRecord>(index) + field;
                let message = format_args!("shape {index}: {found:?}");
                issues.add(kind, Tag::SHAP, offset, message);
            }
        };
        let (targets, paints) = match shape.coverage {
            COVERAGE_MSDF | COVERAGE_CURVES => (file.layers.len(), file.paints.len()),
            // An image brings its own colours; its paint is 0.
            COVERAGE_IMAGE => (file.images.len(), 1),
            _ => {
                note(false, issue::SHAPE_COVERAGE, 0, &shape.coverage);
                continue;
            }
        };
        let rule = matches!(shape.fill_rule, FILL_NON_ZERO | FILL_EVEN_ODD);
        note(rule, issue::SHAPE_FILL_RULE, 4, &shape.fill_rule);
        let target = shape.layer_or_image;
        note((target as usize) < targets, issue::SHAPE_TARGET, 8, &target);
        note(
            (shape.paint as usize) < paints,
            issue::SHAPE_PAINT,
            12,
            &shape.paint,
        );
        let [left, top, right, bottom] = shape.bounds_uv;
        let finite = shape.bounds_uv.iter().all(|edge| edge.is_finite());
        let ordered = finite && left <= right && top <= bottom;
        note(ordered, issue::SHAPE_BOUNDS, 16, &shape.bounds_uv);
        note(
            shape.reserved == 0,
            issue::SHAPE_RESERVED,
            36,
            &shape.reserved,
        );
    }
}

/// The layers' tiles follow each other, and their shapes are as many as they say.
pub(super) fn layers(file: &VtexFile, issues: &mut Issues) {
    let mut members = vec![0_u32; file.layers.len()];
    for shape in &file.shapes {
        // A layer that does not exist is an issue of its shape.
        let layer = members.get_mut(shape.layer_or_image as usize);
        if let Some(count) = layer.filter(|_| shape.coverage != COVERAGE_IMAGE) {
            *count += 1;
        }
    }
    let mut next_tile = 0_u64;
    for (index, (layer, members)) in file.layers.iter().zip(members).enumerate() {
        let offset = 16 * index as u64;
        if u64::from(layer.tile_first) != next_tile {
            let first = layer.tile_first;
            let message = format_args!("layer {index} begins at tile {first}, not {next_tile}");
            issues.add(issue::LAYER_TILES, Tag::LAYR, offset, message);
        }
        next_tile += u64::from(layer.tile_count);
        if layer.shape_count != members {
            let says = layer.shape_count;
            let message = format_args!("layer {index} says {says} shapes, {members} name it");
            issues.add(issue::LAYER_SHAPES, Tag::LAYR, offset + 8, message);
        }
        if layer.reserved != 0 {
            let message = format_args!("layer {index}");
            issues.add(issue::LAYER_RESERVED, Tag::LAYR, offset + 12, message);
        }
    }
    // Entries name tiles by 32 bits.
    if next_tile > u64::from(u32::MAX) {
        let message = format_args!("{next_tile} tiles");
        issues.add(issue::RECORD_COUNT, Tag::LAYR, 0, message);
    }
}

fn offset_of<T>(index: usize) -> u64 {
    (index * size_of::<T>()) as u64
}
