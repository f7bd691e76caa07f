//! Collects what was approximated or left out while the drawing is made.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use vtex_format::{Warning, WarningCode};

/// Warnings in the order of their first report. Shared by reference, because usvg's hooks are
/// `Fn + Sync`; pushing happens in document order on one thread, so the order is deterministic.
#[derive(Debug, Default)]
pub(crate) struct Warnings(Mutex<Vec<Warning>>);

impl Warnings {
    /// Adds one warning; `element` may be empty.
    pub(crate) fn push(
        &self,
        code: WarningCode,
        feature: &str,
        element: &str,
        message: impl Into<String>,
    ) {
        self.add(Warning {
            code,
            feature: feature.to_owned(),
            element: element.to_owned(),
            message: message.into(),
        });
    }

    /// Adds one warning.
    pub(crate) fn add(&self, warning: Warning) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(warning);
    }

    /// The list without repetitions.
    pub(crate) fn into_list(self) -> Vec<Warning> {
        let list = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut seen = BTreeSet::new();
        list.into_iter()
            .filter(|w| {
                let key = (
                    w.code as u32,
                    w.feature.clone(),
                    w.element.clone(),
                    w.message.clone(),
                );
                seen.insert(key)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_go_and_the_order_stays() {
        let warnings = Warnings::default();
        for feature in ["mask", "filter", "mask"] {
            warnings.push(WarningCode::RasterPatch, feature, "a", "m");
        }
        let features: Vec<_> = warnings
            .into_list()
            .into_iter()
            .map(|w| w.feature)
            .collect();
        assert_eq!(features, ["mask", "filter"]);
    }
}
