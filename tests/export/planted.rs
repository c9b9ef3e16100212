//! Models with known volumes, a scene that shows them, and what they were made from.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use ridgeline::base::evidence::{
    Candidates, Evidence, EvidenceTerm, JudgedFacet, JudgedLine, JudgedSurface, WindowCounts,
};
use ridgeline::base::geometry::{Plane, Segment2, Segment3};
use ridgeline::base::ids::{BuildingId, LineId, SegmentId, ViewId};
use ridgeline::base::params::TextureParams;
use ridgeline::lines::lines2d::ImageSegment;
use ridgeline::lines::lines3d::Line3d;
use ridgeline::lines::lines3d::Side;
use ridgeline::lines::lines3d::{LineSupport, SupportKind};
use ridgeline::orienting::scene::{Scene, View};
use ridgeline::photographs::camera::Camera;
use ridgeline::photographs::raster::Gray;
use ridgeline::planes::half_planes::HalfPlane;
use ridgeline::results::export::{ExportInput, export_all};
use ridgeline::results::texture::texture_model;
use ridgeline::roofs::model::{BuildingWalls, Facet, RoofModel, check_invariants};
use ridgeline::roofs::solids::close_buildings;

/// A scene origin as of a national grid.
pub const ORIGIN: Vector3<f64> = Vector3::new(432_100.0, 5_412_300.0, 0.0);

/// A facet over plan rings on `z = z0 + gx x + gy y`.
fn facet(rings: &[&[(f64, f64)]], z0: f64, gx: f64, gy: f64) -> Facet {
    let normal = Vector3::new(-gx, -gy, 1.0);
    let plane = Plane::from_point_normal(&Point3::new(0.0, 0.0, z0), &normal).unwrap();
    let lift = |ring: &&[(f64, f64)]| ring.iter().map(|&(x, y)| plane.lift(x, y)).collect();
    Facet {
        building: BuildingId(0),
        plane,
        outer: lift(&rings[0]),
        holes: rings[1..].iter().map(lift).collect(),
        similarity: 0.9,
        real_ratio: 0.8,
        uncertainty: None,
        probability: 1.0,
        lines: Vec::new(),
        half_planes: Vec::new(),
        proposals: Vec::new(),
        obstructions: Vec::new(),
    }
}

/// One with four corners; `z = z0 + gx x + gy y`.
pub fn quad(ring: [(f64, f64); 4], [z0, gx, gy]: [f64; 3]) -> Facet {
    facet(&[&ring], z0, gx, gy)
}

/// A gable; an L with a hip-less valley; a step between two flat roofs; a courtyard.
pub fn planted_models() -> Vec<(&'static str, RoofModel, f64)> {
    let gable = [
        quad(
            [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)],
            [5.0, 0.0, 0.5],
        ),
        quad(
            [(0.0, 4.0), (10.0, 4.0), (10.0, 8.0), (0.0, 8.0)],
            [9.0, 0.0, -0.5],
        ),
    ];
    // Ridges y = 3 and x = 13 at 6.5 m, equal slopes, so that hip and valley run diagonally.
    let l_shape = [
        quad(
            [(0.0, 0.0), (16.0, 0.0), (13.0, 3.0), (0.0, 3.0)],
            [5.0, 0.0, 0.5],
        ),
        quad(
            [(0.0, 3.0), (13.0, 3.0), (10.0, 6.0), (0.0, 6.0)],
            [8.0, 0.0, -0.5],
        ),
        quad(
            [(16.0, 0.0), (16.0, 12.0), (13.0, 12.0), (13.0, 3.0)],
            [13.0, -0.5, 0.0],
        ),
        quad(
            [(13.0, 3.0), (13.0, 12.0), (10.0, 12.0), (10.0, 6.0)],
            [0.0, 0.5, 0.0],
        ),
    ];
    let step = [
        quad(
            [(0.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 6.0)],
            [8.0, 0.0, 0.0],
        ),
        quad(
            [(5.0, -2.0), (9.0, -2.0), (9.0, 9.0), (5.0, 9.0)],
            [4.0, 0.0, 0.0],
        ),
    ];
    let courtyard = [facet(
        &[
            &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
            &[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)],
        ],
        6.0,
        0.1,
        0.0,
    )];
    // Prism: footprint times the mean height. L: both wings have the mean height 5.75 m, but for
    // the corner.
    let pyramid_quarter = 3.0 * 3.0 * 1.5 / 3.0;
    let l_volume = (16.0 * 6.0 + 6.0 * 6.0) * 5.75
        - 2.0 * (pyramid_quarter - 9.0 * 0.75)
        - 2.0 * (9.0 * 0.75 - pyramid_quarter);
    [
        ("gable", gable.to_vec(), 480.0),
        ("l", l_shape.to_vec(), l_volume),
        ("step", step.to_vec(), 240.0 + 176.0),
        ("courtyard", courtyard.to_vec(), 84.0 * 6.5),
    ]
    .map(|(name, facets, volume)| {
        let (model, trace) = close_buildings(&facets, |_| 0.0);
        assert_eq!(trace.rejected, [], "{name}");
        assert_eq!(check_invariants(&model), [], "{name}");
        (name, model, volume)
    })
    .into()
}

/// Looks straight down from 100 m; red grows to the east and green to the north by one grey value
/// per 10 cm.
pub fn map_view(name: &str, x: f64, y: f64) -> View {
    let (size, focal) = (400u32, 1000.0);
    let k = Matrix3::new(focal, 0.0, 200.0, 0.0, focal, 200.0, 0.0, 0.0, 1.0);
    let down =
        Rotation3::from_matrix_unchecked(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)));
    let camera = Camera::new(k, down, Point3::new(x, y, 100.0), size, size);
    let rgb = image::RgbImage::from_fn(size, size, |column, row| {
        let pixel = nalgebra::Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
        // The gradient is painted on the height of 6 m.
        let p = camera.at_height(&pixel, 6.0).unwrap();
        let grey = |v: f64| (100.0 + 5.0 * v).round().clamp(0.0, 255.0) as u8;
        image::Rgb([grey(p.x), grey(p.y), 40])
    });
    View::new(name.into(), camera, Gray::from_rgb(&rgb), rgb)
}

pub fn scene() -> Scene {
    Scene {
        views: vec![map_view("a.jpg", 5.0, 5.0), map_view("b.jpg", 8.0, 5.0)],
        origin: ORIGIN,
        ground_z: None,
        region: None,
        known: ridgeline::orienting::known::Known::default(),
        warnings: Vec::new(),
        survey: ridgeline::orienting::scene::Survey::default(),
    }
}

pub fn files_of(scene: &Scene, model: &RoofModel) -> BTreeMap<String, Vec<u8>> {
    files_with(scene, model, planted_evidence())
}

pub fn files_with(scene: &Scene, model: &RoofModel, sources: Sources) -> BTreeMap<String, Vec<u8>> {
    files_from(scene, (model, &[]), sources)
}

/// With walls of each building.
pub fn files_of_walled(
    scene: &Scene,
    model: &RoofModel,
    walls: &[BuildingWalls],
) -> BTreeMap<String, Vec<u8>> {
    files_from(scene, (model, walls), planted_evidence())
}

fn files_from(
    scene: &Scene,
    (model, walls): (&RoofModel, &[BuildingWalls]),
    (segments, lines, half_planes): Sources,
) -> BTreeMap<String, Vec<u8>> {
    let params = TextureParams::default();
    let (textured, _) = texture_model(scene, model, &params);
    let results = ExportInput {
        scene,
        segments: &segments,
        lines: &lines,
        half_planes: &half_planes,
        candidates: &planted_candidates(),
        model,
        walls,
        textured: &textured,
    };
    export_all(&results, &params).into_iter().collect()
}

/// A line and a facet that were weighed.
fn planted_candidates() -> Candidates {
    let term = EvidenceTerm {
        feature: "slope_deg",
        value: 12.5,
        nats: -0.5,
    };
    let evidence = Evidence {
        prior: 0.5,
        terms: vec![term],
    };
    let plane = Plane {
        normal: Vector3::z(),
        d: -5.0,
    };
    let outline = [(1.0, 2.0), (4.0, 2.0), (1.0, 6.0)].map(|(x, y)| Point3::new(x, y, 5.0));
    let line = JudgedLine {
        segment: Segment3::new([1.0, 2.0, 3.0].into(), [4.0, 5.0, 6.123_456].into()),
        evidence: evidence.clone(),
    };
    Candidates {
        lines: vec![line.clone()],
        model_lines: vec![line],
        facets: vec![JudgedFacet {
            outline: outline.to_vec(),
            holes: Vec::new(),
            plane,
            accepted: false,
            evidence: evidence.clone(),
            windows: WindowCounts::default(),
        }],
        obstructions: Vec::new(),
        rectangles: Vec::new(),
        surfaces: vec![JudgedSurface {
            patches: outline.to_vec(),
            building: evidence.clone(),
            vegetation: evidence,
        }],
    }
}

/// Image segments, 3D lines and half-planes.
pub type Sources = (Vec<Vec<ImageSegment>>, Vec<Line3d>, Vec<HalfPlane>);

pub fn planted_evidence() -> Sources {
    let segment = Segment2::new([1.0, 2.0].into(), [30.25, 4.0].into());
    let image_segment = ImageSegment {
        kind: Default::default(),
        segment,
        contrast: 0.3,
        edgels: 29,
        covariance: nalgebra::Matrix2::zeros(),
    };
    let support = LineSupport {
        view: ViewId(1),
        segments: vec![SegmentId(0)],
        stretch: segment,
        score: 0.75,
        kind: SupportKind::Matched,
        edge: None,
    };
    let line = Line3d {
        origin: Default::default(),
        segment: Segment3::new([1.0, 2.0, 3.0].into(), [4.0, 5.0, 6.123_456].into()),
        sigma_m: 0.02,
        covariance: [Matrix3::zeros(); 2],
        probability: 0.9,
        supports: vec![support],
        contradiction: None,
    };
    let half_plane = HalfPlane {
        line: LineId(0),
        side: Side::Left,
        theta: 0.5,
        sigma_theta: 0.01,
        similarity: 0.8,
        curvature: 12.0,
        amplitude: 0.5,
        probability: 0.97,
        views: vec![ViewId(0), ViewId(1)],
        plane: facet(&[&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]], 3.0, 0.2, 0.1).plane,
    };
    (
        vec![Vec::new(), vec![image_segment]],
        vec![line],
        vec![half_plane],
    )
}
