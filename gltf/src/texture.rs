//! Textures of slots, raster and vector, each made once for each way in which it is used.

use vtex_format::{AddressMode, Features, Limits, VtexFile};
use vtex_runtime::LoadOptions;

use crate::buffers::accessor::Reader;
use crate::buffers::source::{Files, uri_bytes};
use crate::document::material::{AlphaMode, Slot};
use crate::document::texture::Vector;
use crate::error::{Outcome, find, malformed};
use crate::raster::{Alpha, Raster};

/// Texels that the images of an asset may have in all; those beyond are left out.
const MOST_TEXELS: u64 = 1 << 28;
/// The media type of a baked file.
pub(crate) const VTEX: &str = "application/x-vtex";

/// What a texture shows.
#[derive(Clone, Debug)]
enum Content {
    Raster(Raster),
    Vector(Box<VtexFile>),
}

/// A texture of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Made {
    /// Index in `Scene::textures`.
    pub(crate) index: usize,
    pub(crate) is_vector: bool,
}

/// Makes textures of an asset.
pub(crate) struct Textures<'a> {
    reader: &'a Reader<'a>,
    files: &'a mut dyn Files,
    /// By texture of the asset; the inner one is `None` for what cannot be shown.
    contents: Vec<Option<Option<Content>>>,
    texels_left: u64,
    uses: Vec<(Option<usize>, Alpha, [f32; 6], Made)>,
    pub(crate) made: Vec<(VtexFile, LoadOptions)>,
}

impl<'a> Textures<'a> {
    pub(crate) fn new(reader: &'a Reader<'a>, files: &'a mut dyn Files) -> Self {
        Self {
            contents: vec![None; reader.document.textures.len()],
            reader,
            files,
            texels_left: MOST_TEXELS,
            uses: Vec::new(),
            made: Vec::new(),
        }
    }

    /// The texture of a base colour. `None` without one, or where it cannot be read.
    pub(crate) fn color(
        &mut self,
        slot: &Slot,
        alpha: Alpha,
        place: &str,
        warnings: &mut Vec<String>,
    ) -> Outcome<Option<Made>> {
        self.load(slot.index, place, warnings)?;
        let matrix = slot.uv_matrix();
        let known = |(index, a, m, _): &&(Option<usize>, Alpha, [f32; 6], Made)| {
            *index == Some(slot.index) && *a == alpha && *m == matrix
        };
        if let Some((.., made)) = self.uses.iter().find(known) {
            return Ok(Some(*made));
        }
        let address = self.address(slot.index, warnings)?;
        let made = match &self.contents[slot.index] {
            Some(Some(Content::Raster(raster))) => {
                let file = raster.texture(alpha, address, matrix);
                self.push(file, LoadOptions::default(), false)
            }
            Some(Some(Content::Vector(file))) => {
                let mut options = LoadOptions::default();
                options.pack.address = Some(address);
                let own = file.meta.sampler.texture_matrix;
                options.pack.texture_matrix = Some(then(matrix, own));
                let file = (**file).clone();
                self.push(file, options, true)
            }
            _ => return Ok(None),
        };
        self.uses.push((Some(slot.index), alpha, matrix, made));
        Ok(Some(made))
    }

    /// A texture that is `alpha` everywhere.
    pub(crate) fn plain(&mut self, alpha: Alpha) -> Made {
        let known = |(index, a, ..): &&(Option<usize>, Alpha, [f32; 6], Made)| {
            index.is_none() && *a == alpha
        };
        if let Some((.., made)) = self.uses.iter().find(known) {
            return *made;
        }
        let identity = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let file = Raster::white().texture(alpha, [AddressMode::Clamp; 2], identity);
        let made = self.push(file, LoadOptions::default(), false);
        self.uses.push((None, alpha, identity, made));
        made
    }

    /// Whether the slot names a texture that is there.
    pub(crate) fn check(&self, slot: &Slot, place: &str) -> Outcome<()> {
        find(
            &self.reader.document.textures,
            slot.index,
            "textures",
            place,
        )
        .map(|_| ())
    }

    /// The mean over a texture, of linear data or of colours as linear light.
    pub(crate) fn mean(
        &mut self,
        slot: &Slot,
        is_data: bool,
        place: &str,
        warnings: &mut Vec<String>,
    ) -> Outcome<Option<[f32; 4]>> {
        self.load(slot.index, place, warnings)?;
        Ok(match &self.contents[slot.index] {
            Some(Some(Content::Raster(raster))) => Some(raster.mean(is_data)),
            Some(Some(Content::Vector(file))) => vector_mean(file, is_data),
            _ => None,
        })
    }

    fn push(&mut self, file: VtexFile, options: LoadOptions, is_vector: bool) -> Made {
        self.made.push((file, options));
        Made {
            index: self.made.len() - 1,
            is_vector,
        }
    }

    fn address(&self, texture: usize, warnings: &mut Vec<String>) -> Outcome<[AddressMode; 2]> {
        let document = self.reader.document;
        let place = format!("textures[{texture}].sampler");
        let Some(index) = document.textures[texture].sampler else {
            return Ok([AddressMode::Repeat; 2]);
        };
        let sampler = find(&document.samplers, index, "samplers", &place)?;
        if sampler.is_nearest() {
            warnings.push(format!("{place}: NEAREST is shown as LINEAR"));
        }
        match sampler.address() {
            Some(address) => Ok(address),
            None => malformed(
                &format!("samplers[{index}]"),
                "a wrap mode that glTF does not have",
            ),
        }
    }

    /// Reads the content of a texture unless it is there. What cannot be read is a warning, and the
    /// slot is as if it were empty.
    fn load(&mut self, index: usize, place: &str, warnings: &mut Vec<String>) -> Outcome<()> {
        let document = self.reader.document;
        let texture = find(&document.textures, index, "textures", place)?;
        if self.contents[index].is_some() {
            return Ok(());
        }
        let place = match texture.name.is_empty() {
            true => format!("textures[{index}]"),
            false => format!("textures[{index}] {:?}", texture.name),
        };
        let mut content = None;
        if let Some(vector) = &texture.extensions.vector {
            match self.vector(vector, &place) {
                Ok(file) => content = Some(Content::Vector(Box::new(file))),
                Err(why) => warnings.push(format!("{place}: its image is shown instead: {why}")),
            }
        }
        let webp = texture.extensions.webp.as_ref().map(|webp| webp.source);
        if content.is_none() {
            for source in webp.into_iter().chain(texture.source) {
                find(&document.images, source, "images", &place)?;
                match self.raster(source) {
                    Ok(raster) => {
                        content = Some(Content::Raster(raster));
                        break;
                    }
                    Err(why) => warnings.push(format!("images[{source}]: it was left out: {why}")),
                }
            }
        }
        if content.is_none() {
            warnings.push(format!(
                "{place}: nothing to show; the slot counts as empty"
            ));
        }
        self.contents[index] = Some(content);
        Ok(())
    }

    fn vector(&mut self, vector: &Vector, place: &str) -> Result<VtexFile, String> {
        let bytes = match (&vector.uri, vector.buffer_view) {
            (Some(uri), _) => uri_bytes(uri, place, self.files),
            (None, Some(view)) => {
                let bytes = self.reader.buffers.view(self.reader.document, view, place);
                bytes.map(<[u8]>::to_vec)
            }
            (None, None) => malformed(
                place,
                "VTEX_texture_vector names neither uri nor bufferView",
            ),
        };
        let bytes = bytes.map_err(|error| error.to_string())?;
        let uri = vector.uri.as_deref().unwrap_or_default();
        let is_vtex = vector.mime_type.as_deref() == Some(VTEX) || uri.ends_with(".vtex");
        if is_vtex {
            return VtexFile::parse(&bytes, &Limits::default()).map_err(|error| error.to_string());
        }
        self.files
            .bake(&bytes, if uri.is_empty() { place } else { uri })
    }

    fn raster(&mut self, index: usize) -> Result<Raster, String> {
        let document = self.reader.document;
        let image = &document.images[index];
        let place = format!("images[{index}]");
        let owned;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                owned = uri_bytes(uri, &place, self.files).map_err(|error| error.to_string())?;
                owned.as_slice()
            }
            (None, Some(view)) => {
                let bytes = self.reader.buffers.view(document, view, &place);
                bytes.map_err(|error| error.to_string())?
            }
            (None, None) => return Err(format!("{:?} has neither uri nor bufferView", image.name)),
        };
        let raster = Raster::decode(bytes)?;
        let texels = u64::from(raster.size[0]) * u64::from(raster.size[1]);
        match self.texels_left.checked_sub(texels) {
            Some(left) => {
                self.texels_left = left;
                Ok(raster)
            }
            None => Err(format!("the images have more than {MOST_TEXELS} texels")),
        }
    }
}

/// The last level of the canvas image.
fn vector_mean(file: &VtexFile, is_data: bool) -> Option<[f32; 4]> {
    if file.spec.features & Features::MIPS == 0 {
        return None;
    }
    let last = file.images.first()?.mips.last()?.first_chunk::<4>()?;
    let raster = Raster {
        size: [1; 2],
        texels: last.to_vec(),
    };
    let [r, g, b, a] = raster.mean(is_data);
    Some(
        [r, g, b]
            .map(|c| c / a.max(1.0 / 255.0))
            .map(|c| c.min(1.0)),
    )
    .map(|[r, g, b]| [r, g, b, a])
}

/// One affine map of uv, then another.
fn then(first: [f32; 6], second: [f32; 6]) -> [f32; 6] {
    let linear = |[x, y]: [f32; 2]| [second[0] * x + second[2] * y, second[1] * x + second[3] * y];
    let [a, b] = linear([first[0], first[1]]);
    let [c, d] = linear([first[2], first[3]]);
    let [e, f] = linear([first[4], first[5]]);
    [a, b, c, d, e + second[4], f + second[5]]
}

impl Alpha {
    /// Of a base colour whose alpha is not read.
    pub(crate) const OPAQUE: Self = Self {
        mode: AlphaMode::Opaque,
        factor: 1.0,
        cutoff: 0.0,
    };
}
