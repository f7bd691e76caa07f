//! Labels in HTML.

use usvg::roxmltree::Document;

use crate::style::tests::{framed, resolve};
use crate::warning::Warnings;

#[test]
fn labels_in_html_become_text_and_the_rest_is_said() {
    let label = |content: &str| {
        let text = framed(&format!(
            "<foreignObject width='100' height='50'><div xmlns='http://www.w3.org/1999/xhtml'>{content}</div></foreignObject>"
        ));
        let warnings = Warnings::default();
        let found = resolve(&Document::parse(&text).unwrap(), &warnings)
            .unwrap()
            .unwrap();
        let list: Vec<_> = warnings
            .into_list()
            .into_iter()
            .map(|w| w.message)
            .collect();
        (found, list.join("; "))
    };
    let (text, said) = label("a <b>&lt;b</b><br/><span style='display:none'>no</span>");
    assert!(
        text.contains("&lt;b</tspan>") && !text.contains(">no<"),
        "{text}"
    );
    assert_eq!(said, "");
    let (text, said) = label("<img/><p>x</p><img/><p style='position:absolute'>y</p>");
    assert!(text.contains(">x</tspan>"), "{text}");
    assert_eq!(
        said,
        "<img> in HTML is not drawn (line 1 and 1 element more); position: absolute in HTML is not \
         drawn (line 1)"
    );
    let in_switch = "<switch><foreignObject><p>a</p></foreignObject><text>b</text></switch>";
    let text = framed(in_switch);
    let found = resolve(&Document::parse(&text).unwrap(), &Warnings::default());
    assert_eq!(found.unwrap(), None);
}

#[test]
fn hostile_labels_end_soon() {
    let deep = |open: &str, close: &str, count: usize| {
        framed(&format!(
            "<foreignObject width='9' height='9'>{}a b{}</foreignObject>",
            open.repeat(count),
            close.repeat(count)
        ))
    };
    let style = "<p style='display:inline-block'>";
    for text in [
        deep(style, "</p>", 60),
        deep("<p style='display:flex'>c ", "</p>", 60),
        deep("<p>", "</p>", 900),
        framed(&format!(
            "<foreignObject><p>{}</p></foreignObject>",
            "a b ".repeat(1 << 19)
        )),
    ] {
        let warnings = Warnings::default();
        let document = Document::parse(&text).unwrap();
        assert!(resolve(&document, &warnings).unwrap().is_some());
        assert_ne!(warnings.into_list().len(), 0, "{:.200}", text);
    }
}
