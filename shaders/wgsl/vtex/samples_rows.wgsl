//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/segment
// The samples of a footprint, as seen from one cell of the file; a walk speaks of samples as bits of
// a mask. A footprint's parallelogram has rows of four samples, eight of them or fewer, and bit
// i = 4 k + j of a mask is sample j of row k. Its first axis is horizontal. The samples go down evenly from one to the next, so
// those between two heights are a range of bits; and no two have the same x.

struct VtexRows {
    // The first sample's height, from one to the next, and the inverse of that.
    y: f32,
    dy: f32,
    per_y: f32,
    // Left end of the first row, and from one row to the next.
    x: f32,
    dx: f32,
    // Width of a column.
    pitch: f32,
    // How far right in their columns the samples of the first row lie, in eighths.
    shift: i32,
    // How many there are.
    samples: i32,
}

struct VtexSamples {
    // In cells, from the corner of the cell that the lookup's centre lies in.
    rows: VtexRows,
    // From that corner to this cell's.
    cell: vec2f,
    // The lookup's place, and the extent of a cell, in uv.
    uv: vec2f,
    uv_per_cell: vec2f,
    // In units of this cell's box.
    units: VtexRows,
    // All samples lie between these, in the same units.
    left: f32,
    right: f32,
    // The lookup's centre in this cell.
    centre: vec2f,
}

// The windings of all samples about one outline: a bit of each in a word, modulo 32.
struct VtexWinding {
    low: vec4u,
    high: u32,
}

const VTEX_SAMPLES_EVERY: u32 = VTEX_ROWS_EVERY;

// A row and a column are no smaller, in cells.
const VTEX_ROWS_LEAST: f32 = 1e-12;
// How far a box may reach beyond its sides, in cells: as much as rounding may take. A canvas ends where
// an image that fills it does.
const VTEX_ROWS_SLACK: f32 = 1e-6;
// The samples of a row, and the columns that they lie in (docs/decisions/0016).
const VTEX_ROWS_ROW: vec4f = vec4f(0.0, 1.0, 2.0, 3.0);
const VTEX_ROWS_COLUMN: vec4f = vec4f(2.0, 0.0, 3.0, 1.0);

// No sample lies farther from the centre, in cells, along x and along y. A bound without a root: the
// sides of a parallelogram of one covariance add up to no more than sqrt(2) times what theirs do.
fn vtex_rows_extent(axes: vec4f) -> vec2f {
    return (abs(axes.xy) + abs(axes.zw)) * vec2f(0.7072, 0.5);
}

// The samples move from pixel to pixel. A line that runs along x or y, or by simple steps like one to
// two, meets all pixels in the same places: with the same samples in each it would have too much or too
// little of its ink all along.
struct VtexRowsPhase {
    // In parts of the room that each sample has for itself in x and in y.
    moved: vec2f,
    // By how many eighths of a column all rows are shifted, within their columns.
    shift: i32,
}

// `p` is the lookup's place in cells.
fn vtex_rows_phase(p: vec2f, axes: vec4f) -> VtexRowsPhase {
    let extent = max(abs(axes.xy) + abs(axes.zw), vec2f(VTEX_ROWS_LEAST));
    // Divided by the power of two below: exactly, and so alike everywhere. From one pixel to the next
    // it grows by 1 to 2 at most.
    let exponent = bitcast<vec2u>(extent) & vec2u(0x7f800000u);
    let t = p * bitcast<vec2f>(vec2u(0x7f000000u) - exponent);
    // None where there is no extent.
    let moved = fract(vec2f(0.313, 0.322) * t.yx + 0.5) - 0.5;
    return VtexRowsPhase(moved, i32(8.0 * fract(0.306 * t.x + 0.482 * t.y)));
}

// So many samples have all these bits; they are 32 or a smaller power of two.
fn vtex_rows_every(samples: i32) -> u32 {
    return VTEX_ROWS_EVERY >> (VTEX_ROWS_SAMPLES - bitcast<u32>(samples));
}

// About `centre`; `axes` are those of the footprint, and it has 2 to `halvings` samples.
fn vtex_rows(centre: vec2f, axes: vec4f, phase: VtexRowsPhase, halvings: u32) -> VtexRows {
    let xy = axes.x * axes.y + axes.z * axes.w;
    let yy = axes.y * axes.y + axes.w * axes.w;
    // The parallelogram with a horizontal axis whose covariance is the same.
    let level = yy <= VTEX_ROWS_LEAST * VTEX_ROWS_LEAST;
    let height = select(sqrt(yy), VTEX_ROWS_LEAST, level);
    let per_height = 1.0 / height;
    let area = abs(axes.x * axes.w - axes.y * axes.z);
    let width = select(area * per_height, abs(axes.x) + abs(axes.z), level);
    let samples = 1i << halvings;
    let count = f32(samples);
    // The inverse of the count, exactly.
    let part = bitcast<f32>((127u - halvings) << 23u);
    let dy = height * part;
    let dx = select(xy * per_height, 0.0, level) * (f32(VTEX_ROWS_COLUMNS) * part);
    let pitch = max(width * (1.0 / f32(VTEX_ROWS_COLUMNS)), VTEX_ROWS_LEAST);
    let y = centre.y + (phase.moved.y - (0.5 * count - 0.5)) * dy;
    let x = centre.x - (0.125 * count - 0.125) * dx + (0.125 * phase.moved.x - 2.0) * pitch;
    return VtexRows(y, dy, count * per_height, x, dx, pitch, phase.shift, samples);
}

// The same rows in other units.
fn vtex_rows_scaled(rows: VtexRows, units: f32, offset: vec2f) -> VtexRows {
    return VtexRows(
        rows.y * units + offset.y,
        rows.dy * units,
        rows.per_y / units,
        rows.x * units + offset.x,
        rows.dx * units,
        rows.pitch * units,
        rows.shift,
        rows.samples,
    );
}

// How many samples lie above `y`: half open, so that of two segments that meet at a sample's height
// one counts.
fn vtex_rows_above(rows: VtexRows, y: f32) -> i32 {
    // Integers are clamped, so that no number at all makes a loop over rows long.
    return clamp(i32(ceil((y - rows.y) * rows.per_y)), 0, rows.samples);
}

// Left end of a row's columns, less a half of an eighth, as its samples have it.
fn vtex_rows_start(rows: VtexRows, row: i32) -> f32 {
    let eighths = f32((rows.shift + bitcast<i32>(VTEX_ROWS_SHIFT) * row) & 7);
    return rows.x + f32(row) * rows.dx + (0.125 * eighths + 0.0625) * rows.pitch;
}

// How far right of that the samples of a row lie.
fn vtex_rows_across(rows: VtexRows) -> vec4f {
    return (0.25 * rows.dx) * VTEX_ROWS_ROW + rows.pitch * VTEX_ROWS_COLUMN;
}

// The bit of each sample of a row for which something holds. As integers, since naga reads no vectors
// of truths from SPIR-V that are joined.
fn vtex_rows_marks(holds: vec4<bool>) -> vec4u {
    return select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), holds);
}

// The samples of a row that are marked, as four bits.
fn vtex_rows_bits(marks: vec4u) -> u32 {
    return marks.x | marks.y | marks.z | marks.w;
}

// The first samples, so many.
fn vtex_rows_first_of(count: i32) -> u32 {
    // In two shifts, as one of 32 is none.
    let half = bitcast<u32>(count >> 1u);
    return ~((VTEX_ROWS_EVERY << half) << (bitcast<u32>(count) - half));
}

// The samples in a box, its left and top sides included.
fn vtex_rows_within(rows: VtexRows, low: vec2f, high: vec2f) -> u32 {
    let first = vtex_rows_above(rows, low.y);
    let end = vtex_rows_above(rows, high.y);
    let across = vtex_rows_across(rows);
    var mask = 0u;
    let rows_end = (end + 3) >> 2u;
    for (var row = first >> 2u; row < rows_end; row += 1) {
        let x = vtex_rows_start(rows, row) + across;
        let right = vtex_rows_marks(x >= vec4f(low.x));
        let bits = vtex_rows_bits(right & vtex_rows_marks(x < vec4f(high.x)));
        mask |= bits << (4u * bitcast<u32>(row));
    }
    return mask & vtex_rows_first_of(end) & ~vtex_rows_first_of(first);
}

// Where a sample lies.
fn vtex_rows_place(rows: VtexRows, index: u32) -> vec2f {
    let across = vtex_rows_across(rows)[index & 3u];
    let x = vtex_rows_start(rows, bitcast<i32>(index >> 2u)) + across;
    return vec2f(x, rows.y + f32(bitcast<i32>(index)) * rows.dy);
}

fn vtex_rows_count(mask: u32, bits: u32) -> f32 {
    return f32(bitcast<i32>(countOneBits(mask & bits)));
}

// `cell` is the corner of this cell and `centre` the lookup's place, both from the corner of the cell
// that it lies in, in cells.
fn vtex_samples_of_rows(
    vt: VtexTexture, lookup: VtexLookup, rows: VtexRows, cell: vec2f, centre: vec2f,
) -> VtexSamples {
    let units = vt.curve_units.x;
    let scaled = vtex_rows_scaled(rows, units, vt.curve_units.y - cell * units);
    // From the first row's left end to that of the last sample's.
    let lean = (0.25 * f32(rows.samples) - 0.25) * scaled.dx;
    return VtexSamples(
        rows,
        cell,
        lookup.uv,
        1.0 / vt.cell_from_uv.xy,
        scaled,
        scaled.x + min(lean, 0.0),
        scaled.x + max(lean, 0.0) + 4.0 * scaled.pitch,
        centre - cell,
    );
}

// The samples right of a segment, between the heights of its ends. The test is that of
// `vtex_segment_winding`, with all products about the upper end: so an edge along y is met at the same
// x whatever its length.
fn vtex_rows_right(samples: VtexSamples, command: vec4u) -> u32 {
    let rows = samples.units;
    let a = vtex_segment_point(command.x);
    let b = vtex_segment_point(command.z);
    let to_c = vtex_segment_point(command.y) - a;
    let to_b = b - a;
    let first = vtex_rows_above(rows, a.y);
    let end = vtex_rows_above(rows, b.y);
    // Most segments pass all samples on one side.
    let leftmost = max(a.x, b.x) < samples.left;
    let crosses = !leftmost && min(a.x, b.x) <= samples.right;
    var mask = select(0u, VTEX_ROWS_EVERY, leftmost);
    let bend = vtex_segment_cross(to_c, to_b);
    let across = vtex_rows_across(rows);
    let below = rows.dy * VTEX_ROWS_ROW;
    let rows_end = select(0, (end + 3) >> 2u, crosses);
    for (var row = first >> 2u; row < rows_end; row += 1) {
        // From the upper end to the samples.
        let x = (vtex_rows_start(rows, row) - a.x) + across;
        let y = (rows.y - a.y + f32(4 * row) * rows.dy) + below;
        let chord = x * to_b.y - y * to_b.x;
        let before = x * to_c.y - y * to_c.x;
        let inner = -4.0 * before * (bend - chord + before);
        let near = vtex_rows_marks(chord * bend > vec4f(0.0));
        let between = near & vtex_rows_marks(chord * chord < inner);
        let right = vtex_rows_marks(chord >= vec4f(0.0)) ^ between;
        mask |= vtex_rows_bits(right) << (4u * bitcast<u32>(row));
    }
    return mask & vtex_rows_first_of(end) & ~vtex_rows_first_of(first);
}

// Adds what a segment does to the windings.
fn vtex_samples_wind(samples: VtexSamples, winding: VtexWinding, command: vec4u) -> VtexWinding {
    var carry = vtex_rows_right(samples, command);
    // All ones to count down.
    let down = select(VTEX_ROWS_EVERY, 0u, (command.w & VTEX_CMD_DOWN_BIT) != 0u);
    var low = winding.low;
    let next0 = (low.x ^ down) & carry;
    let next1 = (low.y ^ down) & next0;
    let next2 = (low.z ^ down) & next1;
    let next3 = (low.w ^ down) & next2;
    return VtexWinding(low ^ vec4u(carry, next0, next1, next2), winding.high ^ next3);
}

// The samples that an entry with this tag covers.
fn vtex_samples_filled(winding: VtexWinding, tag: u32) -> u32 {
    // What the segments' windings are where all of it is none.
    let none = 0u - bitcast<u32>(bitcast<i32>(tag << VTEX_CMD_BASE_LEFT) >> VTEX_CMD_BASE_RIGHT);
    let low = winding.low ^ (vec4u(0u) - ((vec4u(none) >> vec4u(0u, 1u, 2u, 3u)) & vec4u(1u)));
    let high = winding.high ^ (0u - ((none >> 4u) & 1u));
    let some = low.x | low.y | low.z | low.w | high;
    return select(some, low.x, (tag & VTEX_CMD_EVEN_ODD_BIT) != 0u);
}

// The mean of samples, in uv, each taken in the middle of the room that its row and column give it.
// From counts of bits: of odd rows, of rows with bit 1 and of rows with bit 2; then of places in a row,
// and of columns.
fn vtex_samples_uv(samples: VtexSamples, mask: u32) -> vec2f {
    let rows = samples.rows;
    let per_whole = 1.0 / max(vtex_rows_count(mask, VTEX_ROWS_EVERY), 1.0);
    let row = vtex_rows_count(mask, 0xf0f0f0f0u) + 2.0 * vtex_rows_count(mask, 0xff00ff00u)
        + 4.0 * vtex_rows_count(mask, 0xffff0000u);
    let right = vtex_rows_count(mask, 0xccccccccu);
    let place = vtex_rows_count(mask, 0xaaaaaaaau) + 2.0 * right;
    let column = right + 2.0 * vtex_rows_count(mask, 0x55555555u);
    // From the mean of all.
    let down = (row + 0.25 * place) * per_whole - (0.125 * f32(rows.samples) - 0.125);
    let across = column * per_whole - 1.5;
    let mean = vec2f(
        down * rows.dx + across * rows.pitch,
        down * f32(VTEX_ROWS_COLUMNS) * rows.dy,
    );
    return samples.uv + mean * samples.uv_per_cell;
}

// The samples in a box, in uv: its corner of least coordinates, then the other.
fn vtex_samples_within(vt: VtexTexture, samples: VtexSamples, box: vec4f) -> u32 {
    let place = (samples.centre + samples.cell).xyxy;
    let sides = place + (box - samples.uv.xyxy) * vt.cell_from_uv.xyxy;
    return vtex_rows_within(samples.rows, sides.xy - VTEX_ROWS_SLACK, sides.zw + VTEX_ROWS_SLACK);
}

fn vtex_samples_q(samples: VtexSamples, index: u32) -> vec2f {
    return vtex_rows_place(samples.rows, index) - samples.cell;
}

fn vtex_samples_centre(samples: VtexSamples) -> vec2f {
    return samples.centre;
}
