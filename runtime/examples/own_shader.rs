//! Vector textures in somebody else's shader: a row of quads in one draw call, each with a texture of its
//! own, filtered by the fragment shader's derivatives. No window:
//! `cargo run --release --example own_shader -- a.vtex b.vtex c.vtex row.png`.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use vtex_runtime::{
    FilterMode, Gpu, Limits, LoadOptions, TextureHandle, TextureSet, TextureSetOptions, VtexFile,
    wgpu,
};
use wgpu::util::DeviceExt as _;

/// The user's shader. `vtex_sample` comes from the fragment that is put in front.
const SHADER: &str = "
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) @interpolate(flat) texture: u32,
}

// An instance: its texture, and its left, top, right and bottom side in clip space.
@vertex
fn corner(
    @builtin(vertex_index) index: u32,
    @location(0) texture: u32,
    @location(1) sides: vec4f,
) -> Corner {
    let uv = vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(mix(sides.xy, sides.zw, uv), 0.0, 1.0), uv, texture);
}

@fragment
fn shade(at: Corner) -> @location(0) vec4f {
    let drawing = vtex_sample(at.texture, at.uv, vec4f(dpdx(at.uv), dpdy(at.uv)));
    let paper = vec3f(1.0);
    return vec4f(drawing.rgb + (1.0 - drawing.a) * paper, 1.0);
}
";

/// Pixels of a quad's longer side.
const SIDE: u32 = 256;
/// The target is sRGB: the GPU encodes the shader's linear colours.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// What a quad reads.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Quad {
    texture: TextureHandle,
    sides: [f32; 4],
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut inputs: Vec<String> = std::env::args().skip(1).collect();
    let output = inputs.pop().filter(|_| !inputs.is_empty());
    let output = output.ok_or("usage: own_shader IN.vtex... OUT.png")?;
    let read = |path: &String| -> Result<VtexFile, Box<dyn Error>> {
        Ok(VtexFile::parse(&std::fs::read(path)?, &Limits::default())?)
    };
    let files: Vec<VtexFile> = inputs.iter().map(read).collect::<Result<_, _>>()?;

    let gpu = Gpu::headless()?;
    let mut options = LoadOptions::default();
    options.pack.filter = FilterMode::Footprint;
    let mut set = TextureSet::new(&gpu.device, &gpu.queue, &TextureSetOptions::default())?;
    let handles = set.add_all(files.iter().map(|file| (file, &options)))?;
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((set.wgsl_fragment(0, 0) + SHADER).into()),
        });
    let pipeline = pipeline(&gpu.device, &module, set.bind_group_layout());
    let quads = quads(&files, &handles);
    let size = [SIDE * u32::try_from(quads.len())?, SIDE];
    let pixels = draw(&gpu, &pipeline, set.bind_group(), &quads, size)?;

    let mut encoder = png::Encoder::new(BufWriter::new(File::create(output)?), size[0], size[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

/// Side by side, each canvas as large as its part of the row allows.
fn quads(files: &[VtexFile], handles: &[TextureHandle]) -> Vec<Quad> {
    let part = 2.0 / files.len() as f32;
    let quad = |(index, (file, &texture)): (usize, (&VtexFile, &TextureHandle))| {
        let [width, height] = file.meta.canvas_size;
        let longer = width.max(height);
        let middle = part * (index as f32 + 0.5) - 1.0;
        let [x, y] = [0.5 * part * width / longer, height / longer];
        Quad {
            texture,
            sides: [middle - x, y, middle + x, -y],
        }
    };
    files.iter().zip(handles).enumerate().map(quad).collect()
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    textures: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(textures)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Quad>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![0 => Uint32, 1 => Float32x4],
            })],
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shade"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into())],
        }),
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws the quads and reads the target back, four bytes a pixel.
fn draw(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    textures: &wgpu::BindGroup,
    quads: &[Quad],
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
    // Rows of quads are multiples of the 256 bytes that copies ask for.
    let row_bytes = 4 * width;
    let readback = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row_bytes) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let instances = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(quads),
            usage: wgpu::BufferUsages::VERTEX,
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
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, textures, &[]);
        pass.set_vertex_buffer(0, instances.slice(..));
        pass.draw(0..4, 0..u32::try_from(quads.len())?);
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
