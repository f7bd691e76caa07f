//! Renders `.vtex` files on a board and a ball, without a window:
//! `cargo run --release --example render_scene -- sign.vtex ball.vtex -o scene.png`.

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use vtex_format::{Limits, VtexFile};
use vtex_runtime::{
    Camera, Gpu, Instance, LoadOptions, Material, Mesh, RectLight, Scene, Sky, Surface,
    TraceOptions, Tracer, scene,
};

const SIZE: [u32; 2] = [960, 640];
const SAMPLES: u32 = 64;

#[expect(clippy::print_stdout, reason = "an example tells what it did")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let output = match arguments.iter().position(|a| a == "-o") {
        Some(at) if at + 1 < arguments.len() => arguments.drain(at..at + 2).nth(1),
        _ => None,
    };
    let files = arguments
        .iter()
        .map(|path| Ok(VtexFile::parse(&std::fs::read(path)?, &Limits::default())?))
        .collect::<Result<Vec<_>, Box<dyn std::error::Error>>>()?;

    let gpu = Gpu::headless()?;
    let options = TraceOptions::for_samples(SAMPLES);
    let scene = board_and_ball(files);
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, SIZE, &options)?;
    // The first dispatch compiles on some drivers; it is not part of the figure.
    tracer.accumulate(1)?;
    let before = tracer.stats()?;
    let start = Instant::now();
    tracer.accumulate(SAMPLES - 1)?;
    let seconds = start.elapsed().as_secs_f64();
    let rays = (tracer.stats()?.rays - before.rays) as f64;
    println!(
        "{}: {SAMPLES} samples, {seconds:.2} s, {:.2} Mrays/s",
        gpu.adapter_name(),
        rays / seconds * 1e-6
    );

    let path = output.unwrap_or_else(|| "scene.png".to_owned());
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(&path)?), SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&tracer.read()?.to_srgb8())?;
    Ok(())
}

/// The first file on a board, the last one on a glazed ball, on a grey floor under a light. Without
/// files both are white.
fn board_and_ball(files: Vec<VtexFile>) -> Scene {
    let aspect = files.first().map_or(1.0, scene::canvas_aspect);
    let floor = Material {
        base_color: [0.3; 3],
        ..Material::default()
    };
    let paper = Material {
        texture: (!files.is_empty()).then_some(0),
        // Transparent parts of the drawing show white paper, not what is behind the board.
        backing: Some([0.9; 3]),
        ..Material::default()
    };
    let glazed = Material {
        texture: files.len().checked_sub(1),
        surface: Surface::Glossy {
            metallic: 0.0,
            roughness: 0.15,
        },
        ..paper
    };
    // Where x, y, z and the origin go: moved, and turned so that what faced z faces up.
    let at = |x, y, z| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [x, y, z]];
    let lying = [
        [1.0, 0.0, 0.0],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0],
    ];
    let objects = [
        (Mesh::plane(20.0, 20.0), floor, lying),
        (Mesh::plane(1.2 * aspect, 1.2), paper, at(-0.8, 0.6, 0.0)),
        (Mesh::sphere(0.5, 96, 2.0), glazed, at(0.9, 0.5, 0.2)),
    ];
    let mut scene = Scene {
        meshes: Vec::new(),
        instances: Vec::new(),
        materials: Vec::new(),
        textures: files
            .into_iter()
            .map(|file| (file, LoadOptions::default()))
            .collect(),
        environment: None,
        punctual: Vec::new(),
        sky: Sky::uniform(0.4),
        lights: vec![RectLight {
            corner: [-1.0, 3.0, 0.5],
            edge_u: [2.0, 0.0, 0.0],
            edge_v: [0.0, 0.0, 2.0],
            radiance: [6.0; 3],
        }],
        camera: Camera {
            position: [0.0, 1.2, 4.5],
            target: [0.0, 0.5, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_y_rad: 0.55,
        },
    };
    for (mesh, material, world_from_object) in objects {
        scene.instances.push(Instance {
            mesh: scene.meshes.len(),
            material: scene.materials.len(),
            world_from_object,
        });
        scene.meshes.push(mesh);
        scene.materials.push(material);
    }
    scene
}
