//! Which view paints what.

use nalgebra::Vector3;
use ridgeline::base::ids::ViewId;
use ridgeline::base::params::TextureParams;
use ridgeline::orienting::scene::{Scene, View};
use ridgeline::results::texture::texture_model;
use ridgeline::roofs::model::Surface;
use ridgeline::roofs::solids::close_buildings;

use crate::planted::{map_view, quad, scene};

#[test]
fn colours_come_back_where_they_were_painted() {
    // A flat roof at the height of the gradient, off the middle and longer than wide.
    let roof = [quad(
        [(2.0, 3.0), (9.0, 3.0), (9.0, 7.0), (2.0, 7.0)],
        [6.0, 0.0, 0.0],
    )];
    let (model, _) = close_buildings(&roof, |_| 0.0);
    let scene = scene();
    let (textured, trace) = texture_model(&scene, &model, &TextureParams::default());
    let solid = &model.buildings[0].solid;
    let atlas = &textured.atlas;
    for (i, face) in solid.faces.iter().enumerate() {
        if textured.faces[0][i].view.is_none() {
            assert!(!matches!(face.surface, Surface::Roof(_)));
            continue;
        }
        let uv = &textured.faces[0][i].uv[0];
        let corners: Vec<_> = face.rings[0]
            .iter()
            .map(|&v| solid.vertices[v as usize])
            .collect();
        let centre = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let middle =
            [0, 1].map(|c| centre(&uv.iter().map(|t| f64::from(t[c])).collect::<Vec<_>>()));
        let mean = corners.iter().map(|p| p.coords).sum::<Vector3<f64>>() / corners.len() as f64;
        for (t, corner) in uv.iter().zip(&corners) {
            // A little inside of the corner, away from the border of the patch.
            let inwards = [0, 1].map(|c| 0.9 * f64::from(t[c]) + 0.1 * middle[c]);
            let x = (inwards[0] * f64::from(atlas.width())) as u32;
            let y = (inwards[1] * f64::from(atlas.height())) as u32;
            let (colour, p) = (atlas.get_pixel(x, y), corner.coords * 0.9 + mean * 0.1);
            // The gradient lies in the plane of the roof; below it a wall shows what the ray passes
            // there.
            let camera = &scene.view(textured.faces[0][i].view.unwrap()).camera;
            let seen = camera
                .at_height(&camera.project(&p.into()).unwrap(), 6.0)
                .unwrap();
            for (channel, value) in [seen.x, seen.y].into_iter().enumerate() {
                let wanted = 100.0 + 5.0 * value;
                assert!(
                    (f64::from(colour[channel]) - wanted).abs() < 2.0,
                    "{colour:?} at {p}"
                );
            }
        }
    }
    let is_roof = |f: usize| matches!(solid.faces[f].surface, Surface::Roof(_));
    let roof_trace = trace.faces.iter().find(|t| is_roof(t.face)).unwrap();
    assert!(
        (roof_trace.texel_m - 0.094).abs() < 1e-3,
        "94 m above the roof, 1000 px"
    );
    assert_eq!(roof_trace.unseen, 0.0);
}

#[test]
fn what_a_higher_roof_hides_is_taken_from_another_view() {
    let roofs = [
        quad(
            [(0.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 6.0)],
            [8.0, 0.0, 0.0],
        ),
        quad(
            [(5.0, 0.0), (9.0, 0.0), (9.0, 6.0), (5.0, 6.0)],
            [4.0, 0.0, 0.0],
        ),
    ];
    let (model, _) = close_buildings(&roofs, |_| 0.0);
    let low_roof = |views: Vec<View>| {
        let scene = Scene { views, ..scene() };
        let (_, trace) = texture_model(&scene, &model, &TextureParams::default());
        let low = Surface::Roof(ridgeline::base::ids::FacetId(1));
        let is_low = |f: usize| model.buildings[0].solid.faces[f].surface == low;
        trace.faces.into_iter().find(|t| is_low(t.face)).unwrap()
    };
    // From (-10, 3, 100) the ray over the step falls by 4 m within 4 * 15 / 92 m of the 4 m wide
    // roof.
    let hidden = 15.0 / 92.0;
    let alone = low_roof(vec![map_view("west.jpg", -10.0, 3.0)]);
    assert!((alone.unseen - hidden).abs() < 0.01, "{}", alone.unseen);
    assert!((alone.views[0].visible - 1.0 + hidden).abs() < 0.01);
    let both = low_roof(vec![
        map_view("east.jpg", 20.0, 3.0),
        map_view("west.jpg", -10.0, 3.0),
    ]);
    assert_eq!((both.views[0].view, both.unseen), (ViewId(0), 0.0));
    // A second view that shows just the hidden part: the step's foot is at its border.
    let mut foot = map_view("foot.jpg", 5.0, 3.0);
    foot.camera.width = 210;
    let filled = low_roof(vec![foot, map_view("west.jpg", -10.0, 3.0)]);
    assert_eq!(
        (filled.views[0].view, filled.views[1].view),
        (ViewId(1), ViewId(0))
    );
    assert!(filled.filled > 0.02 && filled.filled + filled.unseen < hidden + 0.01);
}
