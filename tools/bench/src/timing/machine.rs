//! The machine that the figures belong to.

use std::fs;

use serde_json::{Value, json};

/// What a reader needs to compare figures with their own.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    cpu: String,
    cores: usize,
    memory_gib: Option<f64>,
    os: String,
    rustc: &'static str,
}

impl Machine {
    /// Asks the operating system; what it does not tell is `unknown`.
    pub(crate) fn detect() -> Self {
        Self {
            cpu: proc_field("/proc/cpuinfo", "model name").unwrap_or_else(unknown),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            memory_gib: proc_field("/proc/meminfo", "MemTotal").and_then(|text| gib(&text)),
            os: os_name().unwrap_or_else(|| std::env::consts::OS.to_owned()),
            rustc: env!("VTEX_BENCH_RUSTC"),
        }
    }

    /// Logical cores that this process may use.
    pub(crate) fn cores(&self) -> usize {
        self.cores
    }

    /// Name and value, for people.
    pub(crate) fn lines(&self) -> Vec<(&'static str, String)> {
        let memory = self
            .memory_gib
            .map_or_else(unknown, |gib| format!("{gib:.0} GiB"));
        let architecture = std::env::consts::ARCH;
        vec![
            (
                "CPU",
                format!("{} ({architecture}), {} cores", self.cpu, self.cores),
            ),
            ("Memory", memory),
            ("System", self.os.clone()),
            ("Compiler", self.rustc.to_owned()),
        ]
    }

    /// The same for programs.
    pub(crate) fn to_json(&self) -> Value {
        json!({
            "cpu": self.cpu,
            "architecture": std::env::consts::ARCH,
            "cores": self.cores,
            "memory_gib": self.memory_gib,
            "os": self.os,
            "rustc": self.rustc,
        })
    }
}

/// Runnable threads on the whole machine, averaged over the last minute; tells a busy machine.
pub(crate) fn load_average() -> Option<f64> {
    fs::read_to_string("/proc/loadavg")
        .ok()?
        .split_whitespace()
        .next()?
        .parse()
        .ok()
}

fn unknown() -> String {
    "unknown".to_owned()
}

/// Value of the first `name : value` line.
fn proc_field(path: &str, name: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// `24570000 kB` in GiB.
fn gib(kilobytes: &str) -> Option<f64> {
    let kilobytes: f64 = kilobytes.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes / f64::from(1 << 20))
}

fn os_name() -> Option<String> {
    let text = fs::read_to_string("/etc/os-release").ok()?;
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
    Some(name.trim_matches('"').to_owned())
}

#[cfg(test)]
mod tests {
    use super::gib;

    #[test]
    fn kilobytes_become_gib() {
        assert_eq!(gib("25165824 kB"), Some(24.0));
        assert_eq!(gib("lots"), None);
    }
}
