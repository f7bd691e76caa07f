//! Vector textures: through the hook, from files, added to an asset.

use serde_json::json;
use vtex_format::{Grid, Meta, VtexFile};
use vtex_gltf::{Asset, Attachment, Files, NoFiles, ReadOptions, attach, read};

use crate::builder::{Builder, png};

/// Bakes anything to an empty canvas of four units, and remembers what it was asked for.
#[derive(Default)]
struct Baker {
    baked: Vec<Vec<u8>>,
}

impl Files for Baker {
    fn read(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        match uri {
            "a sign.svg" => Ok(b"<svg from a file/>".to_vec()),
            _ => Err("not there".to_owned()),
        }
    }

    fn bake(&mut self, svg: &[u8], _name: &str) -> Result<VtexFile, String> {
        self.baked.push(svg.to_vec());
        if svg == b"broken" {
            return Err("not an SVG".to_owned());
        }
        Ok(VtexFile::blank(Meta::new(
            [4.0, 4.0],
            Grid::new([2, 2], 16),
        )))
    }
}

fn textured(extension: serde_json::Value) -> Builder {
    let mut builder = Builder::triangle();
    let texture = builder.texture([[1, 2, 3, 255]; 4]);
    builder.json["textures"][texture]["extensions"] = json!({"VTEX_texture_vector": extension});
    let slot = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}});
    builder.push("materials", slot);
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    builder
}

fn canvas(asset: &Asset) -> [f32; 2] {
    asset.scene.textures[0].0.meta.canvas_size
}

#[test]
fn a_drawing_goes_before_its_image() {
    let mut baker = Baker::default();
    let asset = textured(json!({"uri": "a%20sign.svg"}))
        .read_with(&mut baker)
        .unwrap();
    assert_eq!(baker.baked, [b"<svg from a file/>"]);
    assert_eq!(canvas(&asset), [4.0, 4.0]);
    // Opaque: paper shows behind it.
    assert_eq!(asset.scene.materials[0].backing, Some([1.0; 3]));
    assert_eq!(asset.warnings, Vec::<String>::new());
}

#[test]
fn where_a_drawing_fails_the_image_shows() {
    let mut with_view = textured(json!({"bufferView": 0}));
    let view = with_view.view(b"broken");
    with_view.json["textures"][0]["extensions"]["VTEX_texture_vector"]["bufferView"] = json!(view);
    for builder in [
        with_view,
        textured(json!({"uri": "gone.svg"})),
        textured(json!({"bufferView": 99})),
        textured(json!({"bufferView": 0, "mimeType": "application/x-vtex"})),
        textured(json!({})),
    ] {
        let asset = builder.read_with(&mut Baker::default()).unwrap();
        assert_eq!(canvas(&asset), [2.0, 2.0], "the image's texels");
        assert!(
            asset.warnings[0].contains("its image is shown instead"),
            "{:?}",
            asset.warnings
        );
    }
    // A program without a baker.
    let asset = textured(json!({"uri": "a.svg"})).read().unwrap();
    assert_eq!(canvas(&asset), [2.0, 2.0]);
}

#[test]
fn drawings_are_attached_to_textures_and_to_materials_without_one() {
    let mut builder = Builder::triangle();
    builder.push(
        "materials",
        json!({"name": "bare", "extras": {"mine": [1, 2]}}),
    );
    let texture = builder.texture([[1, 2, 3, 255]; 4]);
    builder.json["textures"][texture]["name"] = json!("poster");
    let slot = json!({"baseColorTexture": {"index": texture}});
    builder.push(
        "materials",
        json!({"name": "wall", "pbrMetallicRoughness": slot}),
    );
    let mut second = builder.json["meshes"][0]["primitives"][0].clone();
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    second["material"] = json!(1);
    builder.json["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(second);
    let drawing = |name: &str, svg: &[u8]| Attachment {
        name: name.to_owned(),
        bytes: svg.to_vec(),
        is_vtex: false,
        fallback_png: png([[7, 8, 9, 255]; 4]),
    };
    let drawings = [
        drawing("bare", b"<svg one/>"),
        drawing("poster", b"<svg two/>"),
    ];
    let made = attach(&builder.glb(), &mut NoFiles, &drawings).unwrap();
    let mut baker = Baker::default();
    let asset = read(&made, &mut baker, &ReadOptions::default()).unwrap();
    assert_eq!(baker.baked, [&b"<svg one/>"[..], b"<svg two/>"]);
    assert_eq!(asset.scene.textures.len(), 2);
    assert_eq!(asset.scene.meshes[1].triangles, [[0, 1, 2]]);
    // Elsewhere it shows the raster, and what it had.
    let plain = read(&made, &mut NoFiles, &ReadOptions::default()).unwrap();
    let first = |index: usize| plain.scene.textures[index].0.images[0].mips[0][0];
    assert_eq!([first(0), first(1)], [7, 1]);
    assert!(String::from_utf8_lossy(&made).contains(r#""extras":{"mine":[1,2]}"#));
    let unknown = [drawing("nobody", b"")];
    let error = attach(&builder.glb(), &mut NoFiles, &unknown)
        .unwrap_err()
        .to_string();
    assert!(error.contains("\"poster\", \"bare\", \"wall\""), "{error}");
}

#[test]
fn files_beside_an_asset_are_taken_in() {
    let text = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": []}],
        "buffers": [{"byteLength": 3, "uri": "data:;base64,AAEC"},
                    {"byteLength": 18, "uri": "a%20sign.svg"}],
        "bufferViews": [{"buffer": 1, "byteOffset": 1, "byteLength": 3}],
        "images": [{"uri": "a%20sign.svg", "name": "it"}], "textures": [{"source": 0}]}"#;
    let drawing = Attachment {
        name: "it".to_owned(),
        bytes: b"<svg/>".to_vec(),
        is_vtex: false,
        fallback_png: Vec::new(),
    };
    let made = attach(text.as_bytes(), &mut Baker::default(), &[drawing]).unwrap();
    let text = String::from_utf8_lossy(&made);
    assert!(!text.contains("uri"), "{text}");
    assert!(
        text.contains(r#"{"buffer":0,"byteLength":3,"byteOffset":5}"#),
        "{text}"
    );
    assert!(read(&made, &mut NoFiles, &ReadOptions::default()).is_ok());
}
