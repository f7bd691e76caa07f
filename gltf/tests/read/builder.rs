//! Small assets as JSON, with one binary chunk.

use serde_json::{Value, json};
use vtex_gltf::{Asset, Files, GltfError, NoFiles, ReadOptions, read};

/// An asset of one triangle: buffer, views, accessors 0 (indices) and 1 (positions), mesh, node, scene.
pub(crate) struct Builder {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

pub(crate) const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

impl Builder {
    pub(crate) fn triangle() -> Self {
        Self::of(&CORNERS, &[0, 1, 2])
    }

    pub(crate) fn of(positions: &[[f32; 3]], indices: &[u32]) -> Self {
        let mut builder = Self {
            json: json!({
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
                "accessors": [], "bufferViews": [],
                "materials": [], "textures": [], "images": [], "samplers": [],
            }),
            bin: Vec::new(),
        };
        let bytes: Vec<u8> = indices
            .iter()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        builder.accessor(&bytes, 5125, "SCALAR", indices.len());
        builder.floats(positions, "VEC3");
        builder
    }

    pub(crate) fn floats<const N: usize>(&mut self, values: &[[f32; N]], kind: &str) -> usize {
        let bytes: Vec<u8> = values
            .as_flattened()
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        self.accessor(&bytes, 5126, kind, values.len())
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        self.push("bufferViews", view)
    }

    pub(crate) fn accessor(
        &mut self,
        bytes: &[u8],
        component: u32,
        kind: &str,
        count: usize,
    ) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component, "type": kind, "count": count}),
        )
    }

    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A texture of `texels` of RGBA, two by two.
    pub(crate) fn texture(&mut self, texels: [[u8; 4]; 4]) -> usize {
        let view = self.view(&png(texels));
        let image = self.push(
            "images",
            json!({"bufferView": view, "mimeType": "image/png"}),
        );
        self.push("textures", json!({"source": image}))
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        glb(&json, &self.bin)
    }

    pub(crate) fn read(&self) -> Result<Asset, GltfError> {
        read(&self.glb(), &mut NoFiles, &ReadOptions::default())
    }

    pub(crate) fn read_with(&self, files: &mut dyn Files) -> Result<Asset, GltfError> {
        read(&self.glb(), files, &ReadOptions::default())
    }
}

pub(crate) fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(json).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(word(2));
    bytes.extend(word(28 + json.len() + bin.len()));
    bytes.extend(word(json.len()));
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend(word(bin.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(bin);
    bytes
}

pub(crate) fn png(texels: [[u8; 4]; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_raw(2, 2, texels.concat()).unwrap();
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}
