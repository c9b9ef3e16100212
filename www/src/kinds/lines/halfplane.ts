/** A half-plane, found by Sim(theta) (B99 4.1). */
import { viewName } from "../../stages/figure";
import { fanRing } from "../../viewer/scene/fanRing";
import type { Kind } from "../parts/kind";
import { degreesText, links, linksWhere, slopeText } from "../parts/rows";
import { areas } from "../parts/shapes";
import { allSides } from "./side";

export default {
  title: "Half-plane",
  rows({ index }, about) {
    const { halfPlanes, grouping, facets } = about.results;
    const plane = halfPlanes?.[index];
    if (plane === undefined) {
      return [];
    }
    // The acceptance threshold of the sweep, as the present parameters have it.
    const threshold = (name: string) => {
      const value = about.params["sweep"]?.[name];
      return typeof value === "number" ? ` (≥ ${value})` : "";
    };
    const sigma = plane.sigma_theta === undefined ? "" : ` ± ${degreesText(plane.sigma_theta)}`;
    return [
      links("3D line", "line", [plane.line]),
      ["Side", plane.side],
      ["θ", `${degreesText(plane.theta)}${sigma}`],
      ["Sim(θ)", `${plane.similarity.toFixed(3)}${threshold("min_similarity")}`],
      ["Curvature |Sim″|", `${plane.curvature.toFixed(1)}${threshold("min_curvature")}`],
      ["Amplitude", `${plane.amplitude.toFixed(3)}${threshold("min_amplitude")}`],
      ["P(plane at θ)", `${plane.probability.toFixed(3)}${threshold("min_probability")}`],
      ["Slope of the plane", slopeText(plane.plane.normal)],
      ["Views", plane.views.map((view) => viewName(about, view)).join(", ")],
      linksWhere("Group", "group", grouping?.groups, ({ members }) =>
        members.some(({ half_plane }) => half_plane === index),
      ),
      linksWhere("Facets", "facet", facets, ({ half_planes }) => half_planes?.includes(index) === true),
    ];
  },
  siblings: (_, { results }) => allSides(results),
  shapes({ index }, { halfPlanes, lines }) {
    const plane = halfPlanes?.[index];
    return plane === undefined || lines === null ? [] : areas([fanRing(plane, lines)]);
  },
  lines: ({ index }, { halfPlanes }) => halfPlanes?.slice(index, index + 1).map(({ line }) => line) ?? [],
  question({ index }, { halfPlanes }) {
    const plane = halfPlanes?.[index];
    return plane === undefined ? null : { about: "side", line: plane.line, side: plane.side };
  },
} satisfies Kind<"halfplane">;
