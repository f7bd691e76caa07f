//! The cost of point lookups: how many entries and segments they visit.

use vtex_format::VtexFile;
use vtex_shaders::{PackOptions, cpu::Sampler, pack};

/// Number of lookups: 1 % of them, on which the 99th percentile rests, are 160.
const LOOKUPS: usize = 16_384;

/// Mean and 99th percentile over lookups.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spread {
    /// Arithmetic mean.
    pub(crate) mean: f64,
    /// 99th percentile.
    pub(crate) p99: u32,
}

/// What point lookups without footprint, as at large zooms, visit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LookupLoad {
    /// Entries up to and including the first opaque one that covers the point.
    pub(crate) entries: Spread,
    /// Segments of these entries in the fine cell of the point, and changes of the winding beside
    /// it.
    pub(crate) segments: Spread,
}

/// The cost over points that are spread evenly over the canvas. The same file gives the same result.
pub(crate) fn lookup_load(file: &VtexFile) -> LookupLoad {
    let packed = pack(file, &PackOptions::default());
    let sampler = Sampler::new(&packed);
    let (mut entries, mut segments) = (Vec::new(), Vec::new());
    for k in 0..LOOKUPS {
        // Roberts (2018), "The unreasonable effectiveness of quasirandom sequences": R2.
        let place = |step: f64| ((k + 1) as f64 * step).fract();
        #[expect(clippy::cast_possible_truncation, reason = "a place on the canvas")]
        let uv = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|step| place(step) as f32);
        let cost = sampler.cost(uv, [0.0; 4]);
        entries.push(cost.entries);
        segments.push(cost.segments);
    }
    LookupLoad {
        entries: spread(entries),
        segments: spread(segments),
    }
}

fn spread(mut counts: Vec<u32>) -> Spread {
    counts.sort_unstable();
    let sum: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    Spread {
        mean: sum as f64 / counts.len().max(1) as f64,
        p99: counts.get(counts.len() * 99 / 100).copied().unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use super::{Spread, lookup_load, spread};
    use vtex_baker::{BakeConfig, Mode, Resources, bake};

    #[test]
    fn mean_and_p99() {
        let found = spread((0..200).collect());
        assert_eq!(
            found,
            Spread {
                mean: 99.5,
                p99: 198
            }
        );
    }

    /// A square over a quarter of the canvas, whose edges lie in few cells.
    #[test]
    fn a_square_costs_its_edge_cells() {
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16">
            <path d="M4.1 4.1H12.1V12.1H4.1Z" fill="#fff"/></svg>"##;
        // 128 of 64 x 64 cells hold an edge, and a few more within the reach of one. Fine cells hold
        // an edge, which is one segment, where it runs and nowhere else.
        for (mode, entries, segments) in [
            (Mode::Curves, 0.0005..0.03, 1.0),
            (Mode::Msdf, 0.025..0.06, 0.0),
        ] {
            let config = BakeConfig {
                mode,
                msdf_size: 384,
                ..BakeConfig::default()
            };
            let file = bake(svg, &config, &Resources::default()).unwrap();
            let load = lookup_load(&file);
            assert!(entries.contains(&load.entries.mean), "{mode:?} {load:?}");
            let ratio = load.segments.mean / load.entries.mean;
            assert!((ratio - segments).abs() < 0.2, "{mode:?} {load:?}");
        }
    }
}
