//! BlocksExchange.

use nalgebra::{Matrix3, Point3, Vector3};
use ridgeline::orienting::orientation::{InputFile, StatedReference, detect, orientation_sets};

use super::{k, near, read, refusal, replaced, truth};

pub(super) const BLOCKS: (&str, &str) = case!("blocks/block.xml");

#[test]
fn a_block_stands_in_the_system_that_it_names() {
    let found = read(&[BLOCKS]).unwrap();
    assert_eq!(found.names(), ["a.jpg", "b.jpg", "a.jpg", "b.jpg", "c.jpg"]);
    let groups: Vec<_> = found
        .orientations
        .iter()
        .map(|o| o.group.as_deref().unwrap())
        .collect();
    assert_eq!(groups[..2], ["Block_1"; 2]);
    assert_eq!(groups[2..], ["Block_1 - AT"; 3]);
    found.stands(0, 0, [500.0; 3]);
    let camera = found.stands(4, 2, [0.0; 3]);
    near(&camera.k, &k(900.0, 0.0, 900.0, 8.25, 5.5));
    found.warns(&["component 0", "gps.jpg"]);
    let StatedReference::Place(place) = found.reference else {
        panic!("{:?}", found.reference);
    };
    assert_eq!(
        (place.lat_deg, place.lon_deg, place.height_m),
        (50.1, 14.5, 0.0)
    );
    // The other block, by its label.
    let inputs = [InputFile::new(BLOCKS.0, BLOCKS.1.as_bytes().to_vec())];
    let (sets, _) = orientation_sets(&inputs, &[detect(&inputs[0])]);
    let other = sets[0].reference(&inputs, Some("Block_1"));
    assert_eq!(other, StatedReference::System(25833));
}

#[test]
fn a_block_without_a_system_that_is_known_has_none() {
    let reference = |from: &str, to: &str| {
        let (path, text) = replaced(BLOCKS, from, to);
        read(&[(path, &text)])
    };
    let local = reference("<SRSId>2</SRSId>", "").unwrap().reference;
    assert!(matches!(local, StatedReference::Local(_)), "{local:?}");
    let absent = reference("<SRSId>2</SRSId>", "<SRSId>7</SRSId>").unwrap();
    assert!(matches!(absent.reference, StatedReference::Local(_)));
    absent.warns(&["reference system 7", "not in the file"]);
    // A photogroup may name its own; then it must be that of the whole block.
    let group = |id: &str| format!("<SRSId>{id}</SRSId><Name>Photogroup 1</Name>");
    let own = reference("<Name>Photogroup 1</Name>", &group("1"))
        .unwrap()
        .reference;
    assert_eq!(own, StatedReference::System(25833));
    let (path, text) = replaced(
        BLOCKS,
        "    <Photo><Id>1<",
        "   </Photogroup><Photogroup><SRSId>0</SRSId>    <Photo><Id>1<",
    );
    refusal(
        &[(path, &text)],
        &["another reference system", "one <SRSId>"],
    );
}

#[test]
fn all_eight_orientations_of_a_camera_are_read() {
    let directions = [
        ("Right", Vector3::x()),
        ("Left", -Vector3::x()),
        ("Down", Vector3::y()),
        ("Up", -Vector3::y()),
    ];
    let (r, center) = truth(0);
    let mut count = 0;
    for (x_name, x) in directions {
        for (y_name, y) in directions.iter().filter(|(_, y)| x.dot(y) == 0.0) {
            // What the camera calls x is x of the image, and so on: rows of the file's matrix.
            let rows =
                Matrix3::from_rows(&[x.transpose(), y.transpose(), x.cross(y).transpose()]) * r;
            let mm = |v: &Vector3<f64>| 0.01 * (v.x * 0.25 + v.y * -0.5);
            let text = block_of(
                &format!(
                    "<PixelSize>0.01</PixelSize><FocalLength>9</FocalLength><CameraOrientation>X{x_name}Y{y_name}</CameraOrientation>\
                     <PrincipalPoint><xmm>{}</xmm><ymm>{}</ymm></PrincipalPoint>",
                    mm(&x),
                    mm(y)
                ),
                &matrix_elements(&rows),
                &center,
            );
            let found = read(&[("block.xml", &text)]).unwrap();
            let camera = found.stands(0, 0, [0.0; 3]);
            near(&camera.k, &k(900.0, 0.0, 900.0, 8.25, 5.5));
            count += 1;
        }
    }
    assert_eq!(count, 8);
    let unknown = |name: &str| {
        let group = format!(
            "<FocalLengthPixels>900</FocalLengthPixels><CameraOrientation>{name}</CameraOrientation>"
        );
        let text = block_of(&group, &matrix_elements(&r), &center);
        refusal(
            &[("block.xml", &text)],
            &[&format!("\"{name}\""), "XDownYLeft"],
        );
    };
    for name in ["XRightYLeft", "YUpXRight", "XNorthYDown"] {
        unknown(name);
    }
}

/// A block of one photo of 16 x 12 pixels.
pub(super) fn block_of(group: &str, rotation: &str, center: &Point3<f64>) -> String {
    format!(
        "<BlocksExchange version=\"2.1\"><Block><Photogroups><Photogroup>\n\
         <ImageDimensions><Width>16</Width><Height>12</Height></ImageDimensions>{group}\n\
         <Photo><Id>0</Id><ImagePath>a.jpg</ImagePath><Pose><Rotation>{rotation}</Rotation>\
         <Center><x>{}</x><y>{}</y><z>{}</z></Center></Pose></Photo>\n\
         </Photogroup></Photogroups></Block></BlocksExchange>",
        center.x, center.y, center.z
    )
}

pub(super) fn matrix_elements(m: &Matrix3<f64>) -> String {
    let at = |i: usize, j: usize| format!("<M_{i}{j}>{}</M_{i}{j}>", m[(i, j)]);
    (0..9).map(|n| at(n / 3, n % 3)).collect()
}

#[test]
fn the_forms_of_a_block_that_its_description_allows() {
    let center = truth(0).1;
    // World to camera of the example in the format's description: 179.6523, 0.0499, 179.9065.
    let example = Matrix3::new(
        -0.999998291223340,
        -0.001636319085375301,
        -0.0008602425863163225,
        -0.001631068695467463,
        0.9999802528616577,
        -0.00606906089589293,
        0.0008701565192966738,
        -0.006067647409696231,
        -0.9999812130648239,
    );
    let angles = "<Omega>179.6523471469934</Omega><Phi>0.04985630236313049</Phi><Kappa>179.9065465708369</Kappa>";
    let group =
        "<FocalLengthPixels>900</FocalLengthPixels><AspectRatio>1.01</AspectRatio><Skew>0.5</Skew>";
    let found = read(&[("block.xml", &block_of(group, angles, &center))]).unwrap();
    assert!((found.orientations[0].r - example).norm() < 1e-9);
    near(&found.orientations[0].k, &k(900.0, 0.5, 909.0, 8.0, 6.0));
    assert_eq!(found.reference, StatedReference::None);
    let refused = |group: &str, rotation: &str, words: &[&str]| {
        refusal(&[("block.xml", &block_of(group, rotation, &center))], words);
    };
    let matrix = matrix_elements(&example);
    refused(
        group,
        "<Yaw>1</Yaw><Pitch>2</Pitch><Roll>3</Roll>",
        &["line 3", "<Yaw>", "M_00"],
    );
    refused(
        "<CameraModelType>Spherical</CameraModelType>",
        &matrix,
        &["\"Spherical\"", "line 1"],
    );
    refused(
        "<FocalLength>9</FocalLength>",
        &matrix,
        &["<SensorSize> or <PixelSize>"],
    );
    let lens = |term: &str| format!("{group}<Distortion><K1>0.1</K1>{term}</Distortion>");
    refused(&lens("<K4>0.1</K4>"), &matrix, &["<K4>", "not read"]);
    assert!(
        read(&[(
            "block.xml",
            &block_of(&lens("<K4>0</K4>"), &matrix, &center)
        )])
        .is_ok()
    );
}
