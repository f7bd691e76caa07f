//! Raster mips and patches.

use vtex_format::{AddressMode, Entry, EntryKind, Features, SpecKey, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

use crate::builder::{image, push_entries, row_of, set_canvas, set_solid};
use crate::{FILTERS, check, formula, sample};

/// Levels that lookups read finer than their footprint's width.
const FINER: f64 = 0.75;

/// One white cell over a 16 x 16 chain whose level k is opaque grey of byte `200 - 40 k`.
fn grey_levels() -> VtexFile {
    let mut file = row_of(1);
    set_solid(&mut file, 0, [1.0; 4]);
    set_canvas(&mut file, [16, 16], |level, _, _| {
        let grey = 200 - 40 * level as u8;
        [grey, grey, grey, 255]
    });
    file
}

/// Linear light of level k, rounded to a half as packed.
fn level_value(level: f64) -> f64 {
    let value = |k: f64| formula::decode((200.0 - 40.0 * k) / 255.0);
    let (k, f) = (level.floor(), level.fract());
    value(k) * (1.0 - f) + value(k + 1.0) * f
}

#[test]
fn minification_fades_from_cells_into_the_chain() {
    let file = grey_levels();
    for filter in FILTERS {
        for i in 0..=60 {
            let texels = 2.0_f64.powf(f64::from(i) / 10.0 - 2.0);
            let lod = texels.log2();
            // In footprint mode an octave later.
            let sooner = f64::from(u8::from(filter != FilterMode::Footprint));
            let fade = (lod + sooner).clamp(0.0, 1.0);
            let chain = level_value((lod - FINER).clamp(0.0, 4.0));
            let expected = 1.0 - fade + fade * chain;
            let got = sample(&file, filter, 0.4, texels as f32 / 16.0);
            check(got, [expected, expected, expected, 1.0], 1e-3);
        }
    }
}

#[test]
fn no_step_between_footprints() {
    let file = grey_levels();
    let at = |i: u32| {
        sample(
            &file,
            FilterMode::Footprint,
            0.4,
            0.01 * 1.002_f32.powi(i as i32),
        )
    };
    for i in 0..3000 {
        let (a, b) = (at(i)[0], at(i + 1)[0]);
        assert!((a - b).abs() < 0.005, "a step from {a} to {b} at {i}");
    }
}

#[test]
fn texels_are_linear_light_with_centres_at_one_half() {
    let mut file = row_of(1);
    set_canvas(&mut file, [4, 4], |_, x, _| {
        [if x == 1 { 188 } else { 0 }, 0, 0, 255]
    });
    let peak = formula::decode(188.0 / 255.0);
    for (u, weight) in [
        (0.375, 1.0),
        (0.25, 0.5),
        (0.125, 0.0),
        (0.3125, 0.75),
        (0.0, 0.0),
    ] {
        let got = sample(&file, FilterMode::Point, u, 0.25);
        check(got, [weight * peak, 0.0, 0.0, 1.0], 1e-3);
    }
}

#[test]
fn the_chain_wraps_where_the_address_mode_repeats() {
    let mut file = row_of(1);
    set_canvas(&mut file, [4, 4], |_, x, _| {
        [0, if x == 0 { 255 } else { 0 }, 0, 255]
    });
    for (mode, expected) in [
        (AddressMode::Clamp, 0.0),
        (AddressMode::Mirror, 0.0),
        (AddressMode::Repeat, 0.5),
    ] {
        let options = PackOptions {
            address: Some([mode; 2]),
            ..PackOptions::default()
        };
        let packed = pack(&file, &options);
        let got = Sampler::new(&packed).sample([0.999_999, 0.5], [0.25, 0.0, 0.0, 0.25]);
        check(got, [0.0, expected, 0.0, 1.0], 1e-3);
    }
}

/// A patch in the right half of the canvas over a grey ground.
fn patched(alpha: u8) -> VtexFile {
    patched_as(alpha, false)
}

/// The same; `opaque`: marked as what hides all behind it.
fn patched_as(alpha: u8, opaque: bool) -> VtexFile {
    let mut file = row_of(1);
    let rect = [0.5, 0.0, 1.0, 1.0];
    file.images
        .push(image(rect, [8, 16], |_, _, _| [alpha / 2, 0, 0, alpha]));
    let ground = crate::builder::paint(&mut file, [0.5, 0.5, 0.5, 1.0]);
    let entry = |kind, opaque, index| Entry {
        kind,
        last: false,
        opaque,
        index,
        data: 0,
    };
    let list = [
        entry(EntryKind::Image, opaque, 0),
        entry(EntryKind::Full, true, ground),
    ];
    push_entries(&mut file, 0, &list);
    file
}

#[test]
fn patches_composite_like_paints_inside_their_rectangle() {
    let file = patched(255);
    assert_eq!(
        SpecKey::for_file(&file).features & Features::MIPS,
        0,
        "a patch is no canvas chain"
    );
    // Outside its rectangle an opaque patch hides nothing either.
    for file in [file, patched_as(255, true)] {
        for filter in FILTERS {
            let ground = formula::linear([0.5, 0.5, 0.5, 1.0]);
            check(sample(&file, filter, 0.3, 0.01), ground, 1e-5);
            let opaque = [formula::decode(127.0 / 255.0), 0.0, 0.0, 1.0];
            for width in [0.0, 0.01] {
                check(sample(&file, filter, 0.7, width), opaque, 1e-3);
            }
        }
    }
    let file = patched(128);
    // Stored: linear light, premultiplied, then encoded. Half transparent.
    let a = 128.0 / 255.0;
    let encoded = formula::encode(formula::decode(64.0 / 255.0) / a) * a;
    let behind = 0.5 * (1.0 - a);
    let expected = [encoded + behind, behind, behind].map(formula::decode);
    for filter in FILTERS {
        let got = sample(&file, filter, 0.7, 0.01);
        check(got, [expected[0], expected[1], expected[2], 1.0], 1e-3);
    }
}

/// One lookup of an image stands for all samples that see it.
#[test]
fn a_patch_is_filtered_over_the_whole_footprint() {
    let mut file = row_of(1);
    let grey = |level| 200 - 40 * level as u8;
    file.images
        .push(image([0.0, 0.0, 1.0, 1.0], [16, 16], |level, _, _| {
            [grey(level), grey(level), grey(level), 255]
        }));
    let entry = Entry {
        kind: EntryKind::Image,
        last: true,
        opaque: false,
        index: 0,
        data: 0,
    };
    push_entries(&mut file, 0, &[entry]);
    for i in 0..=40 {
        let lod = f64::from(i) / 10.0 - 1.0;
        let width = 2.0_f64.powf(lod) as f32 / 16.0;
        let expected = level_value((lod - FINER).max(0.0));
        let got = sample(&file, FilterMode::Footprint, 0.5, width);
        check(got, [expected, expected, expected, 1.0], 1e-3);
    }
}

/// Waves of light, 64 texels of them: direction in radians, length in texels.
#[derive(Clone, Copy, Debug)]
struct Waves {
    turn: f64,
    length: f64,
}

impl Waves {
    /// The mean over the parallelogram with these axes about the middle of the canvas, in texels.
    fn mean(self, at: [f64; 2], axes: [[f64; 2]; 2]) -> f64 {
        let along = |v: [f64; 2]| {
            let (sin, cos) = self.turn.sin_cos();
            std::f64::consts::TAU / self.length * (v[0] * cos + v[1] * sin)
        };
        let blur = |axis| match 0.5 * along(axis) {
            0.0 => 1.0,
            half => half.sin() / half,
        };
        0.5 + 0.4 * along(at.map(|x| x - 32.0)).cos() * axes.map(blur).iter().product::<f64>()
    }

    /// A texel that is the mean over its area.
    fn texel(self, level: u32, x: u32, y: u32) -> [u8; 4] {
        let side = f64::from(1_u32 << level);
        let at = [x, y].map(|k| side * (f64::from(k) + 0.5));
        let mean = self.mean(at, [[side, 0.0], [0.0, side]]);
        let byte = (formula::encode(mean) * 255.0).round() as u8;
        [byte, byte, byte, 255]
    }
}

/// A canvas image, and an image that an entry shows, both over the whole canvas.
fn waves(waves: Waves) -> [VtexFile; 2] {
    let mut canvas = row_of(1);
    set_solid(&mut canvas, 0, [1.0; 4]);
    set_canvas(&mut canvas, [64, 64], |level, x, y| {
        waves.texel(level, x, y)
    });
    let mut patch = row_of(1);
    let texels = image([0.0, 0.0, 1.0, 1.0], [64, 64], |level, x, y| {
        waves.texel(level, x, y)
    });
    patch.images.push(texels);
    let entry = Entry {
        kind: EntryKind::Image,
        last: true,
        opaque: true,
        index: 0,
        data: 0,
    };
    push_entries(&mut patch, 0, &[entry]);
    [canvas, patch]
}

/// Options of footprint mode.
fn of_footprints() -> PackOptions {
    PackOptions {
        filter: FilterMode::Footprint,
        ..PackOptions::default()
    }
}

/// Footprints as a plane at a grazing angle has them: waves across stay, waves along go.
#[test]
fn a_long_footprint_is_averaged_along_its_longer_axis_alone() {
    for turn in [0.0, 0.5, 1.57, 2.4, 3.0] {
        for ratio in [1.1, 1.5, 2.0, 3.3, 6.0, 8.0] {
            // Two texels wide; then the same region with axes that are not upright to each other.
            let (sin, cos) = f64::sin_cos(turn);
            let [long, short] = [[cos, sin].map(|c| 2.0 * ratio * c), [-2.0 * sin, 2.0 * cos]];
            let mixed = |a: f64, b: f64| [0, 1].map(|i| a * long[i] + b * short[i]);
            let half = f64::sqrt(0.5);
            for axes in [[long, short], [mixed(half, half), mixed(half, -half)]] {
                let across = Waves {
                    turn: turn + std::f64::consts::FRAC_PI_2,
                    length: 8.0,
                };
                let along = Waves {
                    turn,
                    length: 2.5 * ratio,
                };
                for kind in [across, along] {
                    let expected = kind.mean([32.0; 2], [long, short]);
                    for file in waves(kind) {
                        let packed = pack(&file, &of_footprints());
                        let footprint = axes.as_flattened();
                        let footprint = std::array::from_fn(|i| footprint[i] as f32 / 64.0);
                        let got = Sampler::new(&packed).sample([0.5; 2], footprint);
                        let apart = (f64::from(got[0]) - expected).abs();
                        assert!(apart < 0.05, "{kind:?} {ratio}: {got:?}, not {expected}");
                    }
                }
            }
        }
    }
}

/// Past eight times longer than wide a footprint counts as wider than it is.
#[test]
fn the_longest_footprints_get_wider() {
    let file = grey_levels();
    let packed = pack(&file, &of_footprints());
    for (long, short) in [
        (16.0, 2.0),
        (16.0, 1.0),
        (16.0, 0.0),
        (32.0, 4.0),
        (32.0, 1.0),
    ] {
        let [long_uv, short_uv] = [long, short].map(|texels: f64| (texels / 16.0) as f32);
        let expected = level_value(f64::log2(long / 8.0) - FINER);
        let got = Sampler::new(&packed).sample([0.5; 2], [0.0, long_uv, short_uv, 0.0]);
        check(got, [expected, expected, expected, 1.0], 1e-3);
    }
}

/// Without footprint mode there is one place, as wide as the longer axis, whatever the other.
#[test]
fn points_count_the_longer_axis_alone() {
    let file = grey_levels();
    for filter in [FilterMode::Point, FilterMode::Paper] {
        for (long, short) in [(2.0, 2.0), (4.0, 1.0), (8.0, 0.0)] {
            let [long_uv, short_uv] = [long, short].map(|texels: f64| (texels / 16.0) as f32);
            let options = PackOptions {
                filter,
                ..PackOptions::default()
            };
            let packed = pack(&file, &options);
            let expected = level_value(f64::log2(long) - FINER);
            let got = Sampler::new(&packed).sample([0.5; 2], [0.0, long_uv, short_uv, 0.0]);
            check(got, [expected, expected, expected, 1.0], 1e-3);
        }
    }
}

#[test]
fn a_mask_reads_the_alpha_of_texels() {
    let mut file = patched(128);
    file.entries.truncate(2);
    file.entries[0] |= 1 << 27;
    file.meta.sampler.mask = true;
    for filter in FILTERS {
        check(sample(&file, filter, 0.7, 0.01), [128.0 / 255.0; 4], 1e-3);
        check(sample(&file, filter, 0.3, 0.01), [0.0; 4], 0.0);
    }
}

#[test]
fn garbage_words_never_panic() {
    let packed = pack(&patched(128), &PackOptions::default());
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040);
        (state >> 33) as u32
    };
    for _ in 0..20_000 {
        let mut broken = packed.words.clone();
        for _ in 0..1 + random() % 4 {
            let at = random() as usize % broken.len().min(48);
            broken[at] = if random() % 2 == 0 {
                random() << 1
            } else {
                random() % 64
            };
        }
        broken.truncate(random() as usize % broken.len());
        let sampler = Sampler::of(&broken, &packed.texels);
        let uv = [random() as f32 / 1e9, random() as f32 / 1e9];
        let special = [0.0, 1e-3, 1e9, f32::INFINITY, f32::NAN][random() as usize % 5];
        sampler.sample(uv, [special, 0.0, 0.1, special]);
        sampler.sample([special, uv[1]], [0.0; 4]);
    }
}

#[test]
fn a_footprint_sees_the_share_of_a_patch_that_it_covers() {
    for (alpha, opaque) in [(255, true), (255, false), (100, false)] {
        let file = patched_as(alpha, opaque);
        let both = [FilterMode::Point, FilterMode::Footprint].map(|filter| {
            let options = PackOptions {
                filter,
                ..PackOptions::default()
            };
            pack(&file, &options)
        });
        let [points, footprints] = both.each_ref().map(Sampler::new);
        let mut shares = Vec::new();
        for i in 0..400 {
            let turn = 0.1 * i as f32;
            let [x, y] = [0.1 * turn.cos(), 0.1 * turn.sin()];
            let axes = [x, y, -y, x];
            let uv = [0.5 + 0.12 * (0.37 * turn).sin(), 0.4];
            let places = footprints.places(uv, axes);
            let sum = places.iter().fold([0.0; 4], |sum, place| {
                let one = points.sample(*place, [0.0; 4]);
                std::array::from_fn(|k| sum[k] + f64::from(one[k]))
            });
            let got = footprints.sample(uv, axes);
            check(got, sum.map(|channel| channel / places.len() as f64), 1e-5);
            shares.push((1000.0 * got[1]) as i32);
        }
        shares.sort_unstable();
        shares.dedup();
        // A patch that is there or not has two.
        assert!(shares.len() > 8, "{shares:?}");
    }
}

/// The sides of tiles are rounded each by itself, so that between two there may be a gap of one f32.
#[test]
fn patches_that_abut_leave_no_gap() {
    let mut file = row_of(1);
    let side = 28.0_f32 / 31.0;
    let rects = [
        [0.0, 0.0, side.next_down(), 1.0],
        [side.next_up(), 0.0, 1.0, 1.0],
    ];
    let red = |_, _, _| [255, 0, 0, 255];
    file.images = rects.map(|rect| image(rect, [4, 4], red)).to_vec();
    let entries = [0, 1].map(|index| Entry {
        kind: EntryKind::Image,
        last: false,
        opaque: true,
        index,
        data: 0,
    });
    push_entries(&mut file, 0, &entries);
    file.spec = SpecKey::for_file(&file);
    for filter in FILTERS {
        for u in [side.next_down(), side, side.next_up()] {
            check(sample(&file, filter, u, 0.0), [1.0, 0.0, 0.0, 1.0], 1e-6);
        }
    }
}
