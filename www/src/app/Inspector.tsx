/** The picked thing in numbers, with units and the paper's symbols. */
import { LINE_STRIDE, SEGMENT_STRIDE, SUPPORT_KINDS, SUPPORT_STRIDE, type Vec3 } from "../shared/results";
import type { Selection } from "../shared/selection";
import { params, results, scene, selection } from "./state";

type Row = readonly [label: string, value: string];

export function Inspector() {
  const picked = selection.value;
  return (
    <section class="panel" data-testid="inspector">
      <div class="row spread">
        <h2>Inspector</h2>
        {picked !== null && (
          <button
            type="button"
            class="quiet"
            onClick={() => {
              selection.value = null;
            }}
          >
            Clear
          </button>
        )}
      </div>
      {picked === null ? (
        <p class="muted">Click a segment, a line, a half-plane, a facet or a wall to see its numbers.</p>
      ) : (
        <Facts title={titleOf(picked)} rows={rowsOf(picked)} />
      )}
    </section>
  );
}

function Facts({ title, rows }: { title: string; rows: readonly Row[] }) {
  return (
    <>
      <h3 class="picked">{title}</h3>
      <dl class="facts">
        {rows.map(([label, value]) => (
          <div key={label}>
            <dt>{label}</dt>
            <dd class="numbers">{value}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

function titleOf(picked: Selection): string {
  switch (picked.kind) {
    case "segment":
      return `Segment ${picked.index} of ${viewName(picked.view)}`;
    case "line":
      return `3D line ${picked.index}`;
    case "halfplane":
      return `Half-plane ${picked.index}`;
    case "facet":
      return `Facet ${picked.index}`;
    case "surface":
      return picked.surface.charAt(0).toUpperCase() + picked.surface.slice(1);
    case "view":
      return `View ${viewName(picked.index)}`;
  }
}

function rowsOf(picked: Selection): Row[] {
  switch (picked.kind) {
    case "segment":
      return segmentRows(picked.view, picked.index);
    case "line":
      return lineRows(picked.index);
    case "halfplane":
      return halfPlaneRows(picked.index);
    case "facet":
      return facetRows(picked.index);
    case "surface":
      return surfaceRows(picked);
    case "view":
      return viewRows(picked.index);
  }
}

function segmentRows(view: number, index: number): Row[] {
  const data = results.value.segments[view];
  const at = index * SEGMENT_STRIDE;
  if (data === undefined || at + SEGMENT_STRIDE > data.length) {
    return [];
  }
  const [x0, y0, x1, y1] = [...data.subarray(at, at + SEGMENT_STRIDE)] as [number, number, number, number];
  return [
    ["Length", `${Math.hypot(x1 - x0, y1 - y0).toFixed(1)} px`],
    ["Start", `${x0.toFixed(2)}, ${y0.toFixed(2)} px`],
    ["End", `${x1.toFixed(2)}, ${y1.toFixed(2)} px`],
    ["Direction", `${degrees(Math.atan2(y1 - y0, x1 - x0))} (y down)`],
  ];
}

function lineRows(index: number): Row[] {
  const { lines } = results.value;
  const rows: Row[] = [];
  const at = index * LINE_STRIDE;
  if (lines !== null && at + LINE_STRIDE <= lines.length) {
    const p0 = [...lines.subarray(at, at + 3)] as unknown as Vec3;
    const p1 = [...lines.subarray(at + 3, at + 6)] as unknown as Vec3;
    const [dx, dy, dz] = [p1[0] - p0[0], p1[1] - p0[1], p1[2] - p0[2]];
    const plan = Math.hypot(dx, dy);
    rows.push(
      ["Length", `${Math.hypot(plan, dz).toFixed(2)} m`],
      ["Slope", degrees(Math.atan2(dz, plan))],
      ["Azimuth", azimuth(dx, dy)],
      ["Start", worldText(p0)],
      ["End", worldText(p1)],
      ["Half-planes", String(results.value.halfPlanes?.filter(({ line }) => line === index).length ?? "–")],
    );
  }
  results.value.supports.forEach((supports, view) => {
    for (let i = 0; i + SUPPORT_STRIDE <= supports.length; i += SUPPORT_STRIDE) {
      if (supports[i + 5] === index) {
        rows.push([viewName(view), SUPPORT_KINDS[supports[i + 4] as number] ?? ""]);
      }
    }
  });
  return rows;
}

function halfPlaneRows(index: number): Row[] {
  const plane = results.value.halfPlanes?.[index];
  if (plane === undefined) {
    return [];
  }
  const sigma = plane.sigma_theta === undefined ? "" : ` ± ${degrees(plane.sigma_theta)}`;
  return [
    ["3D line", `${plane.line}, ${plane.side} side`],
    ["θ", `${degrees(plane.theta)}${sigma}`],
    ["Sim(θ)", `${plane.similarity.toFixed(3)}${threshold("min_similarity")}`],
    ["Curvature |Sim″|", `${plane.curvature.toFixed(1)}${threshold("min_curvature")}`],
    ["Amplitude", `${plane.amplitude.toFixed(3)}${threshold("min_amplitude")}`],
    ["Slope of the plane", slopeText(plane.plane.normal)],
    ["Views", plane.views.map(viewName).join(", ")],
  ];
}

function facetRows(index: number): Row[] {
  const facet = results.value.facets?.[index];
  if (facet === undefined) {
    return [];
  }
  const [nx, ny] = facet.plane.normal;
  return [
    ["Building", String(facet.building)],
    ["Area", `${ringsArea(facet.outer, facet.holes, facet.plane.normal).toFixed(1)} m²`],
    ["Slope", slopeText(facet.plane.normal)],
    ["Faces", Math.hypot(nx, ny) < 0.02 ? "level" : azimuth(nx, ny)],
    ["Corners", String(facet.outer.length + facet.holes.flat().length)],
    ["Similarity", facet.similarity.toFixed(3)],
    ["τ real", facet.real_ratio === undefined ? "–" : facet.real_ratio.toFixed(2)],
    ["3D lines", String(facet.lines?.length ?? "–")],
    ["Half-planes", String(facet.half_planes?.length ?? "–")],
  ];
}

function surfaceRows(picked: Extract<Selection, { kind: "surface" }>): Row[] {
  const rows: Row[] = [["Area", `${picked.areaM2.toFixed(1)} m²`]];
  if (picked.building !== null) {
    rows.push(["Building", String(picked.building)]);
  }
  if (picked.facet !== null) {
    rows.push(
      ["Facet", String(picked.facet)],
      ...facetRows(picked.facet).filter(([label]) => !SHOWN.has(label)),
    );
  }
  return rows;
}

/** Rows of a facet that a surface shows by itself. */
const SHOWN = new Set(["Building", "Area"]);

function viewRows(index: number): Row[] {
  const view = scene.value?.views[index];
  return view === undefined
    ? []
    : [
        ["Size", `${view.width} × ${view.height} px`],
        ["Centre", worldText(view.center)],
      ];
}

function viewName(view: number): string {
  return scene.value?.views[view]?.name ?? `view ${view}`;
}

/** The acceptance threshold of the sweep, as the present parameters have it. */
function threshold(name: string): string {
  const value = params.value["sweep"]?.[name];
  return typeof value === "number" ? ` (≥ ${value})` : "";
}

/** A point of the local frame in the frame of the input. */
function worldText([x, y, z]: Vec3): string {
  const [ox, oy, oz] = scene.value?.origin ?? [0, 0, 0];
  return `${(x + ox).toFixed(2)}, ${(y + oy).toFixed(2)}, ${(z + oz).toFixed(2)} m`;
}

function degrees(radians: number): string {
  return `${((radians * 180) / Math.PI).toFixed(1)}°`;
}

/** Clockwise from north. */
function azimuth(east: number, north: number): string {
  return `${(((Math.atan2(east, north) * 180) / Math.PI + 360) % 360).toFixed(0)}° from north`;
}

function slopeText([x, y, z]: Vec3): string {
  return degrees(Math.atan2(Math.hypot(x, y), Math.abs(z)));
}

/** Sloped area: that of the plan over the cosine of the slope. */
function ringsArea(outer: readonly Vec3[], holes: readonly Vec3[][], normal: Vec3): number {
  const plan = Math.abs(planArea(outer)) - holes.reduce((sum, hole) => sum + Math.abs(planArea(hole)), 0);
  return plan / Math.max(1e-6, Math.abs(normal[2]));
}

function planArea(ring: readonly Vec3[]): number {
  return ring.reduce((sum, [x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length] as Vec3;
    return sum + (x * nextY - nextX * y) / 2;
  }, 0);
}
