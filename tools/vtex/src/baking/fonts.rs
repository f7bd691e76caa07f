//! Fonts for text: loaded once, and only when a drawing may hold text.

use std::sync::{Arc, OnceLock};

use usvg::fontdb;

use crate::cli::args::Fonts;
use crate::cli::{ExitCode, Failure, Outcome};
use crate::files::is_gzip;

/// The fonts that the command line names.
#[derive(Debug)]
pub(crate) struct FontLibrary {
    wanted: Fonts,
    loaded: OnceLock<Arc<fontdb::Database>>,
}

impl FontLibrary {
    /// Stores which fonts to load; loads none yet.
    ///
    /// # Errors
    /// When a font folder does not exist.
    pub(crate) fn new(wanted: Fonts) -> Outcome<Self> {
        if let Some(missing) = wanted.font_dir.iter().find(|dir| !dir.is_dir()) {
            let message = format!("{}: this font folder does not exist", missing.display());
            return Err(Failure::new(ExitCode::Io, message));
        }
        Ok(Self {
            wanted,
            loaded: OnceLock::new(),
        })
    }

    /// The fonts, or an empty database when `svg` holds no text: system fonts take long to scan.
    pub(crate) fn for_svg(&self, svg: &[u8]) -> Arc<fontdb::Database> {
        if may_hold_text(svg) {
            self.load()
        } else {
            Arc::default()
        }
    }

    /// The fonts that a bake of `svg` may use, as text for cache keys: name, path and file size of
    /// each face.
    pub(crate) fn fingerprint(&self, svg: &[u8]) -> String {
        let fonts = self.for_svg(svg);
        let mut faces: Vec<String> = fonts.faces().map(describe).collect();
        faces.sort();
        faces.join("\n")
    }

    fn load(&self) -> Arc<fontdb::Database> {
        let load = || {
            let mut fonts = fontdb::Database::new();
            for dir in &self.wanted.font_dir {
                fonts.load_fonts_dir(dir);
            }
            if !self.wanted.no_system_fonts {
                fonts.load_system_fonts();
            }
            name_generic_families(&mut fonts);
            Arc::new(fonts)
        };
        Arc::clone(self.loaded.get_or_init(load))
    }
}

/// Maps the generic families (`serif`, `sans-serif`, ...) to installed fonts. usvg also takes
/// `serif` for every family that is missing. fontdb's own defaults name fonts of Windows, which
/// other systems lack.
fn name_generic_families(fonts: &mut fontdb::Database) {
    let present = |names: &[&str]| {
        let named = |name: &&&str| {
            let families = [fontdb::Family::Name(name)];
            let query = fontdb::Query {
                families: &families,
                ..fontdb::Query::default()
            };
            fonts.query(&query).is_some()
        };
        names.iter().find(named).map(|name| (*name).to_owned())
    };
    let serif = present(&[
        "Times New Roman",
        "Liberation Serif",
        "Noto Serif",
        "DejaVu Serif",
    ]);
    let sans = present(&["Arial", "Liberation Sans", "Noto Sans", "DejaVu Sans"]);
    let mono = present(&[
        "Courier New",
        "Liberation Mono",
        "Noto Sans Mono",
        "DejaVu Sans Mono",
    ]);
    let any = serif.clone().or_else(|| sans.clone()).or(mono.clone());
    let Some(any) = any else { return };
    fonts.set_serif_family(serif.unwrap_or_else(|| any.clone()));
    fonts.set_sans_serif_family(sans.unwrap_or_else(|| any.clone()));
    fonts.set_monospace_family(mono.unwrap_or_else(|| any.clone()));
    fonts.set_cursive_family(any.clone());
    fonts.set_fantasy_family(any);
}

fn describe(face: &fontdb::FaceInfo) -> String {
    let place = match &face.source {
        fontdb::Source::File(path) | fontdb::Source::SharedFile(path, _) => {
            let bytes = std::fs::metadata(path).map_or(0, |file| file.len());
            format!("{} {bytes}", path.display())
        }
        fontdb::Source::Binary(_) => String::new(),
    };
    format!("{} {} {place}", face.post_script_name, face.index)
}

/// Whether an SVG may hold text. Gzipped files are not unpacked for this and count as yes.
fn may_hold_text(svg: &[u8]) -> bool {
    let has = |name: &[u8]| svg.windows(name.len()).any(|window| window == name);
    is_gzip(svg) || has(b"text") || has(b"foreignObject")
}
