//! scratch
use vtex_format::*;
fn main() {
    let n = 8u32;
    let spec = SpecKey {
        abi: SHADER_ABI,
        features: 0,
        address_u: 0,
        address_v: 0,
        texels_per_cell: 8,
        max_entries: 0,
        reserved: [0; 2],
    };
    let colors = [
        [0.85, 0.1, 0.1, 1.0],
        [0.95, 0.8, 0.1, 1.0],
        [0.1, 0.3, 0.7, 1.0],
        [0.0, 0.0, 0.0, 0.0],
    ];
    let file = VtexFile {
        meta: Meta {
            canvas_size: [80.0, 80.0],
            grid: Grid {
                size_cells: [n, n],
                cell_from_uv_scale: [n as f32; 2],
                cell_from_uv_offset: [0.0; 2],
                texels_per_cell: 8,
            },
            distance_range_texels: 4.0,
            max_zoom: 1.0,
            sampler: SamplerSettings::default(),
        },
        spec,
        shader: ShaderBlob {
            abi: SHADER_ABI,
            wgsl_fragment: vtex_shaders::fragment(&spec, Default::default()),
            batch_spirv: vec![0x0723_0203, 0, 0, 0, 0],
        },
        paints: colors.iter().map(|&c| PaintRecord::solid(c)).collect(),
        shapes: vec![],
        layers: vec![],
        cells: (0..n * n)
            .map(|i| {
                let (x, y) = (i % n, i / n);
                CellWord::Solid {
                    paint: if y == 0 {
                        0
                    } else if x == 0 {
                        2
                    } else {
                        (x + y) % 2 * 2 + 1
                    },
                }
                .encode()
                .unwrap()
            })
            .collect(),
        entries: vec![],
        tiles: vec![],
        images: vec![],
        provenance: None,
    };
    for i in file.check() {
        eprintln!("{i:?}");
    }
    std::fs::write(std::env::args().nth(1).unwrap(), file.to_bytes().unwrap()).unwrap();
}
