//! All tunables, one struct a stage, with the papers' values as defaults.
//!
//! Each field quotes its section; where the paper is silent it says "Assumption:" and why.

use serde::{Deserialize, Serialize};

/// The parameters of a whole run. Missing fields of a JSON file take their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Params {
    /// Which of the methods finds the roofs.
    pub method: Method,
    /// Image segments.
    pub segments: SegmentParams,
    /// Line matching.
    pub matching: MatchParams,
    /// 3D lines.
    pub lines3d: Lines3dParams,
    /// Half-plane sweep.
    pub sweep: SweepParams,
    /// Grouping, delineation, verification, conflicts.
    pub roof: RoofParams,
    /// Rectangles in object space.
    pub objectspace: ObjectSpaceParams,
    /// Texture atlas.
    pub texture: TextureParams,
}

/// How roofs are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Lines matched over the views, and half-planes at them (B99).
    #[default]
    Lines,
    /// Regions, and planes between parallel lines in object space (W96).
    Rectangles,
}

/// B99 3.2: segments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegmentParams {
    /// The edgels that segments are made of.
    pub edgels: EdgelParams,
    /// Thin lines, the second source of segments.
    pub bars: BarParams,
    /// Shortest segment, px. B99 3.2: "above a minimum length (here 15 pixels)".
    pub min_length_px: f64,
    /// Edgels in each of the worm's two arms. Assumption: a third of the shortest segment.
    pub worm_arm_edgels: usize,
    /// Tangent break, degrees. Assumption: several times the noise of an arm's direction (2 degrees).
    pub worm_bend_deg: f64,
    /// Largest distance of an edgel from its line, px. B99 3.2: "a very tight threshold"; Assumption:
    /// more than twice the largest rms.
    pub max_residual_px: f64,
    /// Largest root mean square distance of the edgels from their line, px. Assumption: what noise
    /// does to the weakest edges that are worth having.
    pub max_rms_px: f64,
    /// Fewest edgels of a straight piece from which a line is grown. Assumption: what still
    /// predicts a direction.
    pub seed_edgels: usize,
    /// Largest gap over which a line is grown, px. B99 3.2 jumps "up to a one pixel gap" when linking;
    /// Assumption: along a line already fitted twice that is safe. Longer gaps (6, 12) tripled the wrong 3D
    /// lines: pieces of different edges in one line; what belongs together is merged over the views (B99 3.3).
    pub grow_gap_px: usize,
    /// Largest turn of an edgel against the line that takes it up, degrees. Assumption: what texture
    /// does to the gradient of a weak edge.
    pub grow_turn_deg: f64,
    /// Smallest radius of curvature of a line that bends significantly, px. Assumption: over
    /// 60 px it bends by 1.5 px.
    pub min_radius_px: f64,
    /// Natural logarithm of the expected number of lines by chance in an image, a line above which
    /// is refused. Assumption: a few too many, because matching over several views refuses
    /// what is accidental, and nothing brings back a lost edge.
    pub max_ln_false_alarms: f64,
    /// Distance off the line at which the contrast is measured, px. Assumption: outside the blur.
    pub contrast_distance_px: f64,
    /// Least standard deviation of an edgel, px. Assumption: what sampling leaves without noise.
    pub edgel_floor_px: f64,
    /// Least shift of a stretch of a line to the crest of the unsmoothed edge, in standard deviations of that
    /// crest. Assumption: of 0.3, 0.8, 1.3 and 2.5 the second brought lines nearer to true roof edges without following noise.
    pub refine_sigmas: f64,
    /// Standard deviation of the edge that the image shows about the edge that is meant, px, at either end of a segment.
    /// Assumption: what fascias, gutters and ridge caps do on aerial photographs: two thirds of
    /// the segments lie within one standard deviation of the true edge.
    pub edge_floor_px: f64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            edgels: EdgelParams::default(),
            bars: BarParams::default(),
            min_length_px: 15.0,
            worm_arm_edgels: 5,
            worm_bend_deg: 20.0,
            max_residual_px: 1.2,
            max_rms_px: 0.5,
            seed_edgels: 8,
            grow_gap_px: 2,
            grow_turn_deg: 30.0,
            min_radius_px: 300.0,
            max_ln_false_alarms: 7.0,
            contrast_distance_px: 2.5,
            edgel_floor_px: 0.05,
            refine_sigmas: 0.8,
            edge_floor_px: 0.1,
        }
    }
}

/// B99 3.2: edgels. Thresholds are multiples of the local standard deviation of a gradient component.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EdgelParams {
    /// Standard deviation of the smoothing Gaussian, px. Assumption: more displaces edges that are
    /// 2 px apart, as an eave and its gutter are. Of 0.7, 0.8, 1.0 and 1.2 the first two covered most of the
    /// true roof edges of rendered scenes.
    pub smoothing_px: f64,
    /// Least gradient of an edgel, in local noise units. Assumption: noise alone
    /// exceeds 1.8 at one pixel in five; the significance of the whole line is tested later.
    pub low: f64,
    /// Least gradient of the strongest edgel in a chain, in local noise units. Assumption: noise
    /// alone exceeds 2.5 at one pixel in twenty.
    pub high: f64,
}

impl Default for EdgelParams {
    fn default() -> Self {
        Self {
            smoothing_px: 0.8,
            low: 1.8,
            high: 2.5,
        }
    }
}

/// B99 5: bars. Thresholds are multiples of the local scale of the second derivative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BarParams {
    /// Look for bars at all? Assumption: no. On rendered scenes they add 2 % to the true roof edges covered for half as many
    /// segments again; more and weaker edges add as much for less.
    pub detect: bool,
    /// Least second derivative of a point of a bar. Assumption: above what tiles do.
    pub low: f64,
    /// Least second derivative of the strongest point in a chain. Assumption.
    pub high: f64,
    /// A bar is refused that has a segment on an edge so near along half of it, px. Assumption: the edges
    /// of a gutter's two sides.
    pub clear_px: f64,
}

impl Default for BarParams {
    fn default() -> Self {
        Self {
            detect: false,
            low: 2.5,
            high: 3.5,
            clear_px: 2.0,
        }
    }
}

/// B99 3.1 - 3.4: matching.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MatchParams {
    /// Side of the correlation window, px. B99 3.2: "15 x 15".
    pub window_px: usize,
    /// Least correlation of an edgel that counts. B99 3.2: "the threshold value is 0.6".
    pub edgel_correlation: f64,
    /// Least number of such edgels. B99 3.2: "the minimum is 15 edgels". B99 4.1 relaxes it to 10 where
    /// planes are built on the lines; here that adds wrong lines and hardly any roof edges.
    pub min_edgels: usize,
    /// Least score of a pair, see [`crate::linematch::EdgelScore`]. Assumption: the paper gives no value; at 0.5 a line
    /// is seen unoccluded over more than half of its edgels.
    pub pair_score: f64,
    /// Share of `pair_score` asked of a third view with a segment at the predicted position. B99 3.2:
    /// "about 50% of its value".
    pub with_segment: f64,
    /// The same without a segment. B99 3.2: "about 50% more than its value".
    pub without_segment: f64,
    /// Least number of views of a line where six or more see it. B99 3.4: "here 4". Three where
    /// fewer do.
    pub min_views: usize,
    /// Must the bright side be the same in all views? Assumption: one flight, one sun.
    pub same_contrast: bool,
    /// Grey-value noise that windows are trusted against, 0 to 1. Assumption: an 8-bit camera and a
    /// good JPEG.
    pub noise: f64,
    /// Angles of the planes tried on either side of the line, degrees, the horizontal one first
    /// (Schmid and Zisserman 1997). Assumption: up to the slopes of roofs, so close that a window's edge is
    /// less than a pixel off at a base-to-height ratio of 0.4.
    pub plane_angles_deg: Vec<f64>,
    /// Least sine of the angle at which a ray meets the other segment's interpretation plane:
    /// baseline over height times the sine of the line's angle to the epipolar lines. Assumption:
    /// below 0.04 an error of one pixel moves the line by 25 ground pixels in depth.
    pub min_intersection_sine: f64,
    /// Steepest line, degrees. Assumption: roof edges; verticals have no plane across them.
    pub max_slope_deg: f64,
    /// Distance at which a segment lies "at the predicted position", px, where the prediction itself is
    /// certain; three standard deviations where it is not. Assumption.
    pub gate_px: f64,
    /// Longest gap bridged by correlation, px. Assumption: B99 3.3 asks for correlation support only; beyond
    /// about four windows neighbouring houses' edges in one line become likelier than one line.
    pub max_gap_px: f64,
    /// Largest number of partner views of a view. Assumption: keeps the work linear in the number of views.
    pub max_partners: usize,
    /// Heights between which lines are sought, metres in the scene's frame; estimated where `None`.
    pub z_range_m: Option<[f64; 2]>,
}

impl Default for MatchParams {
    fn default() -> Self {
        Self {
            window_px: 15,
            edgel_correlation: 0.6,
            min_edgels: 15,
            pair_score: 0.5,
            with_segment: 0.5,
            without_segment: 1.5,
            min_views: 4,
            same_contrast: true,
            noise: 0.006,
            plane_angles_deg: vec![0.0, -20.0, 20.0, -40.0, 40.0, -55.0, 55.0],
            min_intersection_sine: 0.04,
            max_slope_deg: 75.0,
            gate_px: 1.0,
            max_gap_px: 30.0,
            max_partners: 8,
            z_range_m: None,
        }
    }
}

/// B99 3.2, figure 4: 3D lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Lines3dParams {
    /// Error of a segment's ends that its own covariance does not know, px: calibration,
    /// compression, edges that are not quite straight. Assumption.
    pub position_floor_px: f64,
    /// Scale c of the Cauchy loss, standard deviations. Assumption: the usual 2.4 (95 % efficiency).
    pub loss_scale: f64,
    /// Most Levenberg-Marquardt steps. Assumption: a good start converges in fewer than ten.
    pub max_iterations: usize,
    /// Residual, in standard deviations, beyond which a segment is not of this line. Assumption.
    pub max_residual: f64,
    /// Largest standard deviation of a line across itself, ground pixels. Assumption.
    pub max_sigma_px: f64,
}

impl Default for Lines3dParams {
    fn default() -> Self {
        Self {
            position_floor_px: 0.1,
            loss_scale: 2.4,
            max_iterations: 20,
            max_residual: 4.0,
            max_sigma_px: 1.5,
        }
    }
}

/// B99 4.1: half-planes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SweepParams {
    /// Largest |theta|, degrees. B99 figure 15: "over the interval [-75; +75]".
    pub max_theta_deg: f64,
    /// First step of the subdivision, degrees. Assumption: a point at the far end of the neighbourhood
    /// moves by 2 to 4 px in a step, about the width of a correlation peak; near points move less.
    pub first_step_deg: f64,
    /// The subdivision ends below this step, degrees. B99 4.1: "a termination criterion of
    /// `Delta theta < 1`" degree.
    pub last_step_deg: f64,
    /// Maxima of the first pass that are subdivided. Assumption: the highest few, since the first
    /// pass sees a narrow peak only in part.
    pub max_peaks: usize,
    /// Side of the correlation window, px, odd, at most 15. B99 3.2: "15 x 15".
    pub window_px: usize,
    /// Depth of the neighbourhood away from the line, px. Assumption: the weight 1/distance leaves little to
    /// points beyond.
    pub depth_px: f64,
    /// Depth of the neighbourhood, metres on the ground. Assumption: facets are rarely deeper.
    pub depth_m: f64,
    /// Strip beside the line that is not used, px. Assumption: the line's own blur and position error.
    pub margin_px: f64,
    /// Shortest projected line, px. Assumption: a window is not wider than the line is long.
    pub min_length_px: f64,
    /// Blur before the edge detector, standard deviation in px. Assumption: the least that keeps
    /// single-pixel noise from becoming edges.
    pub poi_blur_px: f64,
    /// Least gradient of an edge that gives points of interest, grey range per px. B99 4.1: "a very low
    /// threshold on gradient". Assumption: one grey level of 256 per pixel, three times the noise
    /// that a good photograph leaves after the blur.
    pub poi_min_gradient: f64,
    /// Every how many edgels there is a point of interest. B99 4.1: "regularly sampled".
    pub poi_spacing_px: usize,
    /// Least number of points of interest. Assumption: as many as the edgels that verify a line
    /// match for planes (B99 4.1: "only 10").
    pub min_points: usize,
    /// A correlation from here on is high. Assumption: the threshold for edgels of a line match (B99 3.2).
    pub high_correlation: f64,
    /// Least share of points of interest with a high correlation in a valid view. B99 4.1: "at
    /// least a threshold number"; Assumption: a share, because the number of points varies widely.
    pub min_high_share: f64,
    /// Least number of valid views besides the reference. Assumption: a single pair has nothing to
    /// confirm it.
    pub min_valid_views: usize,
    /// Least peak. B99 figure 12: `Sim(theta_max) >= 0.4`.
    pub min_similarity: f64,
    /// Least curvature at the peak, per radian squared. B99 figure 12: `|Sim''| >= 4.0`.
    pub min_curvature: f64,
    /// Least amplitude. B99 figure 12: `Sim(theta_max) - Sim(theta_min) >= 0.2`.
    pub min_amplitude: f64,
}

impl Default for SweepParams {
    fn default() -> Self {
        Self {
            max_theta_deg: 75.0,
            first_step_deg: 5.0,
            last_step_deg: 1.0,
            max_peaks: 2,
            window_px: 15,
            depth_px: 40.0,
            depth_m: 6.0,
            margin_px: 1.5,
            min_length_px: 15.0,
            poi_blur_px: 1.0,
            poi_min_gradient: 0.004,
            poi_spacing_px: 3,
            min_points: 10,
            high_correlation: 0.6,
            min_high_share: 0.2,
            min_valid_views: 2,
            min_similarity: 0.4,
            min_curvature: 4.0,
            min_amplitude: 0.2,
        }
    }
}

/// B99 4.2, 4.3: from half-planes to facets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RoofParams {
    /// Half-planes within this angle, degrees, may share a plane. B99 4.4: theta is known to 2 degrees
    /// on textured faces and to 5 on weak ones; two of them may differ by somewhat more than either.
    pub coplanar_angle_deg: f64,
    /// Least distance within which a line counts as lying in a plane, metres. Assumption: eaves have
    /// gutters and ridges have caps of about this size.
    pub coplanar_distance_m: f64,
    /// A facet may reach at least this far from its supporting line, metres. Assumption.
    pub min_facet_depth_m: f64,
    /// ... and at most this far, metres. Assumption: larger facets have lines on both sides.
    pub max_facet_depth_m: f64,
    /// Lines are extended by at least this much at both ends to meet others, metres (B99 figure 22). Assumption.
    pub extension_m: f64,
    /// Correlation at which a plane is as good as no plane. Assumption: half-way between what true planes and
    /// chance reach; B99 accepts half-planes from `Sim = 0.4` on.
    pub min_correlation: f64,
    /// What a metre of facet border costs that no line supports, in square metres of mismatch. Assumption.
    pub border_cost_m: f64,
    /// What a metre of line earns whose half-plane is honoured, in square metres of match. Assumption.
    pub half_plane_gain_m: f64,
    /// Facets smaller than this are not reported, square metres. Assumption.
    pub min_area_m2: f64,
    /// Least share of a facet's outline that lies on reconstructed lines (tau_real, B99 4.3). Assumption.
    pub min_real_ratio: f64,
    /// Facets whose middle is lower than this above the ground are not roofs, metres. Assumption: higher than
    /// cars, lower than garages.
    pub min_height_m: f64,
    /// Regularisation and refinement of the buildings.
    pub refine: RefineParams,
}

impl Default for RoofParams {
    fn default() -> Self {
        Self {
            coplanar_angle_deg: 8.0,
            coplanar_distance_m: 0.15,
            min_facet_depth_m: 5.0,
            max_facet_depth_m: 15.0,
            extension_m: 1.5,
            min_correlation: 0.45,
            border_cost_m: 0.25,
            half_plane_gain_m: 0.1,
            min_area_m2: 1.5,
            min_real_ratio: 0.25,
            min_height_m: 2.0,
            refine: RefineParams::default(),
        }
    }
}

/// B99 section 2 (the partner in Leuven): regularisation, and refinement by the reprojection error of the wireframe. The paper gives
/// no numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RefineParams {
    /// Refine at all?
    pub refine: bool,
    /// A side without a neighbour is sought again within this distance in its facet's plane, metres. Assumption: half a
    /// correlation window of the coarsest images, where delineation ends a facet without a line.
    pub search_m: f64,
    /// Ridges, hips and valleys are sought within this distance, px. Assumption: planes fix them.
    pub reach_px: f64,
    /// Shortest side that is measured, px. B99 3.2: the least length of segments is 15.
    pub min_side_px: f64,
    /// Least number of views that see a side. Assumption: in two, anything stands still.
    pub min_views: usize,
    /// Least step across a side in a profile of one pixel, grey range 1; it falls with the root of the profiles.
    /// Assumption: four standard deviations of noise.
    pub least_contrast: f64,
    /// What a border on the strongest edge earns, square metres for a metre. Assumption: what it saves in the labelling.
    pub edge_gain_m: f64,
    /// Correlation at which a plane is as good as no plane. Assumption: as in the labelling.
    pub min_correlation: f64,
    /// Sides shorter than this between longer ones are tried without, metres. Assumption: half a correlation window; what is nearer
    /// cannot be told apart.
    pub jog_m: f64,
    /// Standard deviation of a grey value, range 1. Assumption: an 8-bit camera and a good JPEG.
    pub noise: f64,
    /// Error of both ends of a measured edge that its scatter does not know, px. Assumption: fascias and gutters.
    pub floor_px: f64,
    /// Scale of the robust loss, standard deviations. Assumption.
    pub loss_sigmas: f64,
    /// Standard deviation of a corner in plan before it is measured, metres. Assumption.
    pub vertex_sigma_m: f64,
    /// Standard deviation of the heights of a facet at its corners, besides what its lines say, metres. Assumption.
    pub height_sigma_m: f64,
    /// Error of heights at a facet's lines that their covariance does not know, metres. Assumption: a third of the distance within
    /// which lines count as coplanar.
    pub height_floor_m: f64,
    /// Shortest side that takes part in relations, metres. Assumption: it has a direction.
    pub min_relation_m: f64,
    /// Relations are proposed for sides and slopes within this angle of them, degrees. Assumption.
    pub near_deg: f64,
    /// ... and for eaves within this height of each other, metres. Assumption.
    pub near_m: f64,
    /// How exactly real buildings keep to relations, metres. Assumption: what carpenters and masons do.
    pub relation_sigma_m: f64,
    /// Largest chi-square (one degree of freedom) at which a relation is adopted. Assumption: refuses one true one in a hundred.
    pub relation_chi2: f64,
    /// Distances beyond this count as this in the reprojection error, px.
    pub cap_px: f64,
    /// Least number of measured edges in a building. Assumption: two sides in three views.
    pub min_sightings: usize,
    /// Most unknowns of a building; larger ones keep their shape. Assumption: seconds of one core.
    pub max_unknowns: usize,
    /// A facet that ends at another one higher or lower is looked at over this distance from there: it may end earlier, and what
    /// lies between is the ground, metres. Assumption: the width of an alley.
    pub part_m: f64,
    /// ... but not over less than this, metres. Assumption: overhangs and gutters.
    pub least_part_m: f64,
    /// Least gain for ending it earlier, square metres for a metre of side. Assumption: the error of a correlation (0.05) over a
    /// metre.
    pub part_gain_m: f64,
    /// ... and for a square metre that is given up. Assumption: twice the error of a correlation; shadow at the foot of a wall
    /// costs a roof hardly that.
    pub part_gain_share: f64,
    /// What a border costs that no edge supports, square metres for a metre. Assumption: as in the labelling.
    pub border_cost_m: f64,
    /// How much the mean correlation inside the facets may fall. Assumption: its error.
    pub similarity_loss: f64,
}

impl Default for RefineParams {
    fn default() -> Self {
        Self {
            refine: true,
            search_m: 0.7,
            reach_px: 2.0,
            min_side_px: 15.0,
            min_views: 3,
            least_contrast: 0.04,
            edge_gain_m: 0.2,
            min_correlation: 0.45,
            jog_m: 0.5,
            noise: 0.006,
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
            min_sightings: 6,
            max_unknowns: 6000,
            part_m: 3.0,
            least_part_m: 0.4,
            part_gain_m: 0.05,
            part_gain_share: 0.1,
            border_cost_m: 0.25,
            similarity_loss: 0.01,
        }
    }
}

/// Texture atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TextureParams {
    /// Largest side of the atlas, px. Assumption: what every WebGL 2 device can hold.
    pub max_atlas_px: u32,
    /// Side of a texel in pixels of the view that shows a face best. Assumption: 1, finer ones hold
    /// no more detail.
    pub texel_px: f64,
    /// Border around each patch, px, against bleeding. Assumption: 4, so that patches stay apart down to the
    /// second mipmap level.
    pub padding_px: u32,
    /// Quality of the atlas as JPEG, 1 to 100. Assumption: 90, where its blocks cannot be seen.
    pub jpeg_quality: u8,
}

impl Default for TextureParams {
    fn default() -> Self {
        Self {
            max_atlas_px: 4096,
            texel_px: 1.0,
            padding_px: 4,
            jpeg_quality: 90,
        }
    }
}

/// W96: the object-space method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectSpaceParams {
    /// Regions and their lines.
    pub oris: OrisParams,
    /// Windows around buildings.
    pub windows: WindowParams,
    /// Main directions.
    pub directions: DirectionParams,
    /// Clusters of lines.
    pub clusters: ClusterParams,
    /// Planes.
    pub planes: PlaneParams,
}

/// W96 3.6: planes between parallel lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlaneParams {
    /// By how much the window of a plane is enlarged, metres. W96 3.6: "appr. 0.5 m".
    pub margin_m: f64,
    /// Steepest plane, degrees. Assumption: roofs, not walls.
    pub max_slope_deg: f64,
    /// Least distance of the two lines, metres. Assumption.
    pub min_width_m: f64,
    /// Largest distance of the two lines, metres. Assumption.
    pub max_width_m: f64,
    /// Planes whose middle is lower than this above the ground are no roofs, metres. Assumption.
    pub min_height_m: f64,
    /// Shortest stretch across the plane that a crossing image line covers, metres. Assumption.
    pub min_crossing_m: f64,
    /// A crossing within this of a right angle is one, degrees. Assumption.
    pub angle_deg: f64,
    /// Crossings within this along the lines are one end, metres. Assumption.
    pub position_m: f64,
    /// Most ends of a pair of lines that are tried. W96: two. Assumption.
    pub max_ends: usize,
    /// Most candidates kept of a pair of lines. Assumption.
    pub max_candidates: usize,
    /// Least share of an outline that image lines cover, mean over the views, for it to be looked at. Assumption.
    pub min_support: f64,
    /// Support at which a side speaks neither for nor against a plane. Assumption.
    pub least_support: f64,
    /// Least correlation of the views on a plane. Assumption: unrelated textures reach 0.45, since only the better half of all pairs of
    /// views counts.
    pub least_correlation: f64,
    /// Planes that fall behind those beside them by more are refused whatever their sides say. Assumption: twice the error of
    /// the comparison on weak texture.
    pub min_rise: f64,
    /// By how much the views agree better on a plane than beside it where an area speaks neither for nor against. Assumption: the
    /// error of the comparison on weak texture, so that the sides decide there.
    pub least_rise: f64,
    /// A plane is compared with those above and below it at a distance that moves the images against each other by this, px.
    /// Assumption: more than the error of a true plane, less than the windows.
    pub beside_px: f64,
    /// What a metre of side weighs against a square metre of area, metres. Assumption.
    pub side_weight_m: f64,
    /// What a plane costs, square metres. Assumption: two planes must explain more than one by this.
    pub plane_cost_m2: f64,
    /// What an end costs that is not at right angles, square metres. Assumption: it has a parameter more.
    pub slant_cost_m2: f64,
    /// Least measure, square metres. W96 accepts any best plane, and proposes "thresholding the measure". Assumption.
    pub min_measure_m2: f64,
    /// Smallest plane, square metres. Assumption.
    pub min_area_m2: f64,
}

impl Default for PlaneParams {
    fn default() -> Self {
        Self {
            margin_m: 0.5,
            max_slope_deg: 65.0,
            min_width_m: 1.2,
            max_width_m: 25.0,
            min_height_m: 2.0,
            min_crossing_m: 0.8,
            angle_deg: 3.0,
            position_m: 0.3,
            max_ends: 8,
            max_candidates: 4,
            min_support: 0.25,
            least_support: 0.3,
            least_correlation: 0.5,
            min_rise: -0.1,
            least_rise: -0.05,
            beside_px: 3.0,
            side_weight_m: 0.5,
            plane_cost_m2: 1.0,
            slant_cost_m2: 1.5,
            min_measure_m2: 1.0,
            min_area_m2: 3.0,
        }
    }
}

/// W96 3.1: where buildings are. The paper assumes it known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowParams {
    /// Buildings' boxes x0, y0, x1, y1, metres in the frame of the orientation; found where there are none.
    pub given_m: Vec<[f64; 4]>,
    /// Heights between which lines are sought, metres in the frame of the orientation; estimated where `None`.
    pub z_range_m: Option<[f64; 2]>,
    /// Side of the tiles in which buildings are sought, metres. Assumption: a house with what stands around it.
    pub tile_m: f64,
    /// Lines of a building are linked over this distance in plan, metres. Assumption: the depth of a facet; closer than
    /// most houses stand.
    pub link_m: f64,
    /// The window reaches beyond the lines by this, metres. Assumption: lines that were not found.
    pub margin_m: f64,
}

impl Default for WindowParams {
    fn default() -> Self {
        Self {
            given_m: Vec::new(),
            z_range_m: None,
            tile_m: 24.0,
            link_m: 6.0,
            margin_m: 4.0,
        }
    }
}

/// W96 3.4: main directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DirectionParams {
    /// Most pairs of directions in a window. W96 has one. Assumption: a few, for neighbours that stand askew.
    pub max_pairs: usize,
    /// Least share of the weight of all lines that follows a pair. Assumption: chance gives 4 of 90 degrees, 5 %.
    pub min_share: f64,
    /// A line within this of a direction follows it, degrees. Assumption.
    pub tolerance_deg: f64,
    /// Pairs are at least so far apart, degrees. Assumption.
    pub apart_deg: f64,
}

impl Default for DirectionParams {
    fn default() -> Self {
        Self {
            max_pairs: 3,
            min_share: 0.12,
            tolerance_deg: 2.0,
            apart_deg: 6.0,
        }
    }
}

/// W96 3.5: clusters of lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClusterParams {
    /// An image line within this of a main direction belongs to it, degrees. Assumption.
    pub angle_deg: f64,
    /// ... or within what this displacement of an end does to its direction, px. Assumption.
    pub end_px: f64,
    /// Image lines within this distance support a 3D line, px. Assumption: three standard deviations.
    pub gate_px: f64,
    /// Standard deviation of an image line, px. Assumption: the precision of region boundaries.
    pub sigma_px: f64,
    /// Intersections nearer than this are one, metres. Assumption.
    pub cell_m: f64,
    /// Largest difference of the grey values on one side at least, grey range 1. Assumption; W96 4 proposes to use radiometry here.
    pub max_grey_difference: f64,
    /// Least number of views. W96 3.5: all views, "too restrictive, due to possible occlusion". Assumption: three.
    pub min_views: usize,
    /// A view that covers less of a line does not count. Assumption.
    pub min_coverage: f64,
    /// What an image line costs on its own, bits. Assumption: one of 64 positions.
    pub position_bits: f64,
    /// What a 3D line costs, bits. Assumption: one of 16 x 16 places beside those that others leave.
    pub line_bits: f64,
    /// What it costs that a view misses a line, bits. Assumption.
    pub miss_bits: f64,
    /// Gaps up to this length are bridged, metres. Assumption: a chimney or a tree top.
    pub max_gap_m: f64,
    /// Shortest line, metres. Assumption.
    pub min_length_m: f64,
}

impl Default for ClusterParams {
    fn default() -> Self {
        Self {
            angle_deg: 2.5,
            end_px: 1.5,
            gate_px: 1.2,
            sigma_px: 0.4,
            cell_m: 0.15,
            max_grey_difference: 0.08,
            min_views: 3,
            min_coverage: 0.25,
            position_bits: 6.0,
            line_bits: 8.0,
            miss_bits: 1.0,
            max_gap_m: 4.0,
            min_length_m: 1.0,
        }
    }
}

/// W96 3.3: region segmentation. W96 gives no numbers ("Wiman 1995").
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OrisParams {
    /// Standard deviation of the blur before gradients are taken, px. Assumption: 0.8, as for edgels.
    pub smoothing_px: f64,
    /// What a vector costs, bits. Assumption: its end is one of 64 x 64 positions relative to its start.
    pub vector_bits: f64,
    /// Pixels that make one independent grey value. Assumption: resampling and compression tie neighbours together.
    pub pixels_per_sample: f64,
    /// Weight of each of the two colour differences beside grey. Assumption: they are smoother, and JPEG stores them at half the
    /// resolution.
    pub color_weight: f64,
    /// Least standard deviation of the grey values of a region, grey levels of 255. Assumption: sensor and JPEG.
    pub least_sigma: f64,
    /// Shortest vector that is measured as a line, px. Assumption: half of B99's shortest segment.
    pub min_line_px: f64,
    /// Least contrast of a line, grey range 1. Assumption: three grey levels of 255.
    pub min_contrast: f64,
    /// Largest root mean square distance of the gradient's crest from the line, px; otherwise the vector itself is taken. Assumption.
    pub max_rms_px: f64,
}

impl Default for OrisParams {
    fn default() -> Self {
        Self {
            smoothing_px: 0.8,
            vector_bits: 12.0,
            pixels_per_sample: 1.7,
            color_weight: 0.5,
            least_sigma: 1.5,
            min_line_px: 8.0,
            min_contrast: 0.012,
            max_rms_px: 0.8,
        }
    }
}
