//! Lookups of alpha that the cells of a texture make needless.

use vtex_format::{CellWord, Grid, Meta, PaintRecord, VtexFile};
use vtex_shaders::{LinkContext, link};

use super::Probe;
use crate::{Camera, Instance, LoadOptions, Material, Mesh, Scene, Sky};

/// Kernel that follows rays through everything see-through and counts what they meet: surfaces, those of
/// them that need a lookup, and where a class is not that of the cell.
const COUNT: &str = "
@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    var stream = rng_stream(3u, id.x, 9u);
    let a = vec3f(rng_next2(&stream), rng_next(&stream)) * 2.0 - 1.0;
    let b = vec3f(rng_next2(&stream), rng_next(&stream)) * 2.0 - 1.0;
    // Half of them from in front of everything, as from a camera; the others up from below, as to a light.
    let starts = select(vec3f(2.0 * a.xy, 6.0), vec3f(2.0 * a.x, -3.0, 2.0 * a.y), id.x % 2u == 1u);
    let ends = select(vec3f(2.0 * b.xy, -1.5), vec3f(2.0 * b.x, 3.0, 2.0 * b.y), id.x % 2u == 1u);
    let direction = normalize(ends - starts);
    var origin = starts;
    for (var i = 0u; i < 64u; i++) {
        let hit = bvh_closest(ray_new(origin, direction, RAY_INFINITY));
        if hit.triangle == TRACE_NONE || !bvh_is_veil(hit) {
            return;
        }
        atomicAdd(&proof_output[0], 1u);
        let class_met = cutout_of(hit);
        if class_met == CUTOUT_MIXED {
            atomicAdd(&proof_output[1], 1u);
        }
        if class_met == CUTOUT_OPAQUE {
            return;
        }
        origin += direction * (hit.t + 1e-4);
    }
}
";

/// A leaf as a baker makes its cells: empty outside, of one paint inside, lists along the outline.
fn leaf(side: u16, holes: bool) -> VtexFile {
    let inside = |x: u16, y: u16| {
        let at = |i: u16| 2.0 * f32::from(i) / f32::from(side) - 1.0;
        let (u, v) = (at(x), at(y));
        let width = 0.8 * (1.0 - v * v).max(0.0) * (0.75 - 0.25 * v);
        let is_hole = holes && (6.0 * u).sin() * (5.0 * v).sin() > 0.75;
        u.abs() < width && !is_hole
    };
    let mut file = VtexFile {
        paints: vec![PaintRecord::solid([0.2, 0.6, 0.1, 1.0])],
        ..VtexFile::blank(Meta::new([1.0; 2], Grid::new([u32::from(side); 2], 8)))
    };
    let cell = |x: u16, y: u16| {
        let corners = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let count = corners.iter().filter(|&&(x, y)| inside(x, y)).count();
        let word = match count {
            0 => CellWord::Empty,
            4 => CellWord::Paint { paint: 0 },
            _ => CellWord::List { offset_words: 0 },
        };
        word.encode().unwrap()
    };
    file.cells = (0..side)
        .flat_map(|y| (0..side).map(move |x| cell(x, y)))
        .collect();
    file.entries = mixed_entry();
    file
}

/// An entry of a paint that is not opaque: nothing can be told of its cell.
fn mixed_entry() -> Vec<u32> {
    let entry = vtex_format::Entry {
        kind: vtex_format::EntryKind::Full,
        last: true,
        opaque: false,
        index: 0,
        data: 0,
    };
    entry.encode().unwrap().to_vec()
}

/// Many cards, turned every way.
fn cards(file: VtexFile) -> Scene {
    let card = |i: u16| {
        let turn = f32::from(i);
        let rotation = glam::Quat::from_euler(glam::EulerRot::XYZ, turn, 0.7 * turn, 2.1 * turn);
        let place = [1.7, 2.3, 3.1].map(|step: f32| 1.6 * (turn * step).sin());
        let placed = glam::Affine3A::from_rotation_translation(rotation, place.into());
        Instance {
            mesh: 0,
            material: 0,
            world_from_object: placed.to_cols_array_2d(),
        }
    };
    Scene {
        meshes: vec![Mesh::plane(0.9, 0.9)],
        instances: (0..80).map(card).collect(),
        materials: vec![Material {
            texture: Some(0),
            ..Material::default()
        }],
        textures: vec![(file, LoadOptions::default())],
        sky: Sky::uniform(1.0),
        environment: None,
        lights: Vec::new(),
        punctual: Vec::new(),
        camera: Camera::facing_rect([0.0; 2], [1.0; 2], 1.0),
    }
}

#[test]
fn cells_make_nine_of_ten_lookups_of_alpha_needless() {
    // Rays meet everything in this text, and ask afterwards.
    let cutout = link("trace/world/cutout", &LinkContext::default()).unwrap();
    let own = cutout.rfind("// trace/world/cutout").unwrap();
    let kept = cutout[own..].replace("fn cutout_hides(", "fn cutout_would_hide(");
    let raw = format!(
        "//!use core/layout\n//!use trace/world/veil\n{kept}\nfn cutout_hides(hit: Hit) -> bool {{ \
         return false; }}\n"
    );
    for (name, side, holes) in [("leaf", 64, false), ("leaf with holes", 128, true)] {
        let scene = cards(leaf(side, holes));
        let context = LinkContext::default().define("trace/world/cutout", raw.clone());
        let imports = ["trace/bvh", "trace/rng"];
        let Some(probe) = Probe::with("cutouts", &scene, &imports, COUNT, context) else {
            return;
        };
        let [met, mixed] = probe.run("count", &[], 2, 512)[..] else {
            unreachable!("two words were asked for");
        };
        assert!(met > 10_000, "{name}: {met} surfaces met");
        let avoided = 1.0 - f64::from(mixed) / f64::from(met);
        assert!(avoided >= 0.9, "{name}: {avoided} of {met}");
    }
}

#[test]
fn what_cells_tell_is_what_lookups_say() {
    // Where a cell is told empty or opaque, the twin's lookups agree all over it.
    let file = leaf(16, true);
    let options = LoadOptions::default();
    let cutout = crate::tracer::world::Cutout::new(&file, &options).unwrap();
    let packed = vtex_shaders::pack(&file, &options.pack);
    let sampler = vtex_shaders::cpu::Sampler::new(&packed);
    let groups = cutout.groups();
    let mut told = [0; 3];
    for index in 0..16 * 16_u16 {
        let word = groups[4 + usize::from(index) / 64][usize::from(index) / 16 % 4];
        let class = word >> (2 * (index % 16)) & 3;
        told[class as usize] += 1;
        for place in 0..25_u16 {
            let at = |cell: u16, part: u16| (f32::from(cell) + f32::from(part) / 5.0 + 0.1) / 16.0;
            let uv = [at(index % 16, place % 5), at(index / 16, place / 5)];
            let [.., alpha] = sampler.sample(uv, [0.0; 4]);
            match class {
                1 => assert!(alpha > 0.999, "{index}: {alpha}"),
                2 => assert!(alpha < 0.001, "{index}: {alpha}"),
                _ => (),
            }
        }
    }
    assert!(told.iter().all(|&count| count > 10), "{told:?}");
}
