//! Folders as people have them: cameras in subfolders, masks, copies, names from other machines.
//!
//! All are the gable house of `ridgeline::orienting::synthetic` at 48 x 48 pixels under other
//! names; whatever lies beside it, each photograph must get its own camera.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat};
use nalgebra::Point3;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};
use ridgeline::orienting::synthetic::{gable_scene, to_files, to_projection};

/// The house's files under other paths and, in the orientation, other names.
fn renamed(path: impl Fn(&str) -> String, stated: impl Fn(&str) -> String) -> Vec<InputFile> {
    let (scene, _) = gable_scene(48);
    let mut files: Vec<InputFile> = to_files(&scene)
        .into_iter()
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    for view in &scene.views {
        let image = format!("images/{}", view.name);
        find(&mut files, &image).path = path(&view.name);
        let list = find(&mut files, "colmap/images.txt");
        let text = String::from_utf8(list.bytes.clone()).unwrap();
        let line = format!(" {}\n", view.name);
        assert!(text.contains(&line));
        list.bytes = (text.replace(&line, &format!(" {}\n", stated(&view.name)))).into_bytes();
    }
    files
}

fn find<'a>(files: &'a mut [InputFile], path: &str) -> &'a mut InputFile {
    files.iter_mut().find(|f| f.path == path).unwrap()
}

/// The same names everywhere.
fn plain() -> Vec<InputFile> {
    renamed(|name| format!("images/{name}"), str::to_owned)
}

fn load(files: &[InputFile]) -> Scene {
    let scene = load_scene(files, &LoadOptions::default()).unwrap();
    let inspected = inspect_files(files, &LoadOptions::default());
    assert_eq!(
        inspected.warnings, scene.warnings,
        "page and run say the same"
    );
    assert_eq!(inspected.views, scene.views.len());
    scene
}

/// Each view must have the pixels and the camera of one view of the house, which is returned.
fn views_of_the_house(scene: &Scene) -> Vec<usize> {
    let (house, _) = gable_scene(48);
    let original = |view: &ridgeline::orienting::scene::View| {
        let same = |other: &ridgeline::orienting::scene::View| other.rgb == view.rgb;
        let index = house
            .views
            .iter()
            .position(same)
            .expect("a photograph of the house");
        let camera = &house.views[index].camera;
        assert!(
            (view.camera.center - camera.center).norm() < 1e-4,
            "{}",
            view.name
        );
        assert!((view.camera.k - camera.k).norm() < 1e-2, "{}", view.name);
        index
    };
    scene.views.iter().map(original).collect()
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// "s2_03.png" as "cam2/03.png".
fn rig(name: &str) -> String {
    format!("cam{}/{}", &name[1..2], &name[3..])
}

#[test]
fn the_same_names_in_the_folders_of_several_cameras() {
    for prefix in [
        "",
        "D:\\flight 3\\",
        "/mnt/other/machine/",
        "file:///C:/Users/x/",
    ] {
        let files = renamed(
            |name| format!("data/images/{}", rig(name)),
            |name| format!("{prefix}{}", rig(name)),
        );
        let scene = load(&files);
        assert_eq!(views_of_the_house(&scene).len(), 6);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        let mut names: Vec<&str> = scene.views.iter().map(|v| &*v.name).collect();
        names.sort_unstable();
        let expected = [
            "cam1/01", "cam1/02", "cam1/03", "cam2/01", "cam2/02", "cam2/03",
        ];
        assert_eq!(names, expected.map(|n| format!("{n}.png")));
    }
    let files = renamed(|name| format!("images/{}", rig(name)), rig);
    // Views are chosen by the names that they go by.
    let wanted = ["cam2/01.png", "cam2/02", "cam1/03.png"];
    let options = LoadOptions {
        views: Some(wanted.map(str::to_owned).to_vec()),
        ..LoadOptions::default()
    };
    let scene = load_scene(&files, &options).unwrap();
    let mut chosen = views_of_the_house(&scene);
    chosen.sort_unstable();
    assert_eq!(chosen, [2, 3, 4]);
    // Where the orientation states no folder, nothing tells the two cameras apart.
    let files = renamed(
        |name| format!("images/{}", rig(name)),
        |name| name[3..].to_owned(),
    );
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    let words = "images/cam1/01.png and images/cam2/01.png have the same name";
    assert!(message.contains(words), "{message}");
}

#[test]
fn accents_are_the_same_composed_and_decomposed() {
    let composed = |name: &str| format!("S\u{fc}d \u{e9} {name}");
    let decomposed = |name: &str| format!("Su\u{308}d e\u{301} {name}");
    for files in [
        renamed(|name| format!("images/{}", composed(name)), decomposed),
        renamed(|name| format!("images/{}", decomposed(name)), composed),
        renamed(decomposed, |name| {
            format!("file:///D:/S%C3%BCd%20%C3%A9%20{name}")
        }),
    ] {
        assert_eq!(views_of_the_house(&load(&files)), [0, 1, 2, 3, 4, 5]);
    }
}

#[test]
fn masks_thumbnails_orthophotos_and_textures_are_no_views() {
    let mut files = plain();
    let expected = load(&files);
    let mask = DynamicImage::new_luma8(48, 48);
    for (path, _) in to_files(&gable_scene(48).0)
        .iter()
        .filter(|(p, _)| p.ends_with("png"))
    {
        let (name, image) = (
            path.strip_prefix("images/").unwrap(),
            find(&mut files, path),
        );
        let image = image::load_from_memory(&image.bytes).unwrap();
        let stem = name.strip_suffix(".png").unwrap();
        for (path, bytes) in [
            (
                format!("masks/{name}.png"),
                encoded(&mask, ImageFormat::Png),
            ),
            (
                format!("masks/{stem}_mask.png"),
                encoded(&mask, ImageFormat::Png),
            ),
            (
                format!("thumbs/{name}"),
                encoded(&image.thumbnail(12, 12), ImageFormat::Png),
            ),
            (
                format!("undistorted/{name}"),
                encoded(&image.crop_imm(0, 0, 47, 40), ImageFormat::Png),
            ),
        ] {
            files.push(InputFile::new(&path, bytes));
        }
    }
    for path in ["odm_orthophoto/odm_orthophoto.tif", "texture_0.tif"] {
        let bytes = encoded(&DynamicImage::new_rgb8(60, 50), ImageFormat::Tiff);
        files.push(InputFile::new(path, bytes));
    }
    files.push(InputFile::new(
        "__MACOSX/images/._s1_01.png",
        b"Mac OS X".to_vec(),
    ));
    let found = load(&files);
    assert_eq!(views_of_the_house(&found), [0, 1, 2, 3, 4, 5]);
    assert_eq!(found.views.len(), expected.views.len());
    let [without, copies] = &found.warnings[..] else {
        panic!("{:?}", found.warnings);
    };
    assert!(
        without.contains("._s1_01.png") && without.contains("odm_orthophoto.tif"),
        "{without}"
    );
    assert!(
        copies.contains("masks/s1_01.png.png (images/s1_01.png was taken)"),
        "{copies}"
    );
    // A mask whose photograph is not there does not stand in for it.
    files.retain(|f| f.path != "images/s1_02.png");
    assert_eq!(views_of_the_house(&load(&files)), [0, 2, 3, 4, 5]);
}

#[test]
fn an_image_without_orientation_is_left_out_and_too_few_are_refused() {
    let mut files = plain();
    let copy = find(&mut files, "images/s1_01.png").bytes.clone();
    files.push(InputFile::new("images/more.png", copy));
    files.push(InputFile::new("images/notes.jpg", b"<html>".to_vec()));
    let scene = load(&files);
    assert_eq!(views_of_the_house(&scene), [0, 1, 2, 3, 4, 5]);
    assert_eq!(scene.warnings.len(), 1);
    let named = "left out: images/more.png, images/notes.jpg";
    assert!(scene.warnings[0].ends_with(named), "{:?}", scene.warnings);
    // The same file is refused where it is one of the photographs.
    find(&mut files, "images/s2_01.png").bytes = b"<html>".to_vec();
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("images/s2_01.png: "), "{message}");
    // Other names altogether.
    let files = renamed(|name| format!("IMG_{name}"), |name| format!("DSC_{name}"));
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    for words in [
        "0 images have an orientation",
        "IMG_s1_01.png",
        "it names DSC_s1_01.png",
    ] {
        assert!(message.contains(words), "{message}");
    }
}

/// Every second pixel, as a thumbnail of half the size: its camera must see the same places.
#[test]
fn an_image_of_half_the_size_has_a_camera_of_half_the_size() {
    let (house, truth) = gable_scene(48);
    let mut files = plain();
    let image = find(&mut files, "images/s1_03.png");
    let half = image::load_from_memory(&image.bytes).unwrap();
    let half = half.resize_exact(24, 24, image::imageops::FilterType::Triangle);
    image.bytes = encoded(&half, ImageFormat::Png);
    let scene = load(&files);
    let named = "images of half the size that their orientation states, whose cameras were scaled: images/s1_03.png";
    assert_eq!(scene.warnings, [named]);
    let (a, b) = (&scene.views[2].camera, &house.views[2].camera);
    assert_eq!((a.width, a.height), (24, 24));
    let corners = truth.facets.iter().flat_map(|(_, ring)| ring);
    for corner in corners.chain([&Point3::new(0.0, 0.0, 5.0)]) {
        let (p, q) = (a.project(corner).unwrap(), b.project(corner).unwrap());
        assert!((p * 2.0 - q.coords).coords.norm() < 1e-3, "{p} {q}");
    }
    // Twice the size; matrices state no size, so that there is nothing to scale by.
    let image = find(&mut files, "images/s1_03.png");
    image.bytes = encoded(
        &half.resize_exact(96, 96, image::imageops::FilterType::Triangle),
        ImageFormat::Png,
    );
    let scene = load(&files);
    assert!(
        scene.warnings[0].starts_with("images of 2 times the size"),
        "{:?}",
        scene.warnings
    );
    assert!((scene.views[2].camera.k[(0, 0)] - 2.0 * 15294.0).abs() < 1.0);
    files.retain(|f| !f.path.starts_with("colmap"));
    let matrices = to_projection(&house).into_iter();
    files.extend(matrices.map(|(path, bytes)| InputFile::new(&path, bytes)));
    assert!(load(&files).warnings.is_empty());
}
