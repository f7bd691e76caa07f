//! A cache of bakes: a folder of files named by the hash of what they were baked from.

use std::path::{Path, PathBuf};

use vtex_baker::BakeConfig;
use vtex_format::{Limits, VtexFile};

use crate::cli::Outcome;
use crate::files::{input, output};

/// A folder of bakes. The name of each is the hash of SVG, options, fonts and version of this tool.
#[derive(Debug)]
pub(crate) struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// Opens the folder, or creates it.
    ///
    /// # Errors
    /// When it cannot be created.
    pub(crate) fn open(folder: &Path) -> Outcome<Self> {
        output::create_folder(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
        })
    }

    /// The name of a bake in the folder, without extension.
    pub(crate) fn key(svg: &[u8], config: &BakeConfig, fonts: &str) -> String {
        let mut hasher = blake3::Hasher::new();
        // The Debug text holds every option, also those added later, and prints every number so
        // that it reads back to the same bits.
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

    /// The bake named `key`; `None` when there is none or it is damaged.
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
