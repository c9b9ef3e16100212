//! Parameters of buildings: refinement (B99 2) and textures.

use serde::{Deserialize, Serialize};

/// B99 section 2 (the contribution of Leuven): regularisation, and refinement by the reprojection
/// error of the wireframe. The paper gives no numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RefineParams {
    /// Refine at all?
    pub refine: bool,
    /// A side without a neighbour is sought again within this distance in its facet's plane,
    /// metres. Assumption: half a correlation window of the coarsest images, where delineation ends
    /// a facet without a line.
    pub search_m: f64,
    /// Uncertainty of a side that lies on a matched line, metres: a parallel edge, as at a gutter,
    /// may be that far away. Assumption.
    pub matched_m: f64,
    /// Ridges, hips and valleys are sought within this distance, px. Assumption: planes fix them.
    pub reach_px: f64,
    /// Shortest side that is measured, px. B99 3.2: the least length of segments is 15.
    pub min_side_px: f64,
    /// Least number of views that see a side. Assumption: two views cannot be verified by a third.
    pub min_views: usize,
    /// Least step across a side in a profile of one pixel, grey range 1; it falls with the root of
    /// the profiles. Assumption: four standard deviations of noise.
    pub least_contrast: f64,
    /// The outline is also tested without sides shorter than this between longer ones, metres.
    /// Assumption: half a correlation window; what is nearer cannot be resolved.
    pub jog_m: f64,
    /// Error of both ends of a measured edge beyond its scatter, px. Assumption:
    /// fascias and gutters.
    pub floor_px: f64,
    /// Scale of the robust loss, standard deviations. Assumption.
    pub loss_sigmas: f64,
    /// Standard deviation of a corner in plan before it is measured, metres. Assumption.
    pub vertex_sigma_m: f64,
    /// Standard deviation of the heights of a facet at its corners, besides that of its lines,
    /// metres. Assumption.
    pub height_sigma_m: f64,
    /// Error of heights at a facet's lines beyond their covariance, metres. Assumption:
    /// a third of the distance within which lines count as coplanar.
    pub height_floor_m: f64,
    /// Shortest side that takes part in relations, metres. Assumption: shorter ones have no certain
    /// direction.
    pub min_relation_m: f64,
    /// Relations are proposed for sides and slopes within this angle of them, degrees. Assumption.
    pub near_deg: f64,
    /// ... and for eaves within this height of each other, metres. Assumption.
    pub near_m: f64,
    /// How exactly real buildings keep to relations, metres. Assumption: tolerances of
    /// construction.
    pub relation_sigma_m: f64,
    /// Largest chi-square (one degree of freedom) at which a relation is adopted. Assumption:
    /// rejects one true relation in a hundred.
    pub relation_chi2: f64,
    /// Distances beyond this count as this in the reprojection error, px.
    pub cap_px: f64,
    /// Least number of measured edges in a building. Assumption: two sides in three views.
    pub min_observations: usize,
    /// Most unknowns of a building; larger ones keep their shape. Assumption: seconds of one core.
    pub max_unknowns: usize,
    /// A facet that ends at a higher or lower one is tested over this distance from there: it may
    /// end earlier, with ground between them, metres. Assumption: the width of an alley.
    pub part_m: f64,
    /// ... but over no less than this, metres. Assumption: overhangs and gutters.
    pub least_part_m: f64,
    /// How much the mean correlation inside the facets may fall. Assumption: its error.
    pub similarity_loss: f64,
}

impl Default for RefineParams {
    fn default() -> Self {
        Self {
            refine: true,
            search_m: 0.7,
            matched_m: 0.3,
            reach_px: 2.0,
            min_side_px: 15.0,
            min_views: 3,
            least_contrast: 0.04,
            jog_m: 0.5,
            floor_px: 0.25,
            loss_sigmas: 2.0,
            vertex_sigma_m: 0.3,
            height_sigma_m: 0.3,
            height_floor_m: 0.05,
            min_relation_m: 1.5,
            near_deg: 5.0,
            near_m: 0.3,
            relation_sigma_m: 0.02,
            relation_chi2: 6.63,
            cap_px: 5.0,
            min_observations: 6,
            max_unknowns: 6000,
            part_m: 3.0,
            least_part_m: 0.4,
            similarity_loss: 0.01,
        }
    }
}

/// Texture atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TextureParams {
    /// Largest side of the atlas, px. Assumption: what every WebGL 2 device can hold.
    pub max_atlas_px: u32,
    /// Side of a texel in pixels of the view that shows a face best. Assumption: 1, finer ones hold
    /// no more detail.
    pub texel_px: f64,
    /// Border around each patch, px, against bleeding. Assumption: 4, so that patches stay apart
    /// down to the second mipmap level.
    pub padding_px: u32,
    /// How far a wall may stand behind the outline of its roof, metres. Assumption: 0.4, an
    /// ordinary eave; where a view passes over or under the wall within that, it shows roof or
    /// ground.
    pub overhang_m: f64,
    /// Quality of the atlas as JPEG, 1 to 100. Assumption: 90, where its blocks cannot be seen.
    pub jpeg_quality: u8,
}

impl Default for TextureParams {
    fn default() -> Self {
        Self {
            max_atlas_px: 4096,
            texel_px: 1.0,
            padding_px: 4,
            overhang_m: 0.4,
            jpeg_quality: 90,
        }
    }
}
