//! glTF assets: the files beside them and the drawings in them.

use std::path::{Component, Path};

use vtex_baker::BakeConfig;
use vtex_format::VtexFile;
use vtex_gltf::{Asset, Files, GltfError, ReadOptions, view_of};
use vtex_runtime::Camera;

use crate::baking;
use crate::baking::fonts::FontLibrary;
use crate::cli::{ExitCode, Failure, Outcome};
use crate::files::input;

/// Files in and below the folder of an asset, and the baker.
pub(crate) struct Beside<'a> {
    /// The asset.
    pub(crate) path: &'a Path,
    /// For text in drawings.
    pub(crate) fonts: &'a FontLibrary,
}

impl Files for Beside<'_> {
    fn read(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        let relative = Path::new(uri);
        // An asset from elsewhere is not to show what lies outside its folder.
        let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if !relative.components().all(inside) {
            return Err("only files in and below the asset's folder are read".to_owned());
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        input::read(&folder.join(relative)).map_err(|failure| failure.message)
    }

    fn bake(&mut self, svg: &[u8], name: &str) -> Result<VtexFile, String> {
        let config = BakeConfig::default();
        let baked = baking::bake(Path::new(name), svg, &config, self.fonts, &|_| ());
        baked.map_err(|failure| failure.message)
    }
}

/// Reads an asset.
///
/// # Errors
/// When it or a file that it needs cannot be read.
pub(crate) fn read(path: &Path, options: &ReadOptions, fonts: &FontLibrary) -> Outcome<Asset> {
    let bytes = input::read(path)?;
    vtex_gltf::read(&bytes, &mut Beside { path, fonts }, options)
        .map_err(|error| failure(path, &error))
}

/// The failure for an error of the reader.
pub(crate) fn failure(path: &Path, error: &GltfError) -> Failure {
    let code = match error {
        GltfError::Unsupported(_) => ExitCode::Unsupported,
        GltfError::Limit(_) => ExitCode::Limit,
        GltfError::Missing(_) => ExitCode::Io,
        GltfError::Parameter(_) => ExitCode::Usage,
        _ => ExitCode::InvalidInput,
    };
    Failure::new(code, format!("{}: {error}", path.display()))
}

/// The camera that the command line asks for, for a film of width / height = `aspect`.
///
/// # Errors
/// When the asset does not have it.
pub(crate) fn camera(asset: &Asset, wanted: Option<&str>, aspect: f32) -> Outcome<Camera> {
    let cameras = &asset.cameras;
    let Some(wanted) = wanted else {
        return Ok(match cameras.first() {
            Some(first) => first.camera,
            None => view_of(&asset.scene, aspect),
        });
    };
    let named = cameras.iter().find(|camera| camera.name == wanted);
    let numbered = || {
        wanted
            .parse::<usize>()
            .ok()
            .and_then(|number| cameras.get(number))
    };
    match named.or_else(numbered) {
        Some(found) => Ok(found.camera),
        None => {
            let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
            Err(Failure::usage(format!(
                "--camera: the asset has no camera {wanted:?}, its {} cameras are {names:?}",
                names.len()
            )))
        }
    }
}
