//! CSS colours on the command line.

/// Parses a CSS colour (`#rgb`, `#rrggbbaa`, `rgb(...)`, `hsl(...)`, a name): straight alpha,
/// sRGB-encoded.
///
/// # Errors
/// A sentence when the text is no colour.
pub fn parse(text: &str) -> Result<[f32; 4], String> {
    let color: svgtypes::Color = text
        .trim()
        .parse()
        .map_err(|_| "not a CSS colour, such as #d03020 or navy".to_owned())?;
    Ok([color.red, color.green, color.blue, color.alpha].map(|c| f32::from(c) / 255.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_hex() {
        assert_eq!(parse("red"), Ok([1.0, 0.0, 0.0, 1.0]));
        assert_eq!(parse("#00f8"), Ok([0.0, 0.0, 1.0, 136.0 / 255.0]));
        assert!(parse("reddish").is_err());
    }
}
