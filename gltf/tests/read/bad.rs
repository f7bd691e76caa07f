//! Hostile and broken assets: an error that says where, or a repair that a warning names.

use serde_json::json;
use vtex_gltf::{NoFiles, ReadOptions, read};

use crate::builder::{Builder, CORNERS, glb};

#[track_caller]
fn refused(builder: &Builder, words: &[&str]) {
    let error = builder.read().unwrap_err().to_string();
    for word in words {
        assert!(error.contains(word), "no {word:?} in: {error}");
    }
}

#[track_caller]
fn text_refused(text: &str, word: &str) {
    let outcome = read(text.as_bytes(), &mut NoFiles, &ReadOptions::default());
    let error = outcome.unwrap_err().to_string();
    assert!(error.contains(word), "no {word:?} in: {error}");
}

#[test]
fn buffers_that_are_not_there() {
    let mut builder = Builder::triangle();
    builder.json["bufferViews"][0]["buffer"] = json!(7);
    refused(&builder, &["bufferViews[0]", "no buffers[7]"]);
    text_refused(
        r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4}]}"#,
        "buffers[0]: it has no uri",
    );
    text_refused(
        r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin", "byteLength": 4}]}"#,
        "buffers[0]: a.bin",
    );
    text_refused(
        r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "https://a/b", "byteLength": 4}]}"#,
        "network",
    );
}

#[test]
fn four_gigabytes_in_a_hundred_bytes() {
    text_refused(
        r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":4294967295,"uri":"data:;base64,AAAA"}]}"#,
        "claims 4294967295 bytes and has 3",
    );
    // Without a view it is zeros that no byte stands for.
    let mut builder = Builder::triangle();
    builder.json["accessors"][1] =
        json!({"componentType": 5126, "type": "VEC3", "count": 4_294_967_295_u32});
    refused(&builder, &["limit", "accessors[1]", "4294967295"]);
    // Again and again.
    let mut builder = Builder::triangle();
    builder.json["accessors"][1] =
        json!({"componentType": 5126, "type": "VEC3", "count": 20_000_000_u32});
    let primitive = builder.json["meshes"][0]["primitives"][0].clone();
    builder.json["meshes"][0]["primitives"] = json!(vec![primitive; 100]);
    refused(&builder, &["limit", "accessors[1]"]);
}

#[test]
fn accessors_that_overflow() {
    for (field, value) in [
        ("count", json!(u64::MAX)),
        ("count", json!(4)),
        ("byteOffset", json!(u64::MAX)),
        ("byteOffset", json!(1)),
    ] {
        let mut builder = Builder::triangle();
        builder.json["accessors"][1][field] = value;
        refused(&builder, &["accessors[1]"]);
    }
    for (field, value) in [
        ("byteLength", json!(u64::MAX)),
        ("byteOffset", json!(u64::MAX)),
    ] {
        let mut builder = Builder::triangle();
        builder.json["bufferViews"][1][field] = value;
        refused(&builder, &["bufferViews[1]", "past the end"]);
    }
    for stride in [0_u64, 3, u64::MAX] {
        let mut builder = Builder::triangle();
        builder.json["bufferViews"][1]["byteStride"] = json!(stride);
        refused(&builder, &["accessors[1]"]);
    }
    let mut builder = Builder::triangle();
    builder.json["accessors"][1]["componentType"] = json!(1);
    refused(&builder, &["componentType 1"]);
    let mut builder = Builder::triangle();
    builder.json["accessors"][1]["type"] = json!("MAT4");
    refused(&builder, &["MAT4 where VEC3"]);
    let mut builder = Builder::triangle();
    builder.json["accessors"][1]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": 0, "componentType": 5125, "byteOffset": 4000},
        "values": {"bufferView": 1},
    });
    refused(&builder, &["accessors[1].sparse"]);
}

#[test]
fn indices_out_of_range() {
    refused(
        &Builder::of(&CORNERS, &[0, 1, 3]),
        &["meshes[0].primitives[0].indices", "index 3", "3 vertices"],
    );
    let mut builder = Builder::triangle();
    builder.json["meshes"][0]["primitives"][0]["indices"] = json!(9);
    refused(&builder, &["no accessors[9]"]);
    let mut builder = Builder::triangle();
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(2);
    refused(&builder, &["no materials[2]"]);
    let mut builder = Builder::triangle();
    builder.json["nodes"][0]["mesh"] = json!(2);
    refused(&builder, &["nodes[0]", "no meshes[2]"]);
    let mut builder = Builder::triangle();
    builder.json["scene"] = json!(2);
    refused(&builder, &["no scenes[2]"]);
}

#[test]
fn nodes_that_form_no_tree() {
    for nodes in [
        json!([{"children": [0]}]),
        json!([{"children": [1]}, {"children": [0]}]),
        json!([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {}]),
    ] {
        let mut builder = Builder::triangle();
        builder.json["nodes"] = nodes;
        refused(&builder, &["nodes[", "must form a tree"]);
    }
    // Deeper than a stack: sound.
    let mut builder = Builder::triangle();
    let chain = (1..=100_000).map(|child| json!({"children": [child]}));
    builder.json["nodes"] = chain.chain([json!({"mesh": 0})]).collect();
    assert_eq!(builder.read().unwrap().scene.instances.len(), 1);
}

#[test]
fn textures_that_are_not_there() {
    let slot = |index: u32| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    let mut builder = Builder::triangle();
    builder.push("materials", slot(5));
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    refused(&builder, &["materials[0]", "no textures[5]"]);
    // Other slots too, whether they are shown or not.
    builder.json["materials"][0] = json!({"normalTexture": {"index": 5}});
    refused(&builder, &["materials[0]", "no textures[5]"]);
    // A file that is not there, or is no image, is left out.
    for image in [
        json!({"uri": "gone.png"}),
        json!({"bufferView": 0}),
        json!({}),
    ] {
        let mut builder = Builder::triangle();
        builder.push("images", image);
        builder.push("textures", json!({"source": 0}));
        builder.push("materials", slot(0));
        builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        let asset = builder.read().unwrap();
        assert_eq!(asset.scene.materials[0].texture, None);
        assert!(
            asset.warnings.iter().any(|w| w.contains("images[0]")),
            "{:?}",
            asset.warnings
        );
    }
}

#[test]
fn vertices_that_are_no_places() {
    for bad in [f32::INFINITY, f32::NAN, f32::NEG_INFINITY] {
        let mut positions = CORNERS.to_vec();
        positions.extend([[bad, 0.0, 0.0], [0.0, bad, 1.0], [1.0, 1.0, bad]]);
        let asset = Builder::of(&positions, &[0, 1, 2, 3, 4, 5, 0, 1, 3])
            .read()
            .unwrap();
        assert_eq!(asset.scene.meshes[0].triangles, [[0, 1, 2]]);
        assert!(
            asset.warnings[0].contains("2 triangles"),
            "{:?}",
            asset.warnings
        );
        assert!(
            asset.scene.meshes[0]
                .positions
                .as_flattened()
                .iter()
                .all(|c| c.is_finite())
        );
    }
    // Huge ones and such without area stay; the tracer drops and counts them.
    let asset = Builder::of(&[[3.0e38; 3], [-3.0e38; 3], [0.0; 3]], &[0, 1, 2, 0, 0, 0]).read();
    let asset = asset.unwrap();
    assert_eq!(asset.scene.meshes[0].triangles.len(), 2);
    assert!(asset.scene.camera.position.iter().all(|c| c.is_finite()));
    let mut builder = Builder::triangle();
    builder.json["nodes"][0]["scale"] = json!([1.0e38, 1.0e38, 1.0e38]);
    builder.json["nodes"][0]["children"] = json!([1]);
    builder.push("nodes", json!({"mesh": 0, "scale": [1.0e38, 1.0, 1.0]}));
    let asset = builder.read().unwrap();
    assert_eq!(asset.scene.instances.len(), 1, "one transform overflows");
    assert!(
        asset.warnings[0].contains("nodes[1]"),
        "{:?}",
        asset.warnings
    );
}

#[test]
fn containers_that_are_cut() {
    let whole = Builder::triangle().glb();
    for length in 0..whole.len() {
        let outcome = read(&whole[..length], &mut NoFiles, &ReadOptions::default());
        assert!(outcome.is_err(), "{length} of {} bytes", whole.len());
    }
    for at in 4..28 {
        for value in [0, 1, 0x7f, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] = value;
            // Any outcome but a panic.
            let _ = read(&bytes, &mut NoFiles, &ReadOptions::default());
        }
    }
    let header = glb(&json!({}), &[]);
    assert!(read(&header, &mut NoFiles, &ReadOptions::default()).is_err());
    text_refused("", "JSON");
    text_refused("[]", "JSON");
    text_refused(&"[".repeat(100_000), "JSON");
    text_refused("{\"asset\": {\"version\": \"1.0\"}}", "knows glTF 2.0");
    text_refused("{\"asset\": {\"version\": \"2.0\"}}", "no scene");
}

#[test]
fn every_byte_of_the_json_may_change() {
    let mut builder = Builder::triangle();
    let texture = builder.texture([[1, 2, 3, 255]; 4]);
    builder.push(
        "materials",
        json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}, "alphaMode": "MASK"}),
    );
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let whole = builder.glb();
    for at in 20..whole.len() {
        for value in [b'0', b'9', b'-', b'"'] {
            let mut bytes = whole.clone();
            bytes[at] = value;
            let _ = read(&bytes, &mut NoFiles, &ReadOptions::default());
        }
    }
}

#[test]
fn extensions_by_whether_they_are_needed() {
    let mut builder = Builder::triangle();
    builder.json["extensionsUsed"] = json!(["ACME_shiny", "KHR_texture_transform"]);
    let asset = builder.read().unwrap();
    assert_eq!(
        asset.warnings,
        ["extensionsUsed: ACME_shiny is not known and was left out"]
    );
    builder.json["extensionsRequired"] = json!(["KHR_texture_transform", "ACME_shiny"]);
    refused(&builder, &["unsupported", "extensionsRequired: ACME_shiny"]);
}
