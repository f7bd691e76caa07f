//! Both evaluators with one texture: the same lookups on the Rust twin and on the GPU.

use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, BatchSampler, Gpu};
use vtex_shaders::cpu;
use vtex_tests::colors::differing;
use vtex_truth::picture::Shot;
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// Largest difference of a channel, linear light, that counts as equal.
const SAME: f32 = 2.0 / 255.0;

/// A file packed for one filter mode, for both evaluators.
pub(crate) struct Eyes {
    words: Vec<u32>,
    /// `None` with `VTEX_GPU=off`.
    gpu: Option<Box<BatchSampler>>,
}

/// What both evaluators answer to the same lookups, in their order.
pub(crate) struct Answers {
    pub(crate) twin: Vec<[f32; 4]>,
    pub(crate) gpu: Option<Vec<[f32; 4]>>,
}

impl Eyes {
    pub(crate) fn new(gpu: Option<&Gpu>, file: &VtexFile, filter: FilterMode) -> Self {
        let pack = canvas_options(filter);
        let sampler = |gpu| match Shooter::on_gpu(gpu, file, pack).unwrap() {
            Shooter::Gpu { sampler } => sampler,
            Shooter::Cpu { .. } => unreachable!("asked for a GPU"),
        };
        Self {
            words: vtex_shaders::pack(file, &pack),
            gpu: gpu.map(sampler),
        }
    }

    pub(crate) fn look_up_twin(&self, queries: &[BatchQuery]) -> Vec<[f32; 4]> {
        let twin = cpu::Sampler::new(&self.words);
        let look = |query: &BatchQuery| twin.sample(query.uv, query.footprint);
        queries.iter().map(look).collect()
    }

    pub(crate) fn look_up(&self, queries: &[BatchQuery]) -> Answers {
        Answers {
            twin: self.look_up_twin(queries),
            gpu: self.gpu.as_ref().map(|gpu| gpu.sample(queries).unwrap()),
        }
    }
}

impl Answers {
    /// Positions of the lookups that GPU and twin answer differently.
    pub(crate) fn apart(&self) -> Vec<usize> {
        let gpu = self.gpu.as_deref().unwrap_or(&self.twin);
        differing(&self.twin, gpu, SAME)
    }
}

/// The lookups of a picture.
pub(crate) fn queries(shot: Shot) -> Vec<BatchQuery> {
    let [width, height] = shot.size_px;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels.flat_map(|[x, y]| shot.queries(x, y)).collect()
}
