//!use trace/bvh
// Answers single rays of the host.

@group(1) @binding(0) var<storage, read> query_rays: array<RayRecord>;
@group(1) @binding(1) var<storage, read_write> query_hits: array<HitRecord>;

@compute @workgroup_size(64)
fn intersect(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_rays) {
        return;
    }
    let query = query_rays[id.x];
    let ray = ray_new(query.origin_t_max.xyz, query.direction.xyz, query.origin_t_max.w);
    let hit = bvh_closest(ray);
    query_hits[id.x] = HitRecord(hit.t, hit.triangle, hit.instance, 0u);
}
