//! Why a subtree is a patch, in words for its warning.

use super::embedded;
use crate::svg::Subtree;

/// Why resvg paints the subtree.
pub(super) fn of(subtree: &Subtree<'_>) -> &'static str {
    match subtree.feature {
        "image" if !embedded::is_upright(subtree) => "it is rotated or skewed",
        "image" => "it has too many texels to keep, alone or together with other images",
        "filter" => "it is no plain change of the colours of shapes",
        "pattern" => "its tiles need too many path elements, or are nested too deeply",
        "linearGradient" | "radialGradient" => "it has too many stops",
        "nesting" => "groups, clips and masks are nested too deeply",
        _ => "no shape can show it",
    }
}
