//!use trace/world/veil
// Scenes whose see-through surfaces tell nothing without a lookup, and rays that do not ask.

fn cutout_hides(hit: Hit) -> bool {
    return false;
}

fn bvh_stops(hit: Hit) -> bool {
    return !bvh_is_veil(hit);
}
