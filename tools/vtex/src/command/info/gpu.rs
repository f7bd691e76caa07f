//! What a texture takes on a GPU, beside rasters of the same canvas, and how long it takes to load.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use vtex_format::{Limits, VtexFile};
use vtex_shaders::{FilterMode, PackOptions, load, pack};
use vtex_truth::comparison::human_bytes;
use vtex_truth::texture::RasterBytes;

/// Texels along the longer side of the rasters.
const RASTERS: [u32; 3] = [4096, 2048, 1024];

/// A texture as the loaders have it.
pub(super) struct OnGpu {
    parsed: Duration,
    /// For lookups of points, as loaders pack it unless they are told otherwise.
    point: PackedBytes,
    footprint: PackedBytes,
    canvas_size: [f32; 2],
}

struct PackedBytes {
    words: u64,
    texels: u64,
    texels_bc: u64,
    packed: Duration,
    /// From the bytes of the file: less than reading all of it and packing where it carries what packing
    /// makes (`vtex bake --profile`).
    loaded: Duration,
}

impl PackedBytes {
    fn of(bytes: &[u8], file: &VtexFile, filter: FilterMode) -> Self {
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        let begun = Instant::now();
        let packed = pack(file, &options);
        let took = begun.elapsed();
        let begun = Instant::now();
        // `file` was read from these bytes, so they are read again.
        let read = load(bytes, &Limits::default(), &options);
        let loaded = begun.elapsed();
        drop(read);
        Self {
            loaded,
            packed: took,
            words: packed.word_bytes() as u64,
            texels: packed.texels.bytes().len() as u64,
            texels_bc: packed.texels.bytes_bc() as u64,
        }
    }

    fn bytes(&self) -> u64 {
        self.words + self.texels
    }

    fn bytes_bc(&self) -> u64 {
        self.words + self.texels_bc
    }

    fn json(&self) -> Value {
        json!({
            "words": self.words, "texels": self.texels, "texels_bc": self.texels_bc,
            "bytes": self.bytes(), "bytes_bc": self.bytes_bc(),
        })
    }
}

impl OnGpu {
    /// Packs `file`, which was read from `bytes` in the time `parsed`.
    pub(super) fn new(bytes: &[u8], file: &VtexFile, parsed: Duration) -> Self {
        Self {
            parsed,
            point: PackedBytes::of(bytes, file, FilterMode::Point),
            footprint: PackedBytes::of(bytes, file, FilterMode::Footprint),
            canvas_size: file.meta.canvas_size,
        }
    }

    fn rasters(&self) -> impl Iterator<Item = (u32, RasterBytes)> {
        let canvas = self.canvas_size.map(f64::from);
        RASTERS
            .into_iter()
            .map(move |side| (side, RasterBytes::of(canvas, side)))
    }

    /// Adds the keys `gpu_bytes`, `gpu_bytes_bc`, `gpu` and `load_ms` to a report.
    pub(super) fn tell(&self, report: &mut Value) {
        report["gpu_bytes"] = json!(self.point.bytes());
        report["gpu_bytes_bc"] = json!(self.point.bytes_bc());
        let rasters = self.rasters().map(|(side, bytes)| {
            json!({"longer_texels": side, "bytes": bytes.rgba8, "bytes_bc": bytes.bc7})
        });
        report["gpu"] = json!({
            "point": self.point.json(), "footprint": self.footprint.json(),
            "rasters": rasters.collect::<Value>(),
        });
        report["load_ms"] = json!({
            "parse": milliseconds(self.parsed), "pack_point": milliseconds(self.point.packed),
            "pack_footprint": milliseconds(self.footprint.packed),
            "load_point": milliseconds(self.point.loaded),
            "load_footprint": milliseconds(self.footprint.loaded),
        });
    }

    /// The same as a table.
    pub(super) fn text(&self, out: &mut String) -> std::fmt::Result {
        writeln!(
            out,
            "\non a GPU\n{:>10} {:>10} {:>10} {:>10} {:>9}",
            "words", "texels", "together", "with BC7", "loads, ms"
        )?;
        for (name, bytes) in [("point", &self.point), ("footprint", &self.footprint)] {
            writeln!(
                out,
                "{:>10} {:>10} {:>10} {:>10} {:>9.1}  for lookups in {name} mode",
                human_bytes(bytes.words),
                human_bytes(bytes.texels),
                human_bytes(bytes.bytes()),
                human_bytes(bytes.bytes_bc()),
                milliseconds(bytes.loaded),
            )?;
        }
        for (side, bytes) in self.rasters() {
            writeln!(
                out,
                "{:>10} {:>10} {:>10} {:>10} {:>9}  a raster of {side} texels with mips",
                "",
                "",
                human_bytes(bytes.rgba8),
                human_bytes(bytes.bc7),
                ""
            )?;
        }
        writeln!(
            out,
            "a full parse {:.1} ms, packing {:.1} ms for points, {:.1} ms for footprints",
            milliseconds(self.parsed),
            milliseconds(self.point.packed),
            milliseconds(self.footprint.packed)
        )
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}
