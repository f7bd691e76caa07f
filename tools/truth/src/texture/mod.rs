//! Pictures of textures: of a `.vtex` file, and of the raster texture that engines use today.

mod patches;
mod raster;

use vtex_format::{AddressMode, Features, VtexFile};
use vtex_runtime::{BatchSampler, Gpu, LoadOptions, Trust};
use vtex_shaders::{PackOptions, Packed, cpu};

use crate::TruthError;
use crate::picture::{POINTS, Picture, Shot};

pub use patches::{PatchCover, patch_cover};
pub use raster::{RasterBytes, RasterTexture, TODAY_TEXELS};
pub use vtex_shaders::FilterMode;

/// Pack options for a filter.
pub fn pack_options(filter: FilterMode) -> PackOptions {
    PackOptions {
        filter,
        ..PackOptions::default()
    }
}

/// As [`pack_options`], without the texture matrix and address modes of the file, so that the texture
/// shows the canvas as the SVG does.
pub fn canvas_options(filter: FilterMode) -> PackOptions {
    PackOptions {
        address: Some([AddressMode::Clamp; 2]),
        texture_matrix: Some([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        ..pack_options(filter)
    }
}

/// Least width and height of a lookup's footprint in uv from which the lookup is a mean over it. In
/// footprint mode all are; in the other modes those that mips answer. There mips fade in between
/// half a texel of mip 0 and one texel.
pub fn region_uv(file: &VtexFile, filter: FilterMode) -> [f64; 2] {
    /// Where mips have more than half of the weight.
    const LEAST_TEXELS: f64 = 0.75;
    let canvas = file
        .images
        .first()
        .filter(|_| file.spec.features & Features::MIPS != 0);
    match (filter, canvas) {
        (FilterMode::Footprint, _) => [0.0; 2],
        (_, Some(canvas)) => canvas.size.map(|side| LEAST_TEXELS / f64::from(side)),
        (_, None) => POINTS,
    }
}

/// Takes pictures of one texture.
#[derive(Debug)]
pub enum Shooter {
    /// On the CPU, with the evaluator in Rust.
    Cpu {
        /// The packed texture.
        packed: Packed,
    },
    /// On a GPU, with the evaluator in WGSL.
    Gpu {
        /// The uploaded texture; boxed, since it is large.
        sampler: Box<BatchSampler>,
    },
}

impl Shooter {
    /// Prepares a texture for pictures on the CPU.
    pub fn on_cpu(file: &VtexFile, pack: PackOptions) -> Self {
        Self::Cpu {
            packed: vtex_shaders::pack(file, &pack),
        }
    }

    /// Prepares a texture for pictures on a GPU that is already open.
    ///
    /// # Errors
    /// When the texture does not fit the GPU.
    pub fn on_gpu(gpu: &Gpu, file: &VtexFile, pack: PackOptions) -> Result<Self, TruthError> {
        let options = LoadOptions {
            pack,
            ..LoadOptions::default()
        };
        let trust = Trust::default();
        let sampler = BatchSampler::new(&gpu.device, &gpu.queue, file, &options, trust)?;
        Ok(Self::Gpu {
            sampler: Box::new(sampler),
        })
    }

    /// Takes a picture.
    ///
    /// # Errors
    /// When the GPU fails.
    pub fn shoot(&self, shot: Shot) -> Result<Picture, TruthError> {
        match self {
            Self::Cpu { packed } => {
                let sampler = cpu::Sampler::new(packed);
                Ok(shot.shoot(|uv, footprint| sampler.sample(uv, footprint)))
            }
            Self::Gpu { sampler } => Ok(shot.shoot_batches(|queries| sampler.sample(queries))?),
        }
    }
}
