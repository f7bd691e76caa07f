//!use trace/bindings
//!use trace/rng
// Light from infinitely far away by a panorama: equirectangular, its middle towards -z, its top up.
//
// It is divided in cells of equal angles, each a group of four words among the nodes: threshold and alias
// (Walker 1977), density per solid angle. The table is that of the panorama as the sampler filters it.

const ENVIRONMENT_PI: f32 = 3.14159265;

fn environment_turned(direction: vec3f, cosine: f32, sine: f32) -> vec3f {
    let x = cosine * direction.x - sine * direction.z;
    let z = sine * direction.x + cosine * direction.z;
    return vec3f(x, direction.y, z);
}

// Both in [0, 1]: round the horizon from the left end of the panorama, then down from straight up.
fn environment_place(direction: vec3f) -> vec2f {
    let turn = trace_frame.environment_turn;
    let local = environment_turned(direction, turn.x, -turn.y);
    let around = atan2(local.x, -local.z) / (2.0 * ENVIRONMENT_PI) + 0.5;
    return vec2f(around, atan2(length(local.xz), local.y) / ENVIRONMENT_PI);
}

fn environment_radiance(direction: vec3f) -> vec3f {
    let place = environment_place(direction);
    let texel = textureSampleLevel(trace_environment, trace_environment_sampler, place, 0.0);
    return texel.rgb * trace_frame.environment_turn.z;
}

fn environment_cell(index: u32) -> vec4u {
    return trace_nodes[trace_frame.environment_first + index];
}

// Density with which environment_sample finds a direction, per solid angle.
fn environment_pdf(direction: vec3f) -> f32 {
    let size = vec2u(trace_frame.environment_columns, trace_frame.environment_rows);
    let cell = min(vec2u(environment_place(direction) * vec2f(size)), size - 1u);
    return bitcast<f32>(environment_cell(cell.y * size.x + cell.x).z);
}

struct EnvironmentSample {
    direction: vec3f,
    pdf: f32,
}

// A cell by the alias table, and in it any direction.
fn environment_sample(xi: vec2f, stream: ptr<function, u32>) -> EnvironmentSample {
    let columns = trace_frame.environment_columns;
    let rows = trace_frame.environment_rows;
    var index = rng_below(stream, columns * rows);
    var cell = environment_cell(index);
    if rng_next(stream) >= bitcast<f32>(cell.x) {
        index = cell.y;
        cell = environment_cell(index);
    }
    let row = f32(index / columns);
    let around = (f32(index % columns) + xi.x) / f32(columns) - 0.5;
    let step = ENVIRONMENT_PI / f32(rows);
    // Even over the area of the cell's band on the sphere.
    let height = mix(cos(row * step), cos((row + 1.0) * step), xi.y);
    let radius = sqrt(max(1.0 - height * height, 0.0));
    let angle = 2.0 * ENVIRONMENT_PI * around;
    let local = vec3f(radius * sin(angle), height, -radius * cos(angle));
    let turn = trace_frame.environment_turn;
    return EnvironmentSample(environment_turned(local, turn.x, turn.y), bitcast<f32>(cell.z));
}
