/** The stages: a folder each. To add one, add its folder and its line here; the types of results and tabs follow. */
import type { StageName } from "../shared/stages";
import { adjacency } from "./adjacency/stage";
import { adjustment } from "./adjustment/stage";
import { clusters } from "./clusters/stage";
import { coplanar } from "./coplanar/stage";
import { corrections } from "./corrections/stage";
import { dense } from "./dense/stage";
import { directions } from "./directions/stage";
import { facets } from "./facets/stage";
import { ground } from "./ground/stage";
import { groups } from "./groups/stage";
import { halfplanes } from "./halfplanes/stage";
import { images } from "./images/stage";
import { lines } from "./lines/stage";
import { matches } from "./matches/stage";
import { model } from "./model/stage";
import { rectangles } from "./rectangles/stage";
import { refinement } from "./refinement/stage";
import { regions } from "./regions/stage";
import { segments } from "./segments/stage";
import type { ResultSource, Stage } from "./stage";

const LIST = {
  images,
  segments,
  matches,
  adjustment,
  regions,
  directions,
  clusters,
  rectangles,
  lines,
  ground,
  coplanar,
  adjacency,
  halfplanes,
  dense,
  groups,
  facets,
  refinement,
  corrections,
  model,
} satisfies Record<StageName | "images", Stage>;

type All = typeof LIST;

/** Views of the stages, and beside them the photographs. */
export type Tab = { [K in keyof All]: All[K] extends { shownBy: string } ? never : K }[keyof All];

type Slots = { [K in keyof All]: All[K] extends { nothing: infer Own } ? Own : never }[keyof All];
type AllOf<Union> = (Union extends unknown ? (one: Union) => void : never) extends (all: infer Every) => void
  ? Every
  : never;

/** What the stages have returned so far; arrays per view are empty until their stage has run. */
export type Results = AllOf<Slots>;

/** What is fetched fits the slots. */
type Listed = Omit<Stage, "fetch"> & { fetch?(from: ResultSource): Promise<Partial<Results>> };

export const STAGE_FACTS: Readonly<Record<keyof All, Listed>> = LIST;

export const NO_RESULTS: Results = Object.assign(
  {},
  ...Object.values(STAGE_FACTS).map(({ nothing }) => nothing),
);

/** What a stage adds to the results. */
export async function fetchResults(stage: StageName, from: ResultSource): Promise<Partial<Results>> {
  return (await STAGE_FACTS[stage].fetch?.(from)) ?? {};
}
