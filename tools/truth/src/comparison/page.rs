//! A page that shows SVG, vtex and raster side by side. It links to its own pictures only, by
//! relative paths.

use std::fmt::Write as _;

use vtex_format::VtexFile;
use vtex_shaders::{PackOptions, pack};

use super::Comparison;
use crate::TruthError;
use crate::picture::{Difference, PSNR_CAP_DB, Picture, difference};
use crate::texture::{RasterBytes, RasterTexture};

/// Sizes of one drawing as SVG, `.vtex` and raster.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    svg_bytes: u64,
    vtex_bytes: u64,
    gpu_bytes: [u64; 2],
    raster_texels: [u32; 2],
    raster_gpu_bytes: [u64; 2],
    raster_png_bytes: u64,
}

impl Sizes {
    /// Collects the sizes of `file`, which takes `vtex_bytes` on disk.
    ///
    /// # Errors
    /// When the raster cannot be encoded.
    pub fn new(
        svg_bytes: u64,
        (file, vtex_bytes): (&VtexFile, u64),
        raster: &RasterTexture,
    ) -> Result<Self, TruthError> {
        let packed = pack(file, &PackOptions::default());
        let [width, height] = raster.size().map(f64::from);
        let bytes = RasterBytes::of(
            [width, height],
            raster.size().into_iter().max().unwrap_or(1),
        );
        Ok(Self {
            svg_bytes,
            vtex_bytes,
            gpu_bytes: [packed.bytes() as u64, packed.bytes_bc() as u64],
            raster_texels: raster.size(),
            raster_gpu_bytes: [bytes.rgba8, bytes.bc7],
            raster_png_bytes: raster.png_bytes()?,
        })
    }
}

/// A picture beside the truth.
#[derive(Debug)]
pub struct Column {
    picture: Picture,
    difference: Difference,
}

impl Column {
    /// Measures `picture` against `truth`.
    pub fn new(comparison: &Comparison<'_>, truth: &Picture, picture: Picture) -> Self {
        let picture = comparison.as_compared(picture);
        Self {
            difference: difference(truth, &picture),
            picture,
        }
    }
}

/// The columns: part of the file names, and heading.
const COLUMNS: [(&str, &str); 3] = [
    ("svg", "SVG, drawn anew at this zoom"),
    ("vtex", ".vtex"),
    ("raster", "raster 4096 with mips"),
];

/// One file of a page.
#[derive(Debug)]
pub struct PageFile {
    /// Its path below the folder of the page, with `/` between folders.
    pub name: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// A page being made, in memory.
#[derive(Debug)]
pub struct Page {
    body: String,
    pictures: Vec<PageFile>,
}

impl Page {
    /// Begins a page.
    pub fn new(title: &str) -> Self {
        Self {
            body: format!("<h1>{}</h1>\n", escape(title)),
            pictures: Vec::new(),
        }
    }

    /// A paragraph of text.
    pub fn paragraph(&mut self, text: &str) {
        self.push(&format!("<p>{}</p>\n", escape(text)));
    }

    /// One large picture, a PNG.
    pub fn large_picture(&mut self, png: Vec<u8>, caption: &str) {
        let name = self.save("scene", png);
        let caption = escape(caption);
        self.push(&format!(
            "<figure class=\"large\"><img src=\"{name}\" alt=\"{caption}\">\
             <figcaption>{caption}</figcaption></figure>\n"
        ));
    }

    /// Begins a drawing.
    pub fn drawing(&mut self, name: &str, sizes: &Sizes) {
        let [width, height] = sizes.raster_texels;
        let facts = [
            ("SVG", human_bytes(sizes.svg_bytes)),
            (".vtex file", human_bytes(sizes.vtex_bytes)),
            ("raster as PNG", human_bytes(sizes.raster_png_bytes)),
            (".vtex on the GPU", human_bytes(sizes.gpu_bytes[0])),
            (
                ".vtex on the GPU, if its texels were BC7",
                human_bytes(sizes.gpu_bytes[1]),
            ),
            (
                "raster on the GPU, RGBA8 with mips",
                human_bytes(sizes.raster_gpu_bytes[0]),
            ),
            (
                "raster on the GPU, BC7 with mips",
                human_bytes(sizes.raster_gpu_bytes[1]),
            ),
        ];
        self.push(&format!("<h2>{}</h2>\n<dl>", escape(name)));
        for (what, value) in facts {
            self.push(&format!("<div><dt>{what}</dt><dd>{value}</dd></div>"));
        }
        self.push(&format!(
            "</dl>\n<p class=\"note\">Raster: {width} x {height} texels.</p>\n"
        ));
    }

    /// One zoom: the truth, then vtex and raster with their figures.
    ///
    /// # Errors
    /// When a picture cannot be encoded.
    pub fn row(
        &mut self,
        zoom: f64,
        truth: &Picture,
        columns: &[Column; 2],
    ) -> Result<(), TruthError> {
        self.push(&format!("<h3>{zoom}&times;</h3>\n<div class=\"row\">\n"));
        self.cell(0, truth, "the truth")?;
        let best = columns[0]
            .difference
            .psnr_db
            .max(columns[1].difference.psnr_db);
        for (index, column) in (1..).zip(columns) {
            let figures = figures(&column.difference, best);
            self.cell(index, &column.picture, &figures)?;
        }
        self.push("</div>\n");
        Ok(())
    }

    fn cell(&mut self, column: usize, picture: &Picture, figures: &str) -> Result<(), TruthError> {
        let (stem, heading) = COLUMNS[column];
        let name = self.save(stem, picture.to_png()?);
        let [width, height] = picture.size_px;
        self.push(&format!(
            "<figure><img src=\"{name}\" width=\"{width}\" height=\"{height}\" alt=\"{heading}\">\
             <figcaption>{heading}<br>{figures}</figcaption></figure>\n"
        ));
        Ok(())
    }

    fn save(&mut self, stem: &str, bytes: Vec<u8>) -> String {
        let name = format!("pictures/{:03}-{stem}.png", self.pictures.len());
        self.pictures.push(PageFile {
            name: name.clone(),
            bytes,
        });
        name
    }

    /// The files of the page: the pictures, then `index.html`.
    pub fn finish(self) -> Vec<PageFile> {
        let html = format!("{HEAD}{}</main>\n</body>\n</html>\n", self.body);
        let mut files = self.pictures;
        files.push(PageFile {
            name: "index.html".to_owned(),
            bytes: html.into_bytes(),
        });
        files
    }

    fn push(&mut self, html: &str) {
        self.body.push_str(html);
    }
}

fn figures(found: &Difference, best_db: f64) -> String {
    let class = if found.psnr_db >= best_db {
        "best"
    } else {
        "other"
    };
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = match found.psnr_db >= PSNR_CAP_DB {
        true => write!(text, "<b class=\"{class}\">identical</b>"),
        false => write!(text, "<b class=\"{class}\">{:.1} dB</b>", found.psnr_db),
    };
    let _ = write!(text, ", {:.2}% wrong pixels", 100.0 * found.wrong_share);
    text
}

/// `1234567` as `1.2 MiB`.
pub fn human_bytes(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    // Rounding to one digit is the purpose.
    let mut value = bytes as f64 / 1024.0;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    format!("{value:.1} {}", UNITS[unit])
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

const HEAD: &str = r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>vtex</title>
<style>
:root { color-scheme: light dark; --ink: #1b2a41; --soft: #5d6b80; --ground: #f7f6f2; --card: #ffffff;
  --line: #dcdad2; --good: #1d7a4f; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ef; --soft: #97a3b6; --ground: #12161d; --card: #1b212b; --line: #2d3644; --good: #6fd3a0; }
}
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 2rem 1rem 4rem; }
h1 { font-size: 2rem; margin: 0 0 .5rem; }
h2 { margin: 3rem 0 .5rem; border-top: 1px solid var(--line); padding-top: 1.5rem; }
h3 { margin: 1.2rem 0 .4rem; font-weight: 600; color: var(--soft); }
p { max-width: 46rem; }
.note { color: var(--soft); font-size: .9rem; margin: .3rem 0 0; }
dl { display: flex; flex-wrap: wrap; gap: .6rem 2.2rem; margin: .6rem 0; }
dl div { display: flex; flex-direction: column; }
dt { color: var(--soft); font-size: .85rem; }
dd { margin: 0; font-variant-numeric: tabular-nums; font-weight: 600; }
.row { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 1rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #fff; }
figure.large { margin: 1.5rem 0; }
figcaption { padding: .5rem .8rem .6rem; font-size: .88rem; color: var(--soft); font-variant-numeric: tabular-nums; }
.best { color: var(--good); }
@media (max-width: 640px) { .row { grid-template-columns: 1fr; } }
</style>
</head>
<body>
<main>
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_links_only_to_its_own_pictures() {
        let mut page = Page::new("<title>");
        page.large_picture(b"png".to_vec(), "a \"scene\"");
        let files = page.finish();
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["pictures/000-scene.png", "index.html"]);
        let html = String::from_utf8(files[1].bytes.clone()).unwrap();
        assert!(
            html.contains("&lt;title&gt;") && !html.contains("http"),
            "{html}"
        );
        assert!(html.contains("src=\"pictures/000-scene.png\""), "{html}");
    }
}
