/** Lesson 6: a line in space has four numbers, and its ends are not among them. */
import { signal } from "@preact/signals";
import { counted } from "../../app/parts/counted";
import { clamp, DEGREE, lineThrough, mix3, rectangle, replaced, times, transpose } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { Bar, Curve, Dot, Handle, Line, Plot, Shape, Slider, Switch } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, metres, num, pixels } from "../parts/say";
import { ImagePane, OBSERVER, PlaneOfLine, Space, seen } from "../parts/scene";
import { realFigure } from "../scene/RealFigure";
import { atHeight, type Camera, imageOf } from "../toy/camera";
import { noisy, stream } from "../toy/evidence";
import { ACROSS, aerial, RIDGE, SOUTH_EAVE } from "../toy/house";
import { type Ends2, type Ends3, inView, lineError, lineOfTwo, partBetween } from "../toy/lines";

const [FIRST, SECOND] = ACROSS;
const TOP_M = 14;
const feet = signal<readonly [Vec2, Vec2]>([
  [-8, -6],
  [6, 2],
]);

function FourFigure({ isRevealed }: { isRevealed: boolean }) {
  const [[a, b], [c, d]] = feet.value;
  const [low, high]: Ends3 = [
    [a, b, 0],
    [c, d, TOP_M],
  ];
  const frame = (z: number) => (
    <Shape
      points={rectangle([-12, -12], [12, 12]).map(([x, y]) => seen([x, y, z]))}
      class="outline s5 thin"
    />
  );
  const handle = (which: 0 | 1, at: Vec3) => (
    <Handle
      at={seen(at)}
      class="s4"
      label={which === 0 ? "Where it meets the ground" : `Where it meets ${TOP_M} m`}
      says={`${metres(at[0])} east, ${metres(at[1])} north`}
      of={feet}
      to={(place) => {
        const [x, y] = atHeight(OBSERVER, place, at[2]);
        return replaced(feet.value, which, [clamp(x, -12, 12), clamp(y, -12, 12)]);
      }}
      isFixed={!isRevealed}
    />
  );
  return (
    <Space label="A line through two levels" cameras={[]}>
      {frame(0)}
      {frame(TOP_M)}
      <Line from={seen(mix3(low, high, -0.15))} to={seen(mix3(low, high, 1.25))} class="s4 thick" />
      {handle(0, low)}
      {handle(1, high)}
    </Space>
  );
}

/** Which part of the eave each view's segment shows, from 0 to 1. */
const parts = signal<readonly [readonly [number, number], readonly [number, number]]>([
  [0.05, 0.6],
  [0.3, 0.95],
]);
const segmentOf = (view: 0 | 1): Ends2 => {
  const [from, to] = parts.value[view];
  return inView(view === 0 ? FIRST : SECOND, [mix3(...SOUTH_EAVE, from), mix3(...SOUTH_EAVE, to)]);
};
const fromSegments = () => lineOfTwo([FIRST, SECOND], [segmentOf(0), segmentOf(1)]);

function EndsFigure({ isRevealed }: { isRevealed: boolean }) {
  const L = partBetween(fromSegments(), 0, -7, 7);
  const pane = (view: 0 | 1, camera: Camera) => {
    const [p, q] = segmentOf(view);
    const whole = inView(camera, SOUTH_EAVE);
    const handle = (end: 0 | 1, at: Vec2) => (
      <Handle
        at={at}
        class={view === 0 ? "s1" : "s2"}
        label={`${end === 0 ? "West" : "East"} end of the segment`}
        says={`${num(100 * (parts.value[view][end] ?? 0), 0)} % along the eave`}
        value={parts.value[view][end] ?? 0}
        of={parts}
        to={([x]) => {
          const t = clamp((x - whole[0][0]) / (whole[1][0] - whole[0][0]), 0, 1);
          const [from, to] = parts.value[view];
          const now =
            end === 0 ? ([Math.min(t, to - 0.1), to] as const) : ([from, Math.max(t, from + 0.1)] as const);
          return replaced(parts.value, view, now);
        }}
      />
    );
    return (
      <ImagePane camera={camera} colour={view === 0 ? 1 : 2}>
        <Line from={p} to={q} class={view === 0 ? "s1 thick" : "s2 thick"} />
        {isRevealed && handle(0, p)}
        {isRevealed && handle(1, q)}
      </ImagePane>
    );
  };
  return (
    <div class="pair three">
      {pane(0, FIRST)}
      {pane(1, SECOND)}
      <Space label="The line in space" cameras={[FIRST, SECOND]}>
        <PlaneOfLine camera={FIRST} ends={segmentOf(0)} class="s1 area" down={5} />
        <PlaneOfLine camera={SECOND} ends={segmentOf(1)} class="s2 area" down={5} />
        <Line from={seen(L[0])} to={seen(L[1])} class="s4 thick" />
      </Space>
    </div>
  );
}

/** Segments of the ridge in three views, with a pixel and a half of noise at their ends. */
const MEASURED: readonly Ends2[] = (() => {
  const random = stream(5);
  return ACROSS.map((camera) =>
    inView(camera, RIDGE).map((x) => noisy(x, 1.5, random)),
  ) as unknown as readonly Ends2[];
})();
/** Heights of the reader's line above its ends. */
const ends = signal<readonly [number, number]>([10, 5.5]);
const lineOf = ([a, b]: readonly [number, number]): Ends3 => [
  [RIDGE[0][0], 0, a],
  [RIDGE[1][0], 0, b],
];
const errorOf = (heights: readonly [number, number]) => lineError(ACROSS, MEASURED, lineOf(heights));
/** The heights of least error, by ever finer steps. */
const best = (() => {
  let at: readonly [number, number] = [8, 8];
  for (let step = 1; step > 1e-3; step /= 2) {
    for (let i = 0; i < 8; i += 1) {
      const around = [-1, 0, 1].flatMap((da) =>
        [-1, 0, 1].map((db) => [at[0] + da * step, at[1] + db * step] as const),
      );
      at = around.reduce((most, one) => (errorOf(one) < errorOf(most) ? one : most), at);
    }
  }
  return at;
})();

function FitFigure({ isRevealed }: { isRevealed: boolean }) {
  const L = lineOf(ends.value);
  return (
    <div class="pair">
      <Space label="The line above the house" cameras={[]}>
        {isRevealed && <Line from={seen(lineOf(best)[0])} to={seen(lineOf(best)[1])} class="s6 dashed" />}
        <Line from={seen(L[0])} to={seen(L[1])} class="s4 thick" />
        {([0, 1] as const).map((end) => (
          <Handle
            key={end}
            at={seen(L[end])}
            class="s4"
            label={`Height of the ${end === 0 ? "west" : "east"} end`}
            says={metres(ends.value[end], 2)}
            value={ends.value[end]}
            step={1}
            of={ends}
            to={(place) => {
              const [x, y] = L[end];
              const [low, high] = [seen([x, y, 0])[1], seen([x, y, 16])[1]];
              return replaced(ends.value, end, clamp((16 * (place[1] - low)) / (high - low), 2, 15));
            }}
          />
        ))}
      </Space>
      <div class="parts">
        {ACROSS.map((camera, i) => (
          <ImagePane
            key={camera.C.join()}
            camera={camera}
            title={["First", "Second", "Third"][i] ?? ""}
            label="View with the measured segment and the image of the line"
            colour={(i + 1) as 1 | 2 | 3}
          >
            <Line from={imageOf(camera, L[0])} to={imageOf(camera, L[1])} class="s4" />
            {(MEASURED[i] as Ends2).map((x) => (
              <Dot key={x.join()} at={x} class="s7" />
            ))}
          </ImagePane>
        ))}
      </div>
    </div>
  );
}

const STRIPS = { one: "One strip", two: "A view from the next strip" } as const;
type Strips = keyof typeof STRIPS;
const strips = signal<Strips>("one");
const azimuth = signal(45 * DEGREE);
const ONE_STRIP = [aerial([-9, 0, 42]), aerial([0, 0, 42]), aerial([9, 0, 42])];
const TWO_STRIPS = [...ONE_STRIP, aerial([0, 14, 42])];
const SIGMA = 0.5;

/** Standard deviation of the height of a level line, from the slopes of its distances: two numbers, height and tilt. */
function heightSigma(cameras: readonly Camera[], phi: number): number {
  const [c, s] = [5 * Math.cos(phi), 5 * Math.sin(phi)];
  const at = (h: number, tilt: number): Ends3 => [
    [-c, -s, 8 + h - tilt],
    [c, s, 8 + h + tilt],
  ];
  const step = 0.01;
  const slopes = cameras.flatMap((camera) => {
    const [a, b, c] = lineThrough(...inView(camera, at(0, 0)));
    const away = (moved: Ends3) =>
      inView(camera, moved).map(([x, y]) => (a * x + b * y + c) / Math.hypot(a, b) / step);
    return transpose([away(at(step, 0)), away(at(0, step))]);
  });
  const [[hh = 0, ht = 0] = [], [, tt = 0] = []] = times(transpose(slopes), slopes);
  return SIGMA * Math.sqrt(tt / (hh * tt - ht * ht));
}
const camerasOf = (of: Strips) => (of === "one" ? ONE_STRIP : TWO_STRIPS);

function AzimuthFigure() {
  const phi = azimuth.value;
  const most = 0.6;
  const curve = (of: Strips) =>
    Array.from({ length: 90 }, (_, i) => i + 1)
      .map((deg): Vec2 => [deg, heightSigma(camerasOf(of), deg * DEGREE)])
      .filter(([, value]) => value < most);
  return (
    <>
      <Switch legend="Strips" names={STRIPS} of={strips} />
      <Plot
        x={[0, 90, "angle between edge and flight, degrees"]}
        y={[0, most, "σ of the height, m"]}
        label="Standard deviation of the height of an edge against its direction"
      >
        {({ at, under }) => (
          <>
            <Curve points={curve(strips.value).map(at)} class="s7" />
            <Handle
              at={at([phi / DEGREE, Math.min(most, heightSigma(camerasOf(strips.value), phi))])}
              class="s6"
              label="Angle between edge and flight"
              says={degrees(phi)}
              value={phi / DEGREE}
              step={5}
              of={azimuth}
              to={(place) => clamp(Math.round(under(place)), 1, 90) * DEGREE}
            />
          </>
        )}
      </Plot>
    </>
  );
}

/** What three views show of one edge, as parts of it from 0 to 1: no view shows all. */
const FRAGMENTS = [
  [
    [0, 0.28],
    [0.4, 0.8],
  ],
  [
    [0.06, 0.55],
    [0.62, 1],
  ],
  [[0.2, 0.9]],
] as const;
const VIEW_COLOURS = ["s1", "s2", "s3"] as const;
const needed = signal(2);
const MOST_STEPS = 200;
/** Shares of the edge that at least so many views show. */
const shownBy = (count: number) =>
  Array.from({ length: MOST_STEPS }, (_, i) => (i + 0.5) / MOST_STEPS).map(
    (t) => FRAGMENTS.filter((own) => own.some(([from, to]) => t >= from && t <= to)).length >= count,
  );
const grownLength = (count: number) => (10 * shownBy(count).filter((is) => is).length) / MOST_STEPS;

function GrowFigure() {
  const isShown = shownBy(needed.value);
  return (
    <>
      <Plot
        x={[0, 10, "along the edge, m"]}
        y={[0, 4, "views (colours), line (top)"]}
        label="Fragments of an edge in three views and the line that they make"
        height={230}
      >
        {({ at }) => (
          <>
            {FRAGMENTS.map((own, view) =>
              own.map(([from, to]) => (
                <Line
                  key={`${view} ${from}`}
                  from={at([10 * from, view + 0.6])}
                  to={at([10 * to, view + 0.6])}
                  class={`thick ${VIEW_COLOURS[view]}`}
                />
              )),
            )}
            {isShown.map(
              (is, i) =>
                is && (
                  <Bar
                    key={i.toString()}
                    from={at([(10 * i) / MOST_STEPS, 3.45])}
                    to={at([(10 * i + 10.1) / MOST_STEPS, 3.85])}
                    class="s4"
                  />
                ),
            )}
          </>
        )}
      </Plot>
      <Slider label="views that must show a place" of={needed} range={[1, 3, 1]} />
    </>
  );
}

export const LINES_IN_SPACE: Lesson = {
  id: "lines-in-space",
  title: "Lines in space",
  aim: "You can say what images fix of a line, and what they leave open.",
  minutes: 8,
  papers: "B99 3.2 to 3.4, figures 4 to 8",
  screens: [
    {
      id: "four",
      title: "How many numbers?",
      prose: () => [
        "A point in space has three numbers. Now a line $L$, endless in both directions, anywhere.",
      ],
      figure: FourFigure,
      predict: {
        kind: "choice",
        question: "How many numbers fix an endless line in space?",
        options: ["3", "4", "5", "6"],
        right: () => 1,
        why: () =>
          "It meets the ground in two coordinates, and a level above in two more. Drag them: every line that is not level is reached. ridgeline writes lines in another way that has no exception, with four numbers as well.",
      },
      says: () => {
        const [[a, b], [c, d]] = feet.value;
        return `(${num(a)}, ${num(b)}) on the ground and (${num(c)}, ${num(d)}) at ${TOP_M} m: four numbers.`;
      },
    },
    {
      id: "ends",
      title: "Ends do not count",
      prose: () => [
        "Edge detectors find the direction of an edge well and its ends badly: a tree, a shadow, weak contrast, and the segment ends early. The two views here show different parts of the eave.",
      ],
      formula: () => "plane1 = P ^T l , plane2 = P2 ^T l2",
      figure: EndsFigure,
      predict: {
        kind: "choice",
        question: "The segment of one view becomes shorter. What happens to the line $L$ in space?",
        options: ["It moves", "It becomes shorter", "Nothing: the plane stays the same"],
        right: () => 2,
        why: () => "A plane through a line knows nothing of the line's ends. Drag them along the eave.",
      },
      says: () => {
        const [p, q] = partBetween(fromSegments(), 0, -5, 5);
        const [a, b] = parts.value;
        return `The views show ${num(10 * (a[1] - a[0]))} m and ${num(10 * (b[1] - b[0]))} m of the eave; $L$ is at ${metres(p[2], 2)} and ${metres(q[2], 2)}, as before.`;
      },
    },
    {
      id: "fit",
      title: "Fit the line yourself",
      prose: () => [
        "Three views, each with the measured ends of a segment. They deviate by a pixel or two, so no line hits them all. Only the distance $d$ *across* the image of $L$ counts: along it, ends say nothing.",
        "Drag the ends of the line up and down until $d$ is as small as you can make it.",
      ],
      formula: () => "min _ L sum d ^2",
      figure: FitFigure,
      predict: {
        kind: "place",
        question: "Bring the line onto the dots in all three views. How small do you get $d$?",
        how: () =>
          `You reached ${pixels(errorOf(ends.value), 2)}; the least is ${pixels(errorOf(best), 2)}, at ${metres(best[0], 2)} and ${metres(best[1], 2)} (dashed). The ridge is at 8 m.`,
      },
      says: () =>
        `With its ends at ${metres(ends.value[0], 2)} and ${metres(ends.value[1], 2)} the line leaves $d$ = ${pixels(errorOf(ends.value), 2)}.`,
    },
    {
      id: "direction",
      title: "Which edges are known well",
      prose: () => [
        "Lesson 4 has shown why an edge along the flight is lost. Here is what that does to its height, for every direction: half a pixel of noise, 42 m up, three views 9 m apart.",
        "Then add one view of the next strip.",
      ],
      formula: () => 'sigmaZ "grows_as" frac { 1 } { sin phi }',
      figure: AzimuthFigure,
      says: () =>
        `At $phi$ = ${degrees(azimuth.value)} the height of the edge is good to ${metres(heightSigma(camerasOf(strips.value), azimuth.value), 2)}${strips.value === "one" ? "." : ", with the view of the next strip."}`,
    },
    {
      id: "growing",
      title: "Merging and growing",
      prose: () => [
        "Now that $L$ is known, its ends can be settled over all views. Where two fragments of one view lie on it, and the windows between them correlate in the others, they are *merged*. Where one view shows more than another, and correlation agrees, the line is *grown*.",
        "How many views must show a place? Fewer: longer lines. More: safer ones.",
      ],
      figure: GrowFigure,
      says: () =>
        `What at least ${counted(needed.value, "views")} show${needed.value === 1 ? "s" : ""} is ${metres(grownLength(needed.value))} of the 10 m; the longest single segment has 7 m.`,
    },
    onScene("own", "Lines of a whole scene", realFigure("line-accuracy"), [
      "Each line with its standard deviation against the number of views, and the picked line in every view. The more views, the better: figure 9 of B99.",
    ]),
  ],
};
