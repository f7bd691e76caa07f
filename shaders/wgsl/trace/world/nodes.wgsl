//!use trace/bindings
//!use trace/ray
//!use trace/stack
//!use trace/world/instance
//!use trace/world/levels
//!use trace/world/cutout
// Nodes and triangles of a compressed wide BVH: Ylitie, Karras, Laine, Efficient Incoherent Ray Traversal
// on GPUs Through Compressed Wide BVHs, HPG 2017. Node layout and order of visits are those of
// the obvhs crate, whose CPU traversal gives the same hit to the bit where the device rounds
// as IEEE 754 says.
//
// A node is five vec4u:
//   0  corner of the box (3 floats), exponents of the three grid steps, mask of inner children
//   1  first child node, first triangle, 8 bytes of child meta
//   2  lower x of 8 children, upper x of 8 children;  3, 4  the same for y, z

// Node visits a ray may take. Some software drivers stop any loop at 65,535 rounds without a
// word; this ends before. Real scenes take tens to hundreds.
const BVH_MAX_VISITS: u32 = 16384u;
// The nearest slab distance that counts, as in obvhs.
const BVH_EPSILON: f32 = 0.0001;

// Octant of the direction, inverted, in each of four bytes: children are visited in the order of
// their slot xor this.
fn bvh_octant_inverse4(direction: vec3f) -> u32 {
    let bits = select(vec3u(4u, 2u, 1u), vec3u(0u), direction < vec3f(0.0));
    return (bits.x | bits.y | bits.z) * 0x01010101u;
}

fn bvh_byte(word: u32, index: u32) -> u32 {
    return (word >> (index * 8u)) & 0xffu;
}

// Hits among four children. `low` and `high` hold one byte a child in each of x, y and z.
fn bvh_hit_children(
    meta4: u32,
    low: vec3u,
    high: vec3u,
    scale: vec3f,
    base: vec3f,
    t_max: f32,
    octant_inverse4: u32,
) -> u32 {
    // Inner children carry 24..31 in the low five bits, so bits 3 and 4 are both set.
    let inner = ((meta4 & (meta4 << 1u)) & 0x10101010u) >> 4u;
    let bit_index4 = (meta4 ^ (octant_inverse4 & (inner * 0xffu))) & 0x1f1f1f1fu;
    let child_bits4 = (meta4 >> 5u) & 0x07070707u;
    var mask = 0u;
    for (var child = 0u; child < 4u; child++) {
        let near = vec3f(vec3u(bvh_byte(low.x, child), bvh_byte(low.y, child), bvh_byte(low.z, child)));
        let far = vec3f(vec3u(bvh_byte(high.x, child), bvh_byte(high.y, child), bvh_byte(high.z, child)));
        let t_near = near * scale + base;
        let t_far = far * scale + base;
        let enter = max(max(t_near.x, max(t_near.y, t_near.z)), BVH_EPSILON);
        let leave = min(min(t_far.x, min(t_far.y, t_far.z)), t_max);
        if enter <= leave {
            mask |= bvh_byte(child_bits4, child) << bvh_byte(bit_index4, child);
        }
    }
    return mask;
}

// Inner hits in the top byte by priority, triangles in the low 24 bits.
fn bvh_hit_node(node: u32, ray: Ray, t_max: f32, octant_inverse4: u32) -> vec4u {
    let first = node * 5u;
    let box = trace_nodes[first];
    let link = trace_nodes[first + 1u];
    let x = trace_nodes[first + 2u];
    let y = trace_nodes[first + 3u];
    let z = trace_nodes[first + 4u];
    let step = vec3f(
        bitcast<f32>(bvh_byte(box.w, 0u) << 23u),
        bitcast<f32>(bvh_byte(box.w, 1u) << 23u),
        bitcast<f32>(bvh_byte(box.w, 2u) << 23u),
    );
    let scale = step * ray.inverse;
    let base = (bitcast<vec3f>(box.xyz) - ray.origin) * ray.inverse;
    let down = ray.direction < vec3f(0.0);
    let low0 = select(vec3u(x.x, y.x, z.x), vec3u(x.z, y.z, z.z), down);
    let low1 = select(vec3u(x.y, y.y, z.y), vec3u(x.w, y.w, z.w), down);
    let high0 = select(vec3u(x.z, y.z, z.z), vec3u(x.x, y.x, z.x), down);
    let high1 = select(vec3u(x.w, y.w, z.w), vec3u(x.y, y.y, z.y), down);
    let mask = bvh_hit_children(link.z, low0, high0, scale, base, t_max, octant_inverse4)
        | bvh_hit_children(link.w, low1, high1, scale, base, t_max, octant_inverse4);
    return vec4u(link.x, (mask & 0xff000000u) | bvh_byte(box.w, 3u), link.y, mask & 0x00ffffffu);
}

// Comes back to `nodes` later. The host refuses trees that need a deeper stack.
fn bvh_push(stack: ptr<function, Stack>, stack_size: ptr<function, u32>, nodes: vec2u) {
    if *stack_size < STACK_SIZE {
        stack_put(stack, *stack_size, nodes);
        *stack_size += 1u;
    }
}

// Goes into the first of `nodes`, whose others wait on the stack: what bvh_hit_node finds there.
fn bvh_enter(
    stack: ptr<function, Stack>,
    stack_size: ptr<function, u32>,
    nodes: vec2u,
    ray: Ray,
    t_max: f32,
    octant_inverse4: u32,
) -> vec4u {
    let offset = firstLeadingBit(nodes.y);
    let others = nodes.y & ~(1u << offset);
    if others > 0x00ffffffu {
        bvh_push(stack, stack_size, vec2u(nodes.x, others));
    }
    let slot = (offset - 24u) ^ (octant_inverse4 & 0xffu);
    let child = nodes.x + countOneBits(nodes.y & ~(0xffffffffu << slot));
    return bvh_hit_node(child, ray, t_max, octant_inverse4);
}

fn bvh_dot(a: vec3f, b: vec3f) -> f32 {
    // The order of the sum is part of the contract with the CPU's traversal.
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Moeller and Trumbore 1997, in the form of obvhs. Keeps `hit` when the triangle is not nearer.
fn bvh_hit_triangle(index: u32, instance: u32, ray: Ray, hit: Hit) -> Hit {
    let edge1 = trace_triangles[index].edge1.xyz;
    let edge2 = trace_triangles[index].edge2.xyz;
    let normal = cross(edge1, edge2);
    let c = trace_triangles[index].v0.xyz - ray.origin;
    let r = cross(ray.direction, c);
    let inverse_determinant = 1.0 / bvh_dot(normal, ray.direction);
    let u = bvh_dot(r, edge2) * inverse_determinant;
    let v = bvh_dot(r, edge1) * inverse_determinant;
    let w = 1.0 - u - v;
    // The sign bit, not `< 0`: -0.0 is outside, as on the CPU.
    let signs = (bitcast<u32>(u) | bitcast<u32>(v) | bitcast<u32>(w)) & 0x80000000u;
    let t = bvh_dot(normal, c) * inverse_determinant;
    if inverse_determinant != 0.0 && signs == 0u && t >= 0.0 && t < hit.t {
        let found = Hit(t, index, instance, vec2f(u, v));
        if !cutout_hides(found) {
            return found;
        }
    }
    return hit;
}
