//! Bakes kept by what they were made from.

use std::path::{Path, PathBuf};

use vtex_baker::BakeConfig;
use vtex_format::{Limits, VtexFile};

use crate::cli::Outcome;
use crate::files::{input, output};

/// A folder of bakes, each named by the hash of source, options, fonts and tool version.
#[derive(Debug)]
pub(crate) struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// Opens the folder and makes it when it is missing.
    ///
    /// # Errors
    /// When it cannot be made.
    pub(crate) fn open(folder: &Path) -> Outcome<Self> {
        output::create_folder(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
        })
    }

    /// The name under which a bake is kept.
    pub(crate) fn key(svg: &[u8], config: &BakeConfig, fonts: &str) -> String {
        let mut hasher = blake3::Hasher::new();
        // Debug text names every option and every bit of every number.
        for part in [
            env!("CARGO_PKG_VERSION").as_bytes(),
            format!("{config:?}").as_bytes(),
        ] {
            hasher
                .update(&(part.len() as u64).to_le_bytes())
                .update(part);
        }
        hasher
            .update(&(fonts.len() as u64).to_le_bytes())
            .update(fonts.as_bytes())
            .update(svg);
        hasher.finalize().to_hex().to_string()
    }

    /// The bake kept under `key`; `None` when there is none or it is damaged.
    pub(crate) fn get(&self, key: &str) -> Option<(VtexFile, Vec<u8>)> {
        let bytes = input::read(&self.path(key)).ok()?;
        let file = VtexFile::parse(&bytes, &Limits::default()).ok()?;
        Some((file, bytes))
    }

    /// Keeps a bake.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn put(&self, key: &str, bytes: &[u8]) -> Outcome<()> {
        output::write(&self.path(key), bytes)
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.vtex"))
    }
}
