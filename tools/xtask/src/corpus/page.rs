//! The table for people: one HTML page that loads nothing.

use std::fmt::Write as _;

use base64::Engine as _;

use super::options::Options;
use super::row::{Row, Zoom};
use super::totals::{FeatureTotals, Totals};

/// Writes the page; rows stay in their order.
pub(crate) fn write(rows: &[Row], options: &Options) -> String {
    let mut page = String::from(HEAD);
    let zooms = options.zoom_list().replace(',', "x, ");
    let bake = options.bake.join(" ");
    push(
        &mut page,
        format_args!(
            "<p>{} files; zoom {zooms}x, {} px, {} samples a pixel",
            rows.len(),
            options.size,
            options.spp
        ),
    );
    push(
        &mut page,
        format_args!(
            "; bake options: {}</p>\n",
            if bake.is_empty() {
                "none".into()
            } else {
                escape(&bake)
            }
        ),
    );
    folders(&mut page, rows, options);
    features(&mut page, rows);
    files(&mut page, rows, options);
    pictures(&mut page, rows);
    page.push_str(TAIL);
    page
}

fn folders(page: &mut String, rows: &[Row], options: &Options) {
    page.push_str("<h2>Folders</h2>\n<table><thead><tr><th class=\"l\">folder");
    for name in [
        "files",
        "failed",
        "no patch",
        "patch %",
        "compared",
        "below bar",
        "KiB",
        "bake s",
    ] {
        push(page, format_args!("<th>{name}"));
    }
    for zoom in &options.zooms {
        push(page, format_args!("<th>{zoom}&times; least<th>median"));
    }
    page.push_str("</thead><tbody>\n");
    for (name, totals) in Totals::by_folder(rows, options.zooms.len(), &options.bars) {
        push(page, format_args!("<tr><td class=\"l\">{}", escape(&name)));
        for count in [totals.files, totals.failed, totals.native] {
            push(page, format_args!("<td>{count}"));
        }
        let area = 100.0 * totals.mean_patch_area();
        push(page, format_args!("<td>{area:.2}"));
        for count in [totals.compared, totals.missed] {
            push(page, format_args!("<td>{count}"));
        }
        push(
            page,
            format_args!("<td>{}<td>{:.1}", totals.bytes / 1024, totals.bake_seconds),
        );
        for zoom in 0..options.zooms.len() {
            match totals.least_and_median(zoom) {
                Some([least, median]) => push(page, format_args!("<td>{least:.1}<td>{median:.1}")),
                None => page.push_str("<td><td>"),
            }
        }
        page.push('\n');
    }
    page.push_str("</tbody></table>\n");
}

fn features(page: &mut String, rows: &[Row]) {
    page.push_str("<h2>Features that became raster patches</h2>\n<table><thead><tr>");
    page.push_str("<th class=\"l\">feature<th>files<th>alone<th>patch %</thead><tbody>\n");
    for (name, totals) in FeatureTotals::all(rows) {
        let (files, alone, area) = (totals.files, totals.alone, 100.0 * totals.mean_area());
        let name = escape(&name);
        push(
            page,
            format_args!("<tr><td class=\"l\">{name}<td>{files}<td>{alone}<td>{area:.2}\n"),
        );
    }
    page.push_str("</tbody></table>\n");
}

fn files(page: &mut String, rows: &[Row], options: &Options) {
    page.push_str("<h2>Files, worst first</h2>\n<p>A click on a heading sorts by it.</p>\n");
    page.push_str("<table class=\"sort\"><thead><tr><th class=\"l\">file<th class=\"l\">folder");
    for zoom in &options.zooms {
        push(page, format_args!("<th>{zoom}&times; dB"));
    }
    page.push_str("<th>wrong %<th>KiB<th>bake s<th class=\"l\">coverage<th>patches<th>patch %<th class=\"l\">warnings<th class=\"l\">error");
    page.push_str("</thead><tbody>\n");
    for row in rows {
        file(page, row, options);
    }
    page.push_str("</tbody></table>\n");
}

fn file(page: &mut String, row: &Row, options: &Options) {
    let name = row.file.strip_prefix(&row.folder).unwrap_or(&row.file);
    let name = name.trim_start_matches('/');
    push(
        page,
        format_args!(
            "<tr><td class=\"l\">{}<td class=\"l\">{}",
            escape(name),
            escape(&row.folder)
        ),
    );
    for index in 0..options.zooms.len() {
        zoom(page, row.zooms.get(index), row.bar_db(&options.bars, index));
    }
    match wrong_share(row) {
        Some(share) => push(page, format_args!("<td>{:.3}", 100.0 * share)),
        None => page.push_str("<td>"),
    }
    push(
        page,
        format_args!("<td>{:.1}", row.content.bytes as f64 / 1024.0),
    );
    match row.bake_seconds {
        Some(seconds) => push(page, format_args!("<td>{seconds:.2}")),
        None => page.push_str("<td>"),
    }
    let content = &row.content;
    let note = match (&row.error, row.skipped) {
        (Some(error), _) => escape(error),
        (None, true) => "not compared: has raster patches".to_owned(),
        (None, false) => String::new(),
    };
    push(
        page,
        format_args!(
            "<td class=\"l\">{}<td>{}<td>{:.2}<td class=\"l\">{}<td class=\"l bad\">{note}\n",
            escape(&content.coverage_text()),
            content.patches,
            100.0 * content.patch_area,
            escape(&content.warning_text()),
        ),
    );
}

fn zoom(page: &mut String, zoom: Option<&Zoom>, bar_db: Option<f64>) {
    let Some(zoom) = zoom else {
        return page.push_str("<td>");
    };
    let class = if bar_db.is_some_and(|bar| zoom.psnr_db < bar) {
        " class=\"bad\""
    } else {
        ""
    };
    push(page, format_args!("<td{class}>{:.1}", zoom.psnr_db));
}

fn wrong_share(row: &Row) -> Option<f64> {
    row.zooms
        .iter()
        .map(|zoom| zoom.wrong_share)
        .max_by(f64::total_cmp)
}

fn pictures(page: &mut String, rows: &[Row]) {
    for row in rows.iter().filter(|row| !row.pictures.is_empty()) {
        push(
            page,
            format_args!("<h3>{}</h3>\n<div class=\"row\">", escape(&row.file)),
        );
        for (png, what) in row.pictures.iter().zip(["SVG", "vtex", "difference"]) {
            let data = base64::engine::general_purpose::STANDARD.encode(png);
            push(
                page,
                format_args!(
                    "<figure><img alt=\"{what}\" src=\"data:image/png;base64,{data}\"><figcaption>{what}</figcaption></figure>"
                ),
            );
        }
        page.push_str("</div>\n");
    }
}

fn push(page: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a String does not fail.
    let _ = page.write_fmt(text);
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

const HEAD: &str = r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>vtex corpus</title>
<style>
:root { color-scheme: light dark; --line: #8885; --bad: #c0392b; }
body { margin: 2rem; font: 14px/1.45 system-ui, sans-serif; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .6rem; text-align: right; border-bottom: 1px solid var(--line); vertical-align: top; }
.l { text-align: left; }
.sort th { cursor: pointer; position: sticky; top: 0; background: Canvas; }
.bad { color: var(--bad); }
.row { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 1rem; }
figure { margin: 0; }
figure img { width: 100%; image-rendering: pixelated; background: #fff; }
</style>
</head>
<body>
<h1>Corpus</h1>
"#;

const TAIL: &str = r#"<script>
for (const table of document.querySelectorAll("table.sort")) {
  const heads = [...table.tHead.rows[0].cells];
  let last = -1, turn = 1;
  heads.forEach((head, column) => head.addEventListener("click", () => {
    turn = column === last ? -turn : 1;
    last = column;
    const value = row => row.cells[column].textContent;
    const compare = (a, b) => {
      const [x, y] = [value(a), value(b)], [p, q] = [parseFloat(x), parseFloat(y)];
      if (!head.classList.contains("l")) {
        if (isNaN(p) || isNaN(q)) return isNaN(p) - isNaN(q);
        return turn * (p - q);
      }
      return turn * x.localeCompare(y);
    };
    table.tBodies[0].append(...[...table.tBodies[0].rows].sort(compare));
  }));
}
</script>
</body>
</html>
"#;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::bars::Bars;

    #[test]
    fn the_page_loads_nothing_and_escapes_names() {
        let row = Row {
            folder: "a".to_owned(),
            file: "a/<b>.svg".to_owned(),
            zooms: vec![Zoom {
                psnr_db: 39.0,
                wrong_share: 0.01,
                noise_db: None,
            }],
            pictures: vec![b"png".to_vec(); 3],
            ..Row::default()
        };
        let options = Options {
            zooms: vec![8.0],
            bars: Bars::strict(&[40.0]),
            ..Options::default()
        };
        let page = write(&[row], &options);
        assert!(
            page.contains("&lt;b&gt;.svg") && !page.contains("<b>"),
            "{page}"
        );
        assert!(page.contains("<td class=\"bad\">39.0<td>1.000"), "{page}");
        assert!(page.contains("base64,cG5n"), "{page}");
        assert!(
            !page.contains("http") && !page.contains("src=\"/"),
            "{page}"
        );
    }
}
