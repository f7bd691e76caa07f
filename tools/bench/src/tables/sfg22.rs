//! The method of \[SFG22\]: dense MSDF layers, every one read at every lookup.

use crate::timing::{Device, Kernel};

/// \[SFG22\]'s own size of a layer.
pub(crate) const LAYER_SIZE: u32 = 512;
/// Shapes of the kinds in \[SFG22\] Table 1: one, a star pattern, text, the Tiger.
pub(crate) const LAYER_COUNTS: [u32; 4] = [1, 5, 27, 240];
/// Half width of the smoothstep, \[SFG22\]'s default.
const SMOOTHING: f32 = 1.0 / 64.0;

/// Layers on the device: a texture array of [`LAYER_SIZE`] and as many layers as fit.
pub(crate) struct Layers {
    view: wgpu::TextureView,
    paints: wgpu::Buffer,
    count: u32,
}

impl Layers {
    /// The largest of [`LAYER_COUNTS`], or as many as the adapter has.
    pub(crate) fn upload(device: &Device) -> Self {
        let most = LAYER_COUNTS.iter().copied().max().unwrap_or(1);
        let count = most.min(device.device.limits().max_texture_array_layers);
        let texture = field_texture(device, count);
        let paint = |k: u32| {
            [
                0.2,
                k as f32 / count as f32,
                0.6,
                if k % 4 == 3 { 0.5 } else { 1.0 },
            ]
        };
        let paints: Vec<[f32; 4]> = (0..count).map(paint).collect();
        Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..wgpu::TextureViewDescriptor::default()
            }),
            paints: device.buffer(bytemuck::cast_slice(&paints), wgpu::BufferUsages::STORAGE),
            count,
        }
    }

    /// The loop over the first `count` layers; `None` when the adapter does not hold so many.
    pub(crate) fn kernel(&self, device: &Device, count: u32) -> Option<Kernel> {
        let params = [count, SMOOTHING.to_bits(), 0, 0];
        let params = device.buffer(bytemuck::cast_slice(&params), wgpu::BufferUsages::UNIFORM);
        let resources = [
            wgpu::BindingResource::TextureView(&self.view),
            self.paints.as_entire_binding(),
            params.as_entire_binding(),
        ];
        let wgsl = include_str!("../wgsl/sfg22.wgsl");
        (count <= self.count).then(|| device.kernel(wgsl, &resources))
    }
}

/// One dense layer read from a texture, four loads a lookup.
pub(crate) fn fetch_texture_kernel(device: &Device) -> Kernel {
    let view = field_texture(device, 1).create_view(&wgpu::TextureViewDescriptor::default());
    let view = wgpu::BindingResource::TextureView(&view);
    device.kernel(include_str!("../wgsl/fetch_texture.wgsl"), &[view])
}

/// Steps of a tile along a cell in [`fetch_buffer_kernel`]. 511 = 7 * 73: tiles then hold the
/// dense layer's own texels.
const TEXELS_PER_CELL: u32 = 7;

/// The same layer cut into tiles in a storage buffer, found through a word of their cell.
pub(crate) fn fetch_buffer_kernel(device: &Device) -> Kernel {
    let words = tiled(&field(0));
    let words = device.buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
    device.kernel(
        include_str!("../wgsl/fetch_buffer.wgsl"),
        &[words.as_entire_binding()],
    )
}

/// As `wgsl/fetch_buffer.wgsl` reads it; tiles repeat their shared edges as `vtex_format::LayerRecord` says.
fn tiled(field: &[u32]) -> Vec<u32> {
    let side = (LAYER_SIZE - 1) / TEXELS_PER_CELL;
    let tile_words = (TEXELS_PER_CELL + 1).pow(2);
    let tiles = 2 + side * side;
    let mut words = vec![side, TEXELS_PER_CELL];
    words.extend((0..side * side).map(|cell| tiles + cell * tile_words));
    for cell in 0..side * side {
        let [x0, y0] = [cell % side * TEXELS_PER_CELL, cell / side * TEXELS_PER_CELL];
        words.extend((0..tile_words).map(|i| {
            let [x, y] = [
                x0 + i % (TEXELS_PER_CELL + 1),
                y0 + i / (TEXELS_PER_CELL + 1),
            ];
            field[(y * LAYER_SIZE + x) as usize]
        }));
    }
    words
}

/// Texels of layer `index`: the distance to a circle of its own, the same in all channels, as
/// packed RGBA8. The loop reads every texel whatever it holds, so any field times alike.
fn field(index: u32) -> Vec<u32> {
    let size = LAYER_SIZE as f32;
    let center = [
        0.2 + 0.6 * (index % 16) as f32 / 16.0,
        0.2 + 0.6 * (index / 16) as f32 / 16.0,
    ];
    let texel = |i: u32| {
        let [x, y] = [i % LAYER_SIZE, i / LAYER_SIZE].map(|k| k as f32);
        let distance_texels = 0.15 * size - (x - center[0] * size).hypot(y - center[1] * size);
        let value = ((distance_texels / 4.0 + 0.5).clamp(0.0, 1.0) * 255.0).round();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "in 0..=255"
        )]
        let byte = value as u8;
        u32::from_le_bytes([byte, byte, byte, 255])
    };
    (0..LAYER_SIZE * LAYER_SIZE).map(texel).collect()
}

fn field_texture(device: &Device, layers: u32) -> wgpu::Texture {
    let size = wgpu::Extent3d {
        width: LAYER_SIZE,
        height: LAYER_SIZE,
        depth_or_array_layers: layers,
    };
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for layer in 0..layers {
        let mut target = texture.as_image_copy();
        target.origin.z = layer;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * LAYER_SIZE),
            rows_per_image: None,
        };
        let one = wgpu::Extent3d {
            depth_or_array_layers: 1,
            ..size
        };
        device
            .queue
            .write_texture(target, bytemuck::cast_slice(&field(layer)), layout, one);
    }
    texture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_hold_the_texels_of_the_field() {
        let field: Vec<u32> = (0..LAYER_SIZE * LAYER_SIZE).collect();
        let words = tiled(&field);
        let cell = 73 * 5 + 9;
        let tile = words[2 + cell] as usize;
        assert_eq!(words[tile], (5 * 7) * LAYER_SIZE + 9 * 7);
        assert_eq!(words[tile + 63], (5 * 7 + 7) * LAYER_SIZE + 9 * 7 + 7);
        assert_eq!(words.len(), 2 + 73 * 73 * 65);
    }
}
