//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/mapping_inset
//!use vtex/lookup
//!use vtex/cell
//!use vtex/samples
//!use vtex/resolved
//!use vtex/lists
// The mean of what the cells show to a footprint's samples. Each pass takes the samples in one fine
// cell, or in a square of such as show the same, or those beyond one side of the canvas, which do not
// count. The first pass is that of the lookup's own place, and mostly the only one.

// Farther than any place in cells.
const VTEX_PICTURE_FAR: f32 = 1e30;
// By how much of its side the list of a fine cell goes beyond it.
const VTEX_PICTURE_OVERLAP: f32 = f32(VTEX_CELL_OVERLAP) / 16.0;

// Linear light, premultiplied.
fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> vec4f {
    // Of a scene's textures some may be looked up in points.
    let axes = select(vec4f(0.0), lookup.axes, vtex_settings_has(vt, VTEX_FEATURE_FOOTPRINT));
    let p = lookup.uv * vt.cell_from_uv.xy + vt.cell_from_uv.zw;
    let home = floor(p);
    let centre = p - home;
    let extent = vtex_rows_extent(axes);
    var rows = vtex_rows(centre, axes, vtex_rows_phase(p, axes));
    // As far as places are kept inside it.
    let inset = vtex_mapping_inset(vt) * vt.cell_from_uv.xy;
    var canvas_low = vt.cell_from_uv.zw + inset - home;
    var canvas_high = vt.cell_from_uv.xy - 2.0 * inset + canvas_low;
    var sum = vec4f(0.0);
    var count = 0.0;
    var live = VTEX_SAMPLES_EVERY;
    var place = centre;
    var own = 0u;
    for (var i = 0u; i <= VTEX_ROWS_SAMPLES; i += 1u) {
        let fine = vtex_cell_fine(vt, place + home);
        let word = vtex_cell_word(vt, fine);
        let tag = word >> VTEX_CELL_TAG_SHIFT;
        let corner = fine * vt.fine.w - home;
        let cell = floor(fine * vt.fine.w) - home;
        // A list serves what is near, as far as its cell of the file goes.
        let listed = tag >= VTEX_CELL_LIST;
        let clearance = f32(bitcast<i32>((word >> VTEX_CELL_CLEARANCE_SHIFT) & VTEX_CELL_CLEARANCE_MASK));
        let around = select(clearance, VTEX_PICTURE_OVERLAP, listed) * vt.fine.w;
        let bounds_low = select(canvas_low, max(canvas_low, cell), vec2<bool>(listed));
        let bounds_high = select(canvas_high, min(canvas_high, cell + 1.0), vec2<bool>(listed));
        var low = max(corner - around, bounds_low);
        var high = min(corner + around + vt.fine.w, bounds_high);
        // All samples are in one square: no need to look for them.
        let whole = all(low <= centre - extent) && all(centre + extent < high);
        let before = place < canvas_low;
        let behind = place >= canvas_high;
        let beyond = any(before) || any(behind);
        low = select(low, select(vec2f(-VTEX_PICTURE_FAR), canvas_high, behind), vec2<bool>(beyond));
        high = select(high, select(vec2f(VTEX_PICTURE_FAR), canvas_low, before), vec2<bool>(beyond));
        high.y = select(high.y, low.y, whole);
        // Rounding must not leave out the one that the pass is for.
        var mask = (vtex_rows_within(rows, low, high) | own) & live;
        mask = select(mask, live, whole);
        let samples = vtex_samples_of_rows(vt, lookup, rows, cell, centre);
        let resolved = vtex_lists(vt, lookup, select(word, VTEX_CELL_EMPTY, beyond), samples, mask);
        let done = select(resolved.done, mask, beyond);
        sum += resolved.sum;
        count += select(vtex_resolved_count(done), 0.0, beyond);
        live &= ~done;
        if live == 0u {
            if count > 0.0 {
                break;
            }
            // None is on the canvas: the lookup's own place stands for all.
            rows = vtex_rows(centre, vec4f(0.0), VtexRowsPhase());
            canvas_low = vec2f(-VTEX_PICTURE_FAR);
            canvas_high = vec2f(VTEX_PICTURE_FAR);
            live = VTEX_SAMPLES_EVERY;
        }
        let next = firstTrailingBit(live);
        own = 1u << next;
        place = vtex_rows_place(rows, next);
    }
    return sum / max(count, 1.0);
}
