//! scratch
use std::sync::Arc;
use vtex::{picture::*, reference::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: u32 = a[1].parse().unwrap();
    let cols = 9.min(a.len() - 3);
    let rows = (a.len() - 3).div_ceil(cols);
    let s = n as usize + 4;
    let mut sheet = Picture {
        size_px: [(cols * s) as u32, (rows * s) as u32],
        pixels: vec![[0.2, 0.2, 0.2, 1.0]; cols * rows * s * s],
    };
    for (i, p) in a[3..].iter().enumerate() {
        let svg = std::fs::read(p).unwrap();
        let r = Reference::parse(&svg, Arc::default(), Edges::Smooth).unwrap();
        let size = fit_size(r.canvas_size(), n);
        let pic = r.render_with(View::WHOLE, size, 2).unwrap();
        for y in 0..size[1] as usize {
            for x in 0..size[0] as usize {
                let [r, g, b, al] = pic.pixels[y * size[0] as usize + x];
                sheet.pixels[(i / cols * s + y) * cols * s + i % cols * s + x] =
                    [r + 1.0 - al, g + 1.0 - al, b + 1.0 - al, 1.0];
            }
        }
    }
    std::fs::write(&a[2], sheet.to_png().unwrap()).unwrap();
}
