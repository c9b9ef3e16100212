//! The stages of a reconstruction: one file each, in one table; those of W96 in `objectspace`.
//!
//! To add a stage: write its file after the pattern of any other (what it finds, then the `impl` of
//! [`StageDefinition`] with its name, the stages it needs, the parameters it reads, its sharded
//! maps, how it runs, how it is summarised, and which planes it proposes); add `mod` and a line at
//! its place in the table below; run `make golden`, which writes the table that the page reads.
//! On the page, what it is to fetch and show is a folder, `www/src/stages/<name>`. Everything else
//! follows from the table: the order, what is out of date after a change of parameters, what
//! workers are given, the reports. Which stages run follows from the sources of planes; a new
//! source is a line in `params/sources.rs`, too.
//!
//! Invariant: no file of a stage knows another one; they meet in [`Results`].

mod adjacency;
mod adjustment;
mod coplanar;
mod corrections;
mod dense;
mod facets;
mod ground;
mod groups;
mod half_planes;
mod lines;
mod matches;
mod model;
mod objectspace;
mod refinement;
mod segments;

use serde::de::DeserializeOwned;
use serde::{Serialize, Serializer};

use crate::base::execution::Sharded;
use crate::base::params::{Params, Source};
use crate::orienting::scene::Scene;
use crate::planes::grouping::ProposedPlane;

/// Makes the enumeration of the stages, the type of their results and the rows of the table.
macro_rules! stage_table {
    ($($(#[$doc:meta])* $stage:ident in $file:ident $(of $folder:ident)?: $needed_by:expr,)*) => {
        /// The stages of all sources of planes, in their order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Stage {
            $($(#[$doc])* $stage,)*
        }

        impl Stage {
            /// All of them, in their order.
            pub const ALL: &'static [Self] = &[$(Self::$stage,)*];
        }

        /// The results of the stages; `None` for what has not run.
        #[derive(Clone, Debug, Default)]
        pub struct Results {
            $($(#[$doc])* pub $file: Option<$($folder::)?$file::Found>,)*
        }

        impl Stage {
            pub(super) fn row(self) -> &'static Row {
                match self {
                    $(Self::$stage => {
                        use $($folder::)?$file::$stage as Definition;
                        const {
                            &Row {
                                name: Definition::NAME,
                                title: Definition::TITLE,
                                section: Definition::SECTION,
                                needed_by: $needed_by,
                                reads: Definition::READS,
                                needs: Definition::NEEDS,
                                proposes: Definition::PROPOSALS.is_some(),
                                takes_proposals: Definition::TAKES_PROPOSALS,
                                shard_maps: Definition::SHARD_MAPS,
                                shards_read_colours: Definition::SHARDS_READ_COLOURS,
                                run: |scene, params, results| {
                                    results.$file = Some(Definition::run(scene, params, results)?);
                                    Ok(())
                                },
                                summary: |scene, results| match &results.$file {
                                    Some(found) => Definition::summary(scene, found, results),
                                    None => Findings::default(),
                                },
                                proposed: |results| match (Definition::PROPOSALS, &results.$file) {
                                    (Some(proposals), Some(found)) => proposals(found),
                                    _ => Vec::new(),
                                },
                                is_found: |results| results.$file.is_some(),
                                discard: |results| results.$file = None,
                                pack: |results| {
                                    let pack = Definition::PACKING.map(|packing| packing.pack);
                                    let found = results.$file.as_ref();
                                    found.map(|found| pack.map_or_else(Vec::new, |pack| pack(found)))
                                },
                                unpack: |results, bytes| {
                                    let packing = Definition::PACKING;
                                    results.$file = packing.and_then(|p| (p.unpack)(bytes));
                                    results.$file.is_some()
                                },
                            }
                        }
                    })*
                }
            }
        }
    };
}

const RECTANGLES: fn(Source) -> bool = |source| source == Source::Rectangles;
const ALL: fn(Source) -> bool = |_| true;

// The order of the stages, the file of each, and the sources of planes that need it.
stage_table! {
    /// Straight image segments in every view (B99 3.2).
    Segments in segments: Source::is_of_lines,
    /// Segments matched over the views (B99 3.1 - 3.4).
    Matches in matches: Source::is_of_lines,
    /// Single views adjusted to the matched lines.
    Adjustment in adjustment: Source::is_of_lines,
    /// Regions with straight boundaries in every view, and the lines on these (W96 3.3).
    Regions in regions of objectspace: RECTANGLES,
    /// Windows and their main directions (W96 3.4).
    Directions in directions of objectspace: RECTANGLES,
    /// 3D lines by clustering (W96 3.5).
    Clusters in clusters of objectspace: RECTANGLES,
    /// 3D lines (B99 3.2).
    Lines in lines: Source::is_of_lines,
    /// The height of the ground.
    Ground in ground: ALL,
    /// Planes between parallel lines and the closed buildings below them (W96 3.6).
    Rectangles in rectangles of objectspace: RECTANGLES,
    /// Coplanar lines and their polygons (B99 2, 5).
    Coplanar in coplanar: |source| source == Source::Coplanar,
    /// Corners matched over the views, and the planes that they propose (B99 2).
    Adjacency in adjacency: |source| source == Source::Adjacency,
    /// Half-planes at the 3D lines (B99 4.1).
    HalfPlanes in half_planes: |source| source == Source::HalfPlanes,
    /// Planes from dense matching (B99 2).
    Dense in dense: |source| matches!(source, Source::Dense | Source::PointCloud),
    /// Groups of lines and half-planes, and the planes that compete for the plan (B99 4.2).
    Groups in groups: Source::is_of_lines,
    /// Roof facets and the closed buildings below them (B99 4.3).
    Facets in facets: Source::is_of_lines,
    /// The buildings refined by the edges of all views (B99 2).
    Refinement in refinement: Source::is_of_lines,
    /// What somebody corrects of the model by hand.
    Corrections in corrections: ALL,
    /// The textured model.
    Model in model: ALL,
}

/// What a stage found, and how.
#[derive(Clone, Debug)]
pub struct Outcome<V, T> {
    /// The result.
    pub value: V,
    /// How it came about, and why other things were rejected.
    pub trace: T,
}

impl<V, T> From<(V, T)> for Outcome<V, T> {
    fn from((value, trace): (V, T)) -> Self {
        Self { value, trace }
    }
}

/// How a source makes planes of what it found; `None` for a stage that is no source.
type Proposals<Found> = Option<fn(&Found) -> Vec<ProposedPlane>>;

/// How a part of a result becomes bytes.
pub(super) struct Packing<Found> {
    pack: fn(&Found) -> Vec<u8>,
    /// The result with that part alone; `None` where the bytes are not that.
    unpack: fn(&[u8]) -> Option<Found>,
}

impl<V: Serialize + DeserializeOwned, T: Default> Outcome<V, T> {
    /// The result without its trace.
    const VALUE: Packing<Self> = Packing {
        pack: |found| to_bytes(&found.value),
        unpack: |bytes| Some((from_bytes(bytes)?, T::default()).into()),
    };
}

/// Everything that is particular to one stage.
pub(super) trait StageDefinition {
    /// What it finds.
    type Found;

    /// The name in messages, reports, files and the session: one lower-case word.
    const NAME: &'static str;
    /// The name that the page shows.
    const TITLE: &'static str;
    /// Where the papers describe it; what it makes, where they do not.
    const SECTION: &'static str;
    /// The parameters that it reads, as paths of names; they may be groups.
    const READS: &'static [&'static str];
    /// The stages whose results it takes in, as far as they run.
    const NEEDS: &'static [Stage];
    /// Does it take in what all sources propose?
    const TAKES_PROPOSALS: bool = false;
    /// The planes that it proposes for roofs, where it is a source of them.
    const PROPOSALS: Proposals<Self::Found> = None;
    /// The part of its result that sharded maps of later stages read, where there are any.
    const PACKING: Option<Packing<Self::Found>> = None;
    /// Its sharded maps, in the order in which they are called.
    const SHARD_MAPS: &'static [&'static str] = &[];
    /// Do its sharded maps read the colours of the views, or grey values only?
    const SHARDS_READ_COLOURS: bool = false;

    /// Runs it on the results of the stages before.
    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Self::Found>;

    /// What it counted, and what the user should know.
    fn summary(scene: &Scene, found: &Self::Found, before: &Results) -> Findings;
}

/// What a stage has to say of its result.
#[derive(Default)]
pub(super) struct Findings {
    /// Counts by name; the most important first.
    pub counts: Vec<(&'static str, usize)>,
    /// What the user should know; each says what to do.
    pub warnings: Vec<String>,
}

/// The definition of a stage as a row of the table.
pub(super) struct Row {
    name: &'static str,
    title: &'static str,
    section: &'static str,
    needed_by: fn(Source) -> bool,
    pub reads: &'static [&'static str],
    needs: &'static [Stage],
    takes_proposals: bool,
    proposes: bool,
    proposed: fn(&Results) -> Vec<ProposedPlane>,
    shard_maps: &'static [&'static str],
    shards_read_colours: bool,
    pub run: fn(&Scene, &Params, &mut Results) -> Sharded<()>,
    pub summary: fn(&Scene, &Results) -> Findings,
    pub is_found: fn(&Results) -> bool,
    pub discard: fn(&mut Results),
    pub pack: fn(&Results) -> Option<Vec<u8>>,
    pub unpack: fn(&mut Results, &[u8]) -> bool,
}

impl Stage {
    /// What is left to do of a model that is there already.
    pub const WITHOUT_VIEWS: &'static [Self] = &[Self::Corrections, Self::Model];

    /// The stages that sources of planes need, in their order.
    pub fn of(sources: &[Source]) -> Vec<Self> {
        let is_needed = |stage: &Self| sources.iter().any(|&s| (stage.row().needed_by)(s));
        Self::ALL.iter().copied().filter(is_needed).collect()
    }

    /// The name in messages, reports and the session: one lower-case word.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The name that a person reads.
    pub fn title(self) -> &'static str {
        self.row().title
    }

    /// Where the papers describe it; what it makes, where they do not.
    pub fn section(self) -> &'static str {
        self.row().section
    }

    /// The stage of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|stage| stage.name() == name)
    }

    /// Its maps that instances of the core may divide between them, in the order in which they are
    /// called.
    pub fn shard_maps(self) -> &'static [&'static str] {
        self.row().shard_maps
    }

    /// Do these maps read the colours of the views, or grey values only?
    pub fn shards_read_colours(self) -> bool {
        self.row().shards_read_colours
    }

    /// The parameters that it reads, as paths of names.
    pub(super) fn reads(self) -> &'static [&'static str] {
        self.row().reads
    }

    /// The stages whose results it takes in, of those that sources need.
    pub(super) fn needs(self, sources: &[Source]) -> Vec<Self> {
        let row = self.row();
        let mut stages = Self::of(sources);
        stages.retain(|s| row.needs.contains(s) || row.takes_proposals && s.row().proposes);
        stages
    }
}

impl Results {
    /// The planes that the sources propose, in the order of their stages.
    fn proposals(&self) -> Vec<ProposedPlane> {
        let stages = Stage::ALL.iter();
        stages
            .flat_map(|stage| (stage.row().proposed)(self))
            .collect()
    }
}

impl Serialize for Stage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// The result of a stage before.
fn required<F>(found: &Option<F>) -> &F {
    found.as_ref().expect("stages run in their order")
}

/// Did the stage before find anything? Where it did not, it has warned already.
fn is_any<V, T>(outcome: &Option<Outcome<Vec<V>, T>>) -> bool {
    outcome.as_ref().is_some_and(|o| !o.value.is_empty())
}

fn warn_if(condition: bool, warning: &str) -> Vec<String> {
    condition.then(|| warning.to_owned()).into_iter().collect()
}

fn to_bytes<V: Serialize>(value: &V) -> Vec<u8> {
    postcard::to_stdvec(value).expect("results can be written to memory")
}

fn from_bytes<V: DeserializeOwned>(bytes: &[u8]) -> Option<V> {
    postcard::from_bytes(bytes).ok()
}
