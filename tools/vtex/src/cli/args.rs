//! The command line, as clap sees it.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use vtex_truth::comparison::WINDOWS;
use vtex_truth::picture::View;
use vtex_truth::texture::FilterMode;

use super::Format;
use super::values::{Color, Matrix, Size, color, matrix, size, view};

/// Bake, look into, check, preview and render vector textures.
#[derive(Debug, Parser)]
#[command(name = "vtex", version, about, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Settings of all commands.
    #[command(flatten)]
    pub(crate) global: Global,
}

const EXIT_CODES: &str = "Exit codes: 0 ok, 1 usage, 2 input/output, 3 invalid input file, \
    4 failure at run time, 5 unsupported, 7 difference found, 8 limit";

/// Settings of all commands.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Global {
    /// How results are written to standard output
    #[arg(
        long,
        global = true,
        value_enum,
        default_value_t,
        value_name = "FORMAT"
    )]
    pub(crate) format: Format,
    /// Say nothing but failures
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say what is being done, and every warning
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Threads to use; 0 means one for each core
    #[arg(long, global = true, default_value_t = 0, value_name = "N")]
    pub(crate) threads: usize,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Bake SVG into .vtex
    #[command(after_help = PROCESSES)]
    Bake(Box<Bake>),
    /// Say what is in a .vtex file
    Info(Info),
    /// Check .vtex files; numbered issues
    Validate(Validate),
    /// Shoot a picture of a .vtex file
    Preview(Preview),
    /// Measure a .vtex file against its SVG at several zooms
    #[command(after_help = METRICS)]
    Compare(Compare),
    /// Write layers, mips, a heat map of the cells and the shader as files
    Extract(Extract),
    /// Path-trace textures: one on a plane, several in a showroom
    Render(Render),
    /// Bake SVG files and write a page that compares SVG, vtex and raster
    #[command(hide = true)]
    Demo(Demo),
    /// Bake what comes over standard input, for `vtex bake`
    #[command(hide = true)]
    Worker(Worker),
}

const PROCESSES: &str = "Files are baked in processes of their own, --threads of them at a time. A \
    process that takes longer than --timeout for one file or more than --max-memory is ended: the \
    file gets exit code 8, the others are baked all the same.";

const METRICS: &str = "The truth is resvg without anti-aliasing at 257 samples a pixel, \
    averaged in linear light. Both pictures are laid over white in linear light and sRGB-encoded; \
    PSNR is over their R, G and B, a pixel is wrong when a channel differs by more than 8 of 255. \
    At zooms above 1 four windows at edges of the drawing are measured and the worst counts.";

/// Fonts for text.
#[derive(Clone, Debug, Args)]
pub(crate) struct Fonts {
    /// Folder with fonts for text, searched before the system's; may be given several times
    #[arg(long, value_name = "DIR")]
    pub(crate) font_dir: Vec<PathBuf>,
    /// Do not look at the system's fonts, so that every machine bakes the same
    #[arg(long)]
    pub(crate) no_system_fonts: bool,
}

/// `vtex bake`.
#[derive(Debug, Args)]
pub(crate) struct Bake {
    /// SVG or gzipped SVG files, folders (searched for .svg and .svgz), globs, or -
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// File, folder, or - for standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// What the bake may do.
    #[command(flatten)]
    pub(crate) options: BakeOptions,
    /// Write nothing: compare with the files that are there, exit with 7 when one differs
    #[arg(long)]
    pub(crate) check: bool,
    /// Write what each output depends on, as a Makefile
    #[arg(long, value_name = "FILE")]
    pub(crate) depfile: Option<PathBuf>,
    /// Keep bakes here and take them from here when source, options and version are the same
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// What one file may use up.
    #[command(flatten)]
    pub(crate) budget: Budget,
}

/// What the bake of one file may use up: it runs in a process of its own.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Budget {
    /// Longest that one file may take; past it the exit code is 8
    #[arg(long, value_name = "SECONDS", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=604_800))]
    pub(crate) timeout: u32,
    /// Most memory that one file may take; past it the exit code is 8. Not enforced on Windows
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
    /// Largest magnification the geometry is prepared for; 1 shows the canvas at 512 pixels
    #[arg(long, value_name = "Z")]
    pub(crate) max_zoom: Option<f32>,
    /// Pixels at the largest zoom by which a distance field may displace an edge before its shape
    /// becomes curves
    #[arg(long, value_name = "PX")]
    pub(crate) error: Option<f64>,
    /// Texels of mip 0's longer side
    #[arg(long, value_name = "N")]
    pub(crate) size: Option<u32>,
    /// Texels of the MSDF lattice along the canvas' longer side
    #[arg(long, value_name = "N")]
    pub(crate) msdf_size: Option<u32>,
    /// Put all shapes into one layer, right only when none overlap
    #[arg(long)]
    pub(crate) merge: bool,
    /// Store coverage only: lookups return alpha
    #[arg(long)]
    pub(crate) mask: bool,
    /// Half width of the paper's constant smoothing, in (0, 0.5]
    #[arg(long, value_name = "S")]
    pub(crate) smoothing: Option<f32>,
    /// Outline of WIDTH texels around every shape from its distance field
    #[arg(long, value_name = "WIDTH", num_args = 0..=1, default_missing_value = "1")]
    pub(crate) outline: Option<f32>,
    /// Replace every fill's colour (CSS: #d03020, navy, rgb(1 2 3))
    #[arg(long, value_name = "COLOR", value_parser = color)]
    pub(crate) fill_color: Option<Color>,
    /// Replace every stroke's and the outline's colour
    #[arg(long, value_name = "COLOR", value_parser = color)]
    pub(crate) stroke_color: Option<Color>,
    /// What lookups outside the canvas see
    #[arg(long, value_enum)]
    pub(crate) address: Option<Address>,
    /// Texture matrix: u' = a u + c v + e, v' = b u + d v + f
    #[arg(long, value_name = "a,b,c,d,e,f", value_parser = matrix, allow_hyphen_values = true)]
    pub(crate) transform: Option<Matrix>,
    /// Also draw images in files at or below DIR that the SVG names; may be given several times.
    /// Without it, and from the network in any case, they are left out with a warning
    #[arg(long, value_name = "DIR")]
    pub(crate) allow_images: Vec<PathBuf>,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// How shapes are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum BakeMode {
    /// The best for each shape
    #[default]
    Auto,
    /// Distance fields
    Msdf,
    /// Exact curves
    Curves,
    /// One raster image with mips
    Raster,
}

/// What lookups outside the canvas see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Address {
    /// The nearest point of the canvas
    Clamp,
    /// The canvas again
    Repeat,
    /// The canvas mirrored at every turn
    Mirror,
    /// Nothing
    Border,
}

/// `vtex info`.
#[derive(Debug, Args)]
pub(crate) struct Info {
    /// The .vtex file, or -
    pub(crate) file: PathBuf,
}

/// `vtex validate`.
#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// .vtex files, or -
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
}

/// How a texture is looked up.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Lookup {
    /// How a lookup filters
    #[arg(long, value_enum, default_value_t)]
    pub(crate) filter: Filter,
    /// Who looks up
    #[arg(long, value_enum, default_value_t)]
    pub(crate) backend: Backend,
    /// Samples a pixel
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) spp: u32,
}

/// How a lookup filters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Filter {
    /// Hard inside test, the samples smooth
    #[default]
    Point,
    /// A ramp as wide as the footprint
    Footprint,
    /// Constant smoothing
    Paper,
}

impl From<Filter> for FilterMode {
    fn from(filter: Filter) -> Self {
        match filter {
            Filter::Point => Self::Point,
            Filter::Footprint => Self::Footprint,
            Filter::Paper => Self::Paper,
        }
    }
}

/// Who looks up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// The evaluator in Rust, needs no GPU
    #[default]
    Cpu,
    /// The evaluator in WGSL on the best adapter, or the one named by `VTEX_ADAPTER`
    Gpu,
}

/// `vtex preview`.
#[derive(Debug, Args)]
pub(crate) struct Preview {
    /// The .vtex file, or -
    pub(crate) file: PathBuf,
    /// PNG to write, or -
    #[arg(short, long, value_name = "PNG")]
    pub(crate) output: PathBuf,
    /// Pixels: `WxH`, or N for the longer side
    #[arg(long, default_value = "512", value_parser = size)]
    pub(crate) size: Size,
    /// Part of the canvas in uv: left, top, right, bottom
    #[arg(long, value_name = "u0,v0,u1,v1", value_parser = view, allow_hyphen_values = true)]
    pub(crate) view: Option<View>,
    /// How it is looked up.
    #[command(flatten)]
    pub(crate) lookup: Lookup,
}

/// `vtex compare`.
#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// The SVG
    #[arg(value_name = "IN.svg")]
    pub(crate) svg: PathBuf,
    /// The .vtex baked from it
    pub(crate) file: PathBuf,
    /// Zooms to measure at; 1 shows the whole canvas
    #[arg(
        long,
        value_name = "Z,...",
        value_delimiter = ',',
        default_value = "1,8,32,256"
    )]
    pub(crate) zoom: Vec<f64>,
    /// Pixels of the pictures' longer side
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(8..=8192))]
    pub(crate) size: u32,
    /// How it is looked up.
    #[command(flatten)]
    pub(crate) lookup: Lookup,
    /// Exit with 7 when a zoom's PSNR is below X dB
    #[arg(long, value_name = "X")]
    pub(crate) min_psnr: Option<f64>,
    /// Windows that each zoom above 1 is compared in
    #[arg(long, value_name = "N", default_value_t = WINDOWS, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) windows: u32,
    /// Also tell the truth's own noise: the PSNR of half the samples along each side of a pixel
    /// against all, in the worst window of each zoom
    #[arg(long)]
    pub(crate) noise: bool,
    /// Also write a page with pictures: SVG, vtex, raster 4096
    #[arg(long, value_name = "DIR")]
    pub(crate) html: Option<PathBuf>,
    /// Also write the worst window of the worst zoom: svg.png, vtex.png and difference.png, which
    /// shows differences four times as large
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
}

/// `vtex extract`.
#[derive(Debug, Args)]
pub(crate) struct Extract {
    /// The .vtex file, or -
    pub(crate) file: PathBuf,
    /// Folder to write into
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// `vtex render`.
#[derive(Debug, Args)]
pub(crate) struct Render {
    /// One .svg or .vtex file for a plane, several for the showroom
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scene: Vec<PathBuf>,
    /// .png (tone-mapped sRGB) or .exr (linear) to write
    #[arg(short, long, value_name = "PNG|EXR")]
    pub(crate) output: PathBuf,
    /// Pixels: `WxH`, or N for the longer side
    #[arg(long, default_value = "768", value_parser = size)]
    pub(crate) size: Size,
    /// Samples a pixel
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) spp: u32,
    /// Scatterings of a path
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=64))]
    pub(crate) bounces: u32,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u32,
    /// Show the showroom even with one file
    #[arg(long)]
    pub(crate) showroom: bool,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
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
    /// Pixels of the pictures' longer side
    #[arg(long, value_name = "N", default_value_t = 360, value_parser = clap::value_parser!(u32).range(8..=4096))]
    pub(crate) size: u32,
    /// Leave the path-traced picture out
    #[arg(long)]
    pub(crate) no_render: bool,
    /// Fonts for text.
    #[command(flatten)]
    pub(crate) fonts: Fonts,
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
