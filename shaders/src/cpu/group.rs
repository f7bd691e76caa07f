//! Twin of `vtex/group_frames.wgsl`, `vtex/tone_encoded.wgsl` and `vtex/tone_linear.wgsl`: groups
//! and masks.

use super::blend::blend;
use super::color::{decode_premultiplied, encode_premultiplied};
use super::frames::Frames;
use crate::layout::{item, mask};

/// Coefficients of Rec. 709, as resvg has them.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// How a walk keeps colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// sRGB-encoded, as they are composited.
    Encoded,
    /// In linear light, in which ramps average them.
    Linear,
}

impl Tone {
    fn encoded(self, color: [f32; 4]) -> [f32; 4] {
        match self {
            Self::Encoded => color,
            Self::Linear => encode_premultiplied(color),
        }
    }

    fn linear(self, color: [f32; 4]) -> [f32; 4] {
        match self {
            Self::Encoded => decode_premultiplied(color),
            Self::Linear => color,
        }
    }

    /// From encoded.
    fn of(self, encoded: [f32; 4]) -> [f32; 4] {
        match self {
            Self::Encoded => encoded,
            Self::Linear => decode_premultiplied(encoded),
        }
    }
}

/// Whether the walk is to pass over what follows the control item.
pub(super) fn group(frames: &mut Frames, item: [u32; 4], tone: Tone) -> bool {
    match item[3] & item::CONTROL_MASK {
        item::OPEN => {
            open(frames, item[0] != 0);
            false
        }
        item::CLOSE => {
            close(frames, item, tone);
            false
        }
        _ => mask_ends(frames, item[0], tone),
    }
}

fn open(frames: &mut Frames, isolated: bool) {
    frames.push_group();
    frames.share = 1.0;
    frames.weight = 1.0;
    if isolated {
        frames.color = [0.0; 4];
    }
}

fn close(frames: &mut Frames, item: [u32; 4], tone: Tone) {
    let group = frames.color;
    let Some(frame) = frames.pop() else {
        return;
    };
    let weight = f32::from_bits(item[0]) * frame.weight;
    frames.share = frame.share;
    frames.color = if item[2] != 0 {
        over(item[1], frame.color, group.map(|c| weight * c), tone)
    } else {
        mix(frame.color, group, weight, tone)
    };
}

/// An isolated group over what lies behind it.
fn over(mode: u32, behind: [f32; 4], group: [f32; 4], tone: Tone) -> [f32; 4] {
    if group[3] <= 0.0 {
        return behind;
    }
    if behind[3] <= 0.0 {
        return group;
    }
    let back = tone.encoded(behind);
    tone.of(blend(mode, back, tone.encoded(group)))
}

fn mix(behind: [f32; 4], group: [f32; 4], weight: f32, tone: Tone) -> [f32; 4] {
    if weight >= 1.0 {
        return group;
    }
    let [back, front] = [behind, group].map(|color| tone.encoded(color));
    tone.of(std::array::from_fn(|i| {
        (1.0 - weight) * back[i] + weight * front[i]
    }))
}

fn mask_ends(frames: &mut Frames, kind: u32, tone: Tone) -> bool {
    let content = frames.color;
    let luminance = |[r, g, b, _]: [f32; 4]| r * LUMINANCE[0] + g * LUMINANCE[1] + b * LUMINANCE[2];
    let shown = match kind {
        mask::LUMINANCE => luminance(tone.encoded(content)),
        mask::LINEAR_LUMINANCE => luminance(tone.linear(content)),
        _ => content[3],
    };
    let Some(frame) = frames.pop() else {
        return false;
    };
    frames.color = frame.color;
    frames.share = frame.share;
    let weight = frame.weight * shown;
    let nothing = weight <= 0.0;
    frames.weight = if nothing { 1.0 } else { weight };
    nothing
}
