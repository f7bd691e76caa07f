//! Writes assets of our own, made like the usual samples: `sample_assets FOLDER`. To be rendered and
//! looked at.
//!
//! - `box_textured.glb`: a cube, the same picture on each side;
//! - `texture_coordinates.glb`: four quads, each showing the corner of the texture it is named after;
//! - `texture_settings.glb`: uv from -1 to 2 by wrap mode, repeating, clamped, mirrored;
//! - `orientation.glb`: arrows along +x, +y and +z in red, green and blue, by turned nodes;
//! - `instances.glb`: 400 cubes of one mesh by `EXT_mesh_gpu_instancing`.

use std::error::Error;
use std::io::Cursor;
use std::path::Path;

use serde_json::{Value, json};

type Outcome<T> = Result<T, Box<dyn Error>>;
type Make = fn() -> Outcome<Vec<u8>>;

fn main() -> Outcome<()> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("name a folder to write into")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let assets: [(&str, Make); 5] = [
        ("box_textured", box_textured),
        ("texture_coordinates", texture_coordinates),
        ("texture_settings", texture_settings),
        ("orientation", orientation),
        ("instances", instances),
    ];
    for (name, make) in assets {
        std::fs::write(folder.join(name).with_extension("glb"), make()?)?;
    }
    Ok(())
}

fn box_textured() -> Outcome<Vec<u8>> {
    let mut asset = Asset::new();
    let picture = asset.picture()?;
    let material = asset.textured(picture, &json!({}), "Box");
    let mesh = asset.cube(material, 1.0);
    asset.node(json!({"mesh": mesh, "rotation": [0.0, 0.3826834, 0.0, 0.9238795]}));
    asset.glb()
}

fn texture_coordinates() -> Outcome<Vec<u8>> {
    let mut asset = Asset::new();
    let picture = asset.picture()?;
    let material = asset.textured(
        picture,
        &json!({"wrapS": 33071, "wrapT": 33071}),
        "Quadrants",
    );
    for (x, y, u, v) in [
        (-0.6, 0.6, 0.0, 0.0),
        (0.6, 0.6, 0.5, 0.0),
        (-0.6, -0.6, 0.0, 0.5),
        (0.6, -0.6, 0.5, 0.5),
    ] {
        let mesh = asset.quad(material, [[u, v], [u + 0.5, v + 0.5]]);
        asset.node(json!({"mesh": mesh, "translation": [x, y, 0.0]}));
    }
    asset.facing(2.6);
    asset.glb()
}

fn texture_settings() -> Outcome<Vec<u8>> {
    let mut asset = Asset::new();
    let picture = asset.picture()?;
    for (x, wrap) in [(-1.2, 10_497), (0.0, 33_071), (1.2, 33_648)] {
        let sampler = json!({"wrapS": wrap, "wrapT": wrap});
        let material = asset.textured(picture, &sampler, "Wrapped");
        let mesh = asset.quad(material, [[-1.0, -1.0], [2.0, 2.0]]);
        asset.node(json!({"mesh": mesh, "translation": [x, 0.0, 0.0]}));
    }
    asset.facing(2.8);
    asset.glb()
}

fn orientation() -> Outcome<Vec<u8>> {
    let mut asset = Asset::new();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // A long box along +x, turned to the other axes.
    for (color, rotation) in [
        ([0.8, 0.05, 0.05, 1.0], [0.0, 0.0, 0.0, 1.0]),
        ([0.05, 0.6, 0.05, 1.0], [0.0, 0.0, half, half]),
        ([0.05, 0.1, 0.8, 1.0], [0.0, -half, 0.0, half]),
    ] {
        let factors = json!({"baseColorFactor": color, "metallicFactor": 0.0});
        let material = asset.push("materials", json!({"pbrMetallicRoughness": factors}));
        let mesh = asset.cube(material, 1.0);
        let shaft = asset.push(
            "nodes",
            json!({"mesh": mesh, "translation": [0.6, 0.0, 0.0], "scale": [1.0, 0.08, 0.08]}),
        );
        let tip = asset.push(
            "nodes",
            json!({"mesh": mesh, "translation": [1.15, 0.0, 0.0], "scale": [0.2, 0.2, 0.2]}),
        );
        asset.node(json!({"children": [shaft, tip], "rotation": rotation}));
    }
    asset.glb()
}

fn instances() -> Outcome<Vec<u8>> {
    let mut asset = Asset::new();
    let picture = asset.picture()?;
    let material = asset.textured(picture, &json!({}), "Box");
    let mesh = asset.cube(material, 0.6);
    let places: Vec<[f32; 3]> = (0_u16..400)
        .map(|i| {
            [
                f32::from(i % 20) - 9.5,
                0.3 * f32::from(i * 7 % 11),
                f32::from(i / 20) - 9.5,
            ]
        })
        .collect();
    let places = asset.floats(&places, "VEC3");
    let attributes = json!({"attributes": {"TRANSLATION": places}});
    asset.node(json!({"mesh": mesh, "extensions": {"EXT_mesh_gpu_instancing": attributes}}));
    asset.glb()
}

/// An asset under way.
struct Asset {
    json: Value,
    bin: Vec<u8>,
}

impl Asset {
    fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
            "extensionsUsed": ["EXT_mesh_gpu_instancing"],
        });
        Self {
            json,
            bin: Vec::new(),
        }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let Some(values) = self.json[list].as_array_mut() else {
            return 0;
        };
        values.push(value);
        values.len() - 1
    }

    /// A node of the scene.
    fn node(&mut self, node: Value) {
        let node = self.push("nodes", node);
        if let Some(nodes) = self.json["scenes"][0]["nodes"].as_array_mut() {
            nodes.push(json!(node));
        }
    }

    /// A camera that sees `height` of the plane z = 0.
    fn facing(&mut self, height: f32) {
        let yfov: f32 = 0.4;
        let lens = json!({"yfov": yfov, "znear": 0.1});
        let camera = self.push(
            "cameras",
            json!({"type": "perspective", "perspective": lens}),
        );
        let distance = 0.5 * height / (0.5 * yfov).tan();
        self.node(json!({"camera": camera, "translation": [0.0, 0.0, distance]}));
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (start, length) = (self.bin.len(), bytes.len());
        self.bin.extend(bytes);
        self.push(
            "bufferViews",
            json!({"buffer": 0, "byteOffset": start, "byteLength": length}),
        )
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], kind: &str) -> usize {
        let bytes: Vec<u8> = values
            .as_flattened()
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let count = values.len();
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "type": kind, "count": count}),
        )
    }

    /// Red, green, blue and yellow quarters from the top left, with a black bar along the top and a
    /// white one along the left side; 64 texels.
    fn picture(&mut self) -> Outcome<usize> {
        let picture = image::RgbImage::from_fn(64, 64, |x, y| {
            image::Rgb(match (x, y) {
                (_, 0..6) => [0, 0, 0],
                (0..6, _) => [255; 3],
                (..32, ..32) => [220, 40, 40],
                (_, ..32) => [40, 160, 40],
                (..32, _) => [40, 60, 200],
                _ => [230, 200, 40],
            })
        });
        let mut png = Cursor::new(Vec::new());
        picture.write_to(&mut png, image::ImageFormat::Png)?;
        let view = self.view(&png.into_inner());
        Ok(self.push(
            "images",
            json!({"bufferView": view, "mimeType": "image/png"}),
        ))
    }

    fn textured(&mut self, image: usize, sampler: &Value, name: &str) -> usize {
        let sampler = self.push("samplers", sampler.clone());
        let texture = self.push("textures", json!({"source": image, "sampler": sampler}));
        let factors = json!({"baseColorTexture": {"index": texture}, "metallicFactor": 0.0});
        self.push(
            "materials",
            json!({"name": name, "pbrMetallicRoughness": factors}),
        )
    }

    fn mesh(&mut self, positions: &[[f32; 3]], uvs: &[[f32; 2]], material: usize) -> usize {
        let positions = self.floats(positions, "VEC3");
        let uvs = self.floats(uvs, "VEC2");
        let primitive = json!({"attributes": {"POSITION": positions, "TEXCOORD_0": uvs},
            "material": material});
        self.push("meshes", json!({"primitives": [primitive]}))
    }

    /// A unit square facing +z, whose left upper and right lower corners have these uv.
    fn quad(&mut self, material: usize, [[u0, v0], [u1, v1]]: [[f32; 2]; 2]) -> usize {
        let corners = [
            [-0.5, 0.5, u0, v0],
            [-0.5, -0.5, u0, v1],
            [0.5, -0.5, u1, v1],
            [0.5, 0.5, u1, v0],
        ];
        let order = [0, 1, 2, 0, 2, 3].map(|i| corners[i]);
        let positions = order.map(|[x, y, ..]| [x, y, 0.0]);
        let uvs = order.map(|[_, _, u, v]| [u, v]);
        self.mesh(&positions, &uvs, material)
    }

    fn cube(&mut self, material: usize, size: f32) -> usize {
        let mesh = vtex_runtime::Mesh::cuboid([size; 3]);
        let order: Vec<usize> = mesh
            .triangles
            .as_flattened()
            .iter()
            .map(|&i| i as usize)
            .collect();
        let positions: Vec<[f32; 3]> = order.iter().map(|&i| mesh.positions[i]).collect();
        let uvs: Vec<[f32; 2]> = order.iter().map(|&i| mesh.uvs[i]).collect();
        self.mesh(&positions, &uvs, material)
    }

    fn glb(mut self) -> Outcome<Vec<u8>> {
        self.json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        let mut text = serde_json::to_vec(&self.json)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF".to_vec();
        let total = u32::try_from(28 + text.len() + self.bin.len())?;
        for word in [2, total, u32::try_from(text.len())?] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(text);
        bytes.extend(u32::try_from(self.bin.len())?.to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(self.bin);
        Ok(bytes)
    }
}
