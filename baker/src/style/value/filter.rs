//! `blur()` and `drop-shadow()` as filter elements: usvg's own cut the shadow at half the box, and
//! resvg lightens shadows that are not in linear light.

/// Deviations that a Gaussian is drawn for on each side.
const REACH: f64 = 3.0;

/// A part of a list of filters.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::style) enum Step {
    /// As usvg reads it.
    Text(String),
    Blur(f64),
    Shadow(Shadow),
}

/// What a drop shadow is made of, in user units.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::style) struct Shadow {
    pub(in crate::style) offset: [f64; 2],
    pub(in crate::style) deviation: f64,
    /// In a spelling that usvg knows.
    pub(in crate::style) color: String,
}

impl Step {
    /// How far the step reaches over what it is given.
    pub(in crate::style) fn reach(&self) -> f64 {
        match self {
            Self::Text(_) => 0.0,
            Self::Blur(deviation) => REACH * deviation,
            Self::Shadow(shadow) => {
                let [dx, dy] = shadow.offset.map(f64::abs);
                REACH * shadow.deviation + dx.max(dy)
            }
        }
    }
}

/// The steps as one attribute, where usvg draws all of them rightly.
pub(in crate::style) fn plain(steps: &[Step]) -> Option<String> {
    let texts: Option<Vec<&str>> = steps
        .iter()
        .map(|step| match step {
            Step::Text(text) => Some(text.as_str()),
            Step::Blur(_) | Step::Shadow(_) => None,
        })
        .collect();
    Some(texts?.join(" "))
}

/// The primitives of a drop shadow. The first and the last one take the attributes `input` and
/// `result`; `flood` are those of the colour.
pub(in crate::style) fn primitives(
    input: &str,
    flood: &str,
    deviation: &str,
    [dx, dy]: &[String; 2],
    result: &str,
) -> String {
    // Names are looked up backwards, so each shadow finds its own.
    let [source, shadow] = ["vtex-style-source", "vtex-style-shadow"];
    [
        format!("<feOffset {input} result=\"{source}\"/>"),
        format!("<feGaussianBlur in=\"{source}\" stdDeviation=\"{deviation}\"/>"),
        format!("<feOffset dx=\"{dx}\" dy=\"{dy}\" result=\"{shadow}\"/>"),
        format!("<feFlood {flood}/><feComposite in2=\"{shadow}\" operator=\"in\"/>"),
        format!("<feMerge {result}><feMergeNode/><feMergeNode in=\"{source}\"/></feMerge>"),
    ]
    .concat()
}
