//! `vtex validate`.

use serde_json::{Value, json};
use vtex_format::{Fault, Issue, Limits, VtexFile, validate};
use vtex_shaders::check_fine;

use crate::cli::args::Validate;
use crate::cli::{Console, ExitCode, Failure, Format, Outcome, counted};
use crate::files::{BAKE_IT_FIRST, input, is_svg, lossy};

/// Runs `vtex validate`.
pub(super) fn run(args: &Validate, console: Console) -> Outcome<ExitCode> {
    let mut worst = ExitCode::Ok;
    let mut reports = Vec::new();
    for path in &args.files {
        let name = path.display();
        match input::read(path) {
            Ok(bytes) => {
                let issues = issues(&bytes);
                worst = worst.max(code(&issues));
                if console.format == Format::Text {
                    let text = match issues.as_slice() {
                        [] => format!("{name}: ok\n"),
                        issues => issues
                            .iter()
                            .map(|issue| format!("{name}: {issue}\n"))
                            .collect(),
                    };
                    console.result(text.as_bytes())?;
                }
                if !issues.is_empty() {
                    let advice = match is_svg(path, &bytes) {
                        true => BAKE_IT_FIRST.to_owned(),
                        false => advice(&issues),
                    };
                    let message = format!("{name}: {advice}");
                    console.failure(&Failure::new(code(&issues), message));
                }
                reports.push(json!({"file": lossy(path), "issues": issues_json(&issues)}));
            }
            Err(failure) => {
                console.failure(&failure);
                worst = worst.max(failure.code);
                reports.push(json!({"file": lossy(path), "error": failure.message}));
            }
        }
    }
    if console.format == Format::Json {
        console.json(&Value::Array(reports))?;
    }
    Ok(worst)
}

/// The issues of the format, and if there are none, whether fine cells show what the lists do.
fn issues(bytes: &[u8]) -> Vec<Issue> {
    let limits = Limits::default();
    let issues = validate(bytes, &limits);
    match VtexFile::parse(bytes, &limits) {
        Ok(file) if issues.is_empty() && !file.fine.is_empty() => {
            check_fine(&file).into_iter().collect()
        }
        _ => issues,
    }
}

fn code(issues: &[Issue]) -> ExitCode {
    match issues.first().map(|issue| issue.fault) {
        None => ExitCode::Ok,
        Some(Fault::Malformed) => ExitCode::InvalidInput,
        Some(Fault::Unsupported | Fault::Outdated) => ExitCode::Unsupported,
        Some(Fault::Limits) => ExitCode::Limit,
    }
}

/// What to do about a file that has issues.
fn advice(issues: &[Issue]) -> String {
    let has = |fault| issues.iter().any(|issue| issue.fault == fault);
    if has(Fault::Outdated) {
        return "of an earlier version; bake it again: `vtex bake drawing.svg -o drawing.vtex`"
            .to_owned();
    }
    let found = counted(issues.len(), "issue");
    let advice = if has(Fault::Unsupported) {
        "read it with a newer version of vtex"
    } else {
        "bake or download the file again"
    };
    format!("{found} found; {advice}")
}

fn issues_json(issues: &[Issue]) -> Value {
    let one = |issue: &Issue| {
        json!({
            "code": format!("V{:04}", issue.code), "section": issue.section.to_string(),
            "offset_bytes": issue.offset_bytes, "message": issue.message,
        })
    };
    issues.iter().map(one).collect()
}
