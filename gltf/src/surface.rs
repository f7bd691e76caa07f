//! What the tracer's material model has of a material of the asset.

use vtex_runtime::{Coat, Dielectric, Glass, Material as TraceMaterial, Surface};

use crate::document::material::{AlphaMode, Ior, Material};
use crate::error::Outcome;
use crate::raster::Alpha;
use crate::texture::{Made, Textures};

/// Colour under the transparent parts of a drawing where alpha is not to be read: paper.
const PAPER: [f32; 3] = [1.0; 3];

/// The material as the tracer shows it. What it does not show is in a warning.
pub(crate) fn traced(
    material: &Material,
    place: &str,
    textures: &mut Textures<'_>,
    warnings: &mut Vec<String>,
) -> Outcome<TraceMaterial> {
    let pbr = &material.pbr_metallic_roughness;
    let [r, g, b, alpha_factor] = pbr.base_color_factor.map(unit);
    let alpha = match material.alpha_mode {
        AlphaMode::Opaque => Alpha::OPAQUE,
        mode => Alpha {
            mode,
            factor: alpha_factor,
            cutoff: material.alpha_cutoff,
        },
    };
    let made = match &pbr.base_color_texture {
        Some(slot) => textures.color(slot, alpha, place, warnings)?,
        None => None,
    };
    let is_through = material.alpha_mode != AlphaMode::Opaque && alpha_factor < 1.0;
    let made = match made {
        None if is_through => Some(textures.plain(alpha)),
        made => made,
    };
    let mut shown = Vec::new();
    let is_vector = made.is_some_and(|made: Made| made.is_vector);
    if is_vector && is_through {
        shown.push("the alpha of baseColorFactor over a drawing");
    }
    let (mut metallic, mut roughness) = (pbr.metallic_factor, pbr.roughness_factor);
    if let Some(slot) = &pbr.metallic_roughness_texture
        && let Some([_, green, blue, _]) = textures.mean(slot, true, place, warnings)?
    {
        (metallic, roughness) = (metallic * blue, roughness * green);
    }
    let strength = material.extensions.emissive_strength.emissive_strength;
    let mut emission = material.emissive_factor.map(|c| radiance(c * strength));
    let glows = emission.iter().any(|&c| c > 0.0);
    if let Some(slot) = &material.emissive_texture
        && glows
        && let Some(mean) = textures.mean(slot, false, place, warnings)?
    {
        for (emission, mean) in emission.iter_mut().zip(mean) {
            *emission *= mean;
        }
    }
    // Other slots are read too, so that a wrong index is an error whatever the tracer shows.
    for (_, slot) in material.slots() {
        textures.check(slot, place)?;
    }
    shown.extend(not_shown(material, glows));
    if !shown.is_empty() {
        warnings.push(format!(
            "{place}: not shown yet, or by its mean: {}",
            shown.join(", ")
        ));
    }
    Ok(TraceMaterial {
        base_color: [r, g, b],
        texture: made.map(|made| made.index),
        backing: (is_vector && material.alpha_mode == AlphaMode::Opaque)
            .then(|| [0, 1, 2].map(|c| PAPER[c] * [r, g, b][c])),
        surface: match material.extensions.unlit {
            Some(_) => Surface::Unlit,
            None => Surface::Glossy {
                metallic: unit(metallic),
                roughness: unit(roughness),
            },
        },
        dielectric: dielectric(material),
        coat: coat(material),
        glass: glass(material),
        emission,
    })
}

/// Textures of extensions that are shown by their factors.
const BY_FACTOR: [&str; 7] = [
    "transmissionTexture",
    "thicknessTexture",
    "specularTexture",
    "specularColorTexture",
    "clearcoatTexture",
    "clearcoatRoughnessTexture",
    "clearcoatNormalTexture",
];

/// Index of refraction; 0 in glTF asks for what reflects all light.
fn index(ior: Ior) -> f32 {
    match ior.ior {
        ior if ior >= 1.0 => ior.min(100.0),
        _ => 1.5,
    }
}

fn dielectric(material: &Material) -> Dielectric {
    let more = &material.extensions;
    let index = index(more.ior);
    let plain = match more.ior.ior {
        0.0 => 1.0,
        _ => ((index - 1.0) / (index + 1.0)).powi(2),
    };
    let (factor, color) = match &more.specular {
        Some(specular) => (
            unit(specular.specular_factor),
            specular.specular_color_factor,
        ),
        None => (1.0, [1.0; 3]),
    };
    Dielectric {
        straight_on: color.map(|c| unit(plain * radiance(c)) * factor),
        grazing: factor,
    }
}

fn coat(material: &Material) -> Option<Coat> {
    let coat = material.extensions.clearcoat.as_ref()?;
    Some(Coat {
        strength: unit(coat.clearcoat_factor),
        roughness: unit(coat.clearcoat_roughness_factor),
    })
}

fn glass(material: &Material) -> Option<Glass> {
    let more = &material.extensions;
    let transmission = more.transmission.as_ref()?;
    let body = more
        .volume
        .as_ref()
        .filter(|volume| volume.thickness_factor > 0.0);
    Some(Glass {
        share: unit(transmission.transmission_factor),
        index: index(more.ior),
        // Beer: what is left at the distance is the colour. Where that is black, nearly nothing is.
        absorption: body.map(|volume| {
            let distance = volume
                .attenuation_distance
                .filter(|&distance| distance > 0.0);
            let left = volume.attenuation_color.map(|c| unit(c).max(1.0e-6));
            left.map(|c| distance.map_or(0.0, |distance| radiance(-c.ln() / distance)))
        }),
    })
}

fn not_shown(material: &Material, glows: bool) -> Vec<&'static str> {
    let more = &material.extensions;
    let pbr = &material.pbr_metallic_roughness;
    let all = [
        (
            "metallicRoughnessTexture (its mean is)",
            pbr.metallic_roughness_texture.is_some(),
        ),
        (
            "emissiveTexture (its mean is)",
            material.emissive_texture.is_some() && glows,
        ),
        ("normalTexture", material.normal_texture.is_some()),
        (
            "occlusionTexture (paths find occlusion themselves)",
            material.occlusion_texture.is_some(),
        ),
        ("KHR_materials_sheen", more.sheen.is_some()),
    ];
    let textures = material.slots().into_iter().map(|(name, _)| name);
    let textures = textures.filter(|name| BY_FACTOR.contains(name));
    all.into_iter()
        .filter(|(_, is_there)| *is_there)
        .map(|(name, _)| name)
        .chain(textures)
        .collect()
}

/// In \[0, 1\]; 0 for what is no number.
fn unit(value: f32) -> f32 {
    if value.is_nan() {
        0.0
    } else {
        value.clamp(0.0, 1.0)
    }
}

/// Finite and not negative.
fn radiance(value: f32) -> f32 {
    if value.is_finite() {
        value.max(0.0)
    } else {
        0.0
    }
}
