//! Accidents: truncation, flipped bits, rubbish.

use vtex_format::{BundleInfo, Codec, Limits, VtexFile, directory, validate};

use crate::forge::{put_together, table_bytes, take_apart};
use crate::grouped::grouped;
use crate::sample;

/// The sample with text long enough that some sections are packed.
fn bytes_with_both_codecs() -> Vec<u8> {
    let mut file = sample::small();
    file.shader.wgsl_fragment = "let zero = 0.0;\n".repeat(20);
    file.to_bytes().unwrap()
}

#[test]
fn every_truncation_is_refused() {
    let bytes = bytes_with_both_codecs();
    for length in 0..bytes.len() {
        let part = &bytes[..length];
        let error = VtexFile::parse(part, &Limits::default()).unwrap_err();
        assert_eq!(
            Some(error.issue()),
            validate(part, &Limits::default()).first()
        );
        let code = if length < 40 { 1001 } else { 1004 };
        assert_eq!(error.issue().code, code, "{length} bytes");
    }
}

#[test]
fn bytes_behind_the_end_are_refused() {
    let mut bytes = bytes_with_both_codecs();
    bytes.push(0);
    let error = VtexFile::parse(&bytes, &Limits::default()).unwrap_err();
    assert_eq!(error.issue().code, 1004);
}

#[test]
fn every_flipped_bit_is_found_or_harmless() {
    for bytes in [
        bytes_with_both_codecs(),
        sample::outlined().to_bytes().unwrap(),
        grouped().to_bytes().unwrap(),
    ] {
        flip_every_bit(&bytes);
    }
}

fn flip_every_bit(bytes: &[u8]) {
    let limits = Limits::default();
    let file = VtexFile::parse(bytes, &limits).unwrap();
    let bundles = directory(bytes, &limits).unwrap().bundles;
    let is_packed = |byte: usize| {
        let holds = |bundle: &&BundleInfo| {
            let start = bundle.offset_bytes as usize;
            (start..start + bundle.stored_bytes as usize).contains(&byte)
        };
        let bundle = bundles.iter().find(holds);
        bundle.is_some_and(|bundle| bundle.codec == Codec::Zstd)
    };
    let mut damaged = bytes.to_vec();
    for bit in 0..8 * bytes.len() {
        damaged[bit / 8] ^= 1 << (bit % 8);
        let issues = validate(&damaged, &limits);
        match VtexFile::parse(&damaged, &limits) {
            // A repetitive text has many zstd frames; everything else is protected.
            Ok(read) => {
                assert!(is_packed(bit / 8), "bit {bit} is not protected");
                assert_eq!(read, file, "bit {bit} changed the value unnoticed");
                assert_eq!(issues, [], "bit {bit}");
            }
            Err(error) => assert_eq!(Some(error.issue()), issues.first(), "bit {bit}"),
        }
        damaged[bit / 8] = bytes[bit / 8];
    }
}

#[test]
fn every_flipped_bit_of_header_and_table_is_found() {
    let bytes = bytes_with_both_codecs();
    let limits = Limits::default();
    let mut damaged = bytes.clone();
    for bit in 0..8 * (40 + table_bytes(&bytes)) {
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(
            directory(&damaged, &limits).is_err(),
            "bit {bit} is not protected"
        );
        damaged[bit / 8] = bytes[bit / 8];
    }
}

#[test]
fn flipped_bits_under_right_hashes_do_no_harm() {
    // Hashes stop accidents, not intent: here the content changes and the hashes with it, so that
    // every check behind them is met. What still reads must be sound: it can be written again.
    for file in [sample::small(), sample::outlined(), grouped()] {
        flip_under_right_hashes(&file);
    }
}

fn flip_under_right_hashes(file: &VtexFile) {
    let sections = take_apart(&file.to_bytes().unwrap());
    let limits = Limits {
        total_raw_bytes: 1 << 20,
        ..Limits::default()
    };
    let mut accepted = 0;
    for place in 0..sections.len() {
        let content = sections[place].content();
        for bit in 0..8 * content.len() {
            let mut changed = content.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            let mut forged = sections.clone();
            forged[place].refill(&changed);
            if let Ok(file) = VtexFile::parse(&put_together(&forged), &limits) {
                assert_eq!(file.check(), [], "section {place} bit {bit}");
                accepted += 1;
            }
        }
    }
    assert!(accepted > 0, "texels, colours and text may change");
}

#[test]
fn rubbish_is_refused() {
    arbtest::arbtest(|u| {
        let rubbish: Vec<u8> = u.arbitrary()?;
        assert!(VtexFile::parse(&rubbish, &Limits::default()).is_err());
        Ok(())
    })
    .budget_ms(300);
}

#[test]
fn rubbish_sections_under_right_hashes_do_no_harm() {
    for file in [sample::small(), sample::outlined(), grouped()] {
        forge_rubbish(&file);
    }
}

fn forge_rubbish(file: &VtexFile) {
    let sections = take_apart(&file.to_bytes().unwrap());
    let limits = Limits {
        total_raw_bytes: 1 << 20,
        ..Limits::default()
    };
    arbtest::arbtest(|u| {
        let mut forged = sections.clone();
        for _ in 0..u.int_in_range(1..=3)? {
            let place = u.choose_index(forged.len())?;
            let mut content = forged[place].content();
            if u.ratio(1, 3)? {
                content = u.arbitrary()?;
            } else if !content.is_empty() {
                let at = u.choose_index(content.len())?;
                content[at] = u.arbitrary()?;
            }
            forged[place].refill(&content);
            if u.ratio(1, 8)? {
                forged[place].raw_bytes = u.arbitrary()?;
            }
        }
        if let Ok(file) = VtexFile::parse(&put_together(&forged), &limits) {
            assert_eq!(file.check(), [], "what reads is sound");
        }
        Ok(())
    })
    .budget_ms(1_000);
}

#[test]
fn a_text_mode_transfer_is_named() {
    let bytes = bytes_with_both_codecs();
    let mut text = bytes.clone();
    text.remove(4); // CR LF became LF
    let error = VtexFile::parse(&text, &Limits::default()).unwrap_err();
    assert_eq!(error.issue().code, 1002);
    assert!(error.to_string().contains("text-mode"), "{error}");
}
