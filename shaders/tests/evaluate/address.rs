//! Address modes and texture matrix.

use vtex_format::{AddressMode, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

use crate::builder::{row_of, set_solid};
use crate::formula;

/// Four cells of grey 0.1, 0.2, 0.3, 0.4.
fn steps() -> VtexFile {
    let mut file = row_of(4);
    for cell in 0..4 {
        let c = 0.1 * (cell + 1) as f32;
        set_solid(&mut file, cell, [c, c, c, 1.0]);
    }
    file
}

/// Which of the four cells is seen at `uv`; `None` for nothing.
fn seen(options: &PackOptions, uv: [f32; 2]) -> Option<usize> {
    let packed = pack(&steps(), options);
    let [r, _, _, a] = Sampler::new(&packed).sample(uv, [0.0; 4]);
    let encoded = formula::encode(f64::from(r)) * 10.0;
    (a > 0.0).then(|| encoded.round() as usize - 1)
}

#[test]
fn address_modes_follow_their_names() {
    use AddressMode::{Border, Clamp, Mirror, Repeat};
    let table = [
        (Clamp, -0.1, Some(0)),
        (Clamp, 7.0, Some(3)),
        (Repeat, -0.1, Some(3)),
        (Repeat, 1.3, Some(1)),
        (Repeat, -3.9, Some(0)),
        (Mirror, -0.1, Some(0)),
        (Mirror, 1.1, Some(3)),
        (Mirror, 1.9, Some(0)),
        (Mirror, 2.3, Some(1)),
        (Mirror, -1.2, Some(3)),
        (Border, -0.001, None),
        (Border, 1.001, None),
        (Border, 1.0, Some(3)),
        (Border, 0.3, Some(1)),
    ];
    for (mode, u, expected) in table {
        let options = PackOptions {
            address: Some([mode, Clamp]),
            ..PackOptions::default()
        };
        assert_eq!(seen(&options, [u, 0.5]), expected, "{mode:?} at {u}");
        // The same along v: only border tells rows of one cell apart.
        let options = PackOptions {
            address: Some([Clamp, mode]),
            ..PackOptions::default()
        };
        let expected = expected.and(Some(1));
        assert_eq!(
            seen(&options, [0.3, u]),
            expected,
            "{mode:?} along v at {u}"
        );
    }
}

#[test]
fn the_texture_matrix_comes_first() {
    // u' = v, v' = u: a transposition, then a shift by a cell.
    let options = PackOptions {
        texture_matrix: Some([0.0, 1.0, 1.0, 0.0, 0.25, 0.0]),
        ..PackOptions::default()
    };
    assert_eq!(seen(&options, [0.5, 0.1]), Some(1));
    assert_eq!(seen(&options, [0.5, 0.6]), Some(3));
    let matrix = PackOptions {
        texture_matrix: Some([2.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        address: Some([AddressMode::Repeat; 2]),
        ..PackOptions::default()
    };
    assert_eq!(seen(&matrix, [0.65, 0.5]), Some(1), "1.3 repeats to 0.3");
}

#[test]
fn the_footprint_goes_through_the_matrix() {
    use crate::builder::{Cover, set_list};
    let mut file = row_of(1);
    set_list(&mut file, 0, &[(Cover::Edge(2.0), [1.0; 4])]);
    let alpha = |scale: f32, u: f32, width: f32| {
        let options = PackOptions {
            filter: FilterMode::Footprint,
            texture_matrix: Some([scale, 0.0, 0.0, scale, 0.0, 0.0]),
            ..PackOptions::default()
        };
        let packed = pack(&file, &options);
        Sampler::new(&packed).sample([u, 0.5 / scale], [width, 0.0, 0.0, width])[3]
    };
    let (plain, halved) = (alpha(1.0, 0.55, 0.4), alpha(0.5, 1.1, 0.8));
    assert!((plain - halved).abs() < 1e-6, "{plain} and {halved}");
    assert!(plain > 0.55 && plain < 0.75, "on the ramp: {plain}");
}

/// Beyond a side that it is clamped to, all of a footprint shows the side; along it, it keeps its extent.
#[test]
fn beyond_a_side_a_footprint_shows_the_side() {
    use AddressMode::Clamp;
    let options = PackOptions {
        address: Some([Clamp; 2]),
        filter: FilterMode::Footprint,
        ..PackOptions::default()
    };
    let packed = pack(&steps(), &options);
    let sampler = Sampler::new(&packed);
    let wide = [0.7, 0.0, 0.0, 0.2];
    for (u, side) in [(-0.1, 0.0), (1.2, 1.0)] {
        let beyond = sampler.sample([u, 0.5], wide);
        assert_eq!(beyond, sampler.sample([side, 0.5], [0.0; 4]), "at {u}");
    }
    let below = sampler.sample([0.5, 1.3], wide);
    assert_eq!(below, sampler.sample([0.5, 1.0], [0.7, 0.0, 0.0, 0.0]));
    assert_ne!(below, sampler.sample([0.5, 1.0], [0.0; 4]));
}

/// What is mirrored is so with its footprint: one that leans leans the other way.
#[test]
fn a_mirrored_footprint_leans_the_other_way() {
    use crate::builder::{Cover, set_list};
    let mut file = row_of(2);
    set_list(&mut file, 0, &[(Cover::Edge(2.0), [1.0; 4])]);
    set_solid(&mut file, 1, [1.0; 4]);
    let options = PackOptions {
        address: Some([AddressMode::Mirror; 2]),
        filter: FilterMode::Footprint,
        ..PackOptions::default()
    };
    let packed = pack(&file, &options);
    let sampler = Sampler::new(&packed);
    let axes = [0.1, 0.3, 0.05, -0.02];
    let [left, up, both] = [
        [-axes[0], axes[1], -axes[2], axes[3]],
        [axes[0], -axes[1], axes[2], -axes[3]],
        axes.map(|extent| -extent),
    ];
    for (uv, folded, axes_there) in [
        ([0.25, 0.5], [0.25, 0.5], axes),
        ([-0.25, 0.5], [0.25, 0.5], left),
        ([0.25, 1.5], [0.25, 0.5], up),
        ([1.75, -0.5], [0.25, 0.5], both),
        ([2.25, -1.5], [0.25, 0.5], axes),
    ] {
        let found = sampler.sample(uv, axes);
        assert_eq!(found, sampler.sample(folded, axes_there), "at {uv:?}");
    }
}

/// In border mode a footprint sees nothing beyond a side, so the side is smooth; a point is on one side.
#[test]
fn a_footprint_smooths_the_side_of_a_border() {
    use AddressMode::{Border, Clamp};
    let mut file = row_of(1);
    set_solid(&mut file, 0, [1.0; 4]);
    let alpha = |filter, uv: [f32; 2], axes| {
        let options = PackOptions {
            address: Some([Border, Clamp]),
            filter,
            ..PackOptions::default()
        };
        Sampler::new(&pack(&file, &options)).sample(uv, axes)[3]
    };
    let table = [
        (-0.06, [0.1, 0.0, 0.0, 0.1], 0.0),
        (-0.025, [0.1, 0.0, 0.0, 0.1], 0.25),
        (0.0, [0.1, 0.0, 0.0, 0.1], 0.5),
        (0.025, [0.06, 0.0, -0.04, 0.1], 0.75),
        (0.5, [0.1, 0.0, 0.0, 0.1], 1.0),
        (1.04, [0.1, 0.0, 0.0, 0.1], 0.1),
        (0.5, [2.0, 0.0, 0.0, 0.1], 0.5),
        // Extents of few units in the last place, and of less than one, lose nothing.
        (0.598_138_9, [5.9e-7, 0.0, 3.0e-7, 0.0], 1.0),
        (0.6, [1e-9, 0.0, 0.0, 1e-9], 1.0),
        (1.0, [0.0; 4], 1.0),
        (1.001, [0.0; 4], 0.0),
    ];
    for (u, axes, expected) in table {
        let found = alpha(FilterMode::Footprint, [u, 0.5], axes);
        assert!((found - expected).abs() < 1e-5, "{found} at {u}");
        let point = alpha(FilterMode::Point, [u, 0.5], axes);
        let inside = (0.0..=1.0).contains(&u);
        assert_eq!(point, f32::from(u8::from(inside)), "a point at {u}");
        let below = alpha(FilterMode::Footprint, [0.5, u], axes);
        assert!((below - alpha(FilterMode::Footprint, [0.5, 0.5], axes)).abs() < 1e-5);
    }
}
