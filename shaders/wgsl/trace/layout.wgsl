// Records that the ray tracer's host code fills: runtime/src/tracer/records.rs holds the same
// fields, and a test compares names, offsets and sizes through naga.

const TRACE_NONE: u32 = 0xffffffffu;

const SURFACE_DIFFUSE: u32 = 0u;
const SURFACE_GLOSSY: u32 = 1u;
// Shows its colour whatever light falls on it.
const SURFACE_UNLIT: u32 = 2u;

// Lights are found by chance and by aiming at them, weighted (multiple importance sampling).
const LIGHT_SAMPLING_MIS: u32 = 0u;
// Lights are found by chance alone: slow and noisy, the check of the other.
const LIGHT_SAMPLING_SCATTER: u32 = 1u;

// The part of a triangle that intersection reads, 48 bytes. edge1 = v0 - v1, edge2 = v2 - v0. v0.w holds
// the bits of 0, or of where the record of an instance lies, for which this then stands. edge1.w is not 0
// where the triangle may let rays through; where it is one of an instance, its record says that.
struct TriangleRecord {
    v0: vec4f,
    edge1: vec4f,
    edge2: vec4f,
}

// The part that shading reads: three normals with u in w, then the three v and the material.
struct AttributeRecord {
    normal0_u: vec4f,
    normal1_u: vec4f,
    normal2_u: vec4f,
    v_material: vec4f,
}

struct MaterialRecord {
    base_color: vec4f,
    emission: vec4f,
    // Under the texture's transparent parts; w = 0 for none, which lets rays through.
    backing: vec4f,
    // Reflectance of what is not metal, seen straight on, and at grazing views.
    dielectric: vec4f,
    // What a body behind it absorbs in a unit of length; its index, negative for a thin wall.
    glass: vec4f,
    metallic: f32,
    // GGX's width parameter, the square of perceptual roughness.
    ggx_alpha: f32,
    surface: u32,
    // First word of the vector texture in vtex_words, or TRACE_NONE.
    texture_word: u32,
    // Density per area with which its points are chosen as lights; 0 where its light is found by chance alone.
    light_density: f32,
    // Which queue the stages put its lookups into.
    texture_queue: u32,
    // 1 for the rectangle of an area light, which shines from its front and scatters nothing.
    is_panel: u32,
    // Where its texture's cutout lies among the nodes, 0 for none: see trace/world/cutout.
    cutout: u32,
    // Share of the light that is not reflected by metal and goes through.
    transmission: f32,
    // Strength of a clear coat, and its width parameter of GGX.
    coat: f32,
    coat_alpha: f32,
    reserved: f32,
}

// What stays the same over a picture.
struct FrameRecord {
    camera_position: vec4f,
    // Half extents of the film at distance 1.
    camera_right: vec4f,
    camera_up: vec4f,
    camera_forward: vec4f,
    sky_zenith: vec4f,
    sky_horizon: vec4f,
    sky_ground: vec4f,
    // Cosine and sine of the angle by which the panorama is turned about y, what its texels are multiplied
    // by, and the chance that it is chosen as a light.
    environment_turn: vec4f,
    film_width: u32,
    film_height: u32,
    light_count: u32,
    triangle_count: u32,
    seed: u32,
    max_bounces: u32,
    light_sampling: u32,
    // 1: a camera ray that meets nothing leaves the film transparent.
    transparent_background: u32,
    // Tangent of half the angle between neighbouring camera rays, scaled by footprint_scale.
    camera_slope: f32,
    footprint_scale: f32,
    indirect_clamp: f32,
    // A distance at which every ray has left the scene.
    reach: f32,
    // Where the lights lie among the nodes, and the cells of the panorama.
    light_first: u32,
    environment_first: u32,
    environment_columns: u32,
    environment_rows: u32,
    // Where the table of trace/albedo lies among the nodes.
    albedo_first: u32,
    // Where the colours of vertices lie among the nodes, a group for each triangle.
    colors_first: u32,
    reserved0: u32,
    reserved1: u32,
}

// Which part of the work one dispatch does.
struct PassRecord {
    row_first: u32,
    row_count: u32,
    sample_first: u32,
    sample_count: u32,
}

// A ray asked for by the host, and the answer.
struct RayRecord {
    origin_t_max: vec4f,
    direction: vec4f,
}

struct HitRecord {
    t: f32,
    triangle: u32,
    instance: u32,
    reserved: u32,
}
