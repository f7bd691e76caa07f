//!use core/color
//!use core/layout
//!use vtex/key
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/resolved
//!use vtex/edge
//!use vtex/brush
//!use vtex/blend
// Lists that hold groups, whose commands lie back to front: one walk, sRGB-encoded, with what lies
// behind each open group on a blend stack.

// A level of the blend stack: an open group or mask.
struct VtexBlendLevel {
    // What lies behind it.
    color: vec4f,
    // What its masks make of its opacity.
    weight: f32,
}

struct VtexBlendStack {
    // So far, premultiplied.
    color: vec4f,
    // Of masks whose group has not begun.
    weight: f32,
    depth: u32,
    levels: array<VtexBlendLevel, VTEX_KEY_BLEND_DEPTH>,
}

// What the list shows to those samples of `live` that do at every edge as the first of them does.
fn vtex_groups(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexResolved {
    let first = vt.commands + (word & VTEX_CELL_PAYLOAD_MASK) * VTEX_CMD_WORDS;
    let leader = live & (~live + 1u);
    var same = live;
    var stack: VtexBlendStack;
    stack.weight = 1.0;
    var winding = VtexWinding();
    var walks = true;
    for (var i = 0u; i < VTEX_CMD_LIMIT; i += 1u) {
        if !walks {
            break;
        }
        let command = vtex_word4(vt, first + i * VTEX_CMD_WORDS);
        winding = vtex_edge_wind(samples, winding, command);
        if (command.w & VTEX_CMD_END_BIT) != 0u {
            let covered = vtex_edge_covered(vt, samples, command, winding, same);
            let leads = (covered & leader) != 0u;
            walks = (command.w & VTEX_CMD_LAST_BIT) == 0u;
            winding = VtexWinding();
            if (command.w & VTEX_CMD_CONTROL_BIT) != 0u {
                var branches = false;
                if vtex_groups_is_branch(command.w) {
                    same &= select(~covered, covered, leads);
                    branches = leads == ((command.w & VTEX_CMD_OPAQUE_BIT) != 0u);
                } else {
                    branches = vtex_groups_control(&stack, command);
                }
                if branches {
                    let over = command.w & VTEX_CMD_INDEX_MASK;
                    walks = over != 0u;
                    i += over;
                }
            } else {
                let drawn = vtex_brush_covered(vt, samples, command.w, covered);
                let shows = (drawn & leader) != 0u;
                same &= select(~drawn, drawn, shows);
                if shows {
                    let uv = vtex_samples_uv(samples, same);
                    let brush = vtex_brush(vt, lookup, command.w, uv).encoded;
                    stack.color = brush + (1.0 - brush.a) * stack.color;
                }
            }
        }
    }
    return vtex_resolved(vtex_color_decode_premultiplied(stack.color), same);
}

// Whether a control command with this tag is a branch or a jump.
fn vtex_groups_is_branch(tag: u32) -> bool {
    let op = tag & VTEX_CMD_CONTROL_MASK;
    return (tag & VTEX_CMD_KIND_MASK) == VTEX_CMD_CURVES || op == VTEX_CMD_JUMP;
}

// Whether the walk branches over what follows the control command.
fn vtex_groups_control(stack: ptr<function, VtexBlendStack>, command: vec4u) -> bool {
    switch command.w & VTEX_CMD_CONTROL_MASK {
        case VTEX_CMD_OPEN: {
            vtex_groups_open(stack, command.x != 0u);
            return false;
        }
        case VTEX_CMD_CLOSE: {
            vtex_groups_close(stack, command);
            return false;
        }
        default: {
            return vtex_groups_mask(stack, command.x);
        }
    }
}

fn vtex_groups_open(stack: ptr<function, VtexBlendStack>, isolated: bool) {
    (*stack).levels[(*stack).depth] = VtexBlendLevel((*stack).color, (*stack).weight);
    (*stack).depth += 1u;
    (*stack).weight = 1.0;
    (*stack).color = select((*stack).color, vec4f(0.0), isolated);
}

fn vtex_groups_pop(stack: ptr<function, VtexBlendStack>) -> VtexBlendLevel {
    (*stack).depth -= 1u;
    return (*stack).levels[(*stack).depth];
}

fn vtex_groups_close(stack: ptr<function, VtexBlendStack>, command: vec4u) {
    let group = (*stack).color;
    let level = vtex_groups_pop(stack);
    let weight = bitcast<f32>(command.x) * level.weight;
    if command.z != 0u {
        (*stack).color = vtex_groups_over(command.y, level.color, weight * group);
    } else if weight < 1.0 {
        (*stack).color = (1.0 - weight) * level.color + weight * group;
    }
}

// An isolated group over what lies behind it.
fn vtex_groups_over(mode: u32, behind: vec4f, group: vec4f) -> vec4f {
    // Where one side alone shows, no mode changes it.
    if group.a <= 0.0 {
        return behind;
    }
    if behind.a <= 0.0 {
        return group;
    }
    return vtex_blend(mode, behind, group);
}

// Coefficients of Rec. 709, as resvg has them.
fn vtex_groups_luminance(color: vec4f) -> f32 {
    return dot(color.rgb, vec3f(0.2126, 0.7152, 0.0722));
}

fn vtex_groups_mask(stack: ptr<function, VtexBlendStack>, kind: u32) -> bool {
    let content = (*stack).color;
    var value = content.a;
    if kind == VTEX_MASK_LUMINANCE {
        value = vtex_groups_luminance(content);
    } else if kind == VTEX_MASK_LINEAR_LUMINANCE {
        value = vtex_groups_luminance(vtex_color_decode_premultiplied(content));
    }
    let level = vtex_groups_pop(stack);
    (*stack).color = level.color;
    let weight = level.weight * value;
    let nothing = weight <= 0.0;
    (*stack).weight = select(weight, 1.0, nothing);
    return nothing;
}
