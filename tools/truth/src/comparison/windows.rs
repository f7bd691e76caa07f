//! Which windows a comparison looks at when it zooms in: those at edges. Elsewhere a drawing is a
//! uniform colour, and every texture is right.

use crate::TruthError;
use crate::picture::{Picture, View, hash};
use crate::reference::Reference;

/// Default number of windows to compare at each zoom above 1.
pub const WINDOWS: u32 = 4;
/// Neighbouring pixels that differ by more than this, of 255, count as an edge.
const EDGE_STEPS: f32 = 24.0;
/// Pixels along each side of the close-ups in which an edge is located more precisely.
const CLOSE_UP_PX: u32 = 32;

/// Finds windows with an edge in them: the same ones on every run.
#[derive(Debug)]
pub struct EdgeFinder<'a> {
    reference: &'a Reference,
    overview: Picture,
    edges: Vec<[u32; 2]>,
}

impl<'a> EdgeFinder<'a> {
    /// Looks for edges in `overview`, which shows the whole canvas.
    pub fn new(reference: &'a Reference, overview: Picture) -> Self {
        let edges = edge_pixels(&overview);
        Self {
            reference,
            overview,
            edges,
        }
    }

    /// The `count` windows to compare at `zoom`, each `1 / zoom` of the canvas along both sides. At
    /// zoom 1 the only window is the whole canvas.
    ///
    /// # Errors
    /// When the reference cannot be drawn.
    pub fn windows(&self, zoom: f64, count: u32) -> Result<Vec<View>, TruthError> {
        if zoom <= 1.0 {
            return Ok(vec![View::WHOLE]);
        }
        (0..u64::from(count))
            .map(|seed| self.window(zoom, seed))
            .collect()
    }

    /// One window around an edge that `seed` chooses at random. The choice does not depend on the
    /// zoom, so windows of one seed lie around the same point.
    ///
    /// # Errors
    /// When the reference cannot be drawn.
    pub fn window(&self, zoom: f64, seed: u64) -> Result<View, TruthError> {
        Ok(View::window(self.edge_uv(zoom, seed)?, zoom))
    }

    fn edge_uv(&self, zoom: f64, seed: u64) -> Result<[f64; 2], TruthError> {
        let size_px = self.overview.size_px;
        let count = self.edges.len() as u64;
        let Some(&[x, y]) = usize::try_from(hash(seed) % count.max(1))
            .ok()
            .and_then(|lot| self.edges.get(lot))
        else {
            return Ok([0.5; 2]);
        };
        let mut center = View::WHOLE.uv_from_px([f64::from(x) + 0.5, f64::from(y) + 0.5], size_px);
        // The edge lies within three pixels of the overview. A window at a large zoom is smaller
        // than that, so the edge is located in close-ups, each three pixels of the one before, until
        // the window is certain to hold it.
        let mut extent = size_px.map(|side| 3.0 / f64::from(side));
        while extent[0].max(extent[1]) > 0.5 / zoom {
            let view = View {
                u0: center[0] - extent[0] / 2.0,
                v0: center[1] - extent[1] / 2.0,
                u1: center[0] + extent[0] / 2.0,
                v1: center[1] + extent[1] / 2.0,
            };
            let close_up = self.reference.render_with(view, [CLOSE_UP_PX; 2], 2)?;
            let Some([x, y]) = nearest_to_centre(&edge_pixels(&close_up)) else {
                break;
            };
            center = view.uv_from_px([f64::from(x) + 0.5, f64::from(y) + 0.5], [CLOSE_UP_PX; 2]);
            extent = extent.map(|side| side * 3.0 / f64::from(CLOSE_UP_PX));
        }
        Ok(center)
    }
}

fn nearest_to_centre(pixels: &[[u32; 2]]) -> Option<[u32; 2]> {
    let distance = |&[x, y]: &[u32; 2]| {
        let [x, y] = [x, y].map(|c| (2 * c).abs_diff(CLOSE_UP_PX - 1));
        x * x + y * y
    };
    pixels.iter().copied().min_by_key(distance)
}

/// Pixels that differ from the one to the right or the one below.
fn edge_pixels(picture: &Picture) -> Vec<[u32; 2]> {
    let [width, height] = picture.size_px;
    let rgb = picture.over(1.0);
    let at = |x: u32, y: u32| rgb[y as usize * width as usize + x as usize];
    let differs = |a: [f32; 3], b: [f32; 3]| {
        a.iter()
            .zip(b)
            .any(|(a, b)| (a - b).abs() * 255.0 > EDGE_STEPS)
    };
    let mut edges = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let right = x + 1 < width && differs(at(x, y), at(x + 1, y));
            let below = y + 1 < height && differs(at(x, y), at(x, y + 1));
            if right || below {
                edges.push([x, y]);
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::reference::Edges;

    #[test]
    fn every_window_shows_an_edge_and_lies_on_the_canvas() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 60'>\
                   <circle cx='47.3' cy='31.9' r='20.1' fill='#205080'/></svg>";
        let reference = Reference::parse(svg.as_bytes(), Arc::default(), Edges::Crisp).unwrap();
        let overview = reference.render(View::WHOLE, [100, 60]).unwrap();
        let finder = EdgeFinder::new(&reference, overview);
        for zoom in [8.0, 256.0, 4096.0] {
            for view in finder.windows(zoom, WINDOWS).unwrap() {
                assert!(view.u0 >= 0.0 && view.v1 <= 1.0, "{view:?}");
                let picture = reference.render_with(view, [16, 16], 2).unwrap();
                assert!(!edge_pixels(&picture).is_empty(), "zoom {zoom}: {view:?}");
            }
        }
    }
}
