//! Settings: finite, in range, and a grid that covers the canvas.

use crate::container::issue::{self, IssueKind, Issues};
use crate::container::layout::meta as at;
use crate::container::tag::Tag;
use crate::file::texture::VtexFile;
use crate::records::meta::{Grid, MAX_GRID_SIDE, MAX_TEXELS_PER_CELL, Meta};

/// How far a cell's sides may differ relatively: f32 rounding of canvas and scale.
const ASPECT_TOLERANCE: f64 = 1e-4;

/// Whether the settings are sound; everything but the outline's paint.
pub(crate) fn meta(meta: &Meta, issues: &mut Issues) -> bool {
    let mut sound = true;
    let mut require = |holds: bool, kind: IssueKind, offset, found: &dyn std::fmt::Debug| {
        if !holds {
            sound = false;
            issues.add(
                kind,
                Tag::META,
                offset,
                format_args!("{}: {found:?}", kind.summary),
            );
        }
    };
    let canvas = meta.canvas_size;
    require(
        canvas.iter().all(|&v| is_positive(v)),
        issue::CANVAS_SIZE,
        at::CANVAS_SIZE,
        &canvas,
    );
    let grid = &meta.grid;
    let side = |cells: &u32| (1..=MAX_GRID_SIDE).contains(cells);
    let size = grid.size_cells;
    require(
        size.iter().all(side),
        issue::GRID_SIZE,
        at::GRID_SIZE,
        &size,
    );
    let scale = grid.cell_from_uv_scale;
    require(
        scale.iter().all(|&v| is_positive(v)),
        issue::GRID_TRANSFORM,
        at::GRID_SCALE,
        &scale,
    );
    let offset = grid.cell_from_uv_offset;
    let unit = offset.iter().all(|v| (0.0..1.0).contains(v));
    require(unit, issue::GRID_TRANSFORM, at::GRID_OFFSET, &offset);
    require(covers_canvas(grid), issue::GRID_COVER, at::GRID_SIZE, &size);
    require(
        is_square(grid, canvas),
        issue::GRID_ASPECT,
        at::GRID_SCALE,
        &scale,
    );
    let texels = grid.texels_per_cell;
    let few = (1..=MAX_TEXELS_PER_CELL).contains(&texels);
    require(few, issue::TEXELS_PER_CELL, at::TEXELS_PER_CELL, &texels);
    let range = meta.distance_range_texels;
    require(
        is_positive(range),
        issue::DISTANCE_RANGE,
        at::DISTANCE_RANGE,
        &range,
    );
    require(
        is_positive(meta.max_zoom),
        issue::MAX_ZOOM,
        at::MAX_ZOOM,
        &meta.max_zoom,
    );
    let sampler = &meta.sampler;
    let matrix = sampler.texture_matrix;
    let finite = matrix.iter().all(|v| v.is_finite());
    require(finite, issue::TEXTURE_MATRIX, at::TEXTURE_MATRIX, &matrix);
    let smoothing = sampler.smoothing;
    // The smoothstep runs from 0.5 - S to 0.5 + S of a stored value in [0, 1].
    let smooth = smoothing > 0.0 && smoothing <= 0.5;
    require(smooth, issue::SMOOTHING, at::SMOOTHING, &smoothing);
    if let Some(outline) = sampler.outline {
        let width = outline.width_texels;
        // Texels hold distances up to half the range: a wider ring would have no outer edge.
        let within = width > 0.0 && width < range / 2.0;
        require(within, issue::OUTLINE_WIDTH, at::OUTLINE_WIDTH, &width);
    }
    if let Some(lattice) = meta.curve_lattice {
        // bincode stores the optional distance outline before the lattice.
        let outline = sampler.outline.map_or(0, |_| at::OUTLINE_BYTES);
        let fits = lattice.units_per_cell >= 1 && lattice.box_units() <= u32::from(u16::MAX);
        let offset = at::CURVE_LATTICE + outline;
        require(fits, issue::CURVE_LATTICE, offset, &lattice);
    }
    sound
}

/// The stored outlines make exactly the records that stand beside them.
pub(super) fn outlines(file: &VtexFile, issues: &mut Issues) {
    let Some((outlines, lattice)) = file.outlines.as_ref().zip(file.meta.curve_lattice) else {
        return;
    };
    // Cutting stops at the first word too many.
    let most = file.curves.len() as u64;
    match outlines.records_within(&file.meta.grid, lattice, most) {
        Ok(words) if words == file.curves => {}
        Ok(words) => {
            let message = format_args!("{} words, not the {most} there are", words.len());
            issues.add(issue::OUTLINE_RECORDS, Tag::OUTL, 0, message);
        }
        Err(error) => issues.add(issue::OUTLINES, Tag::OUTL, 0, format_args!("{error}")),
    }
}

/// There is a curve lattice where there are curve records, and only there.
pub(super) fn curve_lattice(file: &VtexFile, issues: &mut Issues) {
    if file.meta.curve_lattice.is_some() == file.curves.is_empty() {
        let (lattice, words) = (file.meta.curve_lattice, file.curves.len());
        let message = format_args!("{lattice:?} for {words} words of records");
        issues.add(
            issue::CURVE_LATTICE_USE,
            Tag::META,
            at::CURVE_LATTICE,
            message,
        );
    }
}

/// The distance outline's paint exists and is a single colour.
pub(super) fn outline_paint(file: &VtexFile, issues: &mut Issues) {
    let Some(outline) = file.meta.sampler.outline else {
        return;
    };
    let kind = match file.paints.get(outline.paint as usize) {
        None => issue::OUTLINE_PAINT,
        Some(paint) if paint.is_gradient() => issue::OUTLINE_SOLID,
        Some(_) => return,
    };
    let message = format_args!("paint {} of {}", outline.paint, file.paints.len());
    issues.add(kind, Tag::META, at::OUTLINE_PAINT, message);
}

fn is_positive(value: f32) -> bool {
    value.is_finite() && value > 0.0
}

/// uv 0 lies in the first cell because offsets are in \[0, 1); uv 1 must lie in or at the last,
/// as evaluators compute it, in f32.
fn covers_canvas(grid: &Grid) -> bool {
    let axis = |i: usize| {
        let last = f64::from(grid.cell_from_uv_scale[i] + grid.cell_from_uv_offset[i]);
        last <= f64::from(grid.size_cells[i])
    };
    axis(0) && axis(1)
}

/// Cells a user unit are the same along both axes. Not said again where canvas or scale are
/// themselves out of range.
fn is_square(grid: &Grid, canvas: [f32; 2]) -> bool {
    let density = |i: usize| f64::from(grid.cell_from_uv_scale[i]) / f64::from(canvas[i]);
    let (x, y) = (density(0), density(1));
    let comparable = x.is_finite() && y.is_finite() && x > 0.0 && y > 0.0;
    !comparable || (x / y - 1.0).abs() <= ASPECT_TOLERANCE
}
