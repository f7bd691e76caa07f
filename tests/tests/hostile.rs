//! Files that are small and ask for much: what reading and loading make of each.

use vtex_format::{
    Features, LayerRecord, Limits, MAX_ENTRIES_PER_CELL, SHADER_ABI, VtexFile, validate,
};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::layout::rows;
use vtex_shaders::{FilterMode, PackOptions, check_fine, fine_words, load, pack};
use vtex_tests::fixture::random_texture;
use vtex_tests::hostile::{HOSTILE, Hostile};
use vtex_tests::parity::random_queries;
use vtex_tests::random::Random;

/// Bytes of the largest.
const SMALL_BYTES: usize = 64 << 10;
/// Words of one that is not refused, 16 MiB.
const MAX_WORDS: usize = 4 << 20;

fn codes(hostile: &Hostile) -> Vec<u16> {
    let bytes = hostile.bytes();
    assert!(
        bytes.len() < SMALL_BYTES,
        "{}: {}",
        hostile.name,
        bytes.len()
    );
    let mut codes: Vec<u16> = validate(&bytes, &Limits::default())
        .iter()
        .map(|issue| issue.code)
        .collect();
    codes.dedup();
    codes
}

/// Those that ask for too much are refused with the limit that they pass.
#[test]
fn what_asks_for_too_much_is_refused() {
    for hostile in &HOSTILE {
        let name = hostile.name;
        let wanted: &[u16] = match name {
            "tests52" => &[5034],
            "chain8192" => &[2020],
            "entr512" | "img14k" => &[2016],
            _ => &[],
        };
        assert_eq!(codes(hostile), wanted, "{name}");
    }
}

/// One list serves all cells that name it, and no list is divided without end.
#[test]
fn what_is_read_loads_into_few_words() {
    let mut loaded = 0;
    for hostile in &HOSTILE {
        let Ok(file) = VtexFile::parse(&hostile.bytes(), &Limits::default()) else {
            continue;
        };
        loaded += 1;
        for filter in [FilterMode::Point, FilterMode::Footprint] {
            let options = PackOptions {
                filter,
                ..PackOptions::default()
            };
            let packed = pack(&file, &options);
            let words = packed.bytes() / 4;
            assert!(words <= MAX_WORDS, "{}, {filter:?}: {words}", hostile.name);
        }
    }
    assert_eq!(loaded, 2);
}

const GROUPED: u32 = Features::CLIPS | Features::GROUPS | Features::BLENDS | Features::DEEP_GROUPS;
const LISTED: u32 = Features::LISTS | Features::CURVES | Features::TRANSLUCENT;

/// Textures with what fine cells can hold.
fn textures() -> impl Iterator<Item = VtexFile> {
    let drawn = Features::MSDF | Features::IMAGES | Features::MIPS | Features::GRADIENTS;
    let features = [
        Features::LISTS | Features::CURVES,
        LISTED | drawn | Features::OUTLINE,
        LISTED | Features::CLIPS,
        LISTED | GROUPED,
        LISTED | GROUPED | drawn,
    ];
    (1..).zip(features).map(|(seed, features)| {
        let mut file = random_texture(seed, features);
        let side = file.meta.grid.texels_per_cell as usize + 1;
        let tiles = file.tiles.len() / (4 * side * side);
        file.layers = vec![LayerRecord {
            tile_first: 0,
            tile_count: u32::try_from(tiles).expect("a few"),
            shape_count: 0,
            reserved: 0,
        }];
        assert_eq!(file.check(), [], "the texture is a sound file");
        file
    })
}

const MODES: [FilterMode; 2] = [FilterMode::Point, FilterMode::Footprint];

fn in_mode(filter: FilterMode) -> PackOptions {
    PackOptions {
        filter,
        ..PackOptions::default()
    }
}

/// A texture of which nothing is left to cut.
fn without_lists(file: &VtexFile) -> VtexFile {
    VtexFile {
        cells: Vec::new(),
        entries: Vec::new(),
        curves: Vec::new(),
        ..file.clone()
    }
}

/// In every mode and with every option the words are those of a file without fine cells.
#[test]
fn fine_cells_are_what_packing_makes() {
    for (index, plain) in textures().enumerate() {
        for filter in MODES {
            let fine = VtexFile {
                fine: fine_words(&plain, filter),
                ..plain.clone()
            };
            assert_eq!(check_fine(&fine), None);
            let bytes = fine.to_bytes().unwrap();
            let paper = PackOptions {
                smoothing: Some(0.25),
                ..in_mode(FilterMode::Paper)
            };
            let coarse = PackOptions {
                halvings: Some(1),
                ..in_mode(filter)
            };
            let moved = PackOptions {
                texture_matrix: Some([2.0, 0.0, 0.0, 3.0, 0.0, 0.0]),
                address: Some([vtex_format::AddressMode::Repeat; 2]),
                ..in_mode(filter)
            };
            let mut all = vec![in_mode(filter)];
            if index == 2 {
                let other = in_mode(MODES[1 - filter as usize]);
                all.extend([other, paper, coarse, moved]);
            }
            for options in all {
                let expected = pack(&plain, &options);
                assert!(pack(&fine, &options) == expected, "{options:?}");
                let loaded = load(&bytes, &Limits::default(), &options).unwrap();
                assert!(loaded.packed == expected, "{options:?}");
                let for_points = options.filter != FilterMode::Footprint;
                let fits =
                    for_points == (filter == FilterMode::Point) && options.halvings.is_none();
                let alone = pack(&without_lists(&fine), &options);
                assert_eq!(alone == expected, fits, "{options:?}");
            }
        }
    }
}

/// Fine cells of another ABI are nothing to this one.
#[test]
fn fine_cells_of_another_abi_are_passed_over() {
    for plain in textures() {
        let mut fine = fine_words(&plain, FilterMode::Point);
        fine[0] = SHADER_ABI + 1;
        let file = VtexFile {
            fine,
            ..plain.clone()
        };
        assert_eq!(check_fine(&file), None);
        let options = PackOptions::default();
        assert!(pack(&file, &options) == pack(&plain, &options));
        let loaded = load(&file.to_bytes().unwrap(), &Limits::default(), &options);
        assert!(loaded.unwrap().packed == pack(&plain, &options));
    }
}

/// Words behind a texture's own: what a lookup must not read. They are zeros to one that is alone.
const BEHIND: [u32; 4096] = [0xA5A5_5A5A; 4096];

/// Whatever the words of fine cells, loading makes a texture that lookups stay in and end in, or passes
/// them over.
#[test]
fn altered_fine_cells_do_no_harm() {
    let mut random = Random::new(11);
    let (mut taken, mut refused) = (0, 0);
    for plain in textures() {
        for filter in MODES {
            let options = in_mode(filter);
            let sound = fine_words(&plain, filter);
            let none = pack(&without_lists(&plain), &options);
            for round in 0..24 {
                let mut file = without_lists(&plain);
                file.fine = altered(&sound, &mut random);
                let packed = pack(&file, &options);
                if packed == none {
                    refused += 1;
                    continue;
                }
                taken += 1;
                let words = [packed.words.as_slice(), &BEHIND].concat();
                let wider = Sampler::of(&words, &packed.texels);
                let alone = Sampler::new(&packed);
                for query in random_queries(round, 16, 0.25) {
                    let [one, other] = [alone, wider].map(|sampler| {
                        let color = sampler.sample(query.uv, query.footprint);
                        color.map(f32::to_bits)
                    });
                    assert_eq!(
                        one, other,
                        "{filter:?}, round {round}: reads behind its words"
                    );
                    let cost = alone.cost(query.uv, query.footprint);
                    let most = MAX_ENTRIES_PER_CELL * (rows::SAMPLES + 1);
                    assert!(cost.entries <= most, "{filter:?}, round {round}: {cost:?}");
                }
                if round == 0 && file.fine != sound {
                    let lie = VtexFile {
                        fine: file.fine,
                        ..plain.clone()
                    };
                    assert_eq!(check_fine(&lie).map(|issue| issue.code), Some(5040));
                }
            }
        }
    }
    assert!(
        taken > 60 && refused > 90,
        "{taken} taken, {refused} refused"
    );
}

/// Some words changed, dropped or added.
fn altered(sound: &[u32], random: &mut Random) -> Vec<u32> {
    let mut words = sound.to_vec();
    for _ in 0..1 + random.below(3) {
        let length = u32::try_from(words.len()).expect("short");
        let at = random.below(length) as usize;
        match random.below(8) {
            0 => words.truncate(at.max(1)),
            1 => words.extend([0; 4]),
            2 => words[at] = random.bits(),
            3 => words[at] = words[random.below(length) as usize],
            4 => words[at] = words[at].wrapping_add(1),
            _ => words[at] ^= 1 << random.below(32),
        }
    }
    // Words of another ABI are not looked at.
    words[0] = SHADER_ABI;
    words
}
