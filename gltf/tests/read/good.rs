//! What assets become.

use serde_json::json;
use vtex_format::AddressMode;
use vtex_gltf::material::AlphaMode;
use vtex_gltf::{NoFiles, PunctualKind, ReadOptions, read};
use vtex_runtime::{Sky, Surface};

use crate::builder::Builder;

#[test]
fn a_triangle_with_a_texture() {
    let mut builder = Builder::triangle();
    let uv = builder.floats(&[[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]], "VEC2");
    let texture = builder.texture([
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [9, 9, 9, 0],
    ]);
    builder.push("samplers", json!({"wrapS": 33071, "wrapT": 33648}));
    builder.json["textures"][texture]["sampler"] = json!(0);
    builder.push(
        "materials",
        json!({"pbrMetallicRoughness": {
            "baseColorTexture": {"index": texture, "extensions": {"KHR_texture_transform": {
                "offset": [0.25, 0.5], "scale": [2.0, 3.0], "rotation": 1.5707964}}},
            "baseColorFactor": [0.5, 0.25, 1.0, 0.5], "metallicFactor": 0.25}}),
    );
    let primitive = &mut builder.json["meshes"][0]["primitives"][0];
    primitive["material"] = json!(0);
    primitive["attributes"]["TEXCOORD_0"] = json!(uv);
    let asset = builder.read().unwrap();
    assert_eq!(asset.warnings, Vec::<String>::new());
    let scene = &asset.scene;
    assert_eq!(scene.meshes[0].uvs, [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]);
    let material = scene.materials[0];
    assert_eq!(material.base_color, [0.5, 0.25, 1.0]);
    assert_eq!(
        material.surface,
        Surface::Glossy {
            metallic: 0.25,
            roughness: 1.0
        }
    );
    let (file, _) = &scene.textures[material.texture.unwrap()];
    assert_eq!(file.check(), []);
    let sampler = &file.meta.sampler;
    assert_eq!(sampler.address, [AddressMode::Clamp, AddressMode::Mirror]);
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    // A quarter turn counter-clockwise takes u to -v and v to u, v growing downwards.
    assert!(near(
        &sampler.texture_matrix,
        &[0.0, -2.0, 3.0, 0.0, 0.25, 0.5]
    ));
    // Alpha is not read, so that the last texel is as opaque as the others.
    assert_eq!(&file.images[0].mips[0][12..], [9, 9, 9, 255]);
    assert_eq!(asset.materials[0].alpha_mode, AlphaMode::Opaque);
}

#[test]
fn alpha_is_cut_or_kept() {
    for (mode, factor, wanted) in [("MASK", 1.0, [0, 255]), ("BLEND", 0.5, [50, 100])] {
        let mut builder = Builder::triangle();
        let texture = builder.texture([[255, 255, 255, 100], [255, 255, 255, 200], [0; 4], [0; 4]]);
        builder.push(
            "materials",
            json!({"alphaMode": mode, "pbrMetallicRoughness": {
                "baseColorTexture": {"index": texture}, "baseColorFactor": [1, 1, 1, factor]}}),
        );
        builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        let scene = builder.read().unwrap().scene;
        let texels = &scene.textures[0].0.images[0].mips[0];
        assert_eq!([texels[3], texels[7]], wanted, "{mode}");
    }
    // A factor alone is a texture too.
    let mut builder = Builder::triangle();
    let faint = json!({"baseColorFactor": [1, 1, 1, 0.25]});
    builder.push(
        "materials",
        json!({"alphaMode": "BLEND", "pbrMetallicRoughness": faint}),
    );
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let scene = builder.read().unwrap().scene;
    assert_eq!(scene.textures[0].0.images[0].mips[0], [137, 137, 137, 64]);
}

#[test]
fn strips_fans_and_quantised_positions() {
    for (mode, wanted) in [
        (5, vec![[0, 1, 2], [2, 1, 3], [2, 3, 4]]),
        (6, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]),
    ] {
        let mut builder = Builder::of(&[[0.0; 3]; 5], &[0, 1, 2, 3, 4]);
        builder.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        assert_eq!(builder.read().unwrap().scene.meshes[0].triangles, wanted);
    }
    let mut builder = Builder::triangle();
    let bytes = [0, 127, 129, 0, 127, 0, 0, 0, 0, 127, 0, 0];
    let view = builder.view(&bytes);
    builder.json["bufferViews"][view]["byteStride"] = json!(4);
    builder.json["accessors"][1] = json!({"bufferView": view, "componentType": 5120, "type": "VEC3",
        "count": 3, "normalized": true});
    let positions = builder.read().unwrap().scene.meshes[0].positions.clone();
    assert_eq!(
        positions,
        [[0.0, 1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    );
    let mut builder = Builder::triangle();
    builder.json["meshes"][0]["primitives"][0]["mode"] = json!(1);
    let asset = builder.read().unwrap();
    assert!(asset.scene.meshes.is_empty() && asset.warnings[0].contains("points and lines"));
    // Sparse: one vertex is another.
    let mut builder = Builder::triangle();
    let at = builder.view(&2_u32.to_le_bytes());
    let new = builder.view(&[0; 12]);
    builder.json["accessors"][1]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": at, "componentType": 5125}, "values": {"bufferView": new}});
    assert_eq!(
        builder.read().unwrap().scene.meshes[0].positions[2],
        [0.0; 3]
    );
}

#[test]
fn instances_share_a_mesh() {
    let mut builder = Builder::triangle();
    let places = builder.floats(&[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]], "VEC3");
    builder.json["nodes"][0]["translation"] = json!([0.0, 0.0, 5.0]);
    builder.json["nodes"][0]["extensions"] =
        json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}});
    builder.json["scenes"][0]["nodes"] = json!([0, 1]);
    let matrix = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 7, 8, 9, 1];
    builder.push("nodes", json!({"mesh": 0, "matrix": matrix}));
    let scene = builder.read().unwrap().scene;
    assert_eq!(scene.meshes.len(), 1);
    let origins: Vec<[f32; 3]> = scene
        .instances
        .iter()
        .map(|i| i.world_from_object[3])
        .collect();
    assert_eq!(origins, [[1.0, 0.0, 5.0], [0.0, 2.0, 5.0], [7.0, 8.0, 9.0]]);
    assert_eq!(scene.instances[2].world_from_object[0], [2.0, 0.0, 0.0]);
}

#[test]
fn cameras_lights_and_variants() {
    let mut builder = Builder::triangle();
    builder.json["cameras"] = json!([
        {"type": "perspective", "name": "close", "perspective": {"yfov": 0.7, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}},
    ]);
    builder.json["extensions"] = json!({
        "KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 5}]},
        "KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]},
    });
    for color in [[1, 0, 0, 1], [0, 0, 1, 1]] {
        builder.push(
            "materials",
            json!({"pbrMetallicRoughness": {"baseColorFactor": color}}),
        );
    }
    let primitive = &mut builder.json["meshes"][0]["primitives"][0];
    primitive["material"] = json!(0);
    primitive["extensions"] = json!({"KHR_materials_variants": {"mappings": [
        {"material": 1, "variants": [1]}]}});
    builder.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    builder.push("nodes", json!({"camera": 0, "translation": [0, 0, 4]}));
    builder.push("nodes", json!({"camera": 1, "name": "plan"}));
    builder.push(
        "nodes",
        json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}),
    );
    let asset = builder.read().unwrap();
    assert_eq!(asset.cameras.len(), 2);
    assert_eq!(
        (
            asset.cameras[0].name.as_str(),
            asset.cameras[1].name.as_str()
        ),
        ("close", "plan")
    );
    let camera = asset.scene.camera;
    assert_eq!(
        (camera.position, camera.target),
        ([0.0, 0.0, 4.0], [0.0, 0.0, -1.0])
    );
    assert!(matches!(asset.lights[0].kind, PunctualKind::Spot { .. }));
    let [spot] = asset.scene.punctual.as_slice() else {
        panic!("lights: {:?}", asset.scene.punctual);
    };
    assert_eq!((spot.intensity, spot.range), ([5.0; 3], None));
    assert_eq!(asset.scene.sky, Sky::uniform(0.0), "its light is its own");
    assert_eq!(asset.scene.materials[0].base_color, [1.0, 0.0, 0.0]);
    let variant = |name: &str| {
        let options = ReadOptions {
            variant: Some(name.to_owned()),
            ..ReadOptions::default()
        };
        read(&builder.glb(), &mut NoFiles, &options)
    };
    assert_eq!(
        variant("blue").unwrap().scene.materials[0].base_color,
        [0.0, 0.0, 1.0]
    );
    let error = variant("green").unwrap_err().to_string();
    assert!(error.contains("\"red\", \"blue\""), "{error}");
}

#[test]
fn what_is_not_shown_is_kept_and_named() {
    let mut builder = Builder::triangle();
    let texture = builder.texture([[0, 128, 255, 255]; 4]);
    let slot = json!({"index": texture});
    builder.push("materials", json!({
        "name": "glass",
        "pbrMetallicRoughness": {"metallicRoughnessTexture": slot},
        "normalTexture": slot, "occlusionTexture": slot, "emissiveTexture": slot,
        "emissiveFactor": [1, 1, 1],
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 10},
            "KHR_materials_ior": {"ior": 1.3}, "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationColor": [1, 0.5, 0.5]},
            "KHR_materials_specular": {"specularFactor": 0.5},
            "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]},
            "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": slot},
        },
    }));
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let asset = builder.read().unwrap();
    let warning = asset
        .warnings
        .iter()
        .find(|w| w.contains("not shown yet"))
        .unwrap();
    for name in [
        "materials[0] \"glass\"",
        "metallicRoughnessTexture",
        "normalTexture",
        "occlusionTexture",
        "emissiveTexture",
        "sheen",
        "clearcoatTexture",
    ] {
        assert!(warning.contains(name), "no {name} in {warning}");
    }
    let extensions = &asset.materials[0].extensions;
    assert_eq!(extensions.ior.ior.to_bits(), 1.3_f32.to_bits());
    assert_eq!(
        extensions.volume.as_ref().unwrap().attenuation_color,
        [1.0, 0.5, 0.5]
    );
    assert_eq!(asset.materials[0].slots().len(), 5);
    let material = asset.scene.materials[0];
    let Surface::Glossy {
        metallic,
        roughness,
    } = material.surface
    else {
        panic!("{material:?}");
    };
    let straight_on = 0.5 * (0.3_f32 / 2.3).powi(2);
    let off = material
        .dielectric
        .straight_on
        .map(|c| (c - straight_on).abs());
    assert!(off.iter().all(|&off| off < 1e-6), "{material:?}");
    assert_eq!(material.dielectric.grazing.to_bits(), 0.5_f32.to_bits());
    assert_eq!(material.coat.unwrap().strength.to_bits(), 1.0_f32.to_bits());
    let glass = material.glass.unwrap();
    // Without a distance nothing is absorbed, and the thickness makes a body of it.
    assert_eq!((glass.index, glass.absorption), (1.3, Some([0.0; 3])));
    assert!((metallic - 1.0).abs() < 1e-3 && (roughness - 128.0 / 255.0).abs() < 1e-3);
    assert!((material.emission[2] - 10.0).abs() < 1e-3 && material.emission[0] < 1e-3);
}

#[test]
fn bodies_absorb_what_their_colour_says() {
    let mut builder = Builder::triangle();
    builder.push(
        "materials",
        json!({"extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.5},
            "KHR_materials_volume": {
                "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0],
            },
        }}),
    );
    builder.push(
        "materials",
        json!({"extensions": {"KHR_materials_unlit": {}, "KHR_materials_transmission": {}}}),
    );
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let glass = builder.read().unwrap().scene.materials[0].glass.unwrap();
    let [red, green, blue] = glass.absorption.unwrap();
    assert!(
        red == 0.0 && (green - 0.5 * 2.0_f32.ln()).abs() < 1e-6,
        "{glass:?}"
    );
    assert!(blue.is_finite() && blue > 3.0, "{glass:?}");
    assert_eq!((glass.share, glass.index), (0.5, 1.5));
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(1);
    let material = builder.read().unwrap().scene.materials[0];
    assert_eq!(material.surface, Surface::Unlit);
    assert_eq!(material.glass.unwrap().absorption, None, "a thin wall");
}
