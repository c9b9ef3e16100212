/** What the colours of the present tab mean. */
import type { LineOrigin } from "../../shared/records";
import { CLASSES, type ClassName, likeliestClass } from "../../shared/surfaceClass";
import { CERTAIN } from "../../viewer/scene/certainty";
import type { Tab } from "../state/methods";
import { results } from "../state/results";
import { beforeGrowing, tab, withRejected } from "../state/viewState";

type Entry = readonly [colour: string, meaning: string];

const ENTRIES: Partial<Record<Tab, readonly Entry[]>> = {
  segments: [["unmatched", "segment"]],
  matches: [
    ["unmatched", "unmatched"],
    ["matched", "matched"],
    ["merged", "merged"],
    ["grown", "grown"],
  ],
  coplanar: [
    ["grown", "dashed: hull of the lines"],
    ["set", "polygon; one colour a set"],
    ["unmatched", "thin: not verified"],
  ],
  adjacency: [
    ["matched", "edge of a corner in space"],
    ["unmatched", "edge seen in one view"],
    ["set", "region; plane of regions"],
  ],
  groups: [
    ["border-inplane", "line found in a plane"],
    ["unmatched", "thin: no facet"],
  ],
  directions: [
    ["first-direction", "first direction"],
    ["second-direction", "second direction"],
    ["unmatched", "neither"],
  ],
  clusters: [
    ["unmatched", "region boundary"],
    ["matched", "3D line"],
  ],
  rectangles: [
    ["normals", "hue: azimuth, saturation: slope"],
    ["plane-end", "end of a plane"],
  ],
  facets: [["normals", "hue: azimuth, saturation: slope"]],
  refinement: [
    ["grown", "outline before refinement"],
    ["border-inplane", "side in an adopted relation"],
    ["rejected", "rejected; gap in the outline"],
  ],
};

const LINE_ENTRIES: readonly (readonly [LineOrigin, string, string])[] = [
  ["matched", "matched", "matched"],
  ["clustered", "grown", "from regions"],
  ["intersection", "border-intersection", "intersection"],
  ["border", "border-inplane", "border"],
];

/** The kinds of 3D lines that there are. */
function lineEntries(): Entry[] {
  if (results.value.records.length === 0 || (tab.value === "lines" && beforeGrowing.value)) {
    return [["matched", "matched"]];
  }
  const origins = new Set(standingLines().map(({ origin }) => origin));
  return LINE_ENTRIES.filter(([origin]) => origins.has(origin)).map(([, ...entry]) => entry);
}

function hasContradicted(): boolean {
  return results.value.records.some(({ contradiction }) => contradiction != null);
}

const isUncertain = ({ probability = 1 }: { probability?: number }) => probability < CERTAIN;

/** Only where something is faint. */
function faintEntry(things: readonly { probability?: number }[] | null): Entry[] {
  return things?.some(isUncertain) === true ? [["faint", "faint: less certain"]] : [];
}

/** Lines that are drawn as certain as they are. */
function standingLines() {
  return results.value.records.filter(({ contradiction }) => contradiction == null);
}

/** The classes that there are, and whether there are patches in no plane. */
function denseEntries(): Entry[] {
  const { planes, trace } = results.value.dense ?? { planes: [], trace: null };
  const found = planes.map((plane) => likeliestClass(plane.class));
  const names = new Set<ClassName>(found.map(({ name }) => name));
  const inPlanes = planes.reduce((sum, { patches }) => sum + patches.length, 0);
  return [
    ...CLASSES.filter((name) => names.has(name)).map((name): Entry => [`class-${name}`, name]),
    ...((trace?.patches.length ?? 0) > inPlanes ? [["unmatched", "small: in no plane"] as const] : []),
    ...faintEntry(found),
  ];
}

/** What is drawn now: an entry without anything in its colour would be looked for. */
export function presentEntries(): readonly Entry[] {
  switch (tab.value) {
    case "lines":
      return beforeGrowing.value
        ? lineEntries()
        : [
            ...lineEntries(),
            ...faintEntry(standingLines()),
            ...(hasContradicted() ? [["rejected", "contradicted"] as const] : []),
          ];
    case "halfplanes":
      return [
        ...lineEntries().map(([colour, what]): Entry => [colour, what === "matched" ? "3D line" : what]),
        ...faintEntry(standingLines()),
        ["half-plane", "half-plane"],
        ["rejected", hasContradicted() ? "rejected side, contradicted line" : "rejected side"],
      ];
    case "dense":
      return denseEntries();
    case "segments":
      return [
        ...(ENTRIES.segments ?? []),
        ...(withRejected.value ? [["rejected", "rejected"] as const] : []),
      ];
    case "facets":
    case "refinement":
      return [...(ENTRIES[tab.value] ?? []), ...faintEntry(results.value.facets)];
    default:
      return ENTRIES[tab.value] ?? [];
  }
}

export function Legend() {
  const entries = presentEntries();
  if (entries.length === 0) {
    return null;
  }
  return (
    <ul class="legend" aria-label="Colours">
      {entries.map(([colour, meaning]) => (
        <li key={meaning}>
          <span class={`swatch ${colour}`} aria-hidden="true" />
          {meaning}
        </li>
      ))}
    </ul>
  );
}
