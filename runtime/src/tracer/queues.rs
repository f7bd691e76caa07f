//! Which kernel looks up which texture.

use std::collections::BTreeMap;

use vtex_format::VtexFile;
use vtex_shaders::{kernel_key, spec_key};

use crate::batch::trusted_spirv;
use crate::{LoadOptions, Trust};

/// Most queues. Each has room for a lookup of every path, 48 bytes; where textures have more kernel keys
/// than this, the rarest share the text of all their features.
const MAX_QUEUES: usize = 16;
/// Most textures that the kernels in their files look up: each takes a queue of its own.
const MAX_STORED: usize = 8;

/// The queues of lookups and what each texture belongs to.
#[derive(Debug, Default)]
pub(super) struct TextureQueues {
    pub(super) queues: Vec<TextureQueue>,
    /// The queue of each texture.
    pub(super) of_texture: Vec<u32>,
    /// Why files' kernels are not used though asked for, or differ from what their keys make.
    pub(super) notices: Vec<String>,
}

/// What answers a queue.
#[derive(Debug)]
pub(super) struct TextureQueue {
    /// Those of its textures together.
    pub(super) features: u32,
    /// The kernel of the one texture it is for, before its text.
    pub(super) stored: Option<StoredKernel>,
}

/// A kernel that a file carries.
#[derive(Debug)]
pub(super) struct StoredKernel {
    pub(super) texture: usize,
    pub(super) spirv: Vec<u32>,
}

impl TextureQueues {
    pub(super) fn new(textures: &[(VtexFile, LoadOptions)], trust: Trust) -> Self {
        let mut made = Self::default();
        let mut by_text: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        made.of_texture = vec![0; textures.len()];
        let mut left_out = 0;
        for (index, (file, options)) in textures.iter().enumerate() {
            let features = kernel_key(&spec_key(file, &options.pack)).features;
            let is_full = made.queues.len() >= MAX_STORED;
            left_out += usize::from(is_full && trust == Trust::File);
            let is_stored = trust == Trust::File && !is_full;
            let trusted = is_stored.then(|| made.trusted(file, options, index));
            let Some(spirv) = trusted.flatten() else {
                by_text.entry(features).or_default().push(index);
                continue;
            };
            made.of_texture[index] = made.next();
            made.queues.push(TextureQueue {
                features,
                stored: Some(StoredKernel {
                    texture: index,
                    spirv,
                }),
            });
        }
        if left_out > 0 {
            made.notices.push(format!(
                "the kernels of {left_out} files are not used: {MAX_STORED} textures have theirs"
            ));
        }
        made.share(by_text);
        made
    }

    fn trusted(
        &mut self,
        file: &VtexFile,
        options: &LoadOptions,
        index: usize,
    ) -> Option<Vec<u32>> {
        let mut notices = Vec::new();
        let key = spec_key(file, &options.pack);
        let spirv = trusted_spirv(file, &key, Trust::File, &mut notices);
        let spirv = spirv.map(<[u32]>::to_vec);
        let named = notices
            .iter()
            .map(|text| format!("texture {index}: {text}"));
        self.notices.extend(named);
        spirv
    }

    /// A queue for each key, those of most textures first; the last one takes all that are left.
    fn share(&mut self, by_text: BTreeMap<u32, Vec<usize>>) {
        let mut keys: Vec<(u32, Vec<usize>)> = by_text.into_iter().collect();
        // Stable, so equal counts stay in the order of their features.
        keys.sort_by_key(|(_, textures)| std::cmp::Reverse(textures.len()));
        for (features, textures) in keys {
            let is_new = self.queues.len() < MAX_QUEUES;
            if is_new {
                self.queues.push(TextureQueue {
                    features,
                    stored: None,
                });
            }
            let queue = self.next() - 1;
            if let Some(last) = self.queues.last_mut() {
                last.features |= features;
            }
            for texture in textures {
                self.of_texture[texture] = queue;
            }
        }
    }

    /// The number of the queue that is made next.
    fn next(&self) -> u32 {
        u32::try_from(self.queues.len()).unwrap_or(u32::MAX)
    }
}
