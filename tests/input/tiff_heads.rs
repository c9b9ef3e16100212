//! A TIFF is planned with by its directories alone, wherever they stand, and decoded window by
//! window, as if it had been read whole.

use crate::planted_tiff::{Form, Place, forms, offset_of, written};
use ridgeline::orienting::orientation::{FileSource, InputFile, Needed, PhotographHead, detect};
use ridgeline::orienting::scene_loader::{
    LoadOptions, PlannedScene, files_of_ground, files_of_views, load_scene,
};
use ridgeline::orienting::synthetic::{gable_scene, to_files};
use ridgeline::photographs::raster::{HeaderNeeds, image_header, load_image};

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

/// The head of a file in memory.
fn head_of_file(file: &InputFile) -> Option<InputFile> {
    read_head(&file.path, &file.bytes).0
}

/// The head of a file as it is read, and how much of the file that took.
fn head_of(bytes: &[u8]) -> (Option<InputFile>, u64) {
    read_head("a.tif", bytes)
}

fn read_head(path: &str, bytes: &[u8]) -> (Option<InputFile>, u64) {
    let mut head = PhotographHead::new(path, bytes.len() as u64);
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

/// Files of which photographs are read as far as they are needed.
struct Sparing {
    whole: Vec<InputFile>,
    files: Vec<InputFile>,
    /// Bytes that were in memory at once, at most.
    most: usize,
}

impl FileSource for Sparing {
    fn files(&self) -> &[InputFile] {
        &self.files
    }

    fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> ridgeline::Result<()> {
        let needed = needed(&self.files);
        self.files.iter_mut().for_each(InputFile::empty);
        fill(&mut self.files, &self.whole, &needed);
        assert!(needed.iter().all(|one| one.is_in(&self.files)));
        let held = self.files.iter().map(|file| file.bytes.len()).sum();
        self.most = self.most.max(held);
        Ok(())
    }
}

/// Gives files what is needed of them.
fn fill(files: &mut [InputFile], whole: &[InputFile], needed: &[Needed]) {
    for Needed { file, ranges } in needed {
        let (whole, file) = (&whole[*file].bytes, &mut files[*file]);
        match ranges {
            None => assert!(file.fill(whole.clone())),
            Some(ranges) => {
                let part = |r: &std::ops::Range<u64>| &whole[r.start as usize..r.end as usize];
                let parts: Vec<&[u8]> = ranges.iter().map(part).collect();
                assert!(file.fill_ranges(ranges, &parts.concat()));
            }
        }
    }
}

/// A rendered house with TIFFs of all forms as photographs, and the height of the ground.
fn house() -> (Vec<InputFile>, ridgeline::Scene, f64) {
    let (scene, truth) = gable_scene(1000);
    let mut forms = forms().into_iter().rev().cycle();
    let files = (to_files(&scene).into_iter())
        .map(|(path, bytes)| match image::load_from_memory(&bytes) {
            Ok(image) => {
                let bytes = written(&image.into_rgb8(), forms.next().unwrap());
                InputFile::new(&path.replace(".png", ".tif"), bytes)
            }
            Err(_) => {
                let text = String::from_utf8(bytes).unwrap();
                InputFile::new(&path, text.replace(".png", ".tif").into_bytes())
            }
        })
        .collect();
    let ground_z = scene.origin.z + truth.ground_z;
    (files, scene, ground_z)
}

/// The page fills files step by step, and plans anew in each step.
#[test]
fn photographs_of_the_ground_stay_whole_while_windows_of_views_are_filled() {
    let (whole, scene, _) = house();
    let [x, y, _] = scene.origin.into();
    let options = LoadOptions {
        orientation: Some("colmap".to_owned()),
        roi: Some([x - 8.0, y - 8.0, x + 8.0, y + 8.0]),
        max_views: Some(3),
        ..LoadOptions::default()
    };
    let head = |file: &InputFile| head_of_file(file).unwrap_or(file.clone());
    let mut files: Vec<InputFile> = whole.iter().map(head).collect();
    let mut in_both = 0;
    let ground = files_of_ground(&files, &options);
    assert_eq!(ground.len(), 4);
    fill(&mut files, &whole, &ground);
    let views = files_of_views(&files, &options);
    for one in views {
        in_both += usize::from(ground.iter().any(|g| g.file == one.file));
        if !one.is_in(&files) {
            fill(&mut files, &whole, &[one]);
        }
    }
    assert!(in_both > 0, "no view is one of the ground's");
    let loaded = load_scene(&files, &options).unwrap();
    let expected = load_scene(&whole, &options).unwrap();
    assert_eq!(loaded.warnings, expected.warnings);
    assert_eq!(loaded.views.len(), 3);
    for (a, b) in loaded.views.iter().zip(&expected.views) {
        assert_eq!((&a.name, &a.camera), (&b.name, &b.camera));
        assert!(a.rgb == b.rgb, "{}", a.name);
    }
}

#[test]
fn a_region_is_decoded_from_the_strips_and_tiles_that_show_it() {
    let (whole, scene, ground_z) = house();
    let head = |file: &InputFile| head_of_file(file).unwrap_or(file.clone());
    let [x, y, _] = scene.origin.into();
    let options = LoadOptions {
        orientation: Some("colmap".to_owned()),
        roi: Some([x - 1.0, y - 1.0, x + 1.0, y + 1.0]),
        ground_z: Some(ground_z),
        ignore_check: true,
        ..LoadOptions::default()
    };
    let mut sparing = Sparing {
        files: whole.iter().map(head).collect(),
        whole: whole.clone(),
        most: 0,
    };
    let loaded = PlannedScene::new(&mut sparing, &options).unwrap();
    let loaded = loaded.load(sparing.files()).unwrap();
    let expected = load_scene(&whole, &options).unwrap();
    assert_eq!(loaded.warnings, expected.warnings);
    assert!(loaded.views.len() >= 3);
    for (a, b) in loaded.views.iter().zip(&expected.views) {
        assert_eq!((&a.name, &a.camera), (&b.name, &b.camera));
        assert!(a.rgb == b.rgb && a.gray == b.gray, "{}", a.name);
    }
    let all: usize = whole.iter().map(|file| file.bytes.len()).sum();
    assert!(sparing.most < all / 2, "{} of {all}", sparing.most);
}
