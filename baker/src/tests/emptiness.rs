//! Whatever comes to nothing: scopes around content and content of scopes, in all combinations.

use std::fmt::Write as _;

use rayon::prelude::*;

use crate::{BakeConfig, Mode, Resources, bake};

/// What a group, a clip or a mask may hold; many come to nothing.
const CONTENTS: &[&str] = &[
    "<rect x='10' y='10' width='60' height='60' fill='#c33'/>",
    "<rect width='0' height='40'/>",
    "<rect x='500' y='500' width='40' height='40'/>",
    "<path d=''/>",
    "<path d='M10 10H90' stroke='#36c'/>",
    "<circle cx='50' cy='50' r='30' fill='none'/>",
    "<circle cx='50' cy='50' r='30' fill-opacity='.4' display='none'/>",
    "<rect width='90' height='90' filter='url(#empty)'/>",
    "<rect width='90' height='90' filter='url(#missing)'/>",
    "<image width='90' height='90' href='nothing.png'/>",
    "<use href='#missing'/>",
    "<rect width='90' height='90' fill='url(#stopless)'/>",
    "<rect width='90' height='90' fill='url(#hollow)'/>",
    "<text x='10' y='50' font-family='no such font'>a</text>",
    "<g clip-path='url(#never)'><rect width='90' height='90'/></g>",
    "<g mask='url(#dark)'><rect width='90' height='90'/></g>",
    "",
];

/// What a group may be besides.
const SCOPES: &[&str] = &[
    "clip-path='url(#scope)'",
    "mask='url(#scope)'",
    "clip-path='url(#scope)' opacity='.5'",
    "mask='url(#scope)' style='mix-blend-mode:multiply'",
    "clip-path='url(#twice)'",
    "mask='url(#masked)'",
    "filter='url(#empty)' clip-path='url(#scope)'",
];

const DEFINITIONS: &str = "<filter id='empty'><feFlood flood-opacity='0'/></filter>\
    <linearGradient id='stopless'/><pattern id='hollow' width='9' height='9'/>\
    <clipPath id='never'><path d=''/></clipPath><mask id='dark'><path d='' fill='#fff'/></mask>\
    <clipPath id='twice' clip-path='url(#scope)'><circle cx='50' cy='50' r='40'/></clipPath>\
    <mask id='masked' mask='url(#scope)'><circle cx='50' cy='50' r='40' fill='#fff'/></mask>";

/// The drawing in which `scope` with `inside` surrounds `content`, with or without a neighbour.
fn drawing(scope: &str, inside: &str, content: &str, neighbour: bool) -> String {
    let element = if scope.contains("mask=") {
        "mask"
    } else {
        "clipPath"
    };
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{DEFINITIONS}\
         <{element} id='scope'>{inside}</{element}><g {scope}>{content}</g>"
    );
    if neighbour {
        let _ = write!(svg, "{}", CONTENTS[0]);
    }
    svg + "</svg>"
}

#[test]
fn nothing_is_no_reason_to_panic() {
    let config = |mode| BakeConfig {
        mode,
        mip0_size: 8,
        msdf_size: 16,
        max_zoom: 1.0,
        error_px: 1.0,
        ..BakeConfig::default()
    };
    let mut all = Vec::new();
    for scope in SCOPES {
        for inside in CONTENTS {
            for content in CONTENTS {
                all.extend(
                    [false, true].map(|neighbour| drawing(scope, inside, content, neighbour)),
                );
            }
        }
    }
    let broken: Vec<String> = all
        .par_iter()
        .enumerate()
        .filter_map(|(index, svg)| {
            let mode = [Mode::Auto, Mode::Curves, Mode::Msdf][index % 3];
            let made = std::panic::catch_unwind(|| {
                let file = bake(svg.as_bytes(), &config(mode), &Resources::default())
                    .map_err(|error| error.to_string())?;
                file.to_bytes().map(drop).map_err(|error| error.to_string())
            });
            match made {
                Ok(Ok(())) => None,
                Ok(Err(error)) => Some(format!("{error}: {svg}")),
                Err(_) => Some(format!("panic: {svg}")),
            }
        })
        .collect();
    let count = broken.len();
    assert!(
        broken.is_empty(),
        "{count} of {}, first: {}",
        all.len(),
        broken[0]
    );
}
