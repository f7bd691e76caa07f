//! Renders `.vtex` files in a small showroom, without a window:
//! `cargo run --release --example render_scene -- sign.vtex mug.vtex -o showroom.png`.

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use vtex_format::{Limits, VtexFile};
use vtex_runtime::{Gpu, TraceOptions, Tracer, scene};

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
    let scene = scene::showroom(files);
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

    let path = output.unwrap_or_else(|| "showroom.png".to_owned());
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(&path)?), SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&tracer.read()?.to_srgb8())?;
    Ok(())
}
