//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/mapping_inset
//!use vtex/lookup
//!use vtex/cell
//!use vtex/cell_level
//!use vtex/samples
//!use vtex/resolved
//!use vtex/paint
//!use vtex/lists
// The mean of what the cells show to a footprint's samples. Each pass takes the samples in one cell of
// the packed words, or in a square around it that shows the same, or those beyond one side of the
// canvas, which do not count. The first pass is that of the lookup's own place, and mostly the only one.

// Farther than any place in cells, and still finite by the number of samples a cell.
const VTEX_PICTURE_FAR: f32 = 1e24;
// By how much of its side the list of a cell goes beyond it.
const VTEX_PICTURE_OVERLAP: f32 = f32(VTEX_CELL_OVERLAP) / 16.0;
// How wide cells are at least, in what the samples of a footprint may be away from its centre.
const VTEX_PICTURE_WIDTHS: f32 = 2.0;
// Places are kept three halves of a unit inside the canvas and samples count from one unit on: rounding
// puts no place beyond it.
const VTEX_PICTURE_INSIDE: f32 = 2.0 / 3.0;
// What of its side a cell's clearance is counted in.
const VTEX_PICTURE_PART: f32 = 1.0 / f32(VTEX_CELL_CLEARANCE_PARTS);

// A footprint and the canvas, in cells, from the corner of the cell that the lookup's place lies in.
struct VtexPictureCanvas {
    // That corner.
    home: vec2f,
    centre: vec2f,
    // No sample lies farther from the centre.
    extent: vec2f,
    // Cells are no smaller than the footprint: no more than 2 to this along one of the file's.
    most: i32,
    // As far as samples count.
    low: vec2f,
    high: vec2f,
}

struct VtexPicturePass {
    word: u32,
    // The corner of the file's cell.
    cell: vec2f,
    // The samples between these take it.
    low: vec2f,
    high: vec2f,
    // All samples do: no need to look for them.
    whole: bool,
    // They lie beyond the canvas.
    beyond: bool,
}

// The pass for what lies at `place`.
fn vtex_picture_pass(vt: VtexTexture, canvas: VtexPictureCanvas, place: vec2f) -> VtexPicturePass {
    let found = vtex_cell_level(vt, place + canvas.home, canvas.most);
    let side = vtex_cell_side(found);
    let word = found.word;
    let corner = found.at * side - canvas.home;
    let cell = vtex_cell_corner(vt, place + canvas.home) - canvas.home;
    // A list serves what is near, as far as its cell of the file goes.
    let listed = (word >> VTEX_CELL_TAG_SHIFT) >= VTEX_CELL_LIST;
    let clearance = f32(bitcast<i32>((word >> VTEX_CELL_CLEARANCE_SHIFT) & VTEX_CELL_CLEARANCE_MASK));
    let around = select(clearance * VTEX_PICTURE_PART, VTEX_PICTURE_OVERLAP, listed) * side;
    let bounds_low = select(canvas.low, max(canvas.low, cell), vec2<bool>(listed));
    let bounds_high = select(canvas.high, min(canvas.high, cell + 1.0), vec2<bool>(listed));
    let low = max(corner - around, bounds_low);
    let high = min(corner + around + side, bounds_high);
    let whole = all(low <= canvas.centre - canvas.extent) && all(canvas.centre + canvas.extent < high);
    let before = place < canvas.low;
    let behind = place >= canvas.high;
    let beyond = any(before) || any(behind);
    let beyond_low = select(vec2f(-VTEX_PICTURE_FAR), canvas.high, behind);
    let beyond_high = select(vec2f(VTEX_PICTURE_FAR), canvas.low, before);
    return VtexPicturePass(
        word,
        cell,
        select(low, beyond_low, vec2<bool>(beyond)),
        select(high, beyond_high, vec2<bool>(beyond)),
        whole,
        beyond,
    );
}

// Linear light, premultiplied.
fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> vec4f {
    // Of a scene's textures some may be looked up in points.
    let axes = select(vec4f(0.0), lookup.axes, vtex_settings_has(vt, VTEX_FEATURE_FOOTPRINT));
    let p = lookup.uv * vt.cell_from_uv.xy + vt.cell_from_uv.zw;
    let home = floor(p);
    let centre = p - home;
    let inset = VTEX_PICTURE_INSIDE * vtex_mapping_inset(vt) * vt.cell_from_uv.xy;
    let low = vt.cell_from_uv.zw + inset - home;
    let high = vt.cell_from_uv.xy - 2.0 * inset + low;
    let extent = vtex_rows_extent(axes);
    // The power of two above the width. Textures with groups have no levels.
    let width = VTEX_PICTURE_WIDTHS * max(extent.x, extent.y);
    let measure = select(width, 0.0, vtex_settings_has(vt, VTEX_FEATURE_GROUPS));
    let most = 126 - bitcast<i32>(bitcast<u32>(measure) >> VTEX_CELL_EXPONENT_SHIFT);
    var canvas = VtexPictureCanvas(home, centre, extent, most, low, high);
    // Ahead of the loop, not as its first turn: a tenth to a seventh faster on a card.
    var here = vtex_picture_pass(vt, canvas, centre);
    // Most footprints lie in one paint.
    let tag = here.word >> VTEX_CELL_TAG_SHIFT;
    if here.whole && tag < VTEX_CELL_LIST {
        if tag == VTEX_CELL_SOLID {
            return vtex_paint_linear(vt, here.word & VTEX_CELL_PAINT_MASK, lookup.uv);
        }
        return vec4f(0.0);
    }
    let halvings = vt.features >> VTEX_HEADER_SAMPLES_SHIFT;
    var rows = vtex_rows(centre, axes, vtex_rows_phase(p, axes), halvings);
    var sum = vec4f(0.0);
    var count = 0.0;
    var live = vtex_rows_every(rows.samples);
    var own = 0u;
    for (var i = 0u; i <= VTEX_ROWS_SAMPLES; i += 1u) {
        let high = vec2f(here.high.x, select(here.high.y, here.low.y, here.whole));
        // Rounding must not leave out the one that the pass is for.
        var mask = (vtex_rows_within(rows, here.low, high) | own) & live;
        mask = select(mask, live, here.whole);
        let samples = vtex_samples_of_rows(vt, lookup, rows, here.cell, centre);
        let word = select(here.word, VTEX_CELL_EMPTY, here.beyond);
        let resolved = vtex_lists(vt, lookup, word, samples, mask);
        let done = select(resolved.done, mask, here.beyond);
        sum += resolved.sum;
        count += select(vtex_resolved_count(done), 0.0, here.beyond);
        live &= ~done;
        if live == 0u {
            if count > 0.0 {
                break;
            }
            // None is on the canvas: the lookup's own place stands for all.
            rows = vtex_rows(centre, vec4f(0.0), VtexRowsPhase(), halvings);
            canvas.low = vec2f(-VTEX_PICTURE_FAR);
            canvas.high = vec2f(VTEX_PICTURE_FAR);
            live = vtex_rows_every(rows.samples);
        }
        let next = firstTrailingBit(live);
        own = 1u << next;
        here = vtex_picture_pass(vt, canvas, vtex_rows_place(rows, next));
    }
    return sum / max(count, 1.0);
}
