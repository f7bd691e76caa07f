//! Which pool of a set a texture goes to, and what all of them have room for.

use std::sync::atomic::{AtomicU64, Ordering};

use vtex_shaders::Packed;
use vtex_shaders::set::{MAX_POOLS, TextureHandle};

use super::space::{Bounds, Plan, Refused, Space, texels_of};
use super::{SetBytes, TextureSetOptions};
use crate::{RuntimeError, TexelFormat};

/// What is to be done to pools, each of which is in place or the next after those.
#[derive(Debug)]
pub(super) struct PoolPlans {
    pub(super) plans: Vec<Plan>,
    /// Of the textures, in order.
    pub(super) handles: Vec<TextureHandle>,
}

/// Adds each texture to the first pool that has room for it, and opens new ones, up to `max_pools`, for those
/// that none has room for.
///
/// # Errors
/// [`RuntimeError::Limit`] where a texture stays without a pool.
pub(super) fn plan<'a>(
    mut pools: impl Iterator<Item = &'a Space>,
    textures: &mut [Packed],
    bounds: &Bounds,
    max_pools: u32,
) -> Result<PoolPlans, RuntimeError> {
    let mut left = Refused {
        textures: (0..textures.len()).collect(),
        reason: None,
    };
    let mut planned = PoolPlans {
        plans: Vec::new(),
        handles: vec![TextureHandle::NONE; textures.len()],
    };
    for pool in 0..max_pools {
        if left.textures.is_empty() {
            break;
        }
        let space = pools.next();
        let is_new = space.is_none();
        let space = space.map_or_else(|| Space::of_pool(pool), Space::clone);
        let wanted = std::mem::take(&mut left.textures);
        let (plan, refused) = space.with(textures, &wanted, bounds);
        left = refused;
        let Some(plan) = plan else {
            if is_new {
                break;
            }
            continue;
        };
        for &(index, handle) in &plan.added {
            planned.handles[index] = handle;
        }
        planned.plans.push(plan);
    }
    match left.textures.first() {
        Some(&index) => Err(refusal(textures, index, left.reason, bounds, max_pools)),
        None => Ok(planned),
    }
}

/// Why a texture has no pool, and what to do.
fn refusal(
    textures: &mut [Packed],
    index: usize,
    reason: Option<String>,
    bounds: &Bounds,
    max_pools: u32,
) -> RuntimeError {
    let (_, alone) = Space::of_pool(0).with(textures, &[index], bounds);
    RuntimeError::Limit(match (alone.reason, reason) {
        (Some(alone), _) => {
            format!("a texture alone: {alone}: bake it smaller, or open a device that has more")
        }
        (None, reason) => full(&reason.unwrap_or_default(), max_pools),
    })
}

/// What to do where textures fit the limits one by one, and not together.
fn full(reason: &str, max_pools: u32) -> String {
    let more = match max_pools < MAX_POOLS {
        true => format!("let the set have more (at most {MAX_POOLS}), "),
        false => String::new(),
    };
    format!(
        "{reason}; `max_pools` is {max_pools}: remove textures, {more}make a second set, or bake them smaller"
    )
}

/// A texture that is to be added.
#[derive(Debug, Default)]
pub(super) struct Made {
    pub(super) packed: Packed,
    /// What its lookups need code for, bits of [`vtex_format::Features`].
    pub(super) features: u32,
}

/// What textures may take together: known before all of them are packed.
#[derive(Debug)]
pub(super) struct Budget {
    /// Of the textures packed so far: words, and words and texels.
    spent: [AtomicU64; 2],
    /// The same of those that are in the set already.
    used: [u64; 2],
    most: [u64; 2],
    max_pools: u32,
    texels: TexelFormat,
}

impl Budget {
    pub(super) fn new(
        options: &TextureSetOptions,
        bounds: &Bounds,
        used: &SetBytes,
        texels: TexelFormat,
    ) -> Self {
        let max_pools = options.most_pools();
        let words = bounds.buffer_bytes.saturating_mul(u64::from(max_pools));
        Self {
            spent: [0, 0].map(AtomicU64::new),
            used: [used.words, used.words + used.texels],
            most: [words, options.max_bytes],
            max_pools,
            texels,
        }
    }

    /// What `pack` makes; nothing where textures are too many already, which [`Budget::check`] tells.
    ///
    /// # Errors
    /// Those of `pack`.
    pub(super) fn spend<E>(&self, pack: impl FnOnce() -> Result<Made, E>) -> Result<Made, E> {
        if self.passed().is_some() {
            return Ok(Made::default());
        }
        let made = pack()?;
        let words = made.packed.word_bytes() as u64;
        let all = words + self.texels.bytes(texels_of(&made.packed));
        for (spent, bytes) in self.spent.iter().zip([words, all]) {
            spent.fetch_add(bytes, Ordering::Relaxed);
        }
        Ok(made)
    }

    /// Which of the two is passed, and the bytes so far.
    fn passed(&self) -> Option<(usize, u64)> {
        let bytes = |index: usize| {
            let spent = self.spent[index].load(Ordering::Relaxed);
            self.used[index].saturating_add(spent)
        };
        let all = [0, 1].map(|index| (index, bytes(index)));
        all.into_iter()
            .find(|&(index, bytes)| bytes > self.most[index])
    }

    pub(super) fn check(&self) -> Result<(), RuntimeError> {
        let Some((index, bytes)) = self.passed() else {
            return Ok(());
        };
        let most = self.most[index];
        Err(RuntimeError::Limit(match index {
            0 => full(
                &format!(
                    "words of {bytes} bytes or more, and all pools hold {most} (the device's \
                     max_storage_buffer_binding_size and max_buffer_size, and `pool_bytes`)"
                ),
                self.max_pools,
            ),
            _ => format!(
                "textures of {bytes} bytes or more, and `max_bytes` is {most}: remove textures, or allow more"
            ),
        }))
    }
}
