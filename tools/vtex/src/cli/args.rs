//! The command line, as clap sees it.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use vtex_baker::BakeConfig;
use vtex_truth::comparison::WINDOWS;
use vtex_truth::picture::View;

use super::Format;
use super::light::{Light, Surroundings};
use super::lookup::{Filter, Lookup};
use super::values::{
    Color, Matrix, Profile, Size, bytes, color, matrix, number, seconds, size, view,
};

/// Bake SVG drawings into vector textures (.vtex), and inspect, check, compare and render them.
#[derive(Debug, Parser)]
#[command(name = "vtex", version, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Settings of all commands.
    #[command(flatten)]
    pub(crate) global: Global,
}

const EXIT_CODES: &str = "Exit codes: 0 success, 1 wrong command line, 2 a file cannot be read or \
    written, 3 invalid input file, 4 failure at run time, 5 unsupported, 7 difference found, 8 limit \
    exceeded";

/// Settings of all commands.
#[derive(Clone, Copy, Debug, Args)]
// Without a heading of their own clap mixes them into the options of each command.
#[command(next_help_heading = "Options of all commands")]
pub(crate) struct Global {
    /// Format of the results on standard output
    #[arg(
        long,
        global = true,
        value_enum,
        default_value_t,
        value_name = "FORMAT"
    )]
    pub(crate) format: Format,
    /// Print only failures
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Also print details of the work, and all warnings
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Number of threads, at most 512; 0 uses one per core
    #[arg(long, global = true, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=MAX_THREADS))]
    pub(crate) threads: u16,
}

/// Most threads of a process. The start of 512 takes a second on two cores, of 1024 twenty.
const MAX_THREADS: i64 = 512;

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Bake SVG files into .vtex files
    #[command(after_help = PROCESSES)]
    Bake(Box<Bake>),
    /// Print what a .vtex file contains
    Info(Info),
    /// Check .vtex files and print numbered issues
    Validate(Validate),
    /// Write a picture of a .vtex file as PNG
    #[command(after_help = PREVIEWS)]
    Preview(Preview),
    /// Measure how far a .vtex file is from its SVG at several zooms
    #[command(after_help = METRICS)]
    Compare(Compare),
    /// Write the parts of a .vtex file as files: layers, mips, heat maps of the cells, shader
    Extract(Extract),
    /// Path-trace a glTF scene, or textures: one on a plane, several on objects in a showroom
    Render(Render),
    /// Add vector textures to a glTF asset
    #[command(after_help = GLTF)]
    Gltf(Gltf),
    /// Bake SVG files and write a page that compares SVG, .vtex and raster
    #[command(hide = true)]
    Demo(Demo),
    /// Bake the drawings that `vtex bake` sends over standard input
    #[command(hide = true)]
    Worker(Worker),
}

const PROCESSES: &str = "Each file is baked in a separate process, at most --threads of them at a \
    time. A process that needs more time than --timeout or more memory than --max-memory is stopped: \
    its file fails with exit code 8, and the other files are still baked.";

const PREVIEWS: &str = "\
Examples:
  The whole canvas, and a part of it:
    vtex preview sign.vtex -o sign.png
    vtex preview sign.vtex -o close.png --view 0.4,0.4,0.6,0.6
  What an engine shows with one filtered lookup per pixel:
    vtex preview sign.vtex -o sign.png --filter footprint --spp 1";

const GLTF: &str = "\
Examples:
  A drawing for the texture, image or material named Sign:
    vtex gltf street.glb --attach Sign=sign.svg -o street-with-sign.glb
Programs that do not know VTEX_texture_vector show the image that the texture had, or where it had none
a raster of the drawing.";

const METRICS: &str = "The picture of the .vtex file is compared with the truth: the SVG as resvg \
    draws it without anti-aliasing, at 257 samples per pixel (256 for drawings with filters, patterns \
    or images), averaged in linear light. Both pictures are composited over white in linear light and \
    then sRGB-encoded. PSNR is taken over R, G and B. A pixel is wrong if one of its channels differs \
    by more than 8 of 255. At a zoom above 1, only windows at edges of the drawing are compared (as \
    many as --windows says), and the worst one counts.";

/// Fonts for text.
#[derive(Clone, Debug, Args)]
pub(crate) struct Fonts {
    /// Folder with fonts for text, searched before the system fonts; repeat for more folders
    #[arg(long, value_name = "DIR")]
    pub(crate) font_dir: Vec<PathBuf>,
    /// Ignore the system fonts, so that every machine bakes the same bytes
    #[arg(long)]
    pub(crate) no_system_fonts: bool,
}

/// `vtex bake`.
#[derive(Debug, Args)]
pub(crate) struct Bake {
    /// SVG files, plain or gzipped; folders, searched for .svg and .svgz; globs; - for standard input
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Output file or folder; - for standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// What the bake makes.
    #[command(flatten)]
    pub(crate) options: BakeOptions,
    /// Write nothing: compare with the existing outputs, and exit with 7 if one is missing or differs
    #[arg(long)]
    pub(crate) check: bool,
    /// Write to FILE, as Makefile rules, on which files each output depends
    #[arg(long, value_name = "FILE")]
    pub(crate) depfile: Option<PathBuf>,
    /// Keep a copy of each bake in DIR, and reuse it while SVG, options, fonts and the version of
    /// vtex are the same
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// Limits for each file.
    #[command(flatten)]
    pub(crate) budget: Budget,
}

/// Limits for the process that bakes one file.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Budget {
    /// Time limit for one file; a file that exceeds it fails with exit code 8
    #[arg(long, value_name = "SECONDS", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=604_800))]
    pub(crate) timeout: u32,
    /// Memory limit for one file; a file that exceeds it fails with exit code 8. Not enforced on
    /// Windows
    #[arg(long, value_name = "MIB", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(16..=16_777_216))]
    pub(crate) max_memory: u32,
}

/// `vtex worker`.
#[derive(Debug, Args)]
pub(crate) struct Worker {
    /// The command line of the `vtex` that started this one
    #[arg(last = true, required = true)]
    pub(crate) command_line: Vec<OsString>,
}

/// Options that change what a bake makes.
#[derive(Clone, Debug, Args)]
pub(crate) struct BakeOptions {
    /// How shapes are stored
    #[arg(long, value_enum, default_value_t)]
    pub(crate) mode: BakeMode,
    /// Zoom up to which edges stay sharp; at zoom 1 the canvas' longer side is 512 pixels
    #[arg(long, value_name = "Z", default_value_t = BakeConfig::default().max_zoom)]
    pub(crate) max_zoom: f32,
    /// Largest error of an MSDF edge, in pixels at --max-zoom; shapes with a larger error are stored
    /// as curves
    #[arg(long, value_name = "PX", default_value_t = BakeConfig::default().error_px)]
    pub(crate) error: f64,
    /// Texels along the longer side of mip 0, rounded to a power of two: the largest of the mips that
    /// stand for the picture where pixels are wider than its texels. Larger takes more memory and
    /// answers wide pixels faster; in footprint mode it is not sharper
    #[arg(long, value_name = "N", default_value_t = BakeConfig::default().mip0_size)]
    pub(crate) size: u32,
    /// MSDF texels along the canvas' longer side; with --mode auto the largest number that is tried
    #[arg(long, value_name = "N", default_value_t = BakeConfig::default().msdf_size)]
    pub(crate) msdf_size: u32,
    /// Put all shapes into one layer, with --mode auto as MSDFs; correct only if no shapes overlap
    #[arg(long)]
    pub(crate) merge: bool,
    /// Make lookups return alpha in all four channels; the file still stores the colours
    #[arg(long)]
    pub(crate) mask: bool,
    /// Half width of the constant edge smoothing of `--filter paper`, as a share of the MSDF's
    /// distance range: more than 0, at most 0.5
    #[arg(long, value_name = "S", default_value_t = BakeConfig::default().smoothing)]
    pub(crate) smoothing: f32,
    /// Draw a ring of WIDTH MSDF texels around every shape, which --mode auto then stores as an MSDF.
    /// Not with --mode curves or raster; cells that show groups have no rings
    #[arg(long, value_name = "WIDTH", num_args = 0..=1, default_missing_value = "1")]
    pub(crate) outline: Option<f32>,
    /// Replace the colour of every fill by a CSS colour, such as #d03020, navy or rgb(1 2 3)
    #[arg(long, value_name = "COLOR", value_parser = color)]
    pub(crate) fill_color: Option<Color>,
    /// Replace the colour of every stroke, and of --outline, by a CSS colour
    #[arg(long, value_name = "COLOR", value_parser = color)]
    pub(crate) stroke_color: Option<Color>,
    /// What a lookup outside the canvas returns [default: clamp]
    #[arg(long, value_enum)]
    pub(crate) address: Option<Address>,
    /// Texture matrix of lookups: u' = a u + c v + e, v' = b u + d v + f
    #[arg(long, value_name = "a,b,c,d,e,f", value_parser = matrix, allow_hyphen_values = true)]
    pub(crate) transform: Option<Matrix>,
    /// What the files are made for
    #[arg(long, value_enum, default_value_t)]
    pub(crate) profile: Profile,
    /// Also draw image files that the SVG names, if they are in DIR or a folder inside it; repeat
    /// for more folders. Other image files are left out with a warning. Nothing is loaded from the
    /// network
    #[arg(long, value_name = "DIR")]
    pub(crate) allow_images: Vec<PathBuf>,
    /// Bytes on a GPU, or as 64K or 4M, beyond which a texture has a warning: packed for lookups of
    /// points, with texels of four bytes, as `vtex info` counts them
    #[arg(long, value_name = "BYTES", default_value = "4M", value_parser = bytes)]
    pub(crate) gpu_budget: u64,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// How shapes are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum BakeMode {
    /// For each shape what costs less: an MSDF whose error is at most --error, or curves
    #[default]
    Auto,
    /// Multi-channel signed distance fields (MSDF)
    Msdf,
    /// Exact curves
    Curves,
    /// One raster image of the whole canvas, with mips
    Raster,
}

/// What lookups outside the canvas see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Address {
    /// The nearest point of the canvas
    Clamp,
    /// The canvas, repeated
    Repeat,
    /// The canvas, repeated with every second copy mirrored
    Mirror,
    /// Transparent black
    Border,
}

/// `vtex info`.
#[derive(Debug, Args)]
pub(crate) struct Info {
    /// The .vtex file; - for standard input
    pub(crate) file: PathBuf,
}

/// `vtex validate`.
#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// .vtex files; - for standard input
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
}

/// `vtex preview`.
#[derive(Debug, Args)]
pub(crate) struct Preview {
    /// The .vtex file; - for standard input
    pub(crate) file: PathBuf,
    /// File to write, .png; - for standard output
    #[arg(short, long, value_name = "PNG")]
    pub(crate) output: PathBuf,
    /// Size in pixels: `WxH`, or N for the longer side
    #[arg(long, default_value = "512", value_parser = size)]
    pub(crate) size: Size,
    /// Part of the canvas to show: left, top, right, bottom; 0,0,1,1 is the whole canvas. Its sides
    /// are at least 1/65536 of 1, and of its farthest coordinate, which is at most 65536
    #[arg(long, value_name = "u0,v0,u1,v1", value_parser = view, allow_hyphen_values = true)]
    pub(crate) view: Option<View>,
    /// How it is looked up.
    #[command(flatten)]
    pub(crate) lookup: Lookup,
}

/// `vtex compare`.
#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// The SVG file
    #[arg(value_name = "IN.svg")]
    pub(crate) svg: PathBuf,
    /// The .vtex file baked from it
    pub(crate) file: PathBuf,
    /// Zooms to compare at; zoom 1 shows the whole canvas
    #[arg(
        long,
        value_name = "Z,...",
        value_delimiter = ',',
        default_value = "1,8,32,256"
    )]
    pub(crate) zoom: Vec<f64>,
    /// Pixels along the longer side of the pictures
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(8..=8192))]
    pub(crate) size: u32,
    /// How it is looked up.
    #[command(flatten)]
    pub(crate) lookup: Lookup,
    /// Exit with 7 if the PSNR at a zoom is below X dB
    #[arg(long, value_name = "X", value_parser = number)]
    pub(crate) min_psnr: Option<f64>,
    /// Number of windows to compare at each zoom above 1
    #[arg(long, value_name = "N", default_value_t = WINDOWS, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) windows: u32,
    /// Also print how exact the truth is, in the worst window of each zoom: its PSNR against the same
    /// picture drawn with a quarter of the samples
    #[arg(long)]
    pub(crate) noise: bool,
    /// Also write an HTML page into DIR that shows SVG, .vtex and a raster of 4096 texels side by side
    #[arg(long, value_name = "DIR")]
    pub(crate) html: Option<PathBuf>,
    /// Also write pictures of the worst window of all zooms into DIR: svg.png, vtex.png and
    /// difference.png, where differences are amplified four times
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// `vtex extract`.
#[derive(Debug, Args)]
pub(crate) struct Extract {
    /// The .vtex file; - for standard input
    pub(crate) file: PathBuf,
    /// Folder to write into
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Write nothing, and exit with 8, if it would be more than N files
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub(crate) max_files: u32,
}

/// `vtex render`.
#[derive(Debug, Args)]
pub(crate) struct Render {
    /// A .glb or .gltf file; or .svg or .vtex files: one is shown on a plane, several on objects in a
    /// showroom. SVG files are baked first, with default options
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scene: Vec<PathBuf>,
    /// File to write: .png (sRGB, see --tone) or .exr (linear light as it was traced, 32-bit floats)
    #[arg(short, long, value_name = "PNG|EXR")]
    pub(crate) output: PathBuf,
    /// Size in pixels: `WxH`, or N for the longer side
    #[arg(long, default_value = "768", value_parser = size)]
    pub(crate) size: Size,
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) spp: u32,
    /// Start no further sample this long after tracing began; one is always taken, and what there is
    /// is written
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<Duration>,
    /// How light becomes colours.
    #[command(flatten)]
    pub(crate) light: Light,
    /// Light from everywhere else.
    #[command(flatten)]
    pub(crate) surroundings: Surroundings,
    /// How a lookup filters. Samples lie anywhere in their pixel, so that one a pixel is noisy in any
    /// mode
    #[arg(long, value_enum, default_value_t)]
    pub(crate) filter: Filter,
    /// Largest number of bounces of a light path
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=64))]
    pub(crate) bounces: u32,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u32,
    /// Use the showroom even for one file
    #[arg(long)]
    pub(crate) showroom: bool,
    /// Camera of a glTF scene, by name or number from 0 [default: the first; without any, a view of
    /// everything]
    #[arg(long, value_name = "NAME|N")]
    pub(crate) camera: Option<String>,
    /// Scene of a glTF asset, by number from 0
    #[arg(long, value_name = "N")]
    pub(crate) scene_index: Option<usize>,
    /// Variant of the materials of a glTF asset, by name
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// `vtex gltf`.
#[derive(Debug, Args)]
pub(crate) struct Gltf {
    /// A .glb or .gltf file
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Show FILE, an .svg or .vtex, as the texture, image or material NAME; repeat for more
    #[arg(long, required = true, value_name = "NAME=FILE", value_parser = named_file)]
    pub(crate) attach: Vec<(String, PathBuf)>,
    /// The .glb file to write; files beside IN are taken in
    #[arg(short, long, value_name = "GLB")]
    pub(crate) output: PathBuf,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// `NAME=FILE`; the last equals sign counts, for names are stranger than files.
fn named_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.rsplit_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => {
            Ok((name.to_owned(), file.into()))
        }
        _ => Err("not NAME=FILE".to_owned()),
    }
}

/// `vtex demo`, called by `tools/demo`.
#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// SVG files
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Folder to write into
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Pixels along the longer side of the pictures
    #[arg(long, value_name = "N", default_value_t = 360, value_parser = clap::value_parser!(u32).range(8..=4096))]
    pub(crate) size: u32,
    /// Leave the path-traced picture out
    #[arg(long)]
    pub(crate) no_render: bool,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// A value as the command line spells it.
pub(crate) fn spelled(value: &impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn outline_takes_a_width_or_none() {
        let parse = |arguments: &[&str]| {
            let Command::Bake(bake) = Cli::try_parse_from(arguments).unwrap().command else {
                unreachable!("bake was asked for");
            };
            bake.options.outline
        };
        assert_eq!(
            parse(&["vtex", "bake", "a.svg", "-o", "b", "--outline"]),
            Some(1.0)
        );
        assert_eq!(
            parse(&["vtex", "bake", "a.svg", "-o", "b", "--outline", "1.5"]),
            Some(1.5)
        );
        assert_eq!(parse(&["vtex", "bake", "a.svg", "-o", "b"]), None);
    }
}
