//! The path tracer in stages: a kernel for each, lists of paths and queues of lookups between them, all
//! on the device. The host records a fixed number of rounds, and each takes as many paths as are left.

mod lookups;
mod step;
mod times;

use vtex_shaders::LinkContext;
use wgpu::{
    Buffer, BufferBindingType, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device,
    Queue,
};

pub use times::StageTime;
pub(super) use times::StageTimer;

use super::passes::{MAX_SAMPLES_PER_PASS, PATHS_PER_PASS};
use super::pipeline::{BufferGroup, Inputs, SHADING, SceneGroup, TRAVERSAL, linked, pipeline};
use super::records::PassRecord;
use super::upload::SceneBuffers;
use crate::RuntimeError;
use crate::device::{READ, WRITE, checked, compiled, empty_buffer};
use step::{Kernel, Stage, Step, Work};

/// Paths of one submission on a graphics card, which is idle at the end of each round.
const PATHS_ON_A_CARD: u32 = 1 << 18;
/// Paths of a workgroup. A multiple of this many has lists and queues that can be bound.
const WORKGROUP: u32 = 64;
/// Bytes of a path's state: `STATE_FIELDS` of `shaders/wgsl/state/paths.wgsl`, 16 bytes each.
const STATE_BYTES: u64 = 11 * 16;
/// Lists of paths.
const LISTS: u64 = 3;
const QUERY_BYTES: u64 = 32;
const COLOR_BYTES: u64 = 16;
/// Bytes of a path's stack that do not fit memory of a workgroup: `STACK_SIZE` less `STACK_NEAR` of
/// `shaders/wgsl/state/stack.wgsl`, 8 bytes each. They lie where queries do at other times.
const STACK_BYTES: u64 = (32 - 12) * 8;
/// Counts ahead of those of the queues; see `COUNT_LOOKUPS`.
const COUNTS: usize = 4;
/// Arguments ahead of those of the queues; see `DISPATCH_LOOKUPS`.
const ARGUMENTS: usize = 2;
/// Bytes of a dispatch's arguments with their padding.
const ARGUMENTS_BYTES: u64 = 16;
/// `PATH_MAX_VEILS` of `shaders/wgsl/path/steps.wgsl`: each takes a round more.
const MAX_VEILS: u32 = 64;

/// The kernels and what lies between them.
#[derive(Debug)]
pub(super) struct Stages {
    generate: Kernel,
    hit: Kernel,
    surface: Kernel,
    arguments: Kernel,
    lookups: Vec<Kernel>,
    /// Where any surface is see-through.
    veil: Option<Kernel>,
    shade: Kernel,
    shadow: Kernel,
    advance: Kernel,
    film: Kernel,
    counts: Buffer,
    dispatch: Buffer,
    paths: u32,
    rounds: u32,
    width: u32,
    notices: Vec<String>,
}

/// Buffers between stages.
struct Between {
    state: Buffer,
    counts: Buffer,
    lists: Buffer,
    queries: Buffer,
    colors: Buffer,
    dispatch: Buffer,
}

impl Stages {
    pub(super) async fn new(device: &Device, inputs: Inputs<'_>) -> Result<Self, RuntimeError> {
        let has_veils = inputs.scene.has_veils();
        let queues = inputs.scene.queues();
        let mut notices = queues.notices.clone();
        let kernels = lookups::compile(device, &queues.queues, &mut notices).await?;
        let paths = room(device, inputs.size, queues.queues.len());
        let between = checked(device, "queues of the path tracer", || {
            Between::new(device, u64::from(paths), queues.queues.len())
        })
        .await?;
        compiled(device, "path tracer", || {
            let lookups = (0..).zip(&kernels).map(|(index, kernel)| {
                let buffers = [&between.queries, &between.colors];
                let group =
                    lookups::bind(device, kernel, inputs.scene, buffers, index, paths.into());
                Kernel {
                    stage: Stage::Lookups,
                    pipeline: kernel.pipeline.clone(),
                    groups: vec![group],
                }
            });
            let lookups = lookups.collect();
            let make = Maker::new(device, &inputs, &between);
            Ok(Self {
                lookups,
                generate: make.kernel(Stage::Generate)?,
                hit: make.kernel(Stage::Hit)?,
                surface: make.kernel(Stage::Surface)?,
                arguments: make.kernel(Stage::Arguments)?,
                veil: match has_veils {
                    true => Some(make.kernel(Stage::Veil)?),
                    false => None,
                },
                shade: make.kernel(Stage::Shade)?,
                shadow: make.kernel(Stage::Shadow)?,
                advance: make.kernel(Stage::Advance)?,
                film: make.kernel(Stage::Film)?,
                counts: between.counts.clone(),
                dispatch: between.dispatch.clone(),
                paths,
                // A round for each surface that scatters, one for the last, and one for each that is seen
                // through.
                rounds: inputs.max_bounces + 1 + if has_veils { MAX_VEILS } else { 0 },
                width: inputs.size[0],
                notices,
            })
        })
        .await
    }

    /// How many paths a submission may have.
    pub(super) fn paths(&self) -> u32 {
        self.paths
    }

    pub(super) fn notices(&self) -> &[String] {
        &self.notices
    }

    pub(super) fn lookup_kernels(&self) -> usize {
        self.lookups.len()
    }

    /// Sets what the first round finds; to be called ahead of the submission of [`Self::record`].
    pub(super) fn prepare(&self, queue: &Queue, record: &PassRecord) {
        let paths = self.width * record.row_count * record.sample_count;
        let mut counts = vec![0_u32; COUNTS + self.lookups.len()];
        counts[0] = paths;
        queue.write_buffer(&self.counts, 0, bytemuck::cast_slice(&counts));
        let first = [paths.div_ceil(WORKGROUP), 1, 1, 0];
        queue.write_buffer(&self.dispatch, 0, bytemuck::cast_slice(&first));
    }

    /// Records all stages, in one pass.
    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        record: &PassRecord,
        timestamps: Option<ComputePassTimestampWrites<'_>>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("vtex stages"),
            timestamp_writes: timestamps,
        });
        for step in self.steps(record) {
            step.record(&mut pass);
        }
    }

    /// As [`Self::record`], with a pass for each step, whose time is taken.
    pub(super) fn record_timed(
        &self,
        encoder: &mut CommandEncoder,
        record: &PassRecord,
        timer: &mut StageTimer,
    ) {
        for step in self.steps(record) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(step.kernel.stage.name()),
                timestamp_writes: timer.writes(step.kernel.stage),
            });
            step.record(&mut pass);
        }
        timer.resolve(encoder);
    }

    fn steps(&self, record: &PassRecord) -> Vec<Step<'_>> {
        let direct = |kernel, count: u32| Step {
            kernel,
            work: Work::Groups(count),
        };
        let counted = |kernel, place: usize| Step {
            kernel,
            work: Work::Counted(&self.dispatch, place as u64 * ARGUMENTS_BYTES),
        };
        let pixels = self.width * record.row_count;
        let paths = pixels * record.sample_count;
        let mut steps = vec![direct(&self.generate, paths.div_ceil(WORKGROUP))];
        for _ in 0..self.rounds {
            steps.push(counted(&self.hit, 0));
            steps.push(counted(&self.surface, 0));
            if !self.lookups.is_empty() {
                steps.push(direct(&self.arguments, 1));
            }
            let queues = (ARGUMENTS..).zip(&self.lookups);
            steps.extend(queues.map(|(place, kernel)| counted(kernel, place)));
            steps.extend(self.veil.iter().map(|kernel| counted(kernel, 0)));
            steps.push(counted(&self.shade, 0));
            steps.push(direct(&self.arguments, 1));
            steps.push(counted(&self.shadow, 1));
            steps.push(direct(&self.advance, 1));
        }
        steps.push(direct(&self.film, pixels.div_ceil(WORKGROUP)));
        steps
    }
}

impl Between {
    /// To be called in [`checked`].
    fn new(device: &Device, paths: u64, queues: usize) -> Result<Self, RuntimeError> {
        let storage = BufferUsages::STORAGE;
        let host = storage | BufferUsages::COPY_DST;
        let buffer = |label, size, usage| empty_buffer(device, label, size, usage);
        let queries = paths * queries_bytes(queues);
        // A binding has at least one element, whether there are textures or not.
        let colors = paths * queues.max(1) as u64 * COLOR_BYTES;
        let counts = (4 * (COUNTS + queues)) as u64;
        let arguments = (ARGUMENTS + queues) as u64 * ARGUMENTS_BYTES;
        Ok(Self {
            state: buffer("vtex paths", paths * STATE_BYTES, storage)?,
            counts: buffer("vtex path counts", counts, host)?,
            lists: buffer("vtex path lists", paths * LISTS * 4, storage)?,
            queries: buffer("vtex lookups", queries, storage)?,
            colors: buffer("vtex lookup colours", colors, storage)?,
            dispatch: buffer("vtex dispatches", arguments, host | BufferUsages::INDIRECT)?,
        })
    }
}

/// Bytes of a path's queries, or of its stack.
fn queries_bytes(queues: usize) -> u64 {
    (QUERY_BYTES * queues as u64).max(STACK_BYTES)
}

/// Room for paths: as many as a submission takes, as a film has, and as queues can be bound for.
fn room(device: &Device, [width, height]: [u32; 2], queues: usize) -> u32 {
    let limits = device.limits();
    let limit = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let bytes = STATE_BYTES.max(queries_bytes(queues));
    let wanted = match device.adapter_info().device_type {
        wgpu::DeviceType::Cpu => PATHS_PER_PASS,
        _ => PATHS_ON_A_CARD,
    };
    let film = u64::from(width) * u64::from(height) * u64::from(MAX_SAMPLES_PER_PASS);
    let most = (limit / bytes).min(film).min(wanted.into());
    // A row at least: where the device does not bind that many, making the buffers says so.
    let paths = u32::try_from(most).unwrap_or(wanted).max(width);
    paths.next_multiple_of(WORKGROUP)
}

/// Makes the kernels of stages from the groups that they share.
struct Maker<'a> {
    device: &'a Device,
    scene: &'a SceneBuffers,
    traversal: SceneGroup,
    shading: SceneGroup,
    state: BufferGroup,
    queries: BufferGroup,
    stack: BufferGroup,
    colors: BufferGroup,
    dispatch: BufferGroup,
    film: BufferGroup,
}

impl<'a> Maker<'a> {
    fn new(device: &'a Device, inputs: &Inputs<'a>, between: &Between) -> Self {
        let group = |label, types: &[BufferBindingType], buffers: &[&Buffer]| {
            BufferGroup::new(device, label, types, buffers)
        };
        let scene = |numbers| SceneGroup::new(device, inputs.scene, inputs.pass, numbers);
        Self {
            device,
            scene: inputs.scene,
            traversal: scene(TRAVERSAL),
            shading: scene(SHADING),
            state: group(
                "vtex paths",
                &[WRITE, WRITE, WRITE],
                &[&between.state, &between.counts, &between.lists],
            ),
            queries: group("vtex lookups", &[WRITE], &[&between.queries]),
            // The same buffer: while rays are traced no queue has anything in it.
            stack: group("vtex lookups", &[WRITE], &[&between.queries]),
            colors: group("vtex lookup colours", &[READ], &[&between.colors]),
            dispatch: group("vtex dispatches", &[WRITE], &[&between.dispatch]),
            film: BufferGroup::film(device, inputs.film),
        }
    }

    fn kernel(&self, stage: Stage) -> Result<Kernel, RuntimeError> {
        let scene = match stage {
            Stage::Surface | Stage::Veil | Stage::Shade => &self.shading,
            Stage::Hit | Stage::Shadow if self.scene.has_cutouts() => &self.shading,
            _ => &self.traversal,
        };
        let third = match stage {
            Stage::Surface => Some(&self.queries),
            Stage::Veil | Stage::Shade => Some(&self.colors),
            Stage::Hit | Stage::Shadow => Some(&self.stack),
            Stage::Arguments | Stage::Advance => Some(&self.dispatch),
            Stage::Film => Some(&self.film),
            Stage::Generate | Stage::Lookups => None,
        };
        let mut layouts = vec![&scene.layout, &self.state.layout];
        layouts.extend(third.map(|group| &group.layout));
        let mut groups = vec![scene.group.clone(), self.state.group.clone()];
        groups.extend(third.map(|group| group.group.clone()));
        let context = LinkContext::default().fill("trace/stack", "state/stack");
        let context = self.scene.code(context);
        let wgsl = linked(stage.module(), &context)?;
        Ok(Kernel {
            stage,
            pipeline: pipeline(self.device, &wgsl, stage.entry_point(), &layouts),
            groups,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_those_of_the_shaders() {
        let text = |module| vtex_shaders::link(module, &LinkContext::default()).unwrap();
        let dispatch = text("state/dispatch");
        for (name, value) in [
            ("STATE_FIELDS", STATE_BYTES / 16),
            ("COUNT_LOOKUPS", COUNTS as u64),
            ("DISPATCH_LOOKUPS", ARGUMENTS as u64),
            ("PATH_MAX_VEILS", u64::from(MAX_VEILS)),
        ] {
            let line = format!("const {name}: u32 = {value}u;");
            assert!(dispatch.contains(&line), "no `{line}`");
        }
    }
}
