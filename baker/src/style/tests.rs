//! Styles in, attributes out.

use std::sync::Arc;

use usvg::roxmltree::{Document, Node};

use crate::warning::Warnings;

/// [`super::resolve`] without fonts.
pub(super) fn resolve(
    document: &Document<'_>,
    warnings: &Warnings,
) -> Result<Option<String>, crate::BakeError> {
    let fonts = super::Faces {
        database: &Arc::default(),
        select: usvg::FontResolver::default_font_selector,
    };
    super::resolve(document, &fonts, warnings)
}

/// `content` in a drawing of 200 by 200.
pub(super) fn framed(content: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 200'>{content}</svg>")
}

/// The attribute `name` of the element with the id `a`, once its styles are resolved.
fn attribute(content: &str, name: &str) -> Option<String> {
    let text = framed(content);
    let document = Document::parse(&text).unwrap();
    let styled = resolve(&document, &Warnings::default())
        .unwrap()
        .unwrap_or(text.clone());
    let styled = Document::parse(&styled).unwrap();
    let is_wanted = |node: &Node<'_, '_>| node.attribute("id") == Some("a");
    let node = styled.descendants().find(is_wanted).unwrap();
    node.attribute(name).map(str::to_owned)
}

/// The fill of a rectangle with the class `c` under a style sheet.
fn fill(sheet: &str) -> Option<String> {
    // The first rule has the sheet read by the style stage.
    let content = format!(
        "<style><![CDATA[:is(other){{fill:red}}{sheet}]]></style><g class='p' lang='de-AT'><path/><rect id='a' \
         class='c d' data-x='abc-def'/><circle/></g>"
    );
    attribute(&content, "fill")
}

#[test]
fn selectors_match_as_in_browsers() {
    let matching = [
        "rect",
        ".c",
        "#a",
        ".c.d",
        "rect:not(.e)",
        ":is(circle, .c)",
        ":where(rect)",
        "g > rect",
        "path + rect",
        "path ~ rect",
        "svg rect",
        "[data-x]",
        "[data-x^=ab]",
        "[data-x$=ef]",
        "[data-x*='c-d']",
        "[data-x|=abc]",
        "[data-x='ABC-def' i]",
        "rect:nth-child(2)",
        ":nth-child(even)",
        ":nth-child(-n + 2)",
        ":nth-last-child(2)",
        "rect:only-of-type",
        "rect:first-of-type",
        ":nth-child(1 of .c)",
        ":root rect",
        "g:has(> rect) .c",
        "rect:has(+ circle)",
        ":lang(de)",
        "*|rect",
        "g:not(:has(text)) rect",
        "rect:empty",
        "svg:has(circle) > g > :nth-child(2n)",
        "RECT, rect",
        "\\72 ect",
    ];
    for selector in matching {
        let sheet = format!("{selector}{{fill:var(--none, #123456)}}");
        assert_eq!(fill(&sheet).as_deref(), Some("#123456"), "{selector}");
    }
    let others = [
        "RECT",
        ".e",
        "rect:not(.c)",
        "g + rect",
        "rect ~ path",
        ":nth-child(3)",
        "rect:hover",
        "rect::before",
        "rect:unknown, rect",
        "rect:only-child",
        ":lang(en)",
        "|rect",
        "rect >",
        "rect:has(path)",
        ":root",
        "rect:not(",
        "[data-x~=abc]",
        "rect:visited",
    ];
    for selector in others {
        let sheet = format!("{selector}{{fill:var(--none, #123456)}}");
        assert_eq!(fill(&sheet), None, "{selector}");
    }
}

#[test]
fn the_cascade_is_that_of_css() {
    let cases = [
        (
            "rect{fill:red} .c{fill:lime} rect{fill:blue}:is(x){}",
            "lime",
        ),
        (".c.d{fill:red}:is(#a){fill:lime}.c.d{fill:blue}", "lime"),
        (":where(#a){fill:red}rect{fill:lime}", "lime"),
        ("rect{fill:lime!important}#a{fill:red}:is(x){}", "lime"),
        ("@layer x{#a{fill:red}}rect{fill:lime}", "lime"),
        (
            "@layer y,x;@layer x{rect{fill:lime}}@layer y{#a{fill:red}}",
            "lime",
        ),
        (
            "@layer x{rect{fill:lime!important}}#a{fill:red!important}",
            "lime",
        ),
        ("@layer x{@layer z{#a{fill:red}}rect{fill:lime}}", "lime"),
        ("@layer x.y{#a{fill:red}}@layer x{rect{fill:lime}}", "lime"),
        ("@layer x{rect{fill:lime}}#a{fill:revert-layer}", "lime"),
        (
            "@media screen and (min-width:100px){rect{fill:lime}}",
            "lime",
        ),
        (
            "rect{fill:lime}@media print,(prefers-color-scheme:dark){#a{fill:red}}",
            "lime",
        ),
        ("@media not print{rect{fill:lime}}", "lime"),
        (
            "@media (100px < width <= 200px) and (not (hover:none)){rect{fill:lime}}",
            "lime",
        ),
        (
            "@supports (fill:oklch(1 0 0)) and (not (fill:nothing(1))){rect{fill:lime}}",
            "lime",
        ),
        ("@supports selector(a:has(b)){rect{fill:lime}}", "lime"),
        (".p{& > .c{fill:lime}}", "lime"),
        (".p{fill:red;rect{fill:lime}}", "lime"),
        (".p{@media screen{.c{fill:lime}}}", "lime"),
        (".c{@media screen{fill:lime}}", "lime"),
        (".c{fill:red;&.d{fill:lime}}", "lime"),
        ("rect{fill:red;fill:nothing(1);FILL:lime}", "lime"),
        ("rect{fill:lime;fill:nothing(1)}:is(x){}", "lime"),
        (":root{--a:lime}rect{fill:var(--a)}", "lime"),
        ("rect{--a:var(--b);--b:var(--a);fill:var(--a,lime)}", "lime"),
        ("rect{--a:;fill:var(--a) lime}", "lime"),
        (
            "@property --a{syntax:'*';inherits:true;initial-value:lime}rect{fill:var(--a)}",
            "lime",
        ),
        ("g{color:lime}rect{fill:CURRENTCOLOR}", "current"),
        ("rect{fill:initial}", "black"),
        ("/* x */ <!-- rect{fill:lime} -->", "lime"),
        ("rect{fill:light-dark(lime,red)}", "lime"),
    ];
    for (sheet, wanted) in cases {
        let wanted = match wanted {
            "lime" => "#00ff00",
            "black" => "#000000",
            _ => "currentColor",
        };
        assert_eq!(fill(sheet).as_deref(), Some(wanted), "{sheet}");
    }
    assert_eq!(
        fill("g{fill:red}rect{fill:red;fill:unset}.c{fill:var(--none)}"),
        None
    );
}

#[test]
fn values_become_those_of_usvg() {
    let rect = |style: &str| format!("<rect id='a' x='20' y='40' width='40' height='20' {style}/>");
    let cases = [
        ("style='stroke-width:calc(4px + 6px)'", "stroke-width", "10"),
        ("style='opacity:calc(.5)'", "opacity", "0.5"),
        (
            "style='font-size:2em;stroke-width:calc(1em)'",
            "stroke-width",
            "32",
        ),
        ("style='x:calc(10% + 5px)'", "x", "25"),
        ("style='width:50vw'", "width", "100"),
        (
            "style='transform:translate(20px,20px)'",
            "transform",
            "matrix(1 0 0 1 20 20)",
        ),
        (
            "style='transform:translate(50%,10%)'",
            "transform",
            "matrix(1 0 0 1 100 20)",
        ),
        (
            "style='translate:20px 120px;scale:1.5'",
            "transform",
            "matrix(1.5 0 0 1.5 20 120)",
        ),
        (
            "style='transform-box:fill-box;transform-origin:center;transform:rotate(180deg)'",
            "transform",
            "matrix(-1 0 0 -1 80 100)",
        ),
        (
            "transform='rotate(90)' style='transform:none;rotate:0deg'",
            "transform",
            "matrix(1 0 0 1 0 0)",
        ),
        (
            "style='clip-path:circle(5px)'",
            "clip-path",
            "url(#vtex-style-clip-0)",
        ),
        ("style='mask-image:url(#m)'", "mask", "url(#m)"),
        (
            "style='font:bold calc(10px + 10%)/1.2 \"A B\", serif'",
            "font-size",
            "11.6",
        ),
        (
            "style='font:bold 10px/1.2 \"A B\", serif'",
            "font-family",
            "'A B', serif",
        ),
        (
            "style='mix-blend-mode:var(--x,multiply)'",
            "style",
            "mix-blend-mode:multiply;",
        ),
        (
            "style='filter:sepia() drop-shadow(1px 2px 3px rgb(0 0 0 / 50%))'",
            "filter",
            "sepia() url(#vtex-style-filter-0)",
        ),
        (
            "style='filter:hue-rotate(calc(1turn / 4))'",
            "filter",
            "hue-rotate(90deg)",
        ),
        ("rx='1rem'", "rx", "16"),
        ("fill='oklch(1 0 0)'", "fill", "#ffffff"),
        ("stroke='var(--a, var(--b, #1f4fd0))'", "stroke", "#1f4fd0"),
    ];
    for (style, name, wanted) in cases {
        assert_eq!(
            attribute(&rect(style), name).as_deref(),
            Some(wanted),
            "{style}"
        );
    }
}

#[test]
fn styles_that_usvg_knows_stay_as_they_are() {
    let same = [
        "<style>.a,g > #b{fill:#fff;stroke:red!important} *{opacity:.5}</style><g class='a'/>",
        "<rect style='fill:none;stroke:rgb(1,2,3);stroke-width:2px' transform='rotate(4 5 6)'/>",
        "<style>@font-face{font-family:x}</style><text x='1em' font-size='50%'>a</text>",
        "<g fill='currentColor' color='teal' stroke='url(#a)' filter='url(#b)'/><filter id='b'/>",
    ];
    for content in same {
        let text = framed(content);
        let document = Document::parse(&text).unwrap();
        assert_eq!(
            resolve(&document, &Warnings::default()).unwrap(),
            None,
            "{content}"
        );
    }
}

#[test]
fn the_rest_of_a_document_stays() {
    let text = framed(
        "<style>:root{--a:red}</style><text id='t&quot;&lt;' xml:space='preserve'> a&#13;<!--x--> \
         <tspan>&amp;b</tspan>]]&gt;</text><g xmlns='urn:x' y='&#10;'><b/></g>",
    );
    let text = text.replace("<g xmlns", "<path fill='var(--a)'/><g xmlns");
    let document = Document::parse(&text).unwrap();
    let styled = resolve(&document, &Warnings::default()).unwrap().unwrap();
    let styled = Document::parse(&styled).unwrap();
    let nodes = |document: &Document<'_>| -> Vec<String> {
        let nodes = document
            .descendants()
            .filter(|node| node.tag_name().name() != "style");
        let nodes = nodes.filter(|node| {
            node.parent_element()
                .is_none_or(|parent| parent.tag_name().name() != "style")
        });
        nodes
            .map(|node| {
                let text = node.text().filter(|_| node.is_text());
                let kept = node.attributes().filter(|a| a.name() != "fill");
                let attributes: Vec<_> =
                    kept.map(|a| (a.name(), a.value(), a.namespace())).collect();
                format!("{:?} {text:?} {attributes:?}", node.tag_name())
            })
            .collect()
    };
    assert_eq!(nodes(&styled), nodes(&document));
}

#[test]
fn elements_without_a_namespace_are_still_drawn() {
    let text = "<!--x--><svg viewBox='0 0 9 9'><path style='fill:var(--x,red)'/></svg>";
    let styled = resolve(&Document::parse(text).unwrap(), &Warnings::default()).unwrap();
    let tree = usvg::Tree::from_str(&styled.unwrap(), &usvg::Options::default());
    assert!(tree.is_ok(), "{tree:?}");
}

#[test]
fn what_is_not_drawn_is_said() {
    let cases = [
        ("<style>@import url(x.css);</style>", "@import"),
        (
            "<style>@container (width>1px){rect{fill:red}}</style>",
            "@container",
        ),
        (
            "<style>text{text-transform:uppercase}g{fill:var(--x)}</style><text/>",
            "text-transform",
        ),
        (
            "<rect transform='scale(1 2)' fill='url(#a)' style='vector-effect:var(--x,non-scaling-stroke)'/>",
            "vector-effect",
        ),
        ("<rect style='fill:paint(x)'/>", "fill"),
        (
            "<text style='transform-box:fill-box;transform:rotate(1deg)'>a</text>",
            "transform",
        ),
        ("<rect style='clip-path:shape(x)'/>", "clip-path"),
    ];
    for (content, feature) in cases {
        let text = framed(content);
        let warnings = Warnings::default();
        resolve(&Document::parse(&text).unwrap(), &warnings).unwrap();
        let list = warnings.into_list();
        assert!(
            list.iter().any(|warning| warning.feature == feature),
            "{content}: {list:?}"
        );
    }
}

#[test]
fn hostile_sheets_end_soon() {
    let refused = |content: &str| {
        let text = framed(content);
        let document = Document::parse(&text).unwrap();
        match resolve(&document, &Warnings::default()) {
            Err(crate::BakeError::Limit(message)) => message,
            other => panic!("{other:?}"),
        }
    };
    let doubled: String = (1..64)
        .map(|i| format!("--v{i}:var(--v{0}) var(--v{0});", i - 1))
        .collect();
    let bomb = format!("<style>:root{{--v0:x;{doubled}fill:var(--v63)}}</style>");
    assert!(refused(&bomb).contains("variables"));
    let in_functions: String = (1..64)
        .map(|i| format!("--v{i}:f(var(--v{0}) var(--v{0}));", i - 1))
        .collect();
    let bomb = format!("<style>:root{{--v0:x;{in_functions}fill:var(--v63)}}</style>");
    assert!(refused(&bomb).contains("variables"));
    let chain: String = (1..1000)
        .map(|i| format!("--v{}:var(--v{i});", i - 1))
        .collect();
    assert!(refused(&format!("<style>:root{{{chain}}}</style>")).contains("variables"));
    let deep = "rect{".repeat(1000);
    assert!(refused(&format!("<style>{deep}</style>")).contains("nest"));
    let deep = "(".repeat(100_000);
    assert!(refused(&format!("<rect style='fill:{deep}'/>")).contains("nest"));
    let elements = format!("{}{}", "<g>".repeat(500), "</g>".repeat(500));
    let rules = format!("{} x{{fill:red}}", "g ".repeat(40)).replace(" x", " g:not(x g)");
    let bomb = format!("<style>x {rules}</style>{elements}");
    assert!(refused(&bomb).contains("selectors"));
    let rules = "*{fill:red;stroke:red}".repeat(8_000);
    let bomb = format!("<style>{rules}{rules}:is(x){{fill:red}}</style>");
    assert!(refused(&bomb).contains("declarations"));
    let bomb = format!(
        "<style>{rules}:is(x){{fill:red}}</style>{}",
        "<g/>".repeat(2000)
    );
    assert!(refused(&bomb).contains("selectors"));
    // Blocks, spaces and values that once were looked through again for each before them.
    for part in ["a:{}", ";/**/ ", "a:b!", "a{b:", "@x{}", "--a:{}"] {
        let text = framed(&format!("<style>:is(x){{}}{}</style>", part.repeat(60)));
        assert!(
            resolve(&Document::parse(&text).unwrap(), &Warnings::default()).is_ok(),
            "{part}"
        );
        let long = part.repeat(100_000).replace("a{b:", "a b:");
        let text = framed(&format!(
            "<style>:is(x){{{long}}}</style><g style='{long}'/>"
        ));
        let document = Document::parse(&text).unwrap();
        let _ = resolve(&document, &Warnings::default());
    }
}

#[test]
fn filters_are_those_of_browsers() {
    let filter = |attributes: &str| {
        let content = format!("<rect id='a' width='9' height='9' {attributes}/><filter id='f'/>");
        attribute(&content, "filter")
    };
    // Browsers want units, and draw what refers to nothing as if there was no filter.
    for none in [
        "filter='blur(4)'",
        "filter='drop-shadow(1 2 3 red)'",
        "style='filter:url(#f) url(#missing)'",
        "filter='url(#missing)'",
        "filter='url(other.svg#f)'",
        "style='filter:none;fill:var(--x,red)'",
    ] {
        assert_eq!(filter(none), None, "{none}");
    }
    for own in [
        "filter='blur(0)'",
        "style='filter:drop-shadow(red 1px 2px)'",
    ] {
        assert_eq!(
            filter(own).as_deref(),
            Some("url(#vtex-style-filter-0)"),
            "{own}"
        );
    }
    assert_eq!(filter("filter='url(#f)'").as_deref(), Some("url(#f)"));
}

#[test]
fn shadows_out_of_linear_light_are_taken_apart() {
    let shadow = |space: &str| {
        let text = framed(&format!(
            "<filter id='f' {space}><feDropShadow id='a' dx='1' flood-color='red' result='r' x='3'/></filter>"
        ));
        let document = Document::parse(&text).unwrap();
        resolve(&document, &Warnings::default()).unwrap()
    };
    let linear = shadow("").or(shadow("color-interpolation-filters='linearRGB'"));
    assert_eq!(linear, None);
    let found = shadow("color-interpolation-filters='sRGB'").unwrap();
    for part in [
        "<feOffset dx=\"1\" dy=\"2\"",
        "<feFlood  flood-color=\"red\"/>",
        "<feMerge  result=\"r\" x=\"3\">",
    ] {
        assert!(found.contains(part), "{part}: {found}");
    }
    assert!(!found.contains("feDropShadow"), "{found}");
}

#[test]
fn what_many_elements_lack_is_said_once() {
    let text = framed(
        "<style>text{text-transform:uppercase;fill:var(--x)}</style><path/>\n<text id='t'/><text/>\n<text/>",
    );
    let warnings = Warnings::default();
    resolve(&Document::parse(&text).unwrap(), &warnings).unwrap();
    let list: Vec<_> = warnings.into_list().into_iter().collect();
    let found: Vec<_> = list.iter().map(|w| (&*w.element, &*w.message)).collect();
    let message = "text-transform: uppercase is not drawn (line 2 and 2 elements more)";
    assert_eq!(found, [("t", message)]);
}
