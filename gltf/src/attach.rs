//! Adding vector textures to an asset.

use serde_json::{Map, Value, json};

use crate::buffers::glb;
use crate::buffers::source::{Files, uri_bytes};
use crate::error::{GltfError, Outcome, malformed};
use crate::texture::VTEX;

const EXTENSION: &str = "VTEX_texture_vector";

/// A drawing for a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// Name of a texture, of an image or of a material, whose base colour is meant then.
    pub name: String,
    /// An SVG, or a `.vtex` file.
    pub bytes: Vec<u8>,
    /// Whether `bytes` are a `.vtex` file.
    pub is_vtex: bool,
    /// What other programs show where the material has no texture yet, as PNG.
    pub fallback_png: Vec<u8>,
}

/// The asset as GLB, with `attachments` in place. Files beside it are taken in, so that the result
/// stands alone; all that is not understood is kept.
///
/// # Errors
/// [`GltfError::Parameter`] for a name that the asset does not have, and what is wrong with the asset.
pub fn attach(
    bytes: &[u8],
    files: &mut dyn Files,
    attachments: &[Attachment],
) -> Result<Vec<u8>, GltfError> {
    let parts = glb::split(bytes)?;
    let root = match serde_json::from_slice(parts.json) {
        Ok(Value::Object(root)) => root,
        Ok(_) => return malformed("JSON", "not an object"),
        Err(error) => return malformed("JSON", error),
    };
    let mut edited = Edited {
        root,
        bin: Vec::new(),
    };
    edited.take_in(parts.bin, files)?;
    for attachment in attachments {
        edited.attach(attachment)?;
    }
    edited.finish()
}

struct Edited {
    root: Map<String, Value>,
    bin: Vec<u8>,
}

impl Edited {
    /// Makes one buffer of all, and takes in images.
    fn take_in(&mut self, bin: Option<&[u8]>, files: &mut dyn Files) -> Outcome<()> {
        let mut starts = Vec::new();
        for (index, buffer) in self.list("buffers")?.clone().iter().enumerate() {
            let place = format!("buffers[{index}]");
            let own;
            let bytes = match (buffer["uri"].as_str(), bin) {
                (Some(uri), _) => {
                    own = uri_bytes(uri, &place, files)?;
                    own.as_slice()
                }
                (None, Some(bin)) if index == 0 => bin,
                (None, _) => return malformed(&place, "it has no uri and no binary chunk"),
            };
            starts.push(self.append(bytes));
        }
        for (index, view) in self.list("bufferViews")?.iter_mut().enumerate() {
            let buffer = view["buffer"]
                .as_u64()
                .and_then(|b| usize::try_from(b).ok());
            let Some(&start) = buffer.and_then(|buffer| starts.get(buffer)) else {
                return malformed(&format!("bufferViews[{index}]"), "its buffer is not there");
            };
            let offset = view["byteOffset"].as_u64().unwrap_or(0);
            view["buffer"] = json!(0);
            view["byteOffset"] = json!(offset.saturating_add(start as u64));
        }
        for index in 0..self.list("images")?.len() {
            let image = &self.list("images")?[index];
            let Some(uri) = image["uri"].as_str().map(str::to_owned) else {
                continue;
            };
            let bytes = uri_bytes(&uri, &format!("images[{index}]"), files)?;
            let view = self.push_view(&bytes)?;
            let image = &mut self.list("images")?[index];
            if let Some(image) = image.as_object_mut() {
                image.remove("uri");
                image.insert("bufferView".to_owned(), json!(view));
                image.insert("mimeType".to_owned(), json!(media_type(&bytes)));
            }
        }
        Ok(())
    }

    fn attach(&mut self, attachment: &Attachment) -> Outcome<()> {
        let texture = self.texture(attachment)?;
        let view = self.push_view(&attachment.bytes)?;
        let media = if attachment.is_vtex {
            VTEX
        } else {
            "image/svg+xml"
        };
        let place = format!("textures[{texture}]");
        let Some(texture) = self.list("textures")?.get_mut(texture) else {
            return malformed(&place, "a material names it and it is not there");
        };
        let extension = json!({"bufferView": view, "mimeType": media});
        object(texture, &place)?;
        let extensions = &mut texture["extensions"];
        if extensions.is_null() {
            *extensions = json!({});
        }
        object(extensions, &place)?.insert(EXTENSION.to_owned(), extension);
        let used = self.list("extensionsUsed")?;
        if !used.iter().any(|name| name == EXTENSION) {
            used.push(json!(EXTENSION));
        }
        Ok(())
    }

    /// Index of the texture that an attachment is for; a new one where a material has none.
    fn texture(&mut self, attachment: &Attachment) -> Outcome<usize> {
        let name = attachment.name.as_str();
        let named = |value: &Value| value["name"].as_str() == Some(name);
        if let Some(texture) = self.list("textures")?.iter().position(named) {
            return Ok(texture);
        }
        if let Some(image) = self.list("images")?.iter().position(named) {
            let shows = |texture: &Value| texture["source"].as_u64() == Some(image as u64);
            if let Some(texture) = self.list("textures")?.iter().position(shows) {
                return Ok(texture);
            }
        }
        let Some(material) = self.list("materials")?.iter().position(named) else {
            let known: Vec<String> = ["textures", "images", "materials"]
                .iter()
                .flat_map(|list| self.names(list))
                .collect();
            let message = format!(
                "no texture, image or material is named {name:?}; there are {}",
                known.join(", ")
            );
            return Err(GltfError::Parameter(message));
        };
        let place = format!("materials[{material}]");
        let slot = &self.list("materials")?[material]["pbrMetallicRoughness"]["baseColorTexture"];
        if let Some(texture) = slot["index"].as_u64() {
            return usize::try_from(texture).or_else(|error| malformed(&place, error));
        }
        let view = self.push_view(&attachment.fallback_png)?;
        let images = self.list("images")?;
        images.push(json!({"name": name, "bufferView": view, "mimeType": "image/png"}));
        let image = images.len() - 1;
        let textures = self.list("textures")?;
        textures.push(json!({"name": name, "source": image}));
        let texture = textures.len() - 1;
        let material = &mut self.list("materials")?[material];
        object(material, &place)?;
        let pbr = &mut material["pbrMetallicRoughness"];
        if pbr.is_null() {
            *pbr = json!({});
        }
        object(pbr, &place)?.insert("baseColorTexture".to_owned(), json!({"index": texture}));
        Ok(texture)
    }

    fn names(&mut self, list: &str) -> Vec<String> {
        let values = self.root.get(list).and_then(Value::as_array);
        let names = values
            .into_iter()
            .flatten()
            .filter_map(|value| value["name"].as_str());
        names.map(|name| format!("{name:?}")).collect()
    }

    /// A list of the asset, made where it has none.
    fn list(&mut self, name: &str) -> Outcome<&mut Vec<Value>> {
        let list = self.root.entry(name).or_insert_with(|| json!([]));
        match list.as_array_mut() {
            Some(list) => Ok(list),
            None => malformed(name, "not a list"),
        }
    }

    fn append(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let start = self.bin.len();
        self.bin.extend(bytes);
        start
    }

    fn push_view(&mut self, bytes: &[u8]) -> Outcome<usize> {
        let start = self.append(bytes);
        let views = self.list("bufferViews")?;
        views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": bytes.len()}));
        Ok(views.len() - 1)
    }

    fn finish(mut self) -> Outcome<Vec<u8>> {
        let length = self.bin.len();
        self.root
            .insert("buffers".to_owned(), json!([{"byteLength": length}]));
        // glTF has no empty lists.
        self.root
            .retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        if length == 0 {
            self.root.remove("buffers");
        }
        match serde_json::to_vec(&self.root) {
            Ok(json) => glb::join(&json, &self.bin),
            Err(error) => malformed("JSON", error),
        }
    }
}

fn object<'a>(value: &'a mut Value, place: &str) -> Outcome<&'a mut Map<String, Value>> {
    match value.as_object_mut() {
        Some(object) => Ok(object),
        None => malformed(place, "not an object"),
    }
}

/// Of an image, by its first bytes.
fn media_type(bytes: &[u8]) -> &'static str {
    match bytes {
        [0xff, 0xd8, ..] => "image/jpeg",
        [b'R', b'I', b'F', b'F', ..] => "image/webp",
        _ => "image/png",
    }
}
