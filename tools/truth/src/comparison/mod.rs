//! Comparing a texture with its SVG at some zooms.

mod page;
mod windows;

use serde_json::{Value, json};

use crate::TruthError;
use crate::picture::{Difference, Picture, Shot, View, difference, fit_size};
use crate::reference::{Reference, SUPERSAMPLES};

pub use page::{Column, Page, PageFile, Sizes, human_bytes};
pub use windows::{EdgeFinder, WINDOWS};

/// What to measure.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// Pixels of the pictures' longer side.
    pub longer_px: u32,
    /// Samples per pixel.
    pub spp: u32,
    /// As in [`Shot`].
    pub region_uv: [f64; 2],
    /// Number of windows to compare at each zoom above 1.
    pub windows: u32,
    /// Whether lookups return alpha only; then alpha is compared.
    pub mask: bool,
}

/// The measurement in one window.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// The part of the canvas.
    pub view: View,
    /// The figures.
    pub difference: Difference,
    /// Centre of the worst pixel, uv.
    pub worst_uv: [f64; 2],
}

/// The measurements at one zoom.
#[derive(Clone, Debug)]
pub struct ZoomReport {
    /// Magnification; 1 shows the whole canvas.
    pub zoom: f64,
    /// One or more.
    pub windows: Vec<Window>,
}

impl ZoomReport {
    /// The window with the lowest PSNR.
    ///
    /// # Panics
    /// When there is no window.
    pub fn worst(&self) -> &Window {
        self.windows
            .iter()
            .min_by(|a, b| a.difference.psnr_db.total_cmp(&b.difference.psnr_db))
            .expect("a report has a window")
    }

    /// As JSON: the worst window's figures, then all windows.
    pub fn to_json(&self) -> Value {
        let worst = self.worst();
        let windows = self.windows.iter().map(|window| {
            json!({
                "view": window.view.as_array(), "psnr_db": window.difference.psnr_db,
                "wrong_share": window.difference.wrong_share,
                "max_difference": window.difference.max_difference,
                "worst_uv": window.worst_uv,
            })
        });
        json!({
            "zoom": self.zoom, "psnr_db": worst.difference.psnr_db,
            "wrong_share": worst.difference.wrong_share,
            "max_difference": worst.difference.max_difference,
            "worst_window": worst.view.as_array(), "worst_uv": worst.worst_uv,
            "windows": windows.collect::<Vec<_>>(),
        })
    }
}

/// Measures textures against one SVG.
#[derive(Debug)]
pub struct Comparison<'a> {
    reference: &'a Reference,
    terms: Terms,
    size_px: [u32; 2],
    overview: Picture,
    finder: EdgeFinder<'a>,
}

impl<'a> Comparison<'a> {
    /// Draws the SVG at zoom 1 and looks for its edges.
    ///
    /// # Errors
    /// When the SVG cannot be drawn.
    pub fn new(reference: &'a Reference, terms: Terms) -> Result<Self, TruthError> {
        let size_px = fit_size(reference.canvas_size(), terms.longer_px);
        let overview = reference.render(View::WHOLE, size_px)?;
        let finder = EdgeFinder::new(reference, overview.clone());
        Ok(Self {
            reference,
            terms,
            size_px,
            overview,
            finder,
        })
    }

    /// Pixels of the pictures.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Windows at `zoom`, as [`EdgeFinder::windows`].
    ///
    /// # Errors
    /// When the SVG cannot be drawn.
    pub fn windows(&self, zoom: f64) -> Result<Vec<View>, TruthError> {
        self.finder.windows(zoom, self.terms.windows)
    }

    /// One window at `zoom`. Those of different zooms lie around the same point.
    ///
    /// # Errors
    /// When the SVG cannot be drawn.
    pub fn first_window(&self, zoom: f64) -> Result<View, TruthError> {
        if zoom <= 1.0 {
            Ok(View::WHOLE)
        } else {
            self.finder.window(zoom, 0)
        }
    }

    /// The truth in a window.
    ///
    /// # Errors
    /// When the SVG cannot be drawn.
    pub fn truth(&self, view: View) -> Result<Picture, TruthError> {
        let picture = match view == View::WHOLE {
            true => self.overview.clone(),
            false => self.reference.render(view, self.size_px)?,
        };
        Ok(self.as_compared(picture))
    }

    /// The noise of the truth in a window, dB: its PSNR against the truth with half as many samples
    /// along each side of a pixel. A texture cannot be expected to come nearer than that.
    ///
    /// # Errors
    /// When the SVG cannot be drawn.
    pub fn noise_db(&self, view: View) -> Result<f64, TruthError> {
        let coarse = self
            .reference
            .render_with(view, self.size_px, SUPERSAMPLES / 2)?;
        let truth = self.truth(view)?;
        Ok(difference(&truth, &self.as_compared(coarse)).psnr_db)
    }

    /// The picture to measure in place of `picture`: its alpha for a mask, else itself.
    pub fn as_compared(&self, picture: Picture) -> Picture {
        if self.terms.mask {
            picture.alpha_as_grey()
        } else {
            picture
        }
    }

    /// Measures the pictures that `shoot` takes at `zoom`.
    ///
    /// # Errors
    /// When the SVG cannot be drawn or `shoot` fails.
    pub fn measure(
        &self,
        zoom: f64,
        shoot: impl Fn(Shot) -> Result<Picture, TruthError>,
    ) -> Result<ZoomReport, TruthError> {
        let mut windows = Vec::new();
        for view in self.windows(zoom)? {
            let truth = self.truth(view)?;
            let picture = self.as_compared(shoot(self.shot(view))?);
            windows.push(self.window(view, &truth, &picture));
        }
        Ok(ZoomReport { zoom, windows })
    }

    /// The shot of a window.
    pub fn shot(&self, view: View) -> Shot {
        Shot {
            view,
            size_px: self.size_px,
            spp: self.terms.spp,
            region_uv: self.terms.region_uv,
        }
    }

    fn window(&self, view: View, truth: &Picture, picture: &Picture) -> Window {
        let difference = difference(truth, picture);
        let worst_px = difference.max_at_px.map(|side| f64::from(side) + 0.5);
        let worst_uv = view.uv_from_px(worst_px, self.size_px);
        Window {
            view,
            difference,
            worst_uv,
        }
    }
}
