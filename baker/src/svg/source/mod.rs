//! Bytes to a usvg tree: budgets first, then parsing with hooks that touch no file.

mod entities;
mod fonts;
mod images;

use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};

use kurbo::Affine;

use crate::{BakeError, Resources, svg::Cost, warning::Warnings};

pub use fonts::font_selector;

/// Bytes of SVG text, packed or not. The largest real drawings (maps) are about 30 MiB; a gzip
/// stream that unpacks to more is refused while it is read.
const MAX_SVG_BYTES: usize = 64 << 20;
/// Nodes of the parsed tree, after `use` is expanded. usvg has a bound of its own as well.
const MAX_NODES: usize = 1 << 20;
/// Path verbs of the parsed tree.
const MAX_SEGMENTS: usize = 1 << 22;
/// Groups inside groups, clip paths, masks, patterns and SVG images all counted. Real files stay
/// below 100, usvg lets 1024 elements nest. Deeper ones could exhaust the stack of a painter.
const MAX_DEPTH: usize = 1024;
/// Side in texels of the canvas for which filters are weighed.
const WEIGHED_SIDE: f64 = 512.0;
/// Nanoseconds for the filters of a canvas of that side, those of morphology's windows apart.
/// Patches get coarser until theirs take a few seconds each; past this they would show little.
const MAX_FILTER_NS: f64 = 2e10;
/// As [`MAX_FILTER_NS`], for windows, which shrink twice as fast with the patch.
const MAX_WINDOW_NS: f64 = 1.28e12;
/// Longer side of the canvas over the shorter one. Beyond it mip 0 has no texels for a side.
const MAX_ASPECT: f32 = 4096.0;

/// How gzip streams begin.
pub(super) const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Parses an SVG or SVGZ at 96 dpi with the given fonts.
pub(crate) fn parse(
    svg: &[u8],
    resources: &Resources,
    warnings: &Warnings,
) -> Result<usvg::Tree, BakeError> {
    let unpacked;
    let bytes = if svg.starts_with(&GZIP_MAGIC) {
        unpacked = gunzip(svg)?;
        unpacked.as_slice()
    } else {
        svg
    };
    let text = checked_text(bytes)?;
    let options = usvg::Options {
        dpi: 96.0,
        image_href_resolver: images::resolver(warnings, resources.images.as_ref()),
        font_resolver: fonts::resolver(warnings),
        fontdb: resources.fonts.clone(),
        ..usvg::Options::default()
    };
    // usvg is not known to panic, but it reads files nobody vouches for.
    let tree = catch_unwind(AssertUnwindSafe(|| usvg::Tree::from_str(text, &options)))
        .map_err(|_| BakeError::Svg("the SVG parser failed".to_owned()))?
        .map_err(|e| bake_error(&e))?;
    check_size(&tree)?;
    check_filters(&tree)?;
    Ok(tree)
}

/// SVG text that is no longer than allowed, with its entities expanded too.
pub(super) fn checked_text(bytes: &[u8]) -> Result<&str, BakeError> {
    if bytes.len() > MAX_SVG_BYTES {
        return Err(too_many_bytes());
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|e| BakeError::Svg(format!("not UTF-8 text (byte {})", e.valid_up_to())))?;
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(BakeError::Svg("the input is empty".to_owned()));
    }
    if entities::expanded_bytes(text) > MAX_SVG_BYTES {
        return Err(BakeError::Limit(
            "entities expand to too much text".to_owned(),
        ));
    }
    Ok(text)
}

fn gunzip(svgz: &[u8]) -> Result<Vec<u8>, BakeError> {
    let mut bytes = Vec::new();
    let bound = MAX_SVG_BYTES as u64 + 1;
    flate2::read::GzDecoder::new(svgz)
        .take(bound)
        .read_to_end(&mut bytes)
        .map_err(|e| match e.kind() {
            std::io::ErrorKind::OutOfMemory => {
                BakeError::Limit("there is no memory for the unpacked SVG".to_owned())
            }
            _ => BakeError::Svg(format!("broken gzip stream: {e}")),
        })?;
    Ok(bytes)
}

fn too_many_bytes() -> BakeError {
    BakeError::Limit(format!(
        "the SVG text is larger than {} MiB",
        MAX_SVG_BYTES >> 20
    ))
}

fn bake_error(error: &usvg::Error) -> BakeError {
    match error {
        usvg::Error::ElementsLimitReached => {
            BakeError::Limit("the SVG has too many or too deeply nested elements".to_owned())
        }
        usvg::Error::InvalidSize => {
            BakeError::Svg("width, height and viewBox must be positive".to_owned())
        }
        usvg::Error::ParsingFailed(usvg::roxmltree::Error::NodesLimitReached) => {
            BakeError::Limit("the SVG has too many or too deeply nested nodes".to_owned())
        }
        usvg::Error::ParsingFailed(e) => BakeError::Svg(format!("XML: {e}")),
        other => BakeError::Svg(other.to_string()),
    }
}

fn check_size(tree: &usvg::Tree) -> Result<(), BakeError> {
    let (width, height) = (tree.size().width(), tree.size().height());
    if !(width.is_finite() && height.is_finite() && width > 0.0 && height > 0.0) {
        return Err(BakeError::Svg(format!("canvas of {width} x {height}")));
    }
    if width.max(height) > MAX_ASPECT * width.min(height) {
        return Err(BakeError::Limit(format!(
            "canvas of {width} x {height} is longer than {MAX_ASPECT}:1"
        )));
    }
    let mut census = Census::default();
    census.count(tree.root(), 0);
    if census.too_deep {
        return Err(BakeError::Limit(format!(
            "groups, clip paths, masks and patterns nest deeper than {MAX_DEPTH}"
        )));
    }
    if census.nodes > MAX_NODES {
        return Err(BakeError::Limit(format!("more than {MAX_NODES} nodes")));
    }
    if census.segments > MAX_SEGMENTS {
        return Err(BakeError::Limit(format!(
            "more than {MAX_SEGMENTS} path segments"
        )));
    }
    Ok(())
}

fn check_filters(tree: &usvg::Tree) -> Result<(), BakeError> {
    let canvas = [tree.size().width(), tree.size().height()].map(f64::from);
    let scale = WEIGHED_SIDE / canvas[0].max(canvas[1]);
    let cost = Cost::of_group(tree.root(), Affine::IDENTITY, canvas);
    let [filters, windows] = cost.filter_work_ns(scale);
    if filters > MAX_FILTER_NS || windows > MAX_WINDOW_NS {
        return Err(BakeError::Limit(
            "the filters ask for too much work".to_owned(),
        ));
    }
    Ok(())
}

/// Size of a tree, counted up to just past the limits.
#[derive(Default)]
struct Census {
    nodes: usize,
    segments: usize,
    too_deep: bool,
}

impl Census {
    fn count(&mut self, group: &usvg::Group, depth: usize) {
        self.too_deep |= depth > MAX_DEPTH;
        for node in group.children() {
            if self.too_deep || self.nodes > MAX_NODES || self.segments > MAX_SEGMENTS {
                return;
            }
            self.nodes += 1;
            match node {
                usvg::Node::Group(child) => self.count(child, depth + 1),
                usvg::Node::Path(path) => self.segments += path.data().verbs().len(),
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
            // Clip paths, masks, patterns, flattened text and nested images.
            node.subroots(|root| self.count(root, depth + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(svg: &[u8]) -> String {
        let warnings = Warnings::default();
        parse(svg, &Resources::default(), &warnings)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn faults_are_named_in_one_line() {
        let svg = |head: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' {head}/>");
        let cases: [(Vec<u8>, &str); 9] = [
            (b"".to_vec(), "the input is empty"),
            (b" \n\t".to_vec(), "the input is empty"),
            (b"\x89PNG\r\n".to_vec(), "not UTF-8"),
            (b"hello".to_vec(), "XML"),
            (b"<html/>".to_vec(), "not a usable SVG"),
            (
                b"<svg xmlns='http://www.w3.org/2000/svg'><g".to_vec(),
                "XML",
            ),
            (b"\x1f\x8b\x08\x00".to_vec(), "gzip"),
            (svg("width='0' height='5'").into_bytes(), "must be positive"),
            (
                svg("width='100000' height='1'").into_bytes(),
                "longer than 4096:1",
            ),
        ];
        for (input, says) in cases {
            let error = error_of(&input);
            assert!(error.contains(says), "{error:?} should say {says:?}");
            assert!(!error.contains('\n'), "{error:?} is more than a line");
        }
    }

    #[test]
    fn work_is_refused_before_it_starts() {
        let svg = |content: &str| {
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>{content}</svg>")
                .into_bytes()
        };
        let filter = |primitive: &str| {
            svg(&format!(
                "<filter id='f'>{primitive}</filter><path d='M0 0H9V9z' filter='url(#f)'/>"
            ))
        };
        let masks: String = (0..1100)
            .map(|i| {
                let next = i + 1;
                format!("<mask id='m{i}'><g mask='url(#m{next})'><path d='M0 0H9V9z'/></g></mask>")
            })
            .collect();
        let masks = svg(&format!("{masks}<path d='M0 0H9V9z' mask='url(#m0)'/>"));
        let groups = svg(&["<g opacity='.5'>", "</g>"]
            .map(|tag| tag.repeat(60_000))
            .concat());
        let cases = [
            (
                filter("<feTurbulence baseFrequency='1' numOctaves='100000'/>"),
                "filters ask for too much",
            ),
            (masks, "nest deeper than 1024"),
            (groups, "nest"),
            (
                svg("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>"),
                "nest",
            ),
        ];
        // As much stack as the crate's documentation asks for.
        let errors = std::thread::Builder::new().stack_size(64 << 20);
        let errors = errors.spawn(move || cases.map(|(input, says)| (error_of(&input), says)));
        for (error, says) in errors.unwrap().join().unwrap() {
            assert!(error.contains(says), "{error:?} should say {says:?}");
        }
        let warnings = Warnings::default();
        let usual = filter("<feMorphology radius='1'/><feGaussianBlur stdDeviation='2'/>");
        assert!(parse(&usual, &Resources::default(), &warnings).is_ok());
    }

    #[test]
    fn a_gzip_bomb_stops_at_the_limit() {
        use std::io::Write;
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        let spaces = vec![b' '; 1 << 20];
        for _ in 0..80 {
            packer.write_all(&spaces).unwrap();
        }
        let bomb = packer.finish().unwrap();
        assert!(error_of(&bomb).contains("larger than 64 MiB"));
    }
}
