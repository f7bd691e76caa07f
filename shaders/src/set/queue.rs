//! The kernels that answer queues.

use crate::gpu_record;
use crate::layout::RecordLayout;
use crate::specialize::{BindingSlot, linked, scene_context};

/// WGSL of the kernel that answers a queue, entry point `vtex_queue`, for textures with these features that
/// lie in one pool.
///
/// Group 0: binding 0 the queries, an array of [`TextureQuery`](super::TextureQuery); binding 1 their number,
/// a `u32`; binding 2 the results, an array of `vec4f`. Group 1: the set as in
/// [`set_fragment`](super::set_fragment). It is dispatched with the arguments that [`queue_arguments_kernel`]
/// writes. Queries from the number on, or beyond either array's end, are passed over.
pub fn queue_kernel(features: u32) -> String {
    kernel("root/queue_lookups", features)
}

/// WGSL of the kernel that answers one pool's part of a queue, entry point `vtex_queue_pool`.
///
/// Groups 0 and 1 as in [`queue_kernel`], with one pool of the set. Group 2: binding 0 the parts and
/// binding 1 the order that [`queue_order_kernels`] write. It is dispatched once for each pool, with
/// [`QueuePart::groups`] as arguments.
pub fn queue_pool_kernel(features: u32) -> String {
    kernel("root/queue_pool", features)
}

fn kernel(root: &str, features: u32) -> String {
    let slot = BindingSlot {
        group: 1,
        binding: 0,
    };
    linked(root, &scene_context(features, slot))
}

/// WGSL of the kernel that makes dispatch arguments of a queue's length, entry point
/// `vtex_queue_arguments`, one workgroup. It depends on nothing.
///
/// Group 0 is that of [`queue_kernel`]. Group 1, binding 0: the arguments, `array<u32, 3>`.
pub fn queue_arguments_kernel() -> String {
    linked("root/queue_arguments", &crate::LinkContext::default())
}

/// WGSL of the three kernels that put a queue in the order of its pools, to be run one after the other:
/// `vtex_queue_tally` and `vtex_queue_sort` with the arguments of [`queue_arguments_kernel`], between them
/// `vtex_queue_divide` with as many workgroups as the set has pools. They depend on nothing.
///
/// Group 0 is that of [`queue_kernel`]. Group 1: binding 0 [`QUEUE_TALLIES`] words that are zero at first;
/// binding 1 the parts, [`QueuePart`]s of all pools that a set can have; binding 2 the order, a `u32` for
/// each query that there is room for. Queries for pools that the set does not have are answered with zeros
/// at once.
pub fn queue_order_kernels() -> String {
    linked("root/queue_order", &crate::LinkContext::default())
}

/// Words of the tallies: queries of each pool, and those that have their place.
pub const QUEUE_TALLIES: u32 = 2 * super::MAX_POOLS;

/// What one pool answers of a queue, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct QueuePart {
    /// Arguments of its dispatch.
    pub groups: [u32; 3],
    /// How many queries.
    pub count: u32,
    /// The place of the first in the order.
    pub first: u32,
    /// Pools of the set, the same in each part.
    pub pools: u32,
    /// Zeros.
    pub padding: [u32; 2],
}

/// [`QueuePart`] as `wgsl/core/set.wgsl` has it.
pub const QUEUE_PART: RecordLayout =
    gpu_record!(QueuePart as "VtexQueuePart" { groups, count, first, pools, padding });

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specialize::{BATCH_WORKGROUP, MAX_WORKGROUPS};

    #[test]
    fn kernels_count_as_the_host_does() {
        let text = queue_arguments_kernel();
        assert!(text.contains(&format!("VTEX_QUEUE_WORKGROUP: u32 = {BATCH_WORKGROUP}u;")));
        assert!(text.contains(&format!("VTEX_QUEUE_GROUPS: u32 = {MAX_WORKGROUPS}u;")));
        for text in [queue_kernel(0), queue_pool_kernel(0), queue_order_kernels()] {
            assert!(text.contains(&format!("@workgroup_size({BATCH_WORKGROUP})")));
        }
    }
}
