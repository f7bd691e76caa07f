//!use trace/albedo
//!use trace/rng
// How light scatters at a surface: Lambert, or GGX over Lambert as in glTF 2.0 appendix B. Directions are
// local, the shading normal is +z, both point away from the surface.
//
// Light that microfacets send to each other is added by a scale of the single-scattering lobe (Turquin,
// Practical Multiple Scattering Compensation for Microfacet Models, 2019), and Lambert gets what the lobe
// above leaves of it, so that no surface reflects more than comes in and a white one as much.

const BSDF_PI: f32 = 3.14159265;
// Reflectance of a clear coat, of index 1.5, seen straight on.
const BSDF_COAT: f32 = 0.04;

struct Bsdf {
    // What the specular lobe leaves of it.
    diffuse: vec3f,
    // Reflectance seen straight on.
    specular: vec3f,
    // By how much more than single scattering a surface that reflects all light sends back, less 1.
    lost: f32,
    ggx_alpha: f32,
    // Share of the samples drawn from the specular lobe, and reflectance at grazing views: two halves of a
    // word, for shading has no register to spare.
    shares: u32,
}

fn bsdf_specular_share(bsdf: Bsdf) -> f32 {
    return unpack2x16unorm(bsdf.shares).x;
}

struct BsdfCoat {
    bsdf: Bsdf,
    reflected: f32,
}

struct BsdfSample {
    direction: vec3f,
    // Value times cosine over pdf; 0 when nothing is scattered there.
    weight: vec3f,
    // Per solid angle.
    pdf: f32,
}

fn bsdf_new(material: MaterialRecord, base_color: vec3f, out_direction: vec3f) -> Bsdf {
    if material.surface == SURFACE_DIFFUSE {
        return Bsdf(base_color, vec3f(0.0), 0.0, 1.0, 0u);
    }
    let specular = mix(material.dielectric.xyz, base_color, material.metallic);
    let grazing = mix(material.dielectric.w, 1.0, material.metallic);
    let albedo = albedo_of(out_direction.z, material.ggx_alpha);
    let lost = 1.0 / max(albedo.x + albedo.y, 0.01) - 1.0;
    let reflected = (specular * albedo.x + grazing * albedo.y) * (1.0 + specular * lost);
    // Below a dielectric, of which a surface that is half a metal is half.
    let plain = material.dielectric.xyz;
    let dielectric = (plain * albedo.x + material.dielectric.w * albedo.y) * (1.0 + plain * lost);
    let diffuse = base_color * (1.0 - material.metallic) * max(1.0 - dielectric, vec3f(0.0));
    let shine = bsdf_luminance(reflected);
    let glow = bsdf_luminance(diffuse);
    // Each lobe that reflects anything gets at least a tenth.
    let share = select(clamp(shine / max(shine + glow, 1e-6), 0.1, 0.9), 1.0, glow == 0.0);
    return Bsdf(diffuse, specular, lost, material.ggx_alpha, pack2x16unorm(vec2f(share, grazing)));
}

fn bsdf_luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}

// A clear coat alone, and what it reflects of all light.
fn bsdf_coat(coat_alpha: f32, out_direction: vec3f) -> BsdfCoat {
    let albedo = albedo_of(out_direction.z, coat_alpha);
    let lost = 1.0 / max(albedo.x + albedo.y, 0.01) - 1.0;
    let reflected = (BSDF_COAT * albedo.x + albedo.y) * (1.0 + BSDF_COAT * lost);
    let coat = Bsdf(vec3f(0.0), vec3f(BSDF_COAT), lost, coat_alpha, 0xffffffffu);
    return BsdfCoat(coat, reflected);
}

// Schlick 1994.
fn bsdf_fresnel(straight_on: vec3f, grazing: f32, cosine: f32) -> vec3f {
    let x = 1.0 - clamp(cosine, 0.0, 1.0);
    let x2 = x * x;
    return straight_on + (grazing - straight_on) * (x2 * x2 * x);
}

// Smith's Lambda for GGX, Heitz 2014 eq. 72.
fn bsdf_lambda(direction: vec3f, alpha: f32) -> f32 {
    let tangent_squared = dot(direction.xy, direction.xy) / (direction.z * direction.z);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tangent_squared) - 1.0);
}

// GGX, Walter et al. 2007 eq. 33. sin^2 comes from x and y, which keeps it exact near the peak.
fn bsdf_distribution(half_vector: vec3f, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let t = dot(half_vector.xy, half_vector.xy) + a2 * half_vector.z * half_vector.z;
    return a2 / (BSDF_PI * t * t);
}

// Value times cosine of `into`.
fn bsdf_evaluate(bsdf: Bsdf, out_direction: vec3f, into: vec3f) -> vec3f {
    if into.z <= 0.0 || out_direction.z <= 0.0 {
        return vec3f(0.0);
    }
    if bsdf_specular_share(bsdf) == 0.0 {
        return bsdf.diffuse * (into.z / BSDF_PI);
    }
    let half_vector = normalize(into + out_direction);
    let fresnel = bsdf_fresnel(bsdf.specular, unpack2x16unorm(bsdf.shares).y, dot(half_vector, into));
    let alpha = bsdf.ggx_alpha;
    let masking = 1.0 / (1.0 + bsdf_lambda(out_direction, alpha) + bsdf_lambda(into, alpha));
    let single = bsdf_distribution(half_vector, alpha) * masking / (4.0 * out_direction.z);
    return fresnel * (1.0 + bsdf.specular * bsdf.lost) * single + bsdf.diffuse * (into.z / BSDF_PI);
}

fn bsdf_pdf(bsdf: Bsdf, out_direction: vec3f, into: vec3f) -> f32 {
    if into.z <= 0.0 || out_direction.z <= 0.0 {
        return 0.0;
    }
    let diffuse = into.z / BSDF_PI;
    if bsdf_specular_share(bsdf) == 0.0 {
        return diffuse;
    }
    let half_vector = normalize(into + out_direction);
    let alpha = bsdf.ggx_alpha;
    let visible = bsdf_distribution(half_vector, alpha) / (1.0 + bsdf_lambda(out_direction, alpha));
    return mix(diffuse, visible / (4.0 * out_direction.z), bsdf_specular_share(bsdf));
}

fn bsdf_sample(bsdf: Bsdf, out_direction: vec3f, stream: ptr<function, u32>) -> BsdfSample {
    let choice = rng_next(stream);
    let xi = rng_next2(stream);
    var into: vec3f;
    if choice < bsdf_specular_share(bsdf) {
        let half_vector = bsdf_visible_normal(out_direction, bsdf.ggx_alpha, xi);
        into = reflect(-out_direction, half_vector);
    } else {
        into = bsdf_cosine_direction(xi);
    }
    let pdf = bsdf_pdf(bsdf, out_direction, into);
    if pdf <= 0.0 {
        return BsdfSample(into, vec3f(0.0), 0.0);
    }
    if bsdf_specular_share(bsdf) == 0.0 {
        // The cosines cancel; saying so keeps a white furnace exactly white.
        return BsdfSample(into, bsdf.diffuse, pdf);
    }
    return BsdfSample(into, bsdf_evaluate(bsdf, out_direction, into) / pdf, pdf);
}

fn bsdf_cosine_direction(xi: vec2f) -> vec3f {
    let radius = sqrt(xi.x);
    let angle = 2.0 * BSDF_PI * xi.y;
    return vec3f(radius * cos(angle), radius * sin(angle), sqrt(max(1.0 - xi.x, 0.0)));
}

// A visible normal of GGX: Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps,
// HPG 2023, listing 3.
fn bsdf_visible_normal(out_direction: vec3f, alpha: f32, xi: vec2f) -> vec3f {
    let stretched = normalize(vec3f(out_direction.xy * alpha, out_direction.z));
    let angle = 2.0 * BSDF_PI * xi.x;
    let z = (1.0 - xi.y) * (1.0 + stretched.z) - stretched.z;
    let radius = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    let on_cap = vec3f(radius * cos(angle), radius * sin(angle), z) + stretched;
    return normalize(vec3f(on_cap.xy * alpha, on_cap.z));
}

// Columns tangent, bitangent, normal: Duff et al., Building an Orthonormal Basis, Revisited,
// JCGT 2017.
fn bsdf_frame(normal: vec3f) -> mat3x3f {
    let sign_z = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (sign_z + normal.z);
    let b = normal.x * normal.y * a;
    let tangent = vec3f(1.0 + sign_z * normal.x * normal.x * a, sign_z * b, -sign_z * normal.x);
    let bitangent = vec3f(b, sign_z + normal.y * normal.y * a, -normal.y);
    return mat3x3f(tangent, bitangent, normal);
}
