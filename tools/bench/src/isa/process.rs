//! The process that compiles. A driver reads which chip to compile for from the environment, once
//! for a process, and its compiler may crash: so this program runs itself again for each chip.

use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, Result, bail};
use serde_json::{Value, json};

use super::kernels::Kernel;

/// The option with which this program becomes [`serve`].
const OPTION: &str = "--isa-compile";
/// Where Vulkan drivers are registered on Linux.
const DRIVER_FOLDERS: [&str; 4] = [
    "/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/usr/share/vulkan/icd.d",
    // NixOS
    "/run/opengl-driver/share/vulkan/icd.d",
];
/// A shader unlike all others: drivers keep what they have compiled.
const WARM_UP: &str = "@compute @workgroup_size(1) fn warm_up() {}";
/// How the file names of Mesa's driver for AMD begin.
const RADV: &str = "radeon_icd";

/// For which chip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Chip {
    /// The machine's own, by its own driver.
    Own,
    /// One of AMD's that need not be there, as `RADV_FORCE_FAMILY` names it.
    Amd(String),
}

impl std::str::FromStr for Chip {
    type Err = std::convert::Infallible;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Ok(match name {
            "own" => Self::Own,
            name => Self::Amd(name.to_owned()),
        })
    }
}

impl std::fmt::Display for Chip {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Own => "own driver",
            Self::Amd(name) => name,
        })
    }
}

/// What a driver says of one kernel.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    pub(crate) milliseconds: f64,
    /// Names as the driver gives them.
    pub(crate) statistics: Vec<(String, f64)>,
}

/// What a driver calls its device, and the figures of each kernel or why there are none.
pub(crate) type Measured = (String, Vec<Result<Compiled, String>>);

/// Compiles `kernels` for `chip` in a process of its own.
///
/// # Errors
/// Says in a sentence why there are no figures at all.
pub(crate) fn measure(chip: &Chip, kernels: &[Kernel]) -> Result<Measured> {
    let mut command = Command::new(std::env::current_exe().context("cannot find this program")?);
    command.arg(OPTION).envs(environment(chip)?);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    // Drivers chatter there.
    command.stderr(Stdio::null());
    let mut child = command.spawn().context("cannot run this program again")?;
    let texts: Vec<&str> = kernels.iter().map(|kernel| kernel.wgsl.as_str()).collect();
    if let Some(mut input) = child.stdin.take() {
        // It reads all before it writes. Where it died, the missing answer says more than this.
        let _ = input.write_all(json!(texts).to_string().as_bytes());
    }
    let output = child.stdout.take().context("no pipe")?;
    let mut lines = BufReader::new(output).lines();
    let device = match answer(lines.next())? {
        Ok(device) => device.as_str().unwrap_or("?").to_owned(),
        Err(problem) => bail!("{problem}"),
    };
    let mut results = Vec::new();
    for line in lines {
        results.push(answer(Some(line))?.map(|value| compiled(&value)));
    }
    let status = child.wait().context("cannot wait")?;
    if let Some(kernel) = kernels.get(results.len()) {
        bail!("the driver ended with {status} at \"{}\"", kernel.name);
    }
    Ok((device, results))
}

/// The other side of [`measure`]: texts of shaders on stdin, a line of JSON for the device and for
/// each shader on stdout.
pub(crate) fn serve() -> Result<()> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let kernels: Vec<String> = serde_json::from_str(&text)?;
    let compiler = match vtex_isa::Compiler::open() {
        Ok(compiler) => compiler,
        Err(error) => return reply(json!({ "error": error.to_string() })),
    };
    reply(json!({ "ok": compiler.name() }))?;
    // The first time counts what the driver sets up for itself. Whether it compiles, the others say.
    let _ = compiler.compile(WARM_UP);
    for kernel in &kernels {
        reply(match compiler.compile(kernel) {
            Ok(compiled) => json!({ "ok": to_json(&compiled) }),
            Err(error) => json!({ "error": error.to_string() }),
        })?;
    }
    Ok(())
}

fn to_json(compiled: &vtex_isa::Compiled) -> Value {
    let statistics = compiled.statistics.iter();
    json!({
        "milliseconds": compiled.time.as_secs_f64() * 1e3,
        "statistics": statistics.map(|one| (&one.name, one.value)).collect::<Vec<_>>(),
    })
}

fn compiled(value: &Value) -> Compiled {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let statistics = value["statistics"].as_array().into_iter().flatten();
    Compiled {
        milliseconds: number(&value["milliseconds"]),
        statistics: statistics
            .map(|one| (one[0].as_str().unwrap_or("?").to_owned(), number(&one[1])))
            .collect(),
    }
}

fn reply(value: Value) -> Result<()> {
    let mut out = std::io::stdout().lock();
    // Line by line: what is written stays when the driver crashes at a later shader.
    writeln!(out, "{value}")?;
    Ok(out.flush()?)
}

fn answer(line: Option<std::io::Result<String>>) -> Result<Result<Value, String>> {
    let line =
        line.context("the driver ended when it was opened; maybe it knows no such chip")??;
    let mut value: Value = serde_json::from_str(&line).context("not an answer")?;
    Ok(match value["error"].as_str() {
        Some(error) => Err(error.to_owned()),
        None => Ok(value["ok"].take()),
    })
}

/// What makes the driver compile for `chip`.
fn environment(chip: &Chip) -> Result<Vec<(&'static str, OsString)>> {
    // Both names, old and new: a cached shader takes no time to compile.
    let mut variables: Vec<(&str, OsString)> = vec![
        ("MESA_SHADER_CACHE_DISABLE", "1".into()),
        ("MESA_GLSL_CACHE_DISABLE", "1".into()),
        ("__GL_SHADER_DISK_CACHE", "0".into()),
    ];
    if let Chip::Amd(family) = chip {
        let driver = DRIVER_FOLDERS
            .iter()
            .find_map(|folder| radv(Path::new(folder)));
        let driver = driver.context(
            "Mesa's driver for AMD is not installed (Debian and Ubuntu: \
             apt install mesa-vulkan-drivers)",
        )?;
        variables.push(("RADV_FORCE_FAMILY", family.into()));
        // New loaders read the first, old ones the second.
        variables.push(("VK_DRIVER_FILES", driver.clone().into()));
        variables.push(("VK_ICD_FILENAMES", driver.into()));
    }
    Ok(variables)
}

/// The driver's file in a folder; of several, the one for this processor.
fn radv(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let mut found: Vec<PathBuf> = entries
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(RADV))
        .map(|entry| entry.path())
        .collect();
    let is_foreign = |path: &PathBuf| !path.to_string_lossy().contains(std::env::consts::ARCH);
    found.sort_by_key(|path| (is_foreign(path), path.clone()));
    found.into_iter().next()
}
