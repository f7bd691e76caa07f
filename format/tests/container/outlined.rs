//! Cases of the sample whose curve records are made from outlines.

use vtex_format::{StoredOutlines, Tag, VtexFile};

use crate::cases::{FileCase, META, ValueCase, cut, patch};
use crate::forge::Forged;

const OUTL: usize = 10;

/// For files made from the sample with outlines.
pub(crate) const OUTLINED_CASES: &[FileCase] = &[
    (3023, |s| {
        cut(&mut s[META], 8);
        patch(&mut s[META], 90, &[0]);
    }),
    (5021, |s| s[OUTL].refill(&[0; 35])),
    (5021, |s| s[OUTL].refill(&[0; 20])),
    // Fewer words than the records are, more segments than there are kinds.
    (5021, |s| patch(&mut s[OUTL], 0, &[1, 0, 0, 0])),
    (5021, |s| patch(&mut s[OUTL], 4, &[99])),
    (5021, |s| patch(&mut s[OUTL], 8, &[99])),
    (5021, |s| patch(&mut s[OUTL], 12, &[3])),
    // No flatness is a NaN, and no first segment continues an outline.
    (5021, |s| patch(&mut s[OUTL], 16, &[255; 4])),
    (5021, |s| patch(&mut s[OUTL], 36, &[0])),
    (5021, |s| {
        let mut content = s[OUTL].content();
        content.push(0);
        s[OUTL].refill(&content);
    }),
    (5022, |s| patch(&mut s[OUTL], 20, &[0; 16])),
    (5023, |s| s.insert(OUTL, Forged::raw(Tag::CURV, &[0; 12]))),
    (2020, |s| patch(&mut s[OUTL], 0, &[0, 0, 0, 1])),
    (2020, |s| patch(&mut s[OUTL], 4, &[0, 0, 0, 1])),
];

/// For the sample itself.
pub(crate) const OUTLINED_VALUES: &[ValueCase] = &[
    (3023, |f| f.meta.curve_lattice = None),
    (5021, |f| outlines(f).records[0].cell = 4),
    (5021, |f| outlines(f).records[1].outlines.push(2)),
    (5021, |f| outlines(f).outlines[1].segments.clear()),
    (5021, |f| {
        outlines(f).outlines[0].segments[1].control = Some([-1, 0]);
    }),
    (5021, |f| {
        let record = f.outlines.as_ref().unwrap().records[0].clone();
        outlines(f).records.push(record);
    }),
    (5022, |f| f.curves[0] ^= 1 << 31),
    (5022, |f| drop(outlines(f).records.pop())),
    (5022, |f| outlines(f).outlines[0].segments[1].control = None),
];

fn outlines(file: &mut VtexFile) -> &mut StoredOutlines {
    file.outlines.as_mut().unwrap()
}
