// Ray cones: the region of a surface that a lookup should average. Akenine-Moeller et al.,
// Improved Shader and Texture Level of Detail Using Ray Cones, JCGT 2021, with its errata: the
// width grows by 2 t tan(angle / 2). `slope` is that tangent. Curvature is left out.

struct Cone {
    // Full width, world units.
    width: f32,
    slope: f32,
}

// The widest a scatter makes a cone, as a slope: past it lookups would average over things the
// path cannot see.
const CONE_MAX_SCATTER_SLOPE: f32 = 0.25;

fn cone_at(cone: Cone, distance: f32) -> Cone {
    return Cone(cone.width + 2.0 * distance * cone.slope, cone.slope);
}

// Scattering with density `pdf` stands for a solid angle 1 / pdf, a disc of that area at
// distance 1.
fn cone_scatter(cone: Cone, pdf: f32, scale: f32) -> Cone {
    let slope = min(inverseSqrt(3.14159265 * max(pdf, 1e-6)), CONE_MAX_SCATTER_SLOPE);
    return Cone(cone.width, cone.slope + scale * slope);
}
