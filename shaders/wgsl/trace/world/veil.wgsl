//!use trace/bindings
//!use trace/ray
//!use trace/world/instance
//!use trace/world/levels
// What rays go through.

// Whether a surface may let rays through. Other ones stop a shadow ray wherever they are met.
fn bvh_is_veil(hit: Hit) -> bool {
    if WORLD_HAS_INSTANCES && hit.instance != 0u {
        return instance_is_veil(hit.instance);
    }
    return trace_triangles[hit.triangle].edge1.w != 0.0;
}

// The number of the material that a ray met.
fn surface_material(hit: Hit) -> u32 {
    if WORLD_HAS_INSTANCES && hit.instance != 0u {
        return instance_material(hit.instance);
    }
    return bitcast<u32>(trace_attributes[hit.triangle].v_material.w);
}
