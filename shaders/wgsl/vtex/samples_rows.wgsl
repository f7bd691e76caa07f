//!use core/layout
//!use vtex/texture
//!use vtex/segment
// The samples of a footprint, as seen from one cell of the file; a walk speaks of samples as bits of
// a mask. A footprint's parallelogram has eight rows of four samples, and bit 4 k + j of a mask is
// sample j of row k. Its first axis is horizontal: of all parallelograms of one covariance it is the
// one whose rows an outline crosses at a single x each, so that a segment costs a row's work and not
// a sample's.

struct VtexRows {
    // The first row's height, from one to the next, and the inverse of that.
    y: f32,
    dy: f32,
    per_y: f32,
    // Left end of the first row, and from one to the next.
    x: f32,
    dx: f32,
    // From one sample to the next, and its inverse.
    pitch: f32,
    per_x: f32,
}

struct VtexSamples {
    // In cells, from the corner of the cell that the lookup's centre lies in.
    rows: VtexRows,
    // From that corner to this cell's.
    cell: vec2f,
    // That corner in uv, and the uv of a cell.
    home_uv: vec2f,
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

// No sample lies farther from the centre, in cells, along x and along y. A bound without a root: the
// sides of a parallelogram of one covariance add up to no more than sqrt(2) times what theirs do.
fn vtex_rows_extent(axes: vec4f) -> vec2f {
    return (abs(axes.xy) + abs(axes.zw)) * vec2f(0.7072, 0.5);
}

// About `centre`; `axes` are those of the footprint.
fn vtex_rows(centre: vec2f, axes: vec4f) -> VtexRows {
    let xx = axes.x * axes.x + axes.z * axes.z;
    let xy = axes.x * axes.y + axes.z * axes.w;
    let yy = axes.y * axes.y + axes.w * axes.w;
    // The parallelogram with a horizontal axis whose covariance is the same.
    let level = yy <= VTEX_ROWS_LEAST * VTEX_ROWS_LEAST;
    let height = select(sqrt(yy), VTEX_ROWS_LEAST, level);
    let per_height = 1.0 / height;
    let area = abs(axes.x * axes.w - axes.y * axes.z);
    let width = select(area * per_height, abs(axes.x) + abs(axes.z), level);
    let dy = height * (1.0 / f32(VTEX_ROWS_ROWS));
    let dx = select(xy * per_height, 0.0, level) * (1.0 / f32(VTEX_ROWS_ROWS));
    let pitch = max(width * (1.0 / f32(VTEX_ROWS_COLUMNS)), VTEX_ROWS_LEAST);
    let y = centre.y - 3.5 * dy;
    let x = centre.x - 3.5 * dx - 2.0 * pitch;
    return VtexRows(y, dy, f32(VTEX_ROWS_ROWS) * per_height, x, dx, pitch, 1.0 / pitch);
}

// The same rows in other units.
fn vtex_rows_scaled(rows: VtexRows, units: f32, offset: vec2f) -> VtexRows {
    let per_unit = 1.0 / units;
    return VtexRows(
        rows.y * units + offset.y,
        rows.dy * units,
        rows.per_y * per_unit,
        rows.x * units + offset.x,
        rows.dx * units,
        rows.pitch * units,
        rows.per_x * per_unit,
    );
}

// How many rows lie above `y`: half open, so that of two segments that meet on a row's height one
// counts.
fn vtex_rows_above(rows: VtexRows, y: f32) -> i32 {
    // Integers are clamped, so that no number at all makes a loop over rows long.
    return clamp(i32(ceil((y - rows.y) * rows.per_y)), 0, i32(VTEX_ROWS_ROWS));
}

// Where the first sample of a row lies.
fn vtex_rows_start(rows: VtexRows, row: i32) -> f32 {
    let eighths = f32(bitcast<i32>((VTEX_ROWS_SHIFTS >> (4u * bitcast<u32>(row))) & 7u));
    return rows.x + f32(row) * rows.dx + (0.125 * eighths + 0.0625) * rows.pitch;
}

// The samples of a row from `x` on, as its four bits. `start` is where its first lies.
fn vtex_rows_from(rows: VtexRows, start: f32, x: f32) -> u32 {
    let left = clamp(ceil((x - start) * rows.per_x), 0.0, f32(VTEX_ROWS_COLUMNS));
    return 15u << bitcast<u32>(i32(left));
}

// The samples in a box, its left and top sides included.
fn vtex_rows_within(rows: VtexRows, low: vec2f, high: vec2f) -> u32 {
    let end = vtex_rows_above(rows, high.y);
    var mask = 0u;
    for (var row = vtex_rows_above(rows, low.y); row < end; row += 1) {
        let start = vtex_rows_start(rows, row);
        let bits = vtex_rows_from(rows, start, low.x) & ~vtex_rows_from(rows, start, high.x);
        mask |= (bits & 15u) << (4u * bitcast<u32>(row));
    }
    return mask;
}

// Where a sample lies.
fn vtex_rows_place(rows: VtexRows, index: u32) -> vec2f {
    let row = bitcast<i32>(index >> 2u);
    let x = vtex_rows_start(rows, row) + f32(bitcast<i32>(index & 3u)) * rows.pitch;
    return vec2f(x, rows.y + f32(row) * rows.dy);
}

fn vtex_rows_count(mask: u32, bits: u32) -> f32 {
    return f32(bitcast<i32>(countOneBits(mask & bits)));
}

// `home` is the corner of the centre's cell, `cell` from there to this one's, both in cells.
fn vtex_samples_of_rows(
    vt: VtexTexture, rows: VtexRows, home: vec2f, cell: vec2f, centre: vec2f,
) -> VtexSamples {
    let units = vt.curve_units.x;
    let scaled = vtex_rows_scaled(rows, units, vt.curve_units.y - cell * units);
    return VtexSamples(
        rows,
        cell,
        (home - vt.cell_from_uv.zw) / vt.cell_from_uv.xy,
        1.0 / vt.cell_from_uv.xy,
        scaled,
        scaled.x + min(7.0 * scaled.dx, 0.0),
        scaled.x + max(7.0 * scaled.dx, 0.0) + 4.0 * scaled.pitch,
        centre - cell,
    );
}

// The rows above the one with this number.
fn vtex_rows_until(row: i32) -> u32 {
    // In two shifts, as one of 32 is none.
    let half = 2u * bitcast<u32>(row);
    return ~((VTEX_ROWS_EVERY << half) << half);
}

// The samples right of a segment, in the rows that it crosses.
fn vtex_rows_right(samples: VtexSamples, command: vec4u) -> u32 {
    let rows = samples.units;
    let a = vtex_segment_point(command.x);
    let b = vtex_segment_point(command.z);
    // A line's control point is its upper end: half way makes its parameter linear.
    let line = (command.w & VTEX_CMD_LINE_BIT) != 0u;
    let c = select(vtex_segment_point(command.y), 0.5 * (a + b), line);
    // x - x0 = t (x1 + t x2), y - y0 = t (2 half_slope + t bend).
    let x1 = 2.0 * (c.x - a.x);
    let x2 = a.x - 2.0 * c.x + b.x;
    let half_slope = c.y - a.y;
    let bend = a.y - 2.0 * c.y + b.y;
    let first = vtex_rows_above(rows, a.y);
    let end = vtex_rows_above(rows, b.y);
    // Most segments pass all samples on one side.
    let leftmost = max(a.x, b.x) < samples.left;
    let crosses = !leftmost && min(a.x, b.x) <= samples.right;
    var mask = select(0u, vtex_rows_until(end) & ~vtex_rows_until(first), leftmost);
    for (var row = select(end, first, crosses); row < end; row += 1) {
        // The root that does not cancel: both differences are not negative.
        let down = max(rows.y + f32(row) * rows.dy - a.y, 0.0);
        let root = sqrt(max(half_slope * half_slope + bend * down, 0.0));
        let t = down / max(half_slope + root, 1e-20);
        let x = a.x + t * (x1 + t * x2);
        mask |= (vtex_rows_from(rows, vtex_rows_start(rows, row), x) & 15u) << (4u * bitcast<u32>(row));
    }
    return mask;
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

// The mean of samples, in uv. From counts of bits: of odd rows, of rows with bit 1 and of rows with
// bit 2; then of rows whose shift has the bits 1, 2 and 4, in eighths; then of columns.
fn vtex_samples_uv(samples: VtexSamples, mask: u32) -> vec2f {
    let rows = samples.rows;
    let whole = max(vtex_rows_count(mask, VTEX_ROWS_EVERY), 1.0);
    let row = vtex_rows_count(mask, 0xf0f0f0f0u) + 2.0 * vtex_rows_count(mask, 0xff00ff00u)
        + 4.0 * vtex_rows_count(mask, 0xffff0000u);
    let eighths = vtex_rows_count(mask, 0x0ff0ff00u) + 2.0 * vtex_rows_count(mask, 0xf00fff00u)
        + 4.0 * vtex_rows_count(mask, 0xf0f0f00fu);
    let column = vtex_rows_count(mask, 0xaaaaaaaau) + 2.0 * vtex_rows_count(mask, 0xccccccccu);
    let columns = (column + 0.125 * eighths) / whole + 0.0625;
    let mean = vec2f(
        rows.x + row / whole * rows.dx + columns * rows.pitch,
        rows.y + row / whole * rows.dy,
    );
    return samples.home_uv + mean * samples.uv_per_cell;
}

fn vtex_samples_q(samples: VtexSamples, index: u32) -> vec2f {
    return vtex_rows_place(samples.rows, index) - samples.cell;
}

fn vtex_samples_centre(samples: VtexSamples) -> vec2f {
    return samples.centre;
}
