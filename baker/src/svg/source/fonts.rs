//! Fonts for text: only those of the caller, and a warning for each that is missing.

use std::sync::Arc;

use usvg::fontdb::{self, Database, ID};
use usvg::{Font, FontFamily, FontResolver};
use vtex_format::WarningCode;

use crate::warning::Warnings;

/// How a bake chooses a font face: usvg's choice, or else the first face that there is. Use it to
/// draw the same SVG with usvg and get the same glyphs.
pub fn font_selector() -> usvg::FontSelectionFn<'static> {
    let select = FontResolver::default_font_selector();
    Box::new(move |font, fonts| {
        select(font, fonts).or_else(|| fonts.faces().next().map(|face| face.id))
    })
}

/// [`font_selector`] with warnings about fonts and characters that it could not find.
pub(crate) fn resolver(warnings: &Warnings) -> FontResolver<'_> {
    let select = font_selector();
    let fall_back = FontResolver::default_fallback_selector();
    FontResolver {
        select_font: Box::new(move |font, fonts: &mut Arc<Database>| {
            let chosen = select(font, fonts);
            // A substitute is drawn, but the text may then look different.
            if !wanted_family_exists(font, fonts) {
                let families = family_names(font);
                let result = match chosen.and_then(|id| family_of(fonts, id)) {
                    Some(substitute) => format!("drawn with {substitute}"),
                    None => "its text is not drawn".to_owned(),
                };
                let message = format!("font {families} was not found, {result}");
                warnings.push(WarningCode::MissingFont, "font-family", "", message);
            }
            chosen
        }),
        select_fallback: Box::new(move |character, used, fonts: &mut Arc<Database>| {
            let chosen = fall_back(character, used, fonts);
            // A missing space or control character cannot be seen.
            if chosen.is_none() && !is_invisible(character) {
                let code = u32::from(character);
                let message = format!("no font has the character U+{code:04X}");
                warnings.push(WarningCode::MissingFont, "text", "", message);
            }
            chosen
        }),
    }
}

fn is_invisible(character: char) -> bool {
    character.is_whitespace() || character.is_control()
}

fn wanted_family_exists(font: &Font, fonts: &Database) -> bool {
    let families: Vec<_> = font.families().iter().map(fontdb_family).collect();
    fonts
        .query(&fontdb::Query {
            families: &families,
            ..fontdb::Query::default()
        })
        .is_some()
}

fn fontdb_family(family: &FontFamily) -> fontdb::Family<'_> {
    match family {
        FontFamily::Serif => fontdb::Family::Serif,
        FontFamily::SansSerif => fontdb::Family::SansSerif,
        FontFamily::Cursive => fontdb::Family::Cursive,
        FontFamily::Fantasy => fontdb::Family::Fantasy,
        FontFamily::Monospace => fontdb::Family::Monospace,
        FontFamily::Named(name) => fontdb::Family::Name(name),
    }
}

fn family_names(font: &Font) -> String {
    let names: Vec<_> = font.families().iter().map(ToString::to_string).collect();
    names.join(", ")
}

fn family_of(fonts: &Database, id: ID) -> Option<&str> {
    fonts
        .face(id)?
        .families
        .first()
        .map(|(name, _)| name.as_str())
}
