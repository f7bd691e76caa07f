//!use trace/layout
// The scene, bound by runtime/src/tracer/pipeline.rs.

@group(0) @binding(0) var<uniform> trace_frame: FrameRecord;
@group(0) @binding(1) var<uniform> trace_pass: PassRecord;
@group(0) @binding(2) var<storage, read> trace_nodes: array<vec4u>;
@group(0) @binding(3) var<storage, read> trace_triangles: array<TriangleRecord>;
@group(0) @binding(4) var<storage, read> trace_attributes: array<AttributeRecord>;
@group(0) @binding(5) var<storage, read> trace_materials: array<MaterialRecord>;
// Radiance by direction, see trace/light/environment; one texel where there is none.
@group(0) @binding(6) var trace_environment: texture_2d<f32>;
@group(0) @binding(7) var trace_environment_sampler: sampler;
