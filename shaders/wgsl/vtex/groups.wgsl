//!use core/color
//!use core/layout
//!use vtex/key
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/answer
//!use vtex/edge
//!use vtex/source
//!use vtex/blend
// Lists that hold groups, whose items lie back to front: one walk, sRGB-encoded, with what lies
// behind each open group on a stack.

// Of an open group.
struct VtexSaved {
    // What lies behind it.
    color: vec4f,
    // What its masks make of its opacity.
    weight: f32,
}

struct VtexStack {
    // So far, premultiplied.
    color: vec4f,
    // Of masks whose group has not begun.
    weight: f32,
    depth: u32,
    saved: array<VtexSaved, VTEX_KEY_FRAMES>,
}

// What the list shows to those samples of `live` that do at every edge as the first of them does.
fn vtex_groups(
    vt: VtexTexture, lookup: VtexLookup, word: u32, samples: VtexSamples, live: u32,
) -> VtexAnswer {
    let first = vt.items + (word & VTEX_CELL_PAYLOAD_MASK) * VTEX_ITEM_WORDS;
    let leader = live & (~live + 1u);
    var same = live;
    var stack: VtexStack;
    stack.weight = 1.0;
    var winding = VtexWinding();
    var walks = true;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        if !walks {
            break;
        }
        let item = vtex_word4(vt, first + i * VTEX_ITEM_WORDS);
        winding = vtex_edge_wind(samples, winding, item);
        if (item.w & VTEX_ITEM_END_BIT) != 0u {
            let covered = vtex_edge_covered(vt, samples, item, winding, same);
            let leads = (covered & leader) != 0u;
            walks = (item.w & VTEX_ITEM_LAST_BIT) == 0u;
            winding = VtexWinding();
            if (item.w & VTEX_ITEM_CONTROL_BIT) != 0u {
                var jumps = false;
                if vtex_groups_is_test(item.w) {
                    same &= select(~covered, covered, leads);
                    jumps = leads == ((item.w & VTEX_ITEM_OPAQUE_BIT) != 0u);
                } else {
                    jumps = vtex_groups_control(&stack, item);
                }
                if jumps {
                    let over = item.w & VTEX_ITEM_INDEX_MASK;
                    walks = over != 0u;
                    i += over;
                }
            } else {
                same &= select(~covered, covered, leads);
                if leads {
                    let uv = vtex_samples_uv(samples, same);
                    let shown = vtex_source(vt, lookup, item.w, uv).encoded;
                    stack.color = shown + (1.0 - shown.a) * stack.color;
                }
            }
        }
    }
    return vtex_answer(vtex_color_decode_premultiplied(stack.color), same);
}

// Whether a control item with this last word is a test or a jump.
fn vtex_groups_is_test(tail: u32) -> bool {
    let op = tail & VTEX_ITEM_CONTROL_MASK;
    return (tail & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_CURVES || op == VTEX_ITEM_JUMP;
}

// Whether the walk is to pass over what follows the control item.
fn vtex_groups_control(stack: ptr<function, VtexStack>, item: vec4u) -> bool {
    switch item.w & VTEX_ITEM_CONTROL_MASK {
        case VTEX_ITEM_OPEN: {
            vtex_groups_open(stack, item.x != 0u);
            return false;
        }
        case VTEX_ITEM_CLOSE: {
            vtex_groups_close(stack, item);
            return false;
        }
        default: {
            return vtex_groups_mask(stack, item.x);
        }
    }
}

fn vtex_groups_open(stack: ptr<function, VtexStack>, isolated: bool) {
    (*stack).saved[(*stack).depth] = VtexSaved((*stack).color, (*stack).weight);
    (*stack).depth += 1u;
    (*stack).weight = 1.0;
    (*stack).color = select((*stack).color, vec4f(0.0), isolated);
}

fn vtex_groups_pop(stack: ptr<function, VtexStack>) -> VtexSaved {
    (*stack).depth -= 1u;
    return (*stack).saved[(*stack).depth];
}

fn vtex_groups_close(stack: ptr<function, VtexStack>, item: vec4u) {
    let group = (*stack).color;
    let saved = vtex_groups_pop(stack);
    let weight = bitcast<f32>(item.x) * saved.weight;
    if item.z != 0u {
        (*stack).color = vtex_groups_over(item.y, saved.color, weight * group);
    } else if weight < 1.0 {
        (*stack).color = (1.0 - weight) * saved.color + weight * group;
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

fn vtex_groups_mask(stack: ptr<function, VtexStack>, kind: u32) -> bool {
    let content = (*stack).color;
    var shown = content.a;
    if kind == VTEX_MASK_LUMINANCE {
        shown = vtex_groups_luminance(content);
    } else if kind == VTEX_MASK_LINEAR_LUMINANCE {
        shown = vtex_groups_luminance(vtex_color_decode_premultiplied(content));
    }
    let saved = vtex_groups_pop(stack);
    (*stack).color = saved.color;
    let weight = saved.weight * shown;
    let nothing = weight <= 0.0;
    (*stack).weight = select(weight, 1.0, nothing);
    return nothing;
}
