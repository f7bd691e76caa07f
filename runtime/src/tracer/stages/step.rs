//! A kernel with what it binds, and one dispatch of it.

use wgpu::{BindGroup, Buffer, ComputePass, ComputePipeline};

/// What kernels do, in the order of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
    Generate,
    Hit,
    Surface,
    Lookups,
    Veil,
    Shade,
    Shadow,
    Arguments,
    Advance,
    Film,
}

#[derive(Debug)]
pub(super) struct Kernel {
    pub(super) stage: Stage,
    pub(super) pipeline: ComputePipeline,
    /// In order, from group 0 on.
    pub(super) groups: Vec<BindGroup>,
}

/// How many workgroups.
#[derive(Clone, Copy, Debug)]
pub(super) enum Work<'a> {
    Groups(u32),
    /// As many as the device has written into this buffer, at this offset.
    Counted(&'a Buffer, u64),
}

/// A dispatch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<'a> {
    pub(super) kernel: &'a Kernel,
    pub(super) work: Work<'a>,
}

impl Stage {
    pub(super) const ALL: [Self; 10] = [
        Self::Generate,
        Self::Hit,
        Self::Surface,
        Self::Lookups,
        Self::Veil,
        Self::Shade,
        Self::Shadow,
        Self::Arguments,
        Self::Advance,
        Self::Film,
    ];

    /// Its name in tables.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Generate => "generate",
            Self::Hit => "hit",
            Self::Surface => "surface",
            Self::Lookups => "lookups",
            Self::Veil => "veil",
            Self::Shade => "shade",
            Self::Shadow => "shadow",
            Self::Arguments => "arguments",
            Self::Advance => "advance",
            Self::Film => "film",
        }
    }

    /// The WGSL module of its kernel.
    pub(super) fn module(self) -> &'static str {
        match self {
            Self::Generate => "stage/generate",
            Self::Hit => "stage/hit",
            Self::Surface => "stage/surface",
            Self::Lookups => "root/batch",
            Self::Veil => "stage/veil",
            Self::Shade => "stage/shade",
            Self::Shadow => "stage/shadow",
            Self::Arguments => "stage/arguments",
            Self::Advance => "stage/advance",
            Self::Film => "stage/film",
        }
    }

    pub(super) const fn entry_point(self) -> &'static str {
        match self {
            Self::Generate => "stage_generate",
            Self::Hit => "stage_hit",
            Self::Surface => "stage_surface",
            Self::Lookups => "vtex_batch",
            Self::Veil => "stage_veil",
            Self::Shade => "stage_shade",
            Self::Shadow => "stage_shadow",
            Self::Arguments => "stage_arguments",
            Self::Advance => "stage_advance",
            Self::Film => "stage_film",
        }
    }
}

impl Step<'_> {
    pub(super) fn record(&self, pass: &mut ComputePass<'_>) {
        pass.set_pipeline(&self.kernel.pipeline);
        for (number, group) in (0..).zip(&self.kernel.groups) {
            pass.set_bind_group(number, group, &[]);
        }
        match self.work {
            Work::Groups(count) => pass.dispatch_workgroups(count, 1, 1),
            Work::Counted(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, offset),
        }
    }
}
