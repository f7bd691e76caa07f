//! Budgets for reading files that nobody vouches for.

/// Upper bounds that reading checks before it allocates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Raw bytes of all sections together.
    pub total_raw_bytes: u64,
    /// Raw bytes of `META`.
    pub meta_bytes: u64,
    /// Raw bytes of `PROV`.
    pub provenance_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            total_raw_bytes: 1 << 30,
            meta_bytes: 1 << 20,
            provenance_bytes: 64 << 20,
        }
    }
}
