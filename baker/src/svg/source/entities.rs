//! The size of an SVG's text with its XML entities expanded, computed without expanding them: a few
//! kilobytes of text can expand to gigabytes.

use std::collections::BTreeMap;

/// Upper bound on the bytes of the text with all entity references expanded. Declarations that are
/// not understood count as empty: the XML parser refuses those.
pub(crate) fn expanded_bytes(text: &str) -> usize {
    if !text.contains("<!ENTITY") {
        return text.len();
    }
    let mut sizes: BTreeMap<&str, usize> = BTreeMap::new();
    for declaration in text.split("<!ENTITY").skip(1) {
        if let Some((name, value)) = declared(declaration) {
            // Only entities declared before count, because the parser refuses loops.
            let size = value.len().saturating_add(references(value, &sizes));
            // XML: the first declaration of a name counts.
            sizes.entry(name).or_insert(size);
        }
    }
    text.len().saturating_add(references(text, &sizes))
}

/// Name and quoted value of `name "value"> ...`.
fn declared(declaration: &str) -> Option<(&str, &str)> {
    let declaration = declaration.trim_start();
    let (name, rest) = declaration.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let value = rest[1..].split(quote).next()?;
    Some((name, value))
}

/// Bytes that the references in `text` expand to.
fn references(text: &str, sizes: &BTreeMap<&str, usize>) -> usize {
    let after_ampersands = text.split('&').skip(1);
    let names = after_ampersands.filter_map(|rest| rest.split_once(';').map(|(name, _)| name));
    let expanded = names.filter_map(|name| sizes.get(name));
    expanded.fold(0, |sum: usize, &size| sum.saturating_add(size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_entities_multiply() {
        let text = "<!DOCTYPE svg [<!ENTITY a '0123456789'> <!ENTITY b \"&a;&a;&a;\">]><svg \
                    id='&b;'>&a;&amp;</svg>";
        // In the declaration of b: three a. In the body: b with its text, and a.
        let b = "&a;&a;&a;".len() + 30;
        assert_eq!(expanded_bytes(text), text.len() + 30 + b + 10);
        assert_eq!(expanded_bytes("<svg>&amp;</svg>"), 16);
    }

    #[test]
    fn a_quadratic_bomb_is_seen() {
        let text = format!(
            "<!ENTITY a '{}'>{}",
            "x".repeat(65_536),
            "&a;".repeat(65_536)
        );
        assert!(expanded_bytes(&text) > 1 << 32);
    }
}
