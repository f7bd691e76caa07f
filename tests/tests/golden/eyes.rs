//! Both evaluators with one texture: the same lookups on the Rust twin and on the GPU.

use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, BatchSampler, Gpu};
use vtex_shaders::Packed;
use vtex_tests::parity::{Parity, Subject};
use vtex_truth::picture::Shot;
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// A file packed for one filter mode, for both evaluators.
pub(crate) struct Eyes {
    packed: Packed,
    /// Of the key that it is looked up with.
    pub(crate) features: u32,
    /// `None` with `VTEX_GPU=off`.
    gpu: Option<Box<BatchSampler>>,
}

/// What both evaluators answer to the same lookups, in their order.
pub(crate) struct Answers {
    pub(crate) twin: Vec<[f32; 4]>,
    pub(crate) gpu: Option<Vec<[f32; 4]>>,
    /// How they differ; of no lookups without a GPU.
    pub(crate) parity: Parity,
}

impl Eyes {
    pub(crate) fn new(gpu: Option<&Gpu>, file: &VtexFile, filter: FilterMode) -> Self {
        let pack = canvas_options(filter);
        let sampler = |gpu| match Shooter::on_gpu(gpu, file, pack).unwrap() {
            Shooter::Gpu { sampler } => sampler,
            Shooter::Cpu { .. } => unreachable!("asked for a GPU"),
        };
        Self {
            packed: vtex_shaders::pack(file, &pack),
            features: vtex_shaders::spec_key(file, &pack).features,
            gpu: gpu.map(sampler),
        }
    }

    fn subject(&self) -> Subject<'_> {
        Subject {
            words: &self.packed.words,
            texels: &self.packed.texels,
            features: self.features,
        }
    }

    pub(crate) fn look_up_twin(&self, queries: &[BatchQuery]) -> Vec<[f32; 4]> {
        self.subject().twin(queries)
    }

    pub(crate) fn look_up(&self, queries: &[BatchQuery]) -> Answers {
        let twin = self.look_up_twin(queries);
        let gpu = self.gpu.as_ref().map(|gpu| gpu.sample(queries).unwrap());
        let compare = |gpu: &Vec<_>| self.subject().compare(queries, &twin, gpu);
        let parity = gpu.as_ref().map_or_else(Parity::default, compare);
        Answers { twin, gpu, parity }
    }
}

/// The lookups of a picture.
pub(crate) fn queries(shot: Shot) -> Vec<BatchQuery> {
    let [width, height] = shot.size_px;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels.flat_map(|[x, y]| shot.queries(x, y)).collect()
}
