//! The table for programs, RFC 4180.

use super::options::Options;
use super::row::Row;

/// All rows in the order given.
pub(crate) fn write<'a>(rows: impl Iterator<Item = &'a Row>, options: &Options) -> String {
    let mut lines = vec![header(options)];
    lines.extend(rows.map(|row| line(row, options)));
    lines
        .iter()
        .flat_map(|fields| [fields.join(","), "\r\n".to_owned()])
        .collect()
}

fn header(options: &Options) -> Vec<String> {
    let mut fields = vec!["file".to_owned(), "folder".to_owned()];
    for zoom in &options.zooms {
        let names = ["psnr_db", "wrong_share", "noise_db"];
        fields.extend(names.map(|name| format!("{name}_{zoom}x")));
    }
    let rest = [
        "bytes",
        "bake_seconds",
        "coverage",
        "patches",
        "patch_area",
        "patch_features",
        "embedded_images",
        "warnings",
        "native",
        "error",
    ];
    fields.extend(rest.map(str::to_owned));
    fields
}

fn line(row: &Row, options: &Options) -> Vec<String> {
    let mut fields = vec![quoted(&row.file), quoted(&row.folder)];
    for index in 0..options.zooms.len() {
        match row.zooms.get(index) {
            Some(zoom) => fields.extend([
                format!("{:.2}", zoom.psnr_db),
                format!("{:.6}", zoom.wrong_share),
                zoom.noise_db
                    .map_or_else(String::new, |db| format!("{db:.2}")),
            ]),
            None => fields.extend([const { String::new() }; 3]),
        }
    }
    let content = &row.content;
    fields.extend([
        content.bytes.to_string(),
        row.bake_seconds
            .map_or_else(String::new, |s| format!("{s:.3}")),
        quoted(&content.coverage_text()),
        content.patches.to_string(),
        format!("{:.4}", content.patch_area),
        quoted(&patch_features(row)),
        content.embedded.to_string(),
        quoted(&content.warning_text()),
        content.native.to_string(),
        quoted(row.error.as_deref().unwrap_or_default()),
    ]);
    fields
}

/// `filter 0.1250, mask 0.0300`: shares of the canvas.
fn patch_features(row: &Row) -> String {
    let patched = row.content.patched.iter();
    let all: Vec<String> = patched
        .map(|(name, area)| format!("{name} {area:.4}"))
        .collect();
    all.join(", ")
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::row::Zoom;

    #[test]
    fn every_line_has_every_field() {
        let options = Options::default();
        let zoom = Zoom {
            psnr_db: 45.678,
            wrong_share: 0.001,
            noise_db: None,
        };
        let noisy = Zoom {
            noise_db: Some(39.9),
            ..zoom
        };
        let good = Row {
            file: "a/b, c.svg".to_owned(),
            zooms: vec![zoom, noisy],
            ..Row::default()
        };
        let bad = Row {
            error: Some("he said \"no\"".to_owned()),
            ..Row::default()
        };
        let text = write([good, bad].iter(), &options);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[1],
            "\"a/b, c.svg\",,45.68,0.001000,,45.68,0.001000,39.90,0,,,0,0.0000,,0,,false,"
        );
        assert_eq!(
            lines[2],
            ",,,,,,,,0,,,0,0.0000,,0,,false,\"he said \"\"no\"\"\""
        );
        let commas = |line: &str| line.matches(',').count();
        assert_eq!(commas(lines[0]), commas(lines[2]));
    }
}
