//! How surfaces look.

use super::{radiance, unit};

/// How a surface looks. Both sides look alike, but of [`Glass`] that is a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Reflectance in \[0, 1\], linear; multiplies the texture.
    pub base_color: [f32; 3],
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: Option<usize>,
    /// What lies under the texture's transparent parts: `None` lets that share of the rays go
    /// straight through, a colour (linear, in \[0, 1\]) makes the surface solid.
    pub backing: Option<[f32; 3]>,
    /// How light scatters.
    pub surface: Surface,
    /// What of a [`Surface::Glossy`] is not metal.
    pub dielectric: Dielectric,
    /// A clear layer above all that.
    pub coat: Option<Coat>,
    /// Light goes through what is not metal.
    pub glass: Option<Glass>,
    /// Radiance of its own, linear, on both sides. Paths aim at meshes that glow as they do at
    /// [`Scene::lights`](super::Scene::lights), unless they have a see-through texture: those are found
    /// by scattering alone.
    pub emission: [f32; 3],
}

/// How light scatters at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// Lambert.
    Diffuse,
    /// glTF's metallic-roughness model: GGX over Lambert.
    Glossy {
        /// 0 is a [`Dielectric`] over the base colour, 1 a metal of the base colour.
        metallic: f32,
        /// Perceptual roughness in \[0, 1\]; GGX's alpha is its square, at least 0.001.
        roughness: f32,
    },
    /// Not at all: its colour is what is seen, whatever light falls on it.
    Unlit,
}

/// What a surface that is not metal reflects above its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Seen straight on, in \[0, 1\].
    pub straight_on: [f32; 3],
    /// At grazing views, in \[0, 1\].
    pub grazing: f32,
}

/// A clear coat of index 1.5.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coat {
    /// In \[0, 1\].
    pub strength: f32,
    /// Perceptual roughness in \[0, 1\].
    pub roughness: f32,
}

/// Light through a surface. Lights are not aimed at through it, so small ones behind it are noisy, and those
/// without size cast its shadow as if it were solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Share of the light that would reach the colour below and goes through instead, in \[0, 1\].
    pub share: f32,
    /// Index of refraction, at least 1.
    pub index: f32,
    /// What the body behind it takes from light in a unit of length, for each colour; `None` for a thin
    /// wall, which does not bend light.
    pub absorption: Option<[f32; 3]>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: [1.0; 3],
            texture: None,
            backing: None,
            surface: Surface::Diffuse,
            dielectric: Dielectric::default(),
            coat: None,
            glass: None,
            emission: [0.0; 3],
        }
    }
}

impl Default for Dielectric {
    /// Of index 1.5.
    fn default() -> Self {
        Self {
            straight_on: [0.04; 3],
            grazing: 1.0,
        }
    }
}

impl Material {
    /// Whether it may let rays through.
    pub(crate) fn is_veil(&self) -> bool {
        self.texture.is_some() && self.backing.is_none()
    }

    /// `textures`: how many there are.
    pub(super) fn is_valid(&self, textures: usize) -> bool {
        let (metallic, roughness) = self.surface.parameters();
        let glass = self.glass.is_none_or(|glass| {
            let absorbed = glass.absorption.unwrap_or_default();
            unit(glass.share)
                && (1.0..=100.0).contains(&glass.index)
                && absorbed.iter().all(|&a| radiance(a))
        });
        self.base_color.iter().all(|&c| unit(c))
            && self.backing.iter().flatten().all(|&c| unit(c))
            && unit(metallic)
            && unit(roughness)
            && self.dielectric.straight_on.iter().all(|&c| unit(c))
            && unit(self.dielectric.grazing)
            && self
                .coat
                .is_none_or(|coat| unit(coat.strength) && unit(coat.roughness))
            && glass
            && self.emission.iter().all(|&c| radiance(c))
            && self.texture.is_none_or(|texture| texture < textures)
    }
}

impl Surface {
    /// Metallic and roughness; others than the glossy one have neither.
    pub(crate) fn parameters(self) -> (f32, f32) {
        match self {
            // Not read by the shader, but must pass the checks and make a finite record.
            Self::Diffuse | Self::Unlit => (0.0, 1.0),
            Self::Glossy {
                metallic,
                roughness,
            } => (metallic, roughness),
        }
    }
}
