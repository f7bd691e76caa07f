//! `vtex extract`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::json;
use vtex_format::{CellWord, Entry, EntryKind, Image, VtexFile};
use vtex_truth::picture::encode_png;
use vtex_truth::srgb;

use crate::cli::args::Extract;
use crate::cli::{Console, ExitCode, Failure, Outcome, counted};
use crate::files::{input, lossy, output};
use crate::texture;
use crate::texture::heat::{cell_loads, heat_map};

/// Runs `vtex extract`.
pub(super) fn run(args: &Extract, console: Console) -> Outcome<ExitCode> {
    let bytes = input::read(&args.file)?;
    let file = texture::parse(&args.file, &bytes)?;
    let count = file_count(&file);
    if count > args.max_files as usize {
        let (name, most) = (args.file.display(), args.max_files);
        return Err(Failure::new(
            ExitCode::Limit,
            format!(
                "{name}: limit exceeded: these are {count} files, more than {most}; \
                 --max-files {count} allows them"
            ),
        ));
    }
    output::create_folder(&args.output)?;
    let mut folder = Folder {
        path: args.output.clone(),
        taken: output::taken([args.file.as_path()]),
        written: Vec::new(),
    };
    folder.shader(&file)?;
    folder.cells(&file)?;
    folder.layers(&file)?;
    folder.images(&file)?;
    match console.format {
        crate::cli::Format::Json => console.json(&json!(folder.written))?,
        crate::cli::Format::Text => {
            let name = args.output.display();
            let files = counted(folder.written.len(), "file");
            console.note(&format!("{name}: {files}"));
        }
    }
    Ok(ExitCode::Ok)
}

/// How many files the parts of `file` are.
fn file_count(file: &VtexFile) -> usize {
    /// The shader in two languages, two heat maps and their legend.
    const ALWAYS: usize = 5;
    const OF_A_LAYER: usize = 2;
    let mips: usize = file.images.iter().map(|image| image.mips.len()).sum();
    ALWAYS + OF_A_LAYER * file.layers.len() + mips
}

struct Folder {
    path: PathBuf,
    /// What no part may overwrite.
    taken: BTreeSet<PathBuf>,
    /// Names for the report.
    written: Vec<String>,
}

impl Folder {
    fn write(&mut self, name: &str, bytes: &[u8]) -> Outcome<()> {
        let path = self.path.join(Path::new(name));
        output::write_apart(&path, bytes, &self.taken)?;
        self.written.push(lossy(&path));
        Ok(())
    }

    fn png(&mut self, name: &str, size_px: [u32; 2], rgba: &[u8]) -> Outcome<()> {
        self.write(
            name,
            &encode_png(size_px, rgba, png::Compression::Balanced)?,
        )
    }

    fn shader(&mut self, file: &VtexFile) -> Outcome<()> {
        self.write("shader.wgsl", file.shader.wgsl_fragment.as_bytes())?;
        // SPIR-V is a stream of words without a fixed byte order; files are little-endian by
        // convention.
        let spirv: Vec<u8> = file
            .shader
            .batch_spirv
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .collect();
        self.write("batch.spv", &spirv)
    }

    /// Heat maps of entries and of segments, and what their colours mean.
    fn cells(&mut self, file: &VtexFile) -> Outcome<()> {
        let loads = cell_loads(file);
        let mut legends = serde_json::Map::new();
        let counts = [
            ("entries", loads.iter().map(|load| load.entries).collect()),
            ("segments", loads.iter().map(|load| load.segments).collect()),
        ];
        for (what, counts) in counts {
            let counts: Vec<u32> = counts;
            let map = heat_map(file, &counts);
            self.png(&format!("cells-{what}.png"), map.size_px, &map.rgba)?;
            legends.insert(what.to_owned(), map.legend);
        }
        let legends = serde_json::Value::from(legends);
        self.write("cells.json", format!("{legends:#}\n").as_bytes())
    }

    fn layers(&mut self, file: &VtexFile) -> Outcome<()> {
        for (index, lattice) in layer_lattices(file).into_iter().enumerate() {
            let size_px = lattice_size(file);
            self.png(
                &format!("layer-{index:03}-msdf.png"),
                size_px,
                lattice.as_flattened(),
            )?;
            let inside: Vec<[u8; 4]> = lattice.into_iter().map(thresholded).collect();
            self.png(
                &format!("layer-{index:03}-inside.png"),
                size_px,
                inside.as_flattened(),
            )?;
        }
        Ok(())
    }

    fn images(&mut self, file: &VtexFile) -> Outcome<()> {
        for (index, image) in file.images.iter().enumerate() {
            for (level, texels) in (0..).zip(image.mips.iter()) {
                let size_px = Image::level_size(image.size, level);
                let name = format!("image-{index:03}-mip-{level:02}.png");
                self.png(&name, size_px, &straight(texels))?;
            }
        }
        Ok(())
    }
}

fn lattice_size(file: &VtexFile) -> [u32; 2] {
    file.meta
        .grid
        .size_cells
        .map(|cells| cells * file.meta.grid.texels_per_cell + 1)
}

/// For each layer its tiles put together, RGBA8. Transparent where the layer stores nothing,
/// because no edge is near or another shape covers it. Where a cell has tiles of several paints,
/// the texel furthest inside is shown.
fn layer_lattices(file: &VtexFile) -> Vec<Vec<[u8; 4]>> {
    let [width, height] = lattice_size(file).map(|side| side as usize);
    let mut lattices = vec![vec![[0; 4]; width * height]; file.layers.len()];
    let columns = file.meta.grid.size_cells[0].max(1) as usize;
    let texels_per_cell = file.meta.grid.texels_per_cell as usize;
    let side = texels_per_cell + 1;
    let (tiles, _) = file.tiles.as_chunks::<4>();
    for (cell, tile) in placed_tiles(file) {
        let Some(layer) = layer_of(file, tile) else {
            continue;
        };
        let origin = cell / columns * texels_per_cell * width + cell % columns * texels_per_cell;
        let texels = &tiles[tile as usize * side * side..][..side * side];
        for (row, line) in texels.chunks_exact(side).enumerate() {
            for (column, &texel) in line.iter().enumerate() {
                let stored = &mut lattices[layer][origin + row * width + column];
                if stored[3] == 0 || median(texel) > median(*stored) {
                    *stored = [texel[0], texel[1], texel[2], 255];
                }
            }
        }
    }
    lattices
}

/// All pairs of a cell and a tile that its list names.
fn placed_tiles(file: &VtexFile) -> Vec<(usize, u32)> {
    let (pairs, _) = file.entries.as_chunks::<2>();
    let mut placed = Vec::new();
    for (cell, &word) in file.cells.iter().enumerate() {
        let Some(CellWord::List { offset_words }) = CellWord::decode(word) else {
            continue;
        };
        for entry in pairs
            .iter()
            .skip(offset_words as usize / 2)
            .map_while(|&p| Entry::decode(p))
        {
            if entry.kind == EntryKind::Msdf {
                placed.push((cell, entry.data));
            }
            if entry.last {
                break;
            }
        }
    }
    placed
}

fn layer_of(file: &VtexFile, tile: u32) -> Option<usize> {
    file.layers
        .iter()
        .position(|layer| (layer.tile_first..layer.tile_first + layer.tile_count).contains(&tile))
}

fn median([r, g, b, _]: [u8; 4]) -> u8 {
    r.min(g).max(r.max(g).min(b))
}

/// White inside, black outside, transparent where no texel is stored.
fn thresholded(texel: [u8; 4]) -> [u8; 4] {
    let value = if median(texel) >= 128 { 255 } else { 0 };
    [value, value, value, texel[3]]
}

/// Texels of an image (premultiplied in linear light, then sRGB-encoded) as straight-alpha sRGB.
fn straight(texels: &[u8]) -> Vec<u8> {
    let convert = |&[r, g, b, a]: &[u8; 4]| {
        if a == 0 {
            return [0; 4];
        }
        let alpha = f32::from(a) / 255.0;
        let [r, g, b] = [r, g, b].map(|c| {
            srgb::byte(srgb::encode(
                (srgb::decode(f32::from(c) / 255.0) / alpha).min(1.0),
            ))
        });
        [r, g, b, a]
    };
    texels.as_chunks::<4>().0.iter().flat_map(convert).collect()
}
