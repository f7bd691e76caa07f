//! Files that the command reads and writes.

use std::path::Path;

pub(crate) mod input;
pub(crate) mod output;

/// A path as text for JSON, which takes UTF-8 alone: other bytes become U+FFFD.
pub(crate) fn lossy(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// Whether bytes are those of a gzip file (RFC 1952, 2.3.1).
pub(crate) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Whether the bytes of the file at `path` look like an SVG, plain or gzipped.
pub(crate) fn is_svg(path: &Path, bytes: &[u8]) -> bool {
    /// Enough for the comments and entities that precede the root element.
    const HEAD_BYTES: usize = 1 << 16;
    if is_gzip(bytes) {
        return extension(path) == "svgz";
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD_BYTES)]);
    // The first tag, not `<?xml`, `<!DOCTYPE` or `<!--`. The root may be `svg:svg`.
    let mut tags = head.split('<').skip(1);
    let root = tags.find(|tag| tag.starts_with(|c: char| c.is_ascii_alphabetic()));
    let name = root.and_then(|tag| tag.split([' ', '\t', '\r', '\n', '>', '/']).next());
    head.trim_start_matches('\u{feff}')
        .trim_start()
        .starts_with('<')
        && name.is_some_and(|name| name.rsplit(':').next() == Some("svg"))
}

/// What to do with an SVG where a `.vtex` file is wanted.
pub(crate) const BAKE_IT_FIRST: &str =
    "this is an SVG: bake it first: vtex bake IN.svg -o OUT.vtex";

/// The extension in lower case; empty when there is none.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .map_or_else(String::new, |ext| ext.to_string_lossy().to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn svgs_are_known_by_their_root() {
        let svg = |name: &str, bytes: &[u8]| is_svg(Path::new(name), bytes);
        for text in [
            "<svg/>",
            "\u{feff} <?xml version='1.0'?><!DOCTYPE svg []><!-- a -->\n<svg\nwidth='1'>",
            "<svg:svg xmlns:svg='http://www.w3.org/2000/svg'>",
        ] {
            assert!(svg("a", text.as_bytes()), "{text}");
        }
        for text in ["", "svg", "<html><svg/></html>", "<svgs/>", "VTEX <svg>"] {
            assert!(!svg("a.svg", text.as_bytes()), "{text}");
        }
        assert!(svg("a.svgz", &[0x1f, 0x8b, 8]) && !svg("a.gz", &[0x1f, 0x8b, 8]));
    }
}
