//! A TIFF is planned with by its directories alone, wherever they stand, and decoded window by
//! window, as if it had been read whole.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

#[path = "common/tiff.rs"]
mod planted;

use planted::{Form, Place, forms, offset_of, written};
use ridgeline::orientation::{InputFile, PhotographHead, detect};
use ridgeline::raster::{HeaderNeeds, image_header, load_image};

const SIZE: [u32; 2] = [700, 500];

fn image() -> image::RgbImage {
    let [w, h] = SIZE;
    image::RgbImage::from_fn(w, h, |x, y| {
        image::Rgb([
            (x % 251) as u8,
            (y % 241) as u8,
            ((x * 3 + y * 7) % 239) as u8,
        ])
    })
}

/// The head of a file as it is read, and how much of the file that took.
fn head_of(bytes: &[u8]) -> (Option<InputFile>, u64) {
    let mut head = PhotographHead::new("a.tif", bytes.len() as u64);
    let mut read = 0;
    while let HeaderNeeds::Range(range) = head.needs() {
        read += range.end - range.start;
        let part = &bytes[range.start as usize..range.end as usize];
        assert!(head.add(range, part));
    }
    (InputFile::photograph(head), read)
}

#[test]
fn the_head_says_what_the_whole_says() {
    for form in forms() {
        let bytes = written(&image(), form);
        let (head, read) = head_of(&bytes);
        let mut head = head.unwrap_or_else(|| panic!("{form:?}"));
        // The first block and what holds the directory, of a megabyte.
        assert!(read <= (64 + 2 * 16) << 10, "{form:?}: {read}");
        assert_eq!(head.head_length(), read);
        let whole = InputFile::new("a.tif", bytes.clone());
        assert_eq!(detect(&head), detect(&whole));
        let header = |file: &InputFile| image_header("a.tif", file.content()).unwrap();
        assert_eq!(header(&head), header(&whole));
        // Pixels that were not read are refused, not made up.
        let refused = load_image("a.tif", head.content()).unwrap_err().to_string();
        assert!(refused.contains("was not read"), "{refused}");
        let kept = head.clone();
        assert!(head.fill(bytes));
        assert_eq!(load_image("a.tif", head.content()).unwrap().rgb, image());
        assert_eq!(head.head(), kept.head());
        head.empty();
        assert_eq!(head, kept);
    }
}

#[test]
fn a_head_of_another_file_is_not_filled() {
    let form = Form {
        is_big: false,
        place: Place::End,
        tile: None,
    };
    let bytes = written(&image(), form);
    let (head, _) = head_of(&bytes);
    let mut head = head.unwrap();
    // A byte of the directory, which the first bytes do not hold.
    let mut changed = bytes.clone();
    let end = changed.len() - 1;
    changed[end] ^= 1;
    assert!(!head.fill(changed));
    assert!(!head.fill(bytes[1..].to_vec()));
    assert!(head.fill(bytes));
}

#[test]
fn damaged_files_have_the_same_message_as_before() {
    for form in forms() {
        let sound = written(&image(), form);
        let mut beyond = sound.clone();
        let place = offset_of(&sound);
        beyond[place.clone()].fill(0xfe);
        let mut at_the_end = sound.clone();
        let last = (sound.len() as u64 - 1).to_le_bytes();
        at_the_end[place.clone()].copy_from_slice(&last[..place.len()]);
        let mut nowhere = sound.clone();
        nowhere[place].fill(0);
        let cut = sound[..sound.len() * 3 / 4].to_vec();
        for bytes in [beyond, at_the_end, nowhere, cut] {
            let message = image_header("a.tif", &bytes).map_err(|e| e.to_string());
            let (head, read) = head_of(&bytes);
            assert!(read < bytes.len() as u64 / 2, "{form:?}: {read}");
            match (head, message) {
                (None, Err(message)) => {
                    assert!(
                        message.starts_with("a.tif: the image cannot be read"),
                        "{message}"
                    );
                }
                // What is cut off is a strip or a tile.
                (Some(head), Ok(header)) => {
                    assert_ne!(form.place, Place::End);
                    assert_eq!(image_header("a.tif", head.content()).unwrap(), header);
                    let refused = load_image("a.tif", &bytes).unwrap_err().to_string();
                    assert!(refused.contains("damaged or cut off"), "{refused}");
                }
                (head, message) => panic!("{form:?}: {head:?} {message:?}"),
            }
        }
    }
}
