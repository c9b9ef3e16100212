/** Lesson 8: how half-planes become the faces of a roof. */
import { type Signal, signal } from "@preact/signals";
import { clamp, DEGREE, planArea, rectangle } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import { Dot, Drawing, Handle, inMetres, Label, Line, Shape, Slider } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, metres, num } from "../parts/say";
import { realFigure } from "../scene/RealFigure";
import { facetOf, heightOf, PLAN, ridgeOf, SIDES, type SideName } from "../toy/roofs";

const south = signal(30 * DEGREE);
const north = signal(45 * DEGREE);
const CUT = inMetres(480, 300, 34, [104, 210]);
const inCut = (across: number, z: number): Vec2 => CUT.at(across, z - PLAN.eave);
const ACROSS = 2 * PLAN.width;
const ARM_M = 7;

function RidgeFigure({ isRevealed }: { isRevealed: boolean }) {
  const { inwards: at, z } = ridgeOf(south.value, north.value);
  const ridge = isRevealed ? inCut(at, z) : null;
  return (
    <Drawing width={CUT.width} height={CUT.height} label="Two half-planes from their eaves, cut across">
      <Eave side="south" of={south} ridge={ridge} />
      <Eave side="north" of={north} ridge={ridge} />
      {ridge !== null && <Dot at={ridge} class="s4" />}
      {ridge !== null && <Label at={ridge} dy={-12} anchor="middle" class="s4" text={metres(z)} />}
    </Drawing>
  );
}

/** A wall with its half-plane: a stump of it, or all of it where the ridge is known. */
function Eave({ side, of, ridge }: { side: "south" | "north"; of: Signal<number>; ridge: Vec2 | null }) {
  const [across, sign] = side === "south" ? [0, 1] : [ACROSS, -1];
  const foot = inCut(across, PLAN.eave);
  const along = (m: number) =>
    inCut(across + sign * m * Math.cos(of.value), PLAN.eave + m * Math.sin(of.value));
  return (
    <>
      <Line from={foot} to={inCut(across, 3)} class="rule" />
      {ridge === null ? (
        <Line from={foot} to={along(1.6 / Math.cos(of.value))} class="s6 thick" />
      ) : (
        <>
          <Line from={foot} to={along(ARM_M)} class="s6 dashed" />
          <Line from={foot} to={ridge} class="s4 thick" />
          <Handle
            at={along(ARM_M)}
            class="s6"
            label={`Slope of the ${side} half-plane`}
            says={degrees(of.value)}
            value={of.value / DEGREE}
            of={of}
            to={([x, y]) => clamp(Math.atan2(foot[1] - y, sign * (x - foot[0])), 8 * DEGREE, 70 * DEGREE)}
          />
        </>
      )}
      <Label
        at={foot}
        dx={-10 * sign}
        dy={-8}
        anchor={side === "south" ? "end" : "start"}
        class="s6"
        text={degrees(of.value)}
      />
    </>
  );
}

const slopes = signal<Record<SideName, number | null>>({
  south: 35 * DEGREE,
  east: 35 * DEGREE,
  north: 35 * DEGREE,
  west: 50 * DEGREE,
});
const VIEW = inMetres(480, 300, 24, [240, 150]);
const inPlan = ([x, y]: readonly [number, number]): Vec2 => VIEW.at(x, y);
const slopeText = (side: SideName) => {
  const own = slopes.value[side];
  return own === null ? "no half-plane" : degrees(own);
};
const facets = () => SIDES.map((side) => ({ side, ring: facetOf(slopes.value, side) }));
const highest = () =>
  Math.max(
    ...facets().flatMap(({ side, ring }) =>
      ring.map(([x, y]) => heightOf(side, slopes.value[side] ?? 0, x, y)),
    ),
  );
const kindOf = () => {
  const { east, west, south: s, north: n } = slopes.value;
  if (s === null || n === null) {
    return "A roof with an open side";
  }
  return east === null && west === null
    ? "A gable roof"
    : east === null || west === null
      ? "Hipped at one end, a gable at the other"
      : "A hip roof";
};

function EnvelopeFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      <Drawing width={VIEW.width} height={VIEW.height} label="The roof in plan">
        {facets().map(
          ({ side, ring }) =>
            ring.length > 2 && (
              <Shape key={side} points={ring.map(inPlan)} class={`outline s0 tint-${side}`} />
            ),
        )}
        <Shape
          points={rectangle([-PLAN.length, -PLAN.width], [PLAN.length, PLAN.width]).map(inPlan)}
          class="measure s5"
        />
        {(
          [
            ["south", [0, -PLAN.width], 0, 20, "middle"],
            ["north", [0, PLAN.width], 0, -8, "middle"],
            ["east", [PLAN.length, 0], 8, 4, "start"],
            ["west", [-PLAN.length, 0], -8, 4, "end"],
          ] as const
        ).map(([side, at, dx, dy, anchor]) => (
          <Label
            key={side}
            at={inPlan(at)}
            dx={dx}
            dy={dy}
            anchor={anchor}
            text={slopes.value[side] === null ? "–" : degrees(slopes.value[side] ?? 0)}
          />
        ))}
      </Drawing>
      {isRevealed && (
        <div class="sliders">
          {SIDES.map((side) => (
            <div key={side}>
              <Slider
                label={side}
                value={(slopes.value[side] ?? 0) / DEGREE}
                range={[0, 70, 1]}
                says={slopeText(side)}
                onInput={(value) => {
                  slopes.value = { ...slopes.value, [side]: value < 8 ? null : value * DEGREE };
                }}
              />
            </div>
          ))}
        </div>
      )}
    </>
  );
}

/** How far a fragment's half-plane is from the plane of the eave's, upwards. */
const lift = signal(1.1);
const tolerance = 0.25;
const isGrouped = () => Math.abs(lift.value) < tolerance;

function GroupFigure() {
  const slope = 36 * DEGREE;
  const at = (across: number, by = 0) => inCut(across, PLAN.eave + across * Math.tan(slope) + by);
  return (
    <Drawing width={CUT.width} height={CUT.height} label="Two half-planes of one roof, cut across">
      <Line from={inCut(0, PLAN.eave)} to={inCut(0, 3)} class="rule" />
      <Line from={at(0)} to={at(isGrouped() ? 4 : 1.7)} class={isGrouped() ? "s4 thick" : "s1 thick"} />
      <Line from={at(1.7)} to={at(5)} class="s1 faint" />
      <Line
        from={at(2.4, lift.value)}
        to={at(4.4, lift.value)}
        class={isGrouped() ? "s4 thick" : "s2 thick"}
      />
      <Line from={at(3.2)} to={at(3.2, lift.value)} class="s7" />
      <Dot at={at(0)} class="s1" />
      <Dot at={at(2.4, lift.value)} class="s2" />
      <Handle
        at={at(3.2, lift.value)}
        class="s2"
        label="Height of the second half-plane"
        says={`${metres(lift.value, 2)} above the plane of the first`}
        step={1}
        of={lift}
        to={([, y]) => clamp((at(3.2)[1] - y) / CUT.scale, -1.5, 1.5)}
      />
      <Label at={at(0)} dx={-10} dy={18} anchor="end" class="s1" text="eave" />
      <Label at={at(2.4, lift.value)} dx={-10} dy={-8} anchor="end" class="s2" text="another line" />
    </Drawing>
  );
}

/** The facet that bridges two houses: how far it reaches, metres, and how much of its outline is on lines. */
const reach = signal(9);
const real = signal(0.45);
const TRUE_FACE = { area: 7 * 5, real: 0.9 } as const;
const bridgeArea = () => reach.value * 5;
const scoreTrue = TRUE_FACE.area * TRUE_FACE.real;
const scoreBridge = () => bridgeArea() * real.value;

function ConflictFigure({ isRevealed }: { isRevealed: boolean }) {
  const scale = 24;
  const [x0, y0] = [30, 70];
  const box = (x: number, width: number) =>
    rectangle([x0 + scale * x, y0], [x0 + scale * (x + width), y0 + scale * 5]);
  const isBridge = scoreBridge() > scoreTrue;
  const from = 5;
  const end: Vec2 = [x0 + scale * (from + reach.value), y0 + scale * 2.5];
  return (
    <>
      <Drawing width={480} height={240} label="A face and a false one that overlaps it, in plan">
        <Shape points={box(0, 7)} class={`outline s4 ${isRevealed && isBridge ? "gone" : ""}`} />
        <Shape points={box(12, 6)} class="measure s5" />
        <Shape
          points={box(from, reach.value)}
          class={`outline s7 ${isRevealed && !isBridge ? "gone" : ""}`}
        />
        <Label at={[x0 + 10, y0]} dy={-8} class="s4" text="a face" />
        <Label
          at={[x0 + scale * (from + 2.2), y0 + scale * 5]}
          dy={20}
          class="s7"
          text="a bridge to the next house"
        />
        {isRevealed && (
          <Handle
            at={end}
            class="s7"
            label="Reach of the bridging facet"
            says={metres(reach.value)}
            value={reach.value}
            step={scale / 4}
            of={reach}
            to={([x]) => clamp((x - x0) / scale - from, 3, 13)}
          />
        )}
      </Drawing>
      {isRevealed && <Slider symbol="tau" label="of the bridge" of={real} range={[0.05, 1, 0.05]} />}
    </>
  );
}

export const ROOFS: Lesson = {
  id: "roofs",
  title: "From half-planes to roofs",
  aim: "You can follow how planes without borders find their ridges, outlines and rivals.",
  minutes: 8,
  papers: "B99 4.2 and 4.3, figures 15 to 25",
  screens: [
    {
      id: "ridge",
      title: "Two half-planes make a ridge",
      prose: () => [
        "Each eave has found its half-plane: an angle $theta$, and no end. Two that climb towards each other meet in a line. Nobody has to detect it in an image.",
      ],
      formula: () => "z = 5 + away * tan theta",
      figure: RidgeFigure,
      predict: {
        kind: "estimate",
        question: "The eaves are 5 m high and 8 m apart, the slopes 30° and 45°. How high is the ridge?",
        unit: "m",
        range: [5, 12, 0.1],
        truth: () => ridgeOf(30 * DEGREE, 45 * DEGREE).z,
        within: 0.4,
        why: () => "The steeper side is shorter: the ridge is not in the middle. Drag the half-planes.",
      },
      says: () => {
        const { inwards: at, z } = ridgeOf(south.value, north.value);
        return `Slopes of ${degrees(south.value)} and ${degrees(north.value)} meet ${metres(z, 2)} above the ground, ${metres(at, 2)} from the left eave. A degree more on the left: ${metres(ridgeOf(south.value + DEGREE, north.value).z - z, 2)} in height.`;
      },
    },
    {
      id: "envelope",
      title: "Four half-planes make a hip roof",
      prose: () => [
        "Over a convex plan the roof is the *lowest* of the half-planes at each place. Where two are equally high there is a ridge or a hip. Oblique hips are nearly invisible in photographs; here they come for free.",
      ],
      figure: EnvelopeFigure,
      predict: {
        kind: "choice",
        question: "The east side shows no half-plane at any angle. What does the roof become at that end?",
        options: ["A hip", "A gable: the ridge runs through", "Flat"],
        right: () => 1,
        why: () =>
          "Push east below 8°: then that side carries nothing. An occluding edge, says B99, has no half-plane on its occluded side.",
      },
      says: () => {
        const areas = facets()
          .filter(({ ring }) => ring.length > 2)
          .map(({ side, ring }) => `${side} ${num(planArea(ring), 0)} m²`);
        return `${kindOf()}, ${metres(highest())} high at most. In plan: ${areas.join(", ")}.`;
      },
    },
    {
      id: "groups",
      title: "What lies in one plane",
      prose: () => [
        "One slope often carries several lines: the eave, a ridge, the edge of a dormer. Each has its own half-plane, each a little wrong. Those in one plane are grouped, and the plane is fitted again to all of their lines.",
        "Drag the second half-plane into the plane of the first. In B99's figure 18, nine half-planes become four planes: the true number.",
      ],
      figure: GroupFigure,
      says: () =>
        `The second half-plane is ${metres(Math.abs(lift.value), 2)} ${lift.value < 0 ? "below" : "above"} the plane of the first: ${isGrouped() ? "one plane, fitted to both lines." : "two planes."}`,
    },
    {
      id: "conflict",
      title: "Two facets, one place",
      prose: () => [
        "Outlines are closed around the border lines of each plane, and every facet is checked in all views. Now and then two still claim the same place: one of them bridges two houses.",
        "B99 keeps the one with the larger confidence $S$: its area $area$, times the share $tau$ of its outline that lies on lines that were really reconstructed.",
      ],
      formula: () => "S = area * tau",
      figure: ConflictFigure,
      predict: {
        kind: "choice",
        question: `The face has 35 m² and $tau$ = 0.9, the bridge 45 m² and $tau$ = 0.45. Which one stays?`,
        options: ["The face", "The bridge: it is larger"],
        right: () => 0,
        why: () =>
          "Size alone does not win. But drag the bridge out, or give it lines: at some place this rule is wrong. Lesson 10 has a better one.",
      },
      says: () =>
        `Face: $S$ = ${num(scoreTrue)} m². Bridge: ${num(bridgeArea(), 0)} m² · ${num(real.value, 2)} = ${num(scoreBridge())} m². ${scoreBridge() > scoreTrue ? "The bridge stays, and it is false." : "The face stays."}`,
    },
    onScene("own-groups", "Groups of a whole scene", realFigure("groups"), [
      "Each group is a plane with its lines and half-planes. Pick one: its members light up, and so do the facets that it became.",
    ]),
    onScene("own", "Borders and facets of a whole scene", realFigure("facet-plan"), [
      "Border lines by their kind, closed outlines, and what was rejected and why. ridgeline decides by one sum over all cells of the plan which plane covers what, instead of pair by pair.",
    ]),
  ],
};
