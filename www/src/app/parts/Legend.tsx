/** What the colours of the present tab mean. */
import type { Tab } from "../state/methods";
import { tab, withRejected } from "../state/viewState";

const ENTRIES: Partial<Record<Tab, readonly (readonly [string, string])[]>> = {
  segments: [["unmatched", "segment"]],
  matches: [
    ["unmatched", "unmatched"],
    ["matched", "matched"],
    ["merged", "merged"],
    ["grown", "grown"],
  ],
  lines: [
    ["matched", "matched"],
    ["grown", "from regions"],
    ["border-intersection", "intersection"],
    ["border-inplane", "border"],
    ["rejected", "contradicted"],
  ],
  halfplanes: [
    ["matched", "3D line"],
    ["half-plane", "half-plane"],
    ["rejected", "rejected side"],
  ],
  groups: [
    ["bar", "line found in a plane"],
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
    ["bar", "side in an adopted relation"],
    ["rejected", "rejected; gap in the outline"],
  ],
};

export function Legend() {
  const rejected = tab.value === "segments" && withRejected.value ? [["rejected", "rejected"] as const] : [];
  const entries = [...(ENTRIES[tab.value] ?? []), ...rejected];
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
