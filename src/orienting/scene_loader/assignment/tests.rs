//! Masks, twins, copies and rigs: which image is given which orientation.

use nalgebra::{Matrix3, Point3};

use super::*;

/// An orientation for 4000 x 3000 pixels.
pub(super) fn stated(image: &str) -> Orientation {
    let k = Matrix3::new(3500.0, 0.0, 2000.0, 0.0, 3500.0, 1500.0, 0.0, 0.0, 1.0);
    Orientation {
        image: image.to_owned(),
        source: format!("sparse/0/images.txt, line of {image}"),
        k,
        distortion: None,
        r: Matrix3::identity(),
        center: Point3::origin(),
        size: Some((4000, 3000)),
        from_middle: false,
        angles: None,
        crop: None,
        readings: Vec::new(),
        group: None,
    }
}

pub(super) fn image(path: &str) -> ImageCandidate<'_> {
    ImageCandidate {
        path,
        size: Some([4000, 3000]),
        is_gray_png: false,
    }
}

/// What each of the images is given: the name of its orientation, or a dash.
fn given(names: &[&str], images: &[ImageCandidate]) -> String {
    let orientations: Vec<Orientation> = names.iter().map(|name| stated(name)).collect();
    given_of(&orientations, images)
}

fn given_of(orientations: &[Orientation], images: &[ImageCandidate]) -> String {
    let found = assign(orientations, images);
    assert_eq!(found.ambiguous, [], "{images:?}");
    let names = found.of_image.iter();
    let names = names.map(|one| one.map_or("-", |one| &*orientations[one].image));
    names.collect::<Vec<_>>().join(" ")
}

impl std::fmt::Debug for ImageCandidate<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} {:?}", self.path, self.size)
    }
}

fn paths<'a>(paths: &[&'a str]) -> Vec<ImageCandidate<'a>> {
    paths.iter().map(|path| image(path)).collect()
}

#[test]
fn a_mask_is_no_view() {
    let images = paths(&[
        "images/1.jpg",
        "images/2.jpg",
        "masks/1.jpg.png",
        "masks/2.jpg.png",
    ]);
    assert_eq!(given(&["1.jpg", "2.jpg"], &images), "1.jpg 2.jpg - -");
    // The mask of a photograph that is not there, in a folder of its own or beside the others.
    let names = ["1.jpg", "2.jpg", "3.jpg"];
    for mask in ["masks/3.jpg.png", "images/3.jpg.png"] {
        let folder = mask.strip_suffix("3.jpg.png").unwrap();
        let others = ["1", "2"].map(|n| format!("{folder}{n}.jpg.png"));
        let all = ["images/1.jpg", "images/2.jpg", &others[0], &others[1], mask];
        assert_eq!(given(&names, &paths(&all)), "1.jpg 2.jpg - - -", "{mask}");
    }
    // Without extension, the grey one of two formats is the mask.
    let mut images = paths(&["images/1.png", "masks/1.png", "masks/2.png", "images/2.jpg"]);
    images[1].is_gray_png = true;
    images[2].is_gray_png = true;
    assert_eq!(given(&["1", "2"], &images), "1 - - 2");
    // A whole set called like masks, and nothing else, is the photographs.
    let images = paths(&["a/1.jpg.tif", "a/2.jpg.tif"]);
    assert_eq!(given(&["1.jpg", "2.jpg"], &images), "1.jpg 2.jpg");
}

#[test]
fn the_folder_that_is_stated_tells_cameras_apart() {
    let images = paths(&["images/cam1/1.jpg", "images/cam0/1.jpg"]);
    for stated in [
        ["cam0/1.jpg", "cam1/1.jpg"],
        ["D:\\p\\cam0\\1.jpg", "D:\\p\\cam1\\1.jpg"],
        [
            "file:///home/u/My%20p/cam0/1.jpg",
            "file:///home/u/My%20p/cam1/1.jpg",
        ],
        ["/mnt/x/CAM0/1.JPG", "/mnt/x/CAM1/1.JPG"],
        ["./images/cam0/1", "./images/cam1/1"],
    ] {
        assert_eq!(
            given(&stated, &images),
            format!("{} {}", stated[1], stated[0])
        );
    }
    // The other camera is not the one whose image is missing.
    let images = paths(&["cam1/1.jpg", "cam2/1.jpg"]);
    assert_eq!(
        given(&["cam0/1.jpg", "cam1/1.jpg"], &images),
        "cam1/1.jpg -"
    );
    // A folder of another name on another machine does not matter where names are unique.
    let images = paths(&["photos/1.jpg", "photos/2.jpg"]);
    assert_eq!(
        given(&["E:\\flight\\2.jpg", "E:\\flight\\1.jpg"], &images),
        "E:\\flight\\1.jpg E:\\flight\\2.jpg"
    );
}

#[test]
fn of_copies_in_several_sizes_the_one_that_the_orientation_states_is_taken() {
    let mut images = paths(&["half/1.jpg", "full/1.jpg", "thumbs/1.jpg", "half/2.jpg"]);
    images[0].size = Some([2000, 1500]);
    images[2].size = Some([160, 120]);
    images[3].size = Some([2000, 1500]);
    // Where there is no full one, half the size will do.
    images.push(image("full/3.jpg"));
    let names = ["1", "2", "3"];
    assert_eq!(given(&names[..1], &images[..3]), "- 1 -");
    images[3].path = "full/2.jpg";
    assert_eq!(given(&names, &images), "- 1 - 2 3");
    // Nothing is stated but the centre of the lens.
    let mut bare = stated("1");
    bare.size = None;
    assert_eq!(given_of(&[bare], &images[1..3]), "1 -");
}

#[test]
fn undistorted_twins_are_no_views() {
    // Of another size; of the same one, but beside another orientation.
    let mut images = paths(&[
        "images/1.jpg",
        "images/2.jpg",
        "undistorted/1.jpg",
        "undistorted/2.jpg",
    ]);
    images[2].size = Some([3980, 2970]);
    images[3].size = Some([3980, 2970]);
    assert_eq!(given(&["1.jpg", "2.jpg"], &images), "1.jpg 2.jpg - -");
    let images = paths(&["images/1.jpg", "sparse/images/1.jpg"]);
    assert_eq!(given(&["1.jpg"], &images), "- 1.jpg");
    // The orientation states the folder.
    let images = paths(&["undistorted/1.jpg", "images/1.jpg"]);
    assert_eq!(
        given(&["C:/p/images/1.jpg"], &images),
        "- C:/p/images/1.jpg"
    );
}

#[test]
fn what_a_folder_of_copies_holds_beyond_the_photographs_is_left_out() {
    let mut images = paths(&["images/1.jpg", "images/2.jpg"]);
    for path in ["small/1.jpg", "small/2.jpg", "small/3.jpg"] {
        images.push(ImageCandidate {
            size: Some([400, 300]),
            ..image(path)
        });
    }
    let orientations = ["1.jpg", "2.jpg", "3.jpg"].map(stated);
    let found = assign(&orientations, &images);
    assert_eq!(found.of_image, [Some(0), Some(1), None, None, None]);
    let reasons = [LeftOut::For(0), LeftOut::For(1), LeftOut::WithCopies].map(Some);
    assert_eq!(found.left_out[2..], reasons);
    // Two kinds of copies compete for what is not there.
    let more = [
        ("masks/1.png", true),
        ("masks/2.png", true),
        ("masks/3.png", true),
    ];
    images.extend(more.map(|(path, is_gray_png)| ImageCandidate {
        is_gray_png,
        ..image(path)
    }));
    let found = assign(&orientations, &images);
    assert_eq!(found.of_image[..2], [Some(0), Some(1)]);
    assert!(found.of_image[2..].iter().all(Option::is_none), "{found:?}");
    // Of one camera little is oriented, but its folder is stated.
    let rig = paths(&[
        "c0/1.jpg", "c0/2.jpg", "c0/3.jpg", "c1/1.jpg", "c1/2.jpg", "c1/3.jpg",
    ]);
    let names = ["c0/1.jpg", "c1/1.jpg", "c1/2.jpg", "c1/3.jpg"];
    assert_eq!(
        given(&names, &rig),
        "c0/1.jpg - - c1/1.jpg c1/2.jpg c1/3.jpg"
    );
    // Two flights of which one has a stray copy remain two flights.
    images.truncate(3);
    images.extend(paths(&["small/4.jpg", "small/5.jpg"]));
    let orientations = ["1.jpg", "2.jpg", "4.jpg", "5.jpg"].map(stated);
    let found = assign(&orientations, &images);
    assert_eq!(found.of_image, [Some(0), Some(1), None, Some(2), Some(3)]);
}

#[test]
fn what_nothing_tells_apart_is_ambiguous() {
    let ambiguous = |names: &[&str], images: &[&str]| -> Vec<(Vec<usize>, Vec<usize>)> {
        let orientations: Vec<Orientation> = names.iter().map(|name| stated(name)).collect();
        let found = assign(&orientations, &paths(images)).ambiguous.into_iter();
        let sets = found.map(|same| (same.images, same.orientations));
        sets.map(|(a, b)| (a.into_iter().collect(), b.into_iter().collect()))
            .collect()
    };
    assert_eq!(
        ambiguous(&["1.jpg"], &["a/1.jpg", "b/1.jpg"]),
        [(vec![0, 1], vec![0])]
    );
    assert_eq!(
        ambiguous(&["1"], &["a/1.jpeg", "a/1.jpg"]),
        [(vec![0, 1], vec![0])]
    );
    assert_eq!(
        ambiguous(&["1.jpg", "1.jpg"], &["a/1.jpg"]),
        [(vec![0], vec![0, 1])]
    );
    assert_eq!(
        ambiguous(
            &["x/1.jpg", "y/1.jpg", "2.jpg"],
            &["a/1.jpg", "b/1.jpg", "2.jpg"]
        ),
        [(vec![0, 1], vec![0, 1])]
    );
}

#[test]
fn a_thousand_photographs_are_assigned_at_once() {
    let names: Vec<String> = (0..2000).map(|i| format!("DJI_{i:04}.JPG")).collect();
    let orientations: Vec<Orientation> = names.iter().rev().map(|name| stated(name)).collect();
    let images: Vec<String> = names
        .iter()
        .map(|name| format!("100MEDIA/{name}"))
        .collect();
    let images: Vec<ImageCandidate> = images.iter().map(|path| image(path)).collect();
    let found = assign(&orientations, &images);
    assert!((0..2000).all(|i| found.of_image[i] == Some(1999 - i)));
}
