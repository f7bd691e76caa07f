//! Lobes of surfaces.

use super::Probe;
use super::chi_square::{self, Slack, check};
use crate::tracer::upload::MIN_GGX_ALPHA;
use crate::{Camera, Scene, Sky};

const IMPORTS: &[&str] = &["trace/bsdf", "trace/rng"];

/// The surface that `proof_input` describes: metallic (negative for Lambert, 2 for a coat), alpha, cosine of the view, base colour.
const SUBJECT: &str = "
fn subject_out() -> vec3f {
    let cosine = proof_input[2];
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return vec3f(sine * 0.8, sine * 0.6, cosine);
}

fn subject_bsdf() -> Bsdf {
    var material: MaterialRecord;
    material.metallic = proof_input[0];
    material.ggx_alpha = proof_input[1];
    material.surface = SURFACE_GLOSSY;
    material.dielectric = vec4f(0.04, 0.04, 0.04, 1.0);
    if proof_input[0] < 0.0 {
        material.surface = SURFACE_DIFFUSE;
    }
    if proof_input[0] > 1.0 {
        return bsdf_coat(proof_input[1], subject_out()).bsdf;
    }
    return bsdf_new(material, vec3f(proof_input[3]), subject_out());
}

fn subject_sample(stream: ptr<function, u32>) -> vec4f {
    let sample = bsdf_sample(subject_bsdf(), subject_out(), stream);
    return vec4f(sample.direction, sample.pdf);
}

fn subject_pdf(direction: vec3f) -> f32 {
    return bsdf_pdf(subject_bsdf(), subject_out(), direction);
}
";

/// What is reflected: by samples as paths take them, and by directions that are alike likely.
const ALBEDO: &str = "
@compute @workgroup_size(64)
fn albedo(@builtin(global_invocation_id) id: vec3u) {
    var stream = rng_stream(11u, id.x, 5u);
    let bsdf = subject_bsdf();
    let out = subject_out();
    var by_lobe = 0.0;
    var by_chance = 0.0;
    for (var i = 0u; i < 64u; i++) {
        by_lobe += bsdf_sample(bsdf, out, &stream).weight.y;
        let xi = rng_next2(&stream);
        let height = 1.0 - 2.0 * xi.x;
        let radius = sqrt(max(1.0 - height * height, 0.0));
        let angle = 6.2831853 * xi.y;
        let into = vec3f(radius * cos(angle), radius * sin(angle), height);
        by_chance += bsdf_evaluate(bsdf, out, into).y * 12.5663706;
    }
    atomicStore(&proof_output[2u * id.x], bitcast<u32>(by_lobe / 64.0));
    atomicStore(&proof_output[2u * id.x + 1u], bitcast<u32>(by_chance / 64.0));
}
";

fn nothing() -> Scene {
    Scene {
        meshes: Vec::new(),
        instances: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        sky: Sky::uniform(1.0),
        environment: None,
        lights: Vec::new(),
        punctual: Vec::new(),
        camera: Camera::facing_rect([0.0; 2], [1.0; 2], 1.0),
    }
}

const EXACT: Slack = Slack {
    apart: 1.0e-4,
    edges: 0.0,
};
const COSINES: [f32; 4] = [0.99, 0.7, 0.3, 0.06];

#[test]
fn lobes_are_sampled_by_their_densities() {
    let text = [SUBJECT, chi_square::KERNELS].concat();
    let Some(probe) = Probe::new("samples of lobes", &nothing(), IMPORTS, &text) else {
        return;
    };
    for (metallic, roughness, base) in [
        (-1.0, 1.0, 0.8),
        (0.0, 0.3, 0.5),
        (0.0, 0.7, 1.0),
        (0.4, 0.5, 0.9),
        (1.0, 0.25, 0.9),
        (1.0, 1.0, 1.0),
        // A coat.
        (2.0, 0.3, 1.0),
    ] {
        for cosine in COSINES {
            let name = format!("metallic {metallic}, roughness {roughness}, cosine {cosine}");
            let alpha: f32 = roughness * roughness;
            check(&probe, &name, &[metallic, alpha, cosine, base], EXACT);
        }
    }
}

/// Means and their standard errors.
fn albedos(probe: &Probe, input: &[f32]) -> [[f64; 2]; 2] {
    let groups = 512;
    let words = probe.run("albedo", input, 2 * 64 * groups as usize, groups);
    [0, 1].map(|which| {
        let values = words.iter().skip(which).step_by(2);
        let values: Vec<f64> = values.map(|&w| f64::from(f32::from_bits(w))).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let spread = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0);
        [mean, (spread / count).sqrt()]
    })
}

#[test]
fn white_surfaces_reflect_all_light_and_none_reflects_more() {
    let text = [SUBJECT, ALBEDO].concat();
    let Some(probe) = Probe::new("furnaces", &nothing(), IMPORTS, &text) else {
        return;
    };
    for metallic in [0.0, 0.5, 1.0] {
        for roughness in [0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0_f32] {
            for cosine in [1.0, 0.9, 0.7, 0.5, 0.3, 0.15, 0.08] {
                let alpha = (roughness * roughness).max(MIN_GGX_ALPHA);
                let name = format!("metallic {metallic}, roughness {roughness}, cosine {cosine}");
                let [[by_lobe, error], [by_chance, chance_error]] =
                    albedos(&probe, &[metallic, alpha, cosine, 1.0]);
                assert!(error < 1.0e-3, "{name}: known to {error} alone");
                // In between the two models' sum is convex, and what is missing is darker.
                let least = if metallic == 0.5 { 0.8 } else { 0.995 };
                assert!(
                    (least..1.001 + 4.0 * error).contains(&by_lobe),
                    "{name}: {by_lobe}"
                );
                // A part of the lobe may be missed by samples; directions alike likely find it.
                if roughness >= 0.35 {
                    let apart = (by_chance - by_lobe).abs();
                    assert!(
                        apart < 5.0 * (error + chance_error),
                        "{name}: {by_lobe}, {by_chance}"
                    );
                }
                let [[grey, error], _] = albedos(&probe, &[metallic, alpha, cosine, 0.4]);
                assert!(grey < 1.001 + 3.0 * error, "{name}: {grey}");
            }
        }
    }
}
