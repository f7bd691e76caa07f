//! Child processes with an end.

use std::fs::File;
use std::io::{Read as _, Seek as _};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

/// How often a running child is looked at.
const PAUSE: Duration = Duration::from_millis(5);
/// What of a child's complaints is kept.
const KEPT_CHARS: usize = 300;

/// What a child left.
#[derive(Debug)]
pub(crate) struct Finished {
    pub(crate) stdout: Vec<u8>,
    /// `None`: it ended well. Else one line.
    pub(crate) error: Option<String>,
}

/// Runs `command` and ends it after `limit`. What it writes goes to files named after `scratch`,
/// so that no pipe fills up.
pub(crate) fn run(command: &mut Command, limit: Duration, scratch: &Path) -> Result<Finished> {
    let [mut stdout, mut stderr] = [
        file(&scratch.with_extension("out"))?,
        file(&scratch.with_extension("err"))?,
    ];
    let mut child = command
        .stdin(Stdio::null())
        .stdout(stdout.try_clone()?)
        .stderr(stderr.try_clone()?)
        .spawn()
        .with_context(|| format!("cannot run {}", command.get_program().display()))?;
    let started = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if started.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(PAUSE);
    };
    let complaint = String::from_utf8_lossy(&read(&mut stderr)?).into_owned();
    Ok(Finished {
        stdout: read(&mut stdout)?,
        error: error(status, limit, &complaint),
    })
}

fn error(status: Option<ExitStatus>, limit: Duration, complaint: &str) -> Option<String> {
    let Some(status) = status else {
        return Some(format!("not done after {} s", limit.as_secs()));
    };
    if status.success() {
        return None;
    }
    let last = complaint.lines().rfind(|line| !line.trim().is_empty());
    let words = last.map_or_else(|| status.to_string(), str::to_owned);
    Some(words.chars().take(KEPT_CHARS).collect())
}

fn file(path: &Path) -> Result<File> {
    let mut options = File::options();
    let file = options.read(true).write(true).create(true).truncate(true);
    file.open(path).with_context(|| path.display().to_string())
}

fn read(file: &mut File) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Finished {
        let name = format!("vtex-xtask-{}-{}", std::process::id(), script.len());
        let scratch = std::env::temp_dir().join(name);
        let finished = run(Command::new("sh").args(["-c", script]), limit, &scratch).unwrap();
        for extension in ["out", "err"] {
            std::fs::remove_file(scratch.with_extension(extension)).unwrap();
        }
        finished
    }

    #[test]
    fn output_and_complaints_are_kept() {
        let minute = Duration::from_secs(60);
        let good = shell("echo fine", minute);
        assert_eq!((good.stdout.as_slice(), good.error), (&b"fine\n"[..], None));
        let bad = shell("echo 'it broke' >&2; exit 3", minute);
        assert_eq!(bad.error.as_deref(), Some("it broke"));
    }

    #[test]
    fn what_does_not_end_is_ended() {
        let endless = shell("exec sleep 100", Duration::ZERO);
        assert_eq!(endless.error.as_deref(), Some("not done after 0 s"));
    }
}
