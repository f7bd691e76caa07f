//! Collects warnings while the drawing is made: what was approximated or left out.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use vtex_format::{Warning, WarningCode};

/// A warning without an area. `element` is an `id` and may be empty.
pub(crate) fn plain(
    code: WarningCode,
    feature: &str,
    element: &str,
    message: impl Into<String>,
) -> Warning {
    Warning {
        code,
        feature: feature.to_owned(),
        element: element.to_owned(),
        message: message.into(),
        area: 0.0,
    }
}

/// Warnings, in the order in which each was first reported.
///
/// They are shared by reference and locked because usvg's hooks are `Fn + Sync`. All reports come
/// from one thread, in document order, so their order is the same for every bake.
#[derive(Debug, Default)]
pub(crate) struct Warnings(Mutex<Vec<Warning>>);

impl Warnings {
    /// Adds one warning without an area, see [`plain`].
    pub(crate) fn push(
        &self,
        code: WarningCode,
        feature: &str,
        element: &str,
        message: impl Into<String>,
    ) {
        self.add(plain(code, feature, element, message));
    }

    /// Adds one warning.
    pub(crate) fn add(&self, warning: Warning) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(warning);
    }

    /// The list without repetitions. A repeated warning covers the sum of the areas.
    pub(crate) fn into_list(self) -> Vec<Warning> {
        let list = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut places = BTreeMap::new();
        let mut told: Vec<Warning> = Vec::new();
        for warning in list {
            let key = (
                warning.code as u32,
                warning.feature.clone(),
                warning.element.clone(),
                warning.message.clone(),
            );
            let place = *places.entry(key).or_insert(told.len());
            match told.get_mut(place) {
                Some(first) => first.area = (first.area + warning.area).min(1.0),
                None => told.push(warning),
            }
        }
        told
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_go_and_the_order_stays() {
        let warnings = Warnings::default();
        for (feature, area) in [("mask", 0.25), ("filter", 0.5), ("mask", 0.125)] {
            warnings.add(Warning {
                code: WarningCode::RasterPatch,
                feature: feature.into(),
                element: "a".into(),
                message: "m".into(),
                area,
            });
        }
        let list = warnings.into_list().into_iter();
        let found: Vec<_> = list.map(|w| (w.feature, w.area)).collect();
        assert_eq!(found, [("mask".into(), 0.375), ("filter".into(), 0.5)]);
    }
}
