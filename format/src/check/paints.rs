//! Paints and the numbers of gradients.

use crate::container::issue::{self, IssueKind, Issues};
use crate::container::tag::Tag;
use crate::file::texture::VtexFile;
use crate::records::gradient::Gradient;
use crate::records::paint::{PAINT_SOLID, PaintRecord};

/// Every paint is a colour in range or a gradient whose numbers are sound. The numbers of gradients
/// follow each other and nothing lies behind them, so that no number is walked for two paints.
pub(super) fn paints(file: &VtexFile, issues: &mut Issues) {
    let mut next = 0_u64;
    for (index, paint) in file.paints.iter().enumerate() {
        let offset = (index * size_of::<PaintRecord>()) as u64;
        let mut note = |kind, field, message: std::fmt::Arguments<'_>| {
            let message = format_args!("paint {index}: {message}");
            issues.add(kind, Tag::PANT, offset + field, message);
        };
        if paint.is_gradient() {
            gradient(file, paint, next, &mut note);
            // Also for a gradient that is wrong, so that those behind it are judged by themselves.
            next += u64::from(paint.data_count);
        } else if paint.kind == PAINT_SOLID {
            solid(paint, &mut note);
        } else {
            note(issue::PAINT_KIND, 0, format_args!("kind {}", paint.kind));
        }
    }
    if next != file.gradients.len() as u64 {
        let message = format_args!("{} numbers, paints have {next}", file.gradients.len());
        issues.add(issue::GRADIENT_PART, Tag::GRAD, 0, message);
    }
}

type Note<'a> = dyn FnMut(IssueKind, u64, std::fmt::Arguments<'_>) + 'a;

fn solid(paint: &PaintRecord, note: &mut Note<'_>) {
    if (paint.flags, paint.data_first, paint.data_count) != (0, 0, 0) {
        note(issue::PAINT_RESERVED, 4, format_args!("a solid one"));
    }
    if !is_color(&paint.color) {
        note(issue::PAINT_COLOR, 16, format_args!("{:?}", paint.color));
    }
}

fn gradient(file: &VtexFile, paint: &PaintRecord, begins: u64, note: &mut Note<'_>) {
    let flags = paint.flags;
    // By bits, since -0.0 compares equal to 0.
    if !Gradient::flags_have_meaning(flags) || paint.color.map(f32::to_bits) != [0; 4] {
        note(issue::PAINT_RESERVED, 4, format_args!("flags {flags:#x}"));
        return;
    }
    let here = u64::from(paint.data_first) == begins;
    let gradient = Gradient::of(paint, &file.gradients).filter(|_| here);
    let Some(gradient) = gradient else {
        let (first, count) = (paint.data_first, paint.data_count);
        let message = format_args!("{count} numbers at {first}, not at {begins}");
        note(issue::GRADIENT_PART, 8, message);
        return;
    };
    if !gradient.shape.is_sound() {
        let message = format_args!("{:?}", gradient.shape);
        note(issue::GRADIENT_NUMBER, 8, message);
    }
    let offsets = || gradient.stops.iter().map(|stop| stop.offset);
    // NaN is neither in order nor in range.
    if !offsets().is_sorted() || !offsets().all(|offset| (0.0..=1.0).contains(&offset)) {
        note(issue::GRADIENT_STOPS, 8, format_args!("its stops"));
    }
    if let Some(stop) = gradient.stops.iter().find(|stop| !is_color(&stop.color)) {
        note(issue::PAINT_COLOR, 8, format_args!("{:?}", stop.color));
    }
    if paint.is_opaque() != gradient.is_opaque() {
        note(issue::PAINT_OPAQUE, 4, format_args!("flags {flags:#x}"));
    }
}

fn is_color(color: &[f32; 4]) -> bool {
    color.iter().all(|channel| (0.0..=1.0).contains(channel))
}
