//! `ridgeline reconstruct --tile M`: a large area, tile by tile, into one model.

use std::path::Path;
use std::time::Instant;

use ridgeline::ids::ViewId;
use ridgeline::objectspace::{image_segments, world_lines};
use ridgeline::params::{Method, Params};
use ridgeline::pipeline::{Run, Stage, load_adjusted};
use ridgeline::progress::silent;
use ridgeline::scene::Scene;
use ridgeline::scene_loader::{InputFile, LoadOptions, whole_views};
use ridgeline::texture::texture_model;
use ridgeline::tiles::{Tile, TilePart, join, plan_tiles};
use serde_json::json;

use super::{Failure, files};

/// Reconstructs the region of interest in tiles of about `tile_m` metres and writes the results.
pub(super) fn reconstruct_tiles(
    input: &[InputFile],
    options: &LoadOptions,
    params: &Params,
    tile_m: f64,
    out: &Path,
) -> Result<(), Failure> {
    let refuse = |e: ridgeline::Error| Failure::Input(e.to_string());
    let area = options.roi.ok_or_else(|| {
        Failure::Input("--tile needs the area; give it as --roi x0,y0,x1,y1".to_owned())
    })?;
    if options.apply_fix {
        let advice = "--tile takes the orientation as it is; correct it first (--apply-fix without --tile names the mistake)";
        return Err(Failure::Input(advice.to_owned()));
    }
    let tiles = plan_tiles(area, tile_m).map_err(refuse)?;
    let whole = whole_views(input, options).map_err(refuse)?;
    let mut parts = Vec::new();
    let mut report = Vec::new();
    let mut refused = None;
    for (i, tile) in tiles.iter().enumerate() {
        let start = Instant::now();
        let options = LoadOptions {
            roi: Some(tile.region),
            ..options.clone()
        };
        let outcome =
            load_adjusted(input, &options, params).map(|scene| part(scene, params, tile, &whole));
        let told = match &outcome {
            Ok(part) => format!("{} buildings", part.model.buildings.len()),
            Err(e) => e.to_string(),
        };
        println!(
            "tile {} of {}: {told} ({:.1} s)",
            i + 1,
            tiles.len(),
            start.elapsed().as_secs_f64()
        );
        report.push(
            json!({ "core": tile.core, "outcome": told, "seconds": start.elapsed().as_secs_f64() }),
        );
        match outcome {
            Ok(part) => parts.push(part),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    if let (true, Some(error)) = (parts.is_empty(), refused) {
        return Err(refuse(error));
    }
    let joined = join(whole, &parts);
    let mut written = joined.files(&params.texture);
    let report = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "origin": joined.scene.origin.as_slice(),
        "coordinates": joined.scene.survey.describe(),
        "buildings": joined.model.buildings.len(),
        "facets": joined.model.facets.len(),
        "tiles": report,
        "warnings": joined.scene.warnings,
        "params": params,
    });
    let report = serde_json::to_vec_pretty(&report).expect("a report has string keys only");
    written.push(("report.json".to_owned(), report));
    files::write_all(out, &written)?;
    println!(
        "{} buildings, {} facets, written to {}",
        joined.model.buildings.len(),
        joined.model.facets.len(),
        out.display()
    );
    Ok(())
}

/// What one tile shows.
fn part(scene: Scene, params: &Params, tile: &Tile, whole: &Scene) -> TilePart {
    let mut run = Run::new(scene, params.clone());
    for &stage in run.stages().iter().filter(|&&stage| stage != Stage::Model) {
        run.step(stage, &silent());
    }
    let (scene, results) = (run.scene(), run.results());
    let all = results.model().expect("the stages have run");
    let model = tile.keep(all, &scene.origin);
    let (textured, _) = texture_model(scene, &model, &params.texture);
    let found = "the stages have run";
    let (segments, lines, half_planes) = match params.method {
        Method::Lines => (
            results.segments.as_ref().expect(found).value.clone(),
            results.lines.as_ref().expect(found).value.clone(),
            results.half_planes.as_ref().expect(found).value.clone(),
        ),
        Method::Rectangles => {
            let lines = &results.regions.as_ref().expect(found).value;
            let clusters = &results.clusters.as_ref().expect(found).value;
            (
                image_segments(lines),
                world_lines(scene, lines, clusters),
                Vec::new(),
            )
        }
    };
    TilePart {
        tile: *tile,
        origin: scene.origin,
        views: places(scene, whole),
        segments,
        lines,
        half_planes,
        model,
        textured,
    }
}

/// Where the parts of the views lie in the whole images, pixels.
fn places(scene: &Scene, whole: &Scene) -> Vec<(ViewId, [f64; 4])> {
    let place = |view: &ridgeline::scene::View| {
        let index = whole
            .views
            .iter()
            .position(|w| w.name == view.name)
            .expect("tiles show views of the scene");
        let (a, b) = (&whole.views[index].camera, &view.camera);
        // Adjusted views are shifted by fractions of a pixel.
        let offset = [0, 1].map(|i| (a.k[(i, 2)] - b.k[(i, 2)]).round());
        (
            ViewId::from_index(index),
            [
                offset[0],
                offset[1],
                f64::from(b.width),
                f64::from(b.height),
            ],
        )
    };
    scene.views.iter().map(place).collect()
}
