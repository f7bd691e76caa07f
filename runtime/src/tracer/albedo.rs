//! What the GGX lobe of `shaders/wgsl/trace/bsdf.wgsl` reflects by single scattering.

use std::f32::consts::PI;
use std::sync::OnceLock;

use super::upload::MIN_GGX_ALPHA;

/// `ALBEDO_STEPS` of `shaders/wgsl/trace/albedo.wgsl`.
const STEPS: u16 = 32;
/// Places of the integral; with this many the table is right to 0.002 for views above a twentieth.
const PLACES: u16 = 1024;
/// The most grazing view of the table: at 0 itself the lobe has no limit.
const LEAST_COSINE: f32 = 1.0e-4;

/// The table in the order in which the shader reads it.
pub(super) fn table() -> &'static [[u32; 4]] {
    static TABLE: OnceLock<Vec<[u32; 4]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let step = |index: u16| (f32::from(index) / f32::from(STEPS - 1)).powi(2);
        let row = |row: u16| -> Vec<[f32; 2]> {
            let of = |column| albedo(step(column).max(LEAST_COSINE), step(row).max(MIN_GGX_ALPHA));
            (0..STEPS).map(of).collect()
        };
        let pairs = |row: Vec<[f32; 2]>| -> Vec<[u32; 4]> {
            let next = row.iter().skip(1).chain(row.last());
            let pairs = row.iter().zip(next);
            pairs
                .map(|(&[a, b], &[c, d])| [a, b, c, d].map(f32::to_bits))
                .collect()
        };
        (0..STEPS).flat_map(|index| pairs(row(index))).collect()
    })
}

/// The part that the reflectance straight on is multiplied with, and the part that is there in any case,
/// for a view at this cosine: means over visible normals.
fn albedo(cosine: f32, alpha: f32) -> [f32; 2] {
    let lambda = |z: f32| {
        let tangent_squared = (1.0 - z * z).max(0.0) / (z * z);
        0.5 * ((1.0 + alpha * alpha * tangent_squared).sqrt() - 1.0)
    };
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let stretched = [alpha * sine, cosine];
    let scale = 1.0 / stretched[0].hypot(stretched[1]);
    let [x, z] = stretched.map(|c| c * scale);
    let mut sums = [0.0; 2];
    for place in 0..PLACES {
        // The R2 sequence (Roberts 2018). Both sides of the plane of incidence are alike.
        let [u, v] = [0.754_877_7, 0.569_840_3].map(|step| (0.5 + f32::from(place) * step).fract());
        let height = (1.0 - v) * (1.0 + z) - z;
        let radius = (1.0 - height * height).max(0.0).sqrt();
        let (sin, cos) = (PI * u).sin_cos();
        let cap = [radius * cos + x, radius * sin, height + z];
        let normal = [alpha * cap[0], alpha * cap[1], cap[2]];
        let length = normal.iter().map(|c| c * c).sum::<f32>().sqrt();
        let [normal_x, _, normal_z] = normal.map(|c| c / length);
        let along = sine * normal_x + cosine * normal_z;
        let into = 2.0 * along * normal_z - cosine;
        if into <= 0.0 {
            continue;
        }
        let weight = (1.0 + lambda(cosine)) / (1.0 + lambda(cosine) + lambda(into));
        let fresnel = (1.0 - along).clamp(0.0, 1.0).powi(5);
        sums[0] += weight * (1.0 - fresnel);
        sums[1] += weight * fresnel;
    }
    sums.map(|sum| sum / f32::from(PLACES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_surfaces_lose_nothing_and_rough_ones_do() {
        // Of a mirror all is left, parted by Schlick's term.
        let [first, rest] = albedo(0.5, MIN_GGX_ALPHA);
        assert!((first + rest - 1.0).abs() < 1.0e-3, "{first} {rest}");
        assert!((rest - 0.5_f32.powi(5)).abs() < 1.0e-3, "{rest}");
        // By numerical integration of the model elsewhere.
        for (roughness, whole) in [(0.2_f32, 0.9989), (0.5, 0.9148), (1.0, 0.3093)] {
            let [first, rest] = albedo(0.9874, roughness * roughness);
            assert!((first + rest - whole).abs() < 3.0e-3, "{first} {rest}");
        }
        assert_eq!(table().len(), usize::from(STEPS * STEPS));
        let text = vtex_shaders::link("trace/albedo", &vtex_shaders::LinkContext::default());
        let line = format!("const ALBEDO_STEPS: u32 = {STEPS}u;");
        assert!(text.unwrap().contains(&line), "no `{line}`");
    }
}
