//! `vtex info`.

use std::fmt::Write as _;
use std::time::Instant;

use serde_json::{Value, json};
use vtex_format::{
    COVERAGE_IMAGE, CellWord, Directory, Features, Limits, ShapeRecord, VtexFile, Warning,
    directory,
};
use vtex_truth::comparison::human_bytes;
use vtex_truth::texture::patch_cover;

use crate::cli::args::Info;
use crate::cli::{Console, ExitCode, Format, Outcome, counted};
use crate::files::input;
use crate::texture;
use crate::texture::heat::cell_loads;
use crate::texture::lookup_cost::{Spread, lookup_load};

mod gpu;
mod shapes;

use gpu::OnGpu;
use shapes::{shape_json, shapes};

/// Most shapes listed without `--verbose`.
const SHAPES_SHOWN: usize = 24;

/// Runs `vtex info`.
pub(super) fn run(args: &Info, console: Console) -> Outcome<ExitCode> {
    let bytes = input::read(&args.file)?;
    let begun = Instant::now();
    let file = texture::parse(&args.file, &bytes)?;
    let on_gpu = OnGpu::new(&bytes, &file, begun.elapsed());
    let directory = directory(&bytes, &Limits::default())
        .map_err(|error| texture::read_failure(&args.file, &error))?;
    match console.format {
        Format::Json => {
            let mut report = json(&file, &directory);
            on_gpu.tell(&mut report);
            console.json(&report)?;
        }
        Format::Text => {
            let all = console.verbosity == crate::cli::Verbosity::Verbose;
            let shown = if all { usize::MAX } else { SHAPES_SHOWN };
            console.result(text(&file, &directory, &on_gpu, shown).as_bytes())?;
        }
    }
    Ok(ExitCode::Ok)
}

/// How many cells are empty, hold a single paint, or hold a list.
struct CellStats {
    empty: u64,
    single: u64,
    lists: u64,
    entries_mean: f64,
    entries_max: u32,
}

impl CellStats {
    fn new(file: &VtexFile) -> Self {
        let count = |wanted: fn(CellWord) -> bool| {
            let words = file.cells.iter().filter_map(|&word| CellWord::decode(word));
            words.filter(|&cell| wanted(cell)).count() as u64
        };
        let lists = count(|cell| matches!(cell, CellWord::List { .. }));
        let loads = cell_loads(file);
        let lengths = || loads.iter().map(|load| load.entries);
        let listed: u64 = lengths().map(u64::from).sum();
        Self {
            empty: count(|cell| cell == CellWord::Empty),
            single: count(|cell| matches!(cell, CellWord::Paint { .. })),
            lists,
            entries_mean: listed as f64 / lists.max(1) as f64,
            entries_max: lengths().max().unwrap_or(0),
        }
    }
}

/// Names of the features in a spec key.
pub(crate) fn feature_names(features: u32) -> Vec<&'static str> {
    let names = [
        (Features::LISTS, "lists"),
        (Features::MSDF, "msdf"),
        (Features::IMAGES, "images"),
        (Features::MIPS, "mips"),
        (Features::TRANSLUCENT, "translucent"),
        (Features::MASK, "mask"),
        (Features::OUTLINE, "outline"),
        (Features::MAPPING, "mapping"),
        (Features::CURVES, "curves"),
        (Features::FOOTPRINT, "footprint"),
        (Features::PAPER, "paper"),
        (Features::GRADIENTS, "gradients"),
        (Features::CLIPS, "clips"),
        (Features::GROUPS, "groups"),
        (Features::BLENDS, "blends"),
        (Features::DEEP_GROUPS, "deep-groups"),
    ];
    names
        .into_iter()
        .filter(|(bit, _)| features & bit != 0)
        .map(|(_, name)| name)
        .collect()
}

fn json(file: &VtexFile, directory: &Directory) -> Value {
    let meta = &file.meta;
    let cells = CellStats::new(file);
    let lookups = lookup_load(file);
    let patches = patch_cover(file);
    let provenance = file.provenance.as_ref();
    let layers: Vec<_> = (0..)
        .zip(&file.layers)
        .map(|(index, layer)| json!({"tiles": layer.tile_count, "shapes": members(file, index)}))
        .collect();
    let images: Vec<_> = file.images.iter().map(|image| {
        json!({"rect_uv": image.rect_uv, "size": image.size, "levels": image.mips.len()})
    }).collect();
    let sections: Vec<_> = directory.sections.iter().map(|section| json!({
        "tag": section.tag.to_string(), "raw_bytes": section.raw_bytes, "bundle": section.bundle,
    })).collect();
    let bundles: Vec<_> = directory
        .bundles
        .iter()
        .map(|bundle| {
            json!({
                "codec": format!("{:?}", bundle.codec).to_lowercase(),
                "raw_bytes": bundle.raw_bytes, "stored_bytes": bundle.stored_bytes,
            })
        })
        .collect();
    let shapes: Vec<_> = file
        .shapes
        .iter()
        .enumerate()
        .map(|(index, shape)| shape_json(file, index, shape))
        .collect();
    json!({
        "version": format!("{}.{}", directory.version_major, directory.version_minor),
        "file_bytes": directory.file_bytes,
        "raw_bytes": raw_bytes(directory),
        "canvas_size": meta.canvas_size,
        "max_zoom": meta.max_zoom,
        "grid": {
            "size_cells": meta.grid.size_cells, "texels_per_cell": meta.grid.texels_per_cell,
            "distance_range_texels": meta.distance_range_texels,
        },
        "sampler": {
            "address": meta.sampler.address.map(|mode| format!("{mode:?}").to_lowercase()),
            "texture_matrix": meta.sampler.texture_matrix, "smoothing": meta.sampler.smoothing,
            "mask": meta.sampler.mask,
            "outline_texels": meta.sampler.outline.map(|outline| outline.width_texels),
        },
        "cells": {
            "empty": cells.empty, "single": cells.single, "lists": cells.lists,
            "entries_mean": cells.entries_mean, "entries_max": cells.entries_max,
        },
        "lookups": {
            "entries_mean": lookups.entries.mean, "entries_p99": lookups.entries.p99,
            "segments_mean": lookups.segments.mean, "segments_p99": lookups.segments.p99,
        },
        "tiles": tile_count(file), "paints": file.paints.len(),
        "layers": layers, "shapes": shapes, "images": images, "sections": sections,
        "bundles": bundles,
        "shader": {
            "abi": file.shader.abi, "features": feature_names(file.spec.features),
            "key": key(file), "wgsl_bytes": file.shader.wgsl_fragment.len(),
            "spirv_bytes": 4 * file.shader.batch_spirv.len(),
        },
        "tool": provenance.map(|p| &p.tool),
        "source_hash": provenance.map(|p| hex(&p.source_hash)),
        "options": provenance.map(|p| &p.options),
        "patches": {"count": patches.count, "area": patches.area},
        "warnings": warnings_json(provenance.map_or(&[], |p| &p.warnings)),
    })
}

/// Indices of a layer's shapes in the painter's order.
fn members(file: &VtexFile, layer: u32) -> Vec<usize> {
    let in_layer =
        |shape: &ShapeRecord| shape.coverage != COVERAGE_IMAGE && shape.layer_or_image == layer;
    let shapes = file.shapes.iter().enumerate();
    shapes
        .filter(|(_, shape)| in_layer(shape))
        .map(|(index, _)| index)
        .collect()
}

fn key(file: &VtexFile) -> String {
    format!("{:08x}", file.spec.features)
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn tile_count(file: &VtexFile) -> u64 {
    file.layers
        .iter()
        .map(|layer| u64::from(layer.tile_count))
        .sum()
}

fn raw_bytes(directory: &Directory) -> u64 {
    directory
        .sections
        .iter()
        .map(|section| section.raw_bytes)
        .sum()
}

/// Warnings as JSON.
pub(super) fn warnings_json(warnings: &[Warning]) -> Value {
    warnings
        .iter()
        .map(|warning| {
            json!({
                "code": warning.code as u32, "name": format!("{:?}", warning.code),
                "feature": warning.feature, "element": warning.element, "message": warning.message,
                "area": warning.area,
            })
        })
        .collect()
}

/// A warning as a line of text, with the share of the canvas that it is about.
pub(super) fn warning_text(warning: &Warning) -> String {
    let mut text = match warning.element.as_str() {
        "" => warning.message.clone(),
        element => format!("#{element}: {}", warning.message),
    };
    if warning.area > 0.0 {
        // Writing to a String does not fail.
        let _ = write!(text, " ({})", share_of_canvas(warning.area.into()));
    }
    text
}

fn share_of_canvas(share: f64) -> String {
    match 100.0 * share {
        percent if percent > 0.0 && percent < 0.1 => "less than 0.1% of the canvas".to_owned(),
        percent => format!("{percent:.1}% of the canvas"),
    }
}

fn text(file: &VtexFile, directory: &Directory, on_gpu: &OnGpu, shapes_shown: usize) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    let _ = general(&mut out, file, directory);
    let _ = on_gpu.text(&mut out);
    let _ = layers(&mut out, file);
    let _ = shapes(&mut out, file, shapes_shown);
    let _ = images(&mut out, file);
    let _ = sections(&mut out, directory);
    let _ = warnings(&mut out, file);
    out
}

fn general(out: &mut String, file: &VtexFile, directory: &Directory) -> std::fmt::Result {
    let meta = &file.meta;
    let grid = &meta.grid;
    let cells = CellStats::new(file);
    let total = file.cells.len().max(1) as f64;
    let share = |count: u64| 100.0 * count as f64 / total;
    writeln!(
        out,
        "format     {}.{}, {} ({} raw)",
        directory.version_major,
        directory.version_minor,
        human_bytes(directory.file_bytes),
        human_bytes(raw_bytes(directory))
    )?;
    if let Some(provenance) = &file.provenance {
        writeln!(
            out,
            "made by    {} from an SVG with hash {}",
            provenance.tool,
            hex(&provenance.source_hash)
        )?;
    }
    let [width, height] = meta.canvas_size;
    writeln!(
        out,
        "canvas     {width} x {height} user units, prepared for zoom {}",
        meta.max_zoom
    )?;
    writeln!(
        out,
        "cells      {} x {}: {} empty ({:.1}%), {} single colour ({:.1}%), {} ({:.1}%)",
        grid.size_cells[0],
        grid.size_cells[1],
        cells.empty,
        share(cells.empty),
        cells.single,
        share(cells.single),
        counted(cells.lists, "list"),
        share(cells.lists)
    )?;
    writeln!(
        out,
        "lists      {:.2} entries on average, {} at most",
        cells.entries_mean, cells.entries_max
    )?;
    let lookups = lookup_load(file);
    let spread = |Spread { mean, p99 }| format!("{mean:.2} (p99 {p99})");
    writeln!(
        out,
        "lookups    {} entries, {} segments at random points",
        spread(lookups.entries),
        spread(lookups.segments)
    )?;
    let side = grid.texels_per_cell + 1;
    writeln!(
        out,
        "tiles      {} of {side} x {side} texels, distance range {}",
        tile_count(file),
        counted(meta.distance_range_texels, "texel")
    )?;
    writeln!(out, "paints     {}", file.paints.len())?;
    writeln!(out, "sampler    {}", sampler(file))?;
    writeln!(
        out,
        "shader     ABI {}, {}; WGSL {}, SPIR-V {}",
        file.shader.abi,
        feature_names(file.spec.features).join(" "),
        human_bytes(file.shader.wgsl_fragment.len() as u64),
        human_bytes(4 * file.shader.batch_spirv.len() as u64)
    )?;
    writeln!(out, "key        {}", key(file))
}

fn sampler(file: &VtexFile) -> String {
    let sampler = &file.meta.sampler;
    let [u, v] = sampler
        .address
        .map(|mode| format!("{mode:?}").to_lowercase());
    let address = if u == v { u } else { format!("{u} {v}") };
    let mut text = format!("address {address}, smoothing {}", sampler.smoothing);
    if sampler.is_transformed() {
        let _ = write!(text, ", matrix {:?}", sampler.texture_matrix);
    }
    if let Some(outline) = sampler.outline {
        let width = counted(outline.width_texels, "texel");
        let _ = write!(text, ", outline {width}");
    }
    if sampler.mask {
        text.push_str(", mask");
    }
    text
}

fn layers(out: &mut String, file: &VtexFile) -> std::fmt::Result {
    writeln!(
        out,
        "\n{}, back to front\n{:>5} {:>8} {:>8}",
        counted(file.layers.len(), "layer"),
        "layer",
        "shapes",
        "tiles"
    )?;
    for (index, layer) in file.layers.iter().enumerate() {
        writeln!(
            out,
            "{index:>5} {:>8} {:>8}",
            layer.shape_count, layer.tile_count
        )?;
    }
    Ok(())
}

fn images(out: &mut String, file: &VtexFile) -> std::fmt::Result {
    writeln!(
        out,
        "\n{}\n{:>5} {:>13} {:>7}  uv",
        counted(file.images.len(), "image"),
        "image",
        "texels",
        "levels"
    )?;
    for (index, image) in file.images.iter().enumerate() {
        let size = format!("{} x {}", image.size[0], image.size[1]);
        let [u0, v0, u1, v1] = image.rect_uv;
        let rect = format!("{u0:.4},{v0:.4} to {u1:.4},{v1:.4}");
        let levels = image.mips.len();
        let is_canvas = index == 0 && file.spec.features & Features::MIPS != 0;
        let what = if is_canvas { "canvas mips, " } else { "" };
        writeln!(out, "{index:>5} {size:>13} {levels:>7}  {what}{rect}")?;
    }
    let patches = patch_cover(file);
    let (count, share) = (patches.count, share_of_canvas(patches.area));
    writeln!(out, "{}, on {share}", counted(count, "raster patch"))
}

/// Sections by the bundle that they are stored in.
fn sections(out: &mut String, directory: &Directory) -> std::fmt::Result {
    writeln!(
        out,
        "\nsections by bundle\n{:>12} {:>12}  sections",
        "raw", "stored"
    )?;
    for bundle in &directory.bundles {
        let mut tags: Vec<(String, usize)> = Vec::new();
        for section in directory.bundle_sections(bundle) {
            let tag = section.tag.to_string();
            match tags.last_mut() {
                Some((last, count)) if *last == tag => *count += 1,
                _ => tags.push((tag, 1)),
            }
        }
        let names = tags.into_iter().map(|(tag, count)| match count {
            1 => tag,
            count => format!("{count} {tag}"),
        });
        let names = names.collect::<Vec<_>>().join(" ");
        let (raw, stored) = (bundle.raw_bytes, bundle.stored_bytes);
        writeln!(out, "{raw:>12} {stored:>12}  {names}")?;
    }
    let raw = raw_bytes(directory);
    let count = directory.sections.len();
    writeln!(out, "{raw:>12} {:>12}  all {count}", directory.file_bytes)
}

fn warnings(out: &mut String, file: &VtexFile) -> std::fmt::Result {
    let warnings = file.provenance.as_ref().map_or(&[][..], |p| &p.warnings);
    writeln!(out, "\n{}", counted(warnings.len(), "warning"))?;
    for warning in warnings {
        let (code, feature) = (warning.code, &warning.feature);
        writeln!(out, "  {code:?} {feature}: {}", warning_text(warning))?;
    }
    Ok(())
}
