//! Budgets for reading untrusted files.

/// Upper bounds that reading checks before it allocates. All in bytes after decompression.
///
/// The memory of a section is allocated in one piece, once its length is known to be what grid,
/// records and budgets allow. Besides that, reading takes a few bytes for each entry of the section
/// table, and 64 KiB for a bundle of several sections. In memory tiles take four thirds of
/// their stored length, `PROV` with many short strings up to eight times. The dictionaries that
/// bundles refer to are this library's own; each that was ever asked for stays in memory, 100 KiB or
/// less, at most 1.2 MiB in all.
///
/// The C library unpacks a section into that piece. The decoder in Rust (feature `ruzstd` without
/// `zstd`) first fills a buffer of its own, which takes up to twice the section's raw length; while
/// that buffer grows, it and the smaller one take up to three times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// All bundles with known sections together.
    pub total_raw_bytes: u64,
    /// `META`; at most 99 bytes today.
    pub meta_bytes: u64,
    /// `SHDR`: text and SPIR-V.
    pub shader_bytes: u64,
    /// `PROV`.
    pub provenance_bytes: u64,
}

impl Default for Limits {
    /// Generous for real art (the largest of thousands of files bakes to tens of megabytes), small
    /// beside a machine's memory, which loading takes a few times over. A texture of more than half as
    /// many words fits no storage binding of core WebGPU, 128 MiB.
    fn default() -> Self {
        Self {
            total_raw_bytes: 256 << 20,
            meta_bytes: 1 << 20,
            shader_bytes: 16 << 20,
            provenance_bytes: 64 << 20,
        }
    }
}
