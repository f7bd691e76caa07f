//! What sections hold, one record or struct a file: sizes, bits and meanings, nothing that depends
//! on another section.

pub(crate) mod curve;
pub(crate) mod gradient;
pub(crate) mod image;
pub(crate) mod layer;
pub(crate) mod meta;
pub(crate) mod paint;
pub(crate) mod prov;
pub(crate) mod shader;
pub(crate) mod shape;

const _: () = {
    assert!(
        size_of::<paint::PaintRecord>() == 32,
        "docs/format.md, PANT"
    );
    assert!(
        size_of::<shape::ShapeRecord>() == 40,
        "docs/format.md, SHAP"
    );
    assert!(
        size_of::<layer::LayerRecord>() == 16,
        "docs/format.md, LAYR"
    );
    assert!(
        size_of::<image::ImageRecord>() == 32,
        "docs/format.md, IMAG"
    );
};
