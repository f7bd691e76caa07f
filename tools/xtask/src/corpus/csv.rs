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
        fields.extend([format!("psnr_db_{zoom}x"), format!("wrong_share_{zoom}x")]);
    }
    let rest = [
        "bytes",
        "bake_seconds",
        "coverage",
        "patches",
        "warnings",
        "solid",
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
            ]),
            None => fields.extend([String::new(), String::new()]),
        }
    }
    let content = &row.content;
    fields.extend([
        content.bytes.to_string(),
        row.bake_seconds
            .map_or_else(String::new, |s| format!("{s:.3}")),
        quoted(&content.coverage_text()),
        content.patches.to_string(),
        quoted(&content.warning_text()),
        content.solid.to_string(),
        quoted(row.error.as_deref().unwrap_or_default()),
    ]);
    fields
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
        };
        let good = Row {
            file: "a/b, c.svg".to_owned(),
            zooms: vec![zoom; 2],
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
            "\"a/b, c.svg\",,45.68,0.001000,45.68,0.001000,0,,,0,,false,"
        );
        assert_eq!(lines[2], ",,,,,,0,,,0,,false,\"he said \"\"no\"\"\"");
        let commas = |line: &str| line.matches(',').count();
        assert_eq!(commas(lines[0]), commas(lines[2]));
    }
}
