//! Curve records: the exact outline of a shape inside one cell.

use serde::{Deserialize, Serialize};

/// Most straight lines, and most quadratics, of one record: 11 bits. Bounds every evaluator loop;
/// a cell that needs more gets several records or another kind of coverage.
pub const MAX_CURVE_SEGMENTS: u32 = (1 << 11) - 1;
/// Most steps of one record: 9 bits.
pub const MAX_CURVE_STEPS: u32 = (1 << 9) - 1;
/// Words of a [`CurveHeader`].
pub const CURVE_HEADER_WORDS: u32 = 2;
/// Words of a straight line.
pub const CURVE_LINE_WORDS: u32 = 2;
/// Words of a quadratic.
pub const CURVE_QUAD_WORDS: u32 = 3;

const QUAD_SHIFT: u32 = 11;
const STEP_SHIFT: u32 = 22;
const EVEN_ODD_BIT: u32 = 1 << 31;
const BASE_SHIFT: u32 = 22;
const BASE_LIMIT: i32 = 1 << 9;

/// The lattice that coordinates of curve records lie on.
///
/// A record's coordinates are 16-bit integers in a *box*: the cell widened on all sides by
/// `margin_units`, origin at its top left. `unit = q * units_per_cell + margin_units`, where `q`
/// is the position inside the cell. The lattices of neighbouring cells are one and the same, so a
/// point that several boxes or several shapes share is the same point in all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CurveLattice {
    /// Units along a cell's side.
    pub units_per_cell: u32,
    /// Units by which a box is wider than its cell on each side.
    pub margin_units: u32,
}

impl CurveLattice {
    /// The finest lattice whose boxes reach `margin_cells` beyond their cells; `None` unless the
    /// margin is in \[0, 1\].
    pub fn new(margin_cells: f32) -> Option<Self> {
        if !(0.0..=1.0).contains(&margin_cells) {
            return None;
        }
        let units = (f64::from(u16::MAX) / (1.0 + 2.0 * f64::from(margin_cells))).floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 21845, at most 65535"
        )]
        let units_per_cell = units as u32;
        Some(Self {
            units_per_cell,
            // Half of what 16 bits leave: the box never has more.
            margin_units: (u32::from(u16::MAX) - units_per_cell) / 2,
        })
    }

    /// Side of a box in units; a box of more than 65535 is malformed.
    pub fn box_units(self) -> u32 {
        self.units_per_cell
            .saturating_add(self.margin_units.saturating_mul(2))
    }
}

/// The first two words of a record.
///
/// | bits | first word | second word |
/// |---|---|---|
/// | 10..0 | lines | lines that run down |
/// | 21..11 | quadratics | quadratics that run down |
/// | 30..22 | steps | base winding, bits 31..22, two's complement |
/// | 31 | 1: even-odd, 0: non-zero | |
///
/// Then follow the steps (a word each: y, then the change of the winding as a signed 16-bit
/// number), the lines (two words: end points, x in the low half) and the quadratics (three words:
/// start, control point, end). Both coordinates of a quadratic are monotone. Every segment is
/// stored from its upper to its lower end, whichever way the outline runs; those that run down
/// come first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurveHeader {
    /// Number of straight lines.
    pub line_count: u32,
    /// How many of them run down; they come first.
    pub down_line_count: u32,
    /// Number of quadratics.
    pub quad_count: u32,
    /// How many of them run down; they come first.
    pub down_quad_count: u32,
    /// Number of steps.
    pub step_count: u32,
    /// Inside where the winding is odd instead of not zero.
    pub even_odd: bool,
    /// Winding at the box's top left corner.
    pub base_winding: i32,
}

impl CurveHeader {
    /// The two words as stored; `None` when a field does not fit.
    pub fn encode(self) -> Option<[u32; 2]> {
        let fits = self.line_count <= MAX_CURVE_SEGMENTS
            && self.quad_count <= MAX_CURVE_SEGMENTS
            && self.step_count <= MAX_CURVE_STEPS
            && self.down_line_count <= self.line_count
            && self.down_quad_count <= self.quad_count
            && (-BASE_LIMIT..BASE_LIMIT).contains(&self.base_winding);
        let rule = if self.even_odd { EVEN_ODD_BIT } else { 0 };
        fits.then(|| {
            [
                self.line_count
                    | (self.quad_count << QUAD_SHIFT)
                    | (self.step_count << STEP_SHIFT)
                    | rule,
                self.down_line_count
                    | (self.down_quad_count << QUAD_SHIFT)
                    | (self.base_winding.cast_unsigned() << BASE_SHIFT),
            ]
        })
    }

    /// Reads two stored words; `None` when more segments run down than there are.
    pub fn decode([first, second]: [u32; 2]) -> Option<Self> {
        let header = Self {
            line_count: first & MAX_CURVE_SEGMENTS,
            down_line_count: second & MAX_CURVE_SEGMENTS,
            quad_count: (first >> QUAD_SHIFT) & MAX_CURVE_SEGMENTS,
            down_quad_count: (second >> QUAD_SHIFT) & MAX_CURVE_SEGMENTS,
            step_count: (first >> STEP_SHIFT) & MAX_CURVE_STEPS,
            even_odd: first & EVEN_ODD_BIT != 0,
            base_winding: second.cast_signed() >> BASE_SHIFT,
        };
        let sound = header.down_line_count <= header.line_count
            && header.down_quad_count <= header.quad_count;
        sound.then_some(header)
    }

    /// Words of the whole record.
    pub fn record_words(self) -> u32 {
        CURVE_HEADER_WORDS
            + self.step_count
            + self.line_count * CURVE_LINE_WORDS
            + self.quad_count * CURVE_QUAD_WORDS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_round_trips_at_its_limits() {
        for base_winding in [-512, -1, 0, 1, 511] {
            let header = CurveHeader {
                line_count: MAX_CURVE_SEGMENTS,
                down_line_count: 3,
                quad_count: 7,
                down_quad_count: 7,
                step_count: MAX_CURVE_STEPS,
                even_odd: base_winding == 0,
                base_winding,
            };
            let words = header.encode().expect("fits");
            assert_eq!(CurveHeader::decode(words), Some(header));
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let good = CurveHeader {
            line_count: 2,
            ..CurveHeader::default()
        };
        let bad = [
            CurveHeader {
                line_count: MAX_CURVE_SEGMENTS + 1,
                ..good
            },
            CurveHeader {
                down_line_count: 3,
                ..good
            },
            CurveHeader {
                step_count: MAX_CURVE_STEPS + 1,
                ..good
            },
            CurveHeader {
                base_winding: 512,
                ..good
            },
            CurveHeader {
                base_winding: -513,
                ..good
            },
        ];
        assert!(good.encode().is_some());
        for header in bad {
            assert_eq!(header.encode(), None, "{header:?}");
        }
        assert_eq!(CurveHeader::decode([2, 3]), None);
    }

    #[test]
    fn boxes_fit_sixteen_bits() {
        for margin in [0.0, 1.0 / 16.0, 0.125, 0.3, 1.0] {
            let lattice = CurveLattice::new(margin).expect("in range");
            assert!(lattice.box_units() <= 65_535, "{lattice:?}");
            let margin_cells = f64::from(lattice.margin_units) / f64::from(lattice.units_per_cell);
            assert!(margin_cells >= f64::from(margin) - 2e-5, "{lattice:?}");
        }
        assert_eq!(CurveLattice::new(-0.1), None);
        assert_eq!(CurveLattice::new(f32::NAN), None);
    }
}
