//! Fonts for tests, the same on every machine.

use std::sync::{Arc, OnceLock};

use usvg::fontdb::{Database, Source};

/// Latin, Greek, Cyrillic and Hebrew.
pub const SERIF: &str = "Libertinus Serif";
/// Latin, Greek and Cyrillic.
pub const MONOSPACE: &str = "DejaVu Sans Mono";

/// The faces of [`SERIF`], which stands for every generic family but one, and [`MONOSPACE`].
///
/// They come with the crate typst-assets: OFL 1.1, and the Bitstream Vera licence.
pub fn library() -> Arc<Database> {
    static LIBRARY: OnceLock<Arc<Database>> = OnceLock::new();
    Arc::clone(LIBRARY.get_or_init(|| Arc::new(load())))
}

fn load() -> Database {
    let mut fonts = Database::new();
    for bytes in typst_assets::fonts() {
        fonts.load_font_source(Source::Binary(Arc::new(bytes)));
    }
    let wanted = |name: &str| name == SERIF || name == MONOSPACE;
    let others: Vec<_> = fonts
        .faces()
        .filter(|face| !face.families.iter().any(|(name, _)| wanted(name)))
        .map(|face| face.id)
        .collect();
    for face in others {
        fonts.remove_face(face);
    }
    for set in [
        Database::set_serif_family,
        Database::set_sans_serif_family,
        Database::set_cursive_family,
        Database::set_fantasy_family,
    ] {
        set(&mut fonts, SERIF);
    }
    fonts.set_monospace_family(MONOSPACE);
    fonts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_families_are_there_and_no_others() {
        let fonts = library();
        let mut families: Vec<_> = fonts.faces().map(|face| &*face.families[0].0).collect();
        families.sort_unstable();
        families.dedup();
        assert_eq!(families, [MONOSPACE, SERIF]);
        assert!(fonts.len() >= 8, "regular, bold, italic and both of each");
    }
}
