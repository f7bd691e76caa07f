//! A vector texture in somebody else's shader: ten lines between a `.vtex` file and a full-screen
//! quad whose fragment shader filters by its own derivatives. No window:
//! `cargo run --release --example own_shader -- sign.vtex sign.png`.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use vtex_format::{Limits, VtexFile};
use vtex_runtime::{FilterMode, Gpu, GpuVtex, LoadOptions, wgpu};

/// The user's shader. `vtex_sample` comes from the fragment that is put in front.
const SHADER: &str = "
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let uv = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Corner(vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0), uv);
}

@fragment
fn shade(at: Corner) -> @location(0) vec4f {
    let drawing = vtex_sample(at.uv, vec4f(dpdx(at.uv), dpdy(at.uv)));
    let paper = vec3f(1.0);
    return vec4f(drawing.rgb + (1.0 - drawing.a) * paper, 1.0);
}
";

const WIDTH: u32 = 768;
/// The target is sRGB: the GPU encodes the shader's linear colours.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(input), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("usage: own_shader IN.vtex OUT.png".into());
    };
    let file = VtexFile::parse(&std::fs::read(input)?, &Limits::default())?;
    let [width, height] = file.meta.canvas_size;
    let size = [WIDTH, rounded(WIDTH as f32 * height / width).max(1)];

    let gpu = Gpu::headless()?;
    let mut options = LoadOptions::default();
    options.pack.filter = FilterMode::Footprint;
    let texture = GpuVtex::upload(&gpu.device, &gpu.queue, &file, &options)?;
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((texture.wgsl_fragment(0, 0) + SHADER).into()),
        });
    let pipeline = pipeline(&gpu.device, &module, texture.bind_group_layout());
    let pixels = draw(&gpu, &pipeline, texture.bind_group(), size)?;

    let mut encoder = png::Encoder::new(BufWriter::new(File::create(output)?), size[0], size[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    texture: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(texture)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shade"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws one triangle over the whole target and reads it back, four bytes a pixel.
fn draw(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    texture: &wgpu::BindGroup,
    [width, height]: [u32; 2],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let extent = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    // Rows of 768 pixels are multiples of the 256 bytes that copies ask for.
    let row_bytes = 4 * width;
    let readback = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row_bytes) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, texture, &[]);
        pass.draw(0..3, 0..1);
    }
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &readback,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            },
        },
        extent,
    );
    gpu.queue.submit([encoder.finish()]);
    readback.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(readback.get_mapped_range(..)?.to_vec())
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "float casts saturate, and a picture that large fails in the driver with a message"
)]
fn rounded(pixels: f32) -> u32 {
    pixels.round() as u32
}
