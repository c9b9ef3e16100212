/** The profile along a vertical cut, drawn to one scale both ways, with heights and slopes. */
import type { ProfilePiece, Section } from "../../../viewer/tools/section";
import { axesOf, Chart, Fit, type Frame, type Scale } from "../../parts/charts";
import { degreesOf } from "../../parts/numberText";
import { scene } from "../../state/scene";

/** Labels nearer to each other than this are left out, units of the view box. */
const LABEL_SPACE = 40;
/** Steeper pieces are walls. */
const WALL = (85 * Math.PI) / 180;

export function SectionChart({ section }: { section: Section }) {
  const ground = scene.value?.origin[2] ?? 0;
  const heights = section.pieces.flatMap(({ from, to }) => [from[1], to[1]]);
  if (heights.length === 0) {
    return <p>Nothing between the two points is cut.</p>;
  }
  const [low, high] = [Math.min(...heights), Math.max(...heights)];
  const places = section.pieces.flatMap(({ from, to }) => [from[0], to[0]]);
  const reach = { min: Math.min(...places), max: Math.max(...places) };
  return (
    <>
      <Fit>
        {(frame) => (
          <Profile
            frame={frame}
            section={section}
            reach={reach}
            range={{ min: low + ground, max: high + ground }}
          />
        )}
      </Fit>
      <p class="numbers">
        {section.lengthM.toFixed(2)} m long, heights {(low + ground).toFixed(2)} to{" "}
        {(high + ground).toFixed(2)} m ({(high - low).toFixed(2)} m), one scale both ways
      </p>
    </>
  );
}

function Profile(of: { frame: Frame; section: Section; reach: Scale; range: Scale }) {
  const { frame, section } = of;
  const ground = scene.value?.origin[2] ?? 0;
  const [x, y] = oneScale(frame, of.reach, of.range);
  const [toX, toY] = axesOf(frame, x, y);
  const at = ([along, height]: readonly [number, number]) => [toX(along), toY(height + ground)] as const;
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="along the cut (m)"
      yTitle="height (m)"
      label={`Profile of ${section.lengthM.toFixed(1)} m`}
      testid="profile"
    >
      {section.pieces.map((piece) => {
        const [[x1, y1], [x2, y2]] = [at(piece.from), at(piece.to)];
        return <line key={`${x1} ${y1} ${x2} ${y2}`} class="profile" x1={x1} y1={y1} x2={x2} y2={y2} />;
      })}
      {slopeLabels(section.pieces, at).map(([text, lx, ly]) => (
        <text key={`${lx} ${ly}`} class="profile-slope" x={lx} y={ly} text-anchor="middle">
          {text}
        </text>
      ))}
      {heightLabels(section.pieces, at, ground).map(({ text, x: lx, y: ly, anchor }) => (
        <text key={`${lx} ${ly}`} class="profile-height" x={lx} y={ly} text-anchor={anchor}>
          {text}
        </text>
      ))}
    </Chart>
  );
}

/** The same number of units per metre both ways: slopes look as steep as they are. */
export function oneScale(frame: Frame, reach: Scale, range: Scale): [x: Scale, y: Scale] {
  const width = Math.max(1, frame.width - frame.left - frame.right);
  const height = Math.max(1, frame.height - frame.top - frame.bottom);
  const perM = Math.min(
    width / Math.max(1, 1.1 * (reach.max - reach.min)),
    height / Math.max(1, 1.3 * (range.max - range.min)),
  );
  const about = ({ min, max }: Scale, units: number) => ({
    min: (min + max - units / perM) / 2,
    max: (min + max + units / perM) / 2,
  });
  return [about(reach, width), about(range, height)];
}

type At = (point: readonly [number, number]) => readonly [number, number];
type Label = [text: string, x: number, y: number];

function slopeLabels(pieces: readonly ProfilePiece[], at: At): Label[] {
  return pieces.flatMap(({ from, to, slope }): Label[] => {
    const [[x1, y1], [x2, y2]] = [at(from), at(to)];
    // The level base of a building needs no slope, and its heights stand there.
    if (Math.abs(slope) > WALL || x2 - x1 < LABEL_SPACE || to[1] === from[1]) {
      return [];
    }
    return [[`${degreesOf(slope).toFixed(1)}°`, (x1 + x2) / 2, (y1 + y2) / 2 + 14]];
  });
}

/** Below what is lowest, beside what rises away from it, else above: no label lies on the profile. */
interface HeightLabel {
  text: string;
  x: number;
  y: number;
  anchor: "start" | "middle" | "end";
}

const FLAT_M = 0.1;

/** Heights at the ends of the pieces, the highest first, as far as there is room. */
function heightLabels(pieces: readonly ProfilePiece[], at: At, ground: number): HeightLabel[] {
  const lowest = Math.min(...pieces.flatMap(({ from, to }) => [from[1], to[1]]));
  const ends = pieces
    .filter(({ slope }) => Math.abs(slope) <= WALL)
    .flatMap(({ from, to }) => {
      const rise = to[1] - from[1];
      return [
        { end: from, anchor: rise > FLAT_M ? ("end" as const) : ("middle" as const) },
        { end: to, anchor: rise < -FLAT_M ? ("start" as const) : ("middle" as const) },
      ];
    });
  const labels: HeightLabel[] = [];
  for (const { end, anchor } of ends.sort((p, q) => q.end[1] - p.end[1])) {
    const [x, corner] = at(end);
    const isLowest = end[1] - lowest < FLAT_M;
    const y = isLowest ? corner + 14 : corner - 5;
    if (labels.every((label) => Math.abs(label.x - x) > LABEL_SPACE || Math.abs(label.y - y) > 15)) {
      labels.push({ text: (end[1] + ground).toFixed(2), x, y, anchor: isLowest ? "middle" : anchor });
    }
  }
  return labels;
}
