/** Groups of coplanar half-planes. */
import { planeOf } from "../../app/results/takeAlong/rows";
import type { PlaneGroup } from "../../shared/records";
import { highest } from "../highest";
import type { StageFigure } from "../stageFigure";
import { GroupLab } from "./GroupLab";

const halfPlanesOf = ({ members }: PlaneGroup) =>
  members.filter(({ half_plane }) => half_plane !== null).length;

export default {
  title: "Grouping",
  source: "B99 4.2, figures 16 to 20",
  text: "Collinear lines with a common [[half-plane]] are joined; neighbours that lie in one plane within its uncertainty form a group, which gets a new plane by regression over points X of all its lines. The Delaunay triangulation constrained to the projected lines decides which lines are neighbours. In each plane, further lines are found where segments of several views coincide.",
  equation: ["vec n ^T vec X + d ≈ 0"],
  hint: "Pick a group: its lines light up in space and in every view. Green: lines found in a plane.",

  rows: ({ results: { grouping } }) =>
    (grouping?.groups ?? []).map((found, group) => ({
      group,
      ...planeOf(found.plane),
      lines: new Set(found.members.map(({ line }) => line)).size,
      half_planes: halfPlanesOf(found),
    })),
  Lab: GroupLab,
  legend: () => [
    ["border-inplane", "line found in a plane"],
    ["unmatched", "thin: no facet"],
  ],
  kinds: {
    groups: {
      View: GroupLab,
      begin: ({ results: { grouping } }) => highest("group", grouping?.groups, halfPlanesOf),
    },
  },
} satisfies StageFigure;
