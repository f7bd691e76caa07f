//!use core/layout
//!use vtex/frames
//!use vtex/tone
//!use vtex/blend
// Groups and masks: what a walk does where they begin and end.

// Whether the walk is to pass over what follows the control item.
fn vtex_group(frames: ptr<function, VtexFrames>, item: vec4u) -> bool {
    switch item.w & VTEX_ITEM_CONTROL_MASK {
        case VTEX_ITEM_OPEN: {
            vtex_group_open(frames, item.x != 0u);
            return false;
        }
        case VTEX_ITEM_CLOSE: {
            vtex_group_close(frames, item);
            return false;
        }
        default: {
            return vtex_group_mask(frames, item.x);
        }
    }
}

fn vtex_group_open(frames: ptr<function, VtexFrames>, isolated: bool) {
    let frame = VtexFrame((*frames).color, 0u, (*frames).share, (*frames).weight);
    (*frames).list[(*frames).depth] = frame;
    (*frames).depth += 1u;
    (*frames).ends = 0u;
    (*frames).share = 1.0;
    (*frames).weight = 1.0;
    (*frames).color = select((*frames).color, vec4f(0.0), isolated);
}

fn vtex_group_close(frames: ptr<function, VtexFrames>, item: vec4u) {
    let group = (*frames).color;
    let frame = vtex_frames_pop(frames);
    let weight = bitcast<f32>(item.x) * frame.weight;
    (*frames).share = frame.share;
    if item.z != 0u {
        (*frames).color = vtex_group_over(item.y, frame.color, weight * group);
    } else {
        (*frames).color = vtex_group_mix(frame.color, group, weight);
    }
}

// An isolated group over what lies behind it.
fn vtex_group_over(mode: u32, behind: vec4f, group: vec4f) -> vec4f {
    // Where one side alone shows, no mode changes it.
    if group.a <= 0.0 {
        return behind;
    }
    if behind.a <= 0.0 {
        return group;
    }
    let back = vtex_tone_encoded(behind);
    return vtex_tone_of(vtex_blend(mode, back, vtex_tone_encoded(group)));
}

fn vtex_group_mix(behind: vec4f, group: vec4f, weight: f32) -> vec4f {
    if weight >= 1.0 {
        return group;
    }
    let back = vtex_tone_encoded(behind);
    return vtex_tone_of((1.0 - weight) * back + weight * vtex_tone_encoded(group));
}

// Coefficients of Rec. 709, as resvg has them.
fn vtex_group_luminance(color: vec4f) -> f32 {
    return dot(color.rgb, vec3f(0.2126, 0.7152, 0.0722));
}

fn vtex_group_mask(frames: ptr<function, VtexFrames>, kind: u32) -> bool {
    let content = (*frames).color;
    var shown = content.a;
    if kind == VTEX_MASK_LUMINANCE {
        shown = vtex_group_luminance(vtex_tone_encoded(content));
    } else if kind == VTEX_MASK_LINEAR_LUMINANCE {
        shown = vtex_group_luminance(vtex_tone_linear(content));
    }
    let frame = vtex_frames_pop(frames);
    (*frames).color = frame.color;
    (*frames).share = frame.share;
    let weight = frame.weight * shown;
    let nothing = weight <= 0.0;
    (*frames).weight = select(weight, 1.0, nothing);
    return nothing;
}
