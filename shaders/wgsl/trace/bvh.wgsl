//!use trace/ray
//!use trace/world/traverse
// Closest and any hits in the hierarchies of a scene.

// The nearest triangle nearer than ray.t_max, or a miss.
fn bvh_closest(ray: Ray) -> Hit {
    return bvh_traverse(ray, false);
}

// For shadow rays: any triangle nearer than ray.t_max that stops all rays; where none does, the nearest
// of the others, or a miss.
fn bvh_any(ray: Ray) -> Hit {
    return bvh_traverse(ray, true);
}
