/** Lesson 9: W96's way: no image is compared with another, everything meets in space, and the shortest description wins. */
import { computed, signal } from "@preact/signals";
import { counted } from "../../app/parts/counted";
import { add, clamp, DEGREE } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import {
  Bar,
  Curve,
  Dot,
  Drawing,
  Grey,
  Handle,
  inMetres,
  Label,
  Line,
  Plot,
  Shape,
  Slider,
} from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, metres, num } from "../parts/say";
import { realFigure } from "../scene/RealFigure";
import { byCount, describe, shortest, stretchesOf } from "../toy/description";
import { azimuthHistogram, crossSum, mainDirection, seenLines } from "../toy/directions";
import { normal, stream } from "../toy/evidence";
import { aerial } from "../toy/house";

const viewCount = signal(6);
const lineCount = signal(200);
const comparisons = (views: number) => (views * (views - 1) * lineCount.value ** 2) / 2;
const accumulated = (views: number) => views * lineCount.value;
const thousands = (value: number) =>
  Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, "\u202f");

function CountFigure({ isRevealed }: { isRevealed: boolean }) {
  const counts = [2, 3, 4, 5, 6, 7, 8, 9, 10];
  const most = comparisons(10);
  return (
    <>
      <Plot
        x={[2, 10, "views"]}
        y={[0, isRevealed ? most : 10 * lineCount.value, "lines touched"]}
        label="Work against the number of views"
      >
        {({ at, upright }) => (
          <>
            {isRevealed && <Curve points={counts.map((n): Vec2 => at([n, comparisons(n)]))} class="s7" />}
            <Curve points={counts.map((n): Vec2 => at([n, accumulated(n)]))} class="s4" />
            {isRevealed && (
              <Label at={at([6.6, comparisons(7)])} anchor="end" class="s7" text="image against image" />
            )}
            <Label at={at([10, accumulated(10)])} dy={-8} anchor="end" class="s4" text="into space" />
            <Line {...upright(viewCount.value)} class="s5 faint" />
          </>
        )}
      </Plot>
      {isRevealed && <Slider symbol="N" label="views" of={viewCount} range={[2, 10, 1]} />}
    </>
  );
}

/** Six views all round, of a house turned by 24 degrees. */
const TURN = 24 * DEGREE;
const AROUND = [
  [-9, -8],
  [0, -9],
  [9, -8],
  [-9, 8],
  [0, 9],
  [9, 8],
].map(([x = 0, y = 0]) => aerial([x, y, 42]));
const BINS = 90;
const used = signal(6);
const seenBy = computed(() => seenLines(AROUND.slice(0, used.value), TURN, 12, 0.7));
const histogram = computed(() => azimuthHistogram(AROUND, seenBy.value, BINS));
const alpha = signal(63 * DEGREE);
const bestAlpha = () => mainDirection(histogram.value);

function DirectionFigure({ isRevealed }: { isRevealed: boolean }) {
  const most = Math.max(...histogram.value);
  const angles = [alpha.value, alpha.value + Math.PI / 2].map((a) => a % Math.PI);
  return (
    <>
      <Plot
        x={[0, 180, "azimuth, degrees"]}
        y={[0, most, "length of lines, px"]}
        label="Lengths of all image lines by azimuth"
      >
        {({ at, under, upright }) => (
          <>
            {histogram.value.map((value, bin) => (
              <Bar
                key={bin.toString()}
                from={at([(180 * bin) / BINS, 0])}
                to={at([(180 * (bin + 0.9)) / BINS, value])}
                class="s5"
              />
            ))}
            {angles.map((a, i) => (
              <Line key={i.toString()} {...upright(a / DEGREE)} class={i === 0 ? "s6" : "s6 dashed"} />
            ))}
            <Handle
              at={add(upright((angles[0] as number) / DEGREE).from, [0, 8])}
              class="s6"
              label="Direction alpha"
              says={`${degrees(alpha.value)} and ${degrees(angles[1] as number)}`}
              value={alpha.value / DEGREE}
              step={2.4}
              of={alpha}
              to={(place) => clamp(under(place), 0, 179.9) * DEGREE}
            />
          </>
        )}
      </Plot>
      {isRevealed && <Slider symbol="N" label="views in the histogram" of={used} range={[1, 6, 1]} />}
    </>
  );
}

/** Across the main direction: each line of a view is a ray in this plane, from its projection centre. */
const CENTRES: readonly Vec2[] = [
  [-11, 42],
  [-7, 42],
  [-3, 42],
  [4, 42],
  [8, 42],
  [12, 42],
];
const TRUE_POINTS: readonly Vec2[] = [
  [-4, 5],
  [0, 8],
  [4, 5],
];
interface Ray {
  view: number;
  through: Vec2;
}
const RAYS: readonly Ray[] = (() => {
  const random = stream(21);
  return CENTRES.flatMap((_, view) => [
    ...TRUE_POINTS.map(
      ([y, z]): Ray => ({ view, through: [y + 0.12 * normal(random), z + 0.12 * normal(random)] }),
    ),
    // Kerbs, shadows, a path.
    { view, through: [-9 + 18 * random(), 0] as Vec2 },
    { view, through: [-9 + 18 * random(), 1.5 * random()] as Vec2 },
  ]);
})();
const TOLERANCE_M = 0.3;
const probe = signal<Vec2>([-2, 2.5]);

function distanceToRay({ view, through }: Ray, [y, z]: Vec2): number {
  const [cy, cz] = CENTRES[view] as Vec2;
  const [dy, dz] = [through[0] - cy, through[1] - cz];
  return Math.abs(dy * (z - cz) - dz * (y - cy)) / Math.hypot(dy, dz);
}
const supporters = (at: Vec2) =>
  new Set(RAYS.filter((ray) => distanceToRay(ray, at) < TOLERANCE_M).map(({ view }) => view));
const CROSS = inMetres(480, 330, 21, [240, 285]);
const inCross = (at: Vec2): Vec2 => CROSS.at(...at);
const VIEW_CLASS = ["s1", "s2", "s3", "s4", "s5", "s7"] as const;

/** The parts of a ray between two heights of the drawing. */
function rayIn({ view, through }: Ray): readonly [Vec2, Vec2] {
  const [cy, cz] = CENTRES[view] as Vec2;
  const at = (z: number): Vec2 => [cy + ((through[0] - cy) * (z - cz)) / (through[1] - cz), z];
  return [inCross(at(13)), inCross(at(-1.5))];
}

function ClusterFigure({ isRevealed }: { isRevealed: boolean }) {
  const own = supporters(probe.value);
  return (
    <Drawing
      width={CROSS.width}
      height={CROSS.height}
      label="The plane across the ridge with a ray for every image line"
      isImage
      class="plain"
    >
      {isRevealed && (
        <Shape points={([[-4, 0], ...TRUE_POINTS, [4, 0]] as const).map(inCross)} class="outline s0" />
      )}
      {RAYS.map((ray, i) => {
        const [from, to] = rayIn(ray);
        const isNear = distanceToRay(ray, probe.value) < TOLERANCE_M;
        return (
          <Line
            key={i.toString()}
            from={from}
            to={to}
            class={`${VIEW_CLASS[ray.view]} ${isNear ? "" : "faint"}`}
          />
        );
      })}
      <Handle
        at={inCross(probe.value)}
        class="s6"
        label="Where a line in space might be"
        says={`${counted(own.size, "views")}, ${metres(probe.value[1])} high`}
        value={own.size}
        of={probe}
        to={(at): Vec2 => {
          const [y, z] = CROSS.place(at);
          return [clamp(y, -10, 10), clamp(z, -1, 12)];
        }}
      />
    </Drawing>
  );
}

/** A row of pixels across a house: garden, roof in the sun, roof in the shade, path, garden. */
const SIGMA = 9;
const PIXELS = 64;
const TRUE_BREAKS = [14, 31, 46, 54];
const LEVELS = [88, 172, 120, 190, 96];
const ROW: readonly number[] = (() => {
  const random = stream(3);
  return Array.from({ length: PIXELS }, (_, i) => {
    const part = TRUE_BREAKS.filter((at) => at <= i).length;
    return Math.round((LEVELS[part] as number) + SIGMA * normal(random));
  });
})();
const BEST = shortest(ROW, SIGMA);
const breaks = signal<readonly number[]>([20, 40]);
const own = () => describe(ROW, breaks.value, SIGMA);

function DescriptionFigure({ isRevealed }: { isRevealed: boolean }) {
  const { model, data } = own();
  const scale = 480 / describe(ROW, [], SIGMA).total;
  return (
    <>
      <Grey values={ROW} width={PIXELS} height={1} label="A row of 64 pixels" class="row-of-pixels" />
      <Plot
        x={[0, PIXELS, "pixel"]}
        y={[50, 220, "grey value"]}
        label="Grey values of the row and the stretches that describe them"
        height={250}
      >
        {({ at, under, upright }) => (
          <>
            {ROW.map((value, i) => (
              <Dot key={i.toString()} at={at([i + 0.5, value])} class="s1 small" />
            ))}
            {stretchesOf(ROW, breaks.value).map(({ from, to, mean }) => (
              <Line key={from} from={at([from, mean])} to={at([to, mean])} class="s6 thick" />
            ))}
            {isRevealed &&
              BEST.map((best) => <Line key={`best ${best}`} {...upright(best)} class="s4 dashed" />)}
            {breaks.value.map((before, i) => (
              <g key={i.toString()}>
                <Line {...upright(before)} class="s6" />
                <Handle
                  at={add(upright(before).from, [0, 8])}
                  class="s6"
                  label={`Break ${i + 1}`}
                  says={`before pixel ${before}`}
                  value={before}
                  step={at([1, 0])[0] - at([0, 0])[0]}
                  of={breaks}
                  to={(place) => {
                    const low = (breaks.value[i - 1] ?? 0) + 1;
                    const high = (breaks.value[i + 1] ?? PIXELS) - 1;
                    return breaks.value.with(i, clamp(Math.round(under(place)), low, high));
                  }}
                />
              </g>
            ))}
          </>
        )}
      </Plot>
      <div class="row">
        <button type="button" disabled={breaks.value.length > 6} onClick={addBreak}>
          One break more
        </button>
        <button
          type="button"
          disabled={breaks.value.length === 0}
          onClick={() => {
            breaks.value = breaks.value.slice(0, -1);
          }}
        >
          One less
        </button>
      </div>
      <Drawing width={480} height={44} label={`Model ${num(model, 0)} bits, data ${num(data, 0)} bits`}>
        <Bar from={[0, 4]} to={[scale * model, 20]} class="s6" />
        <Bar from={[scale * model, 4]} to={[scale * model + Math.min(480, scale * data), 20]} class="s1" />
        <Label at={[0, 22]} dy={14} class="s6" text={`model ${num(model, 0)}`} />
        <Label at={[140, 22]} dy={14} class="s1" text={`deviations ${num(data, 0)} bits`} />
      </Drawing>
    </>
  );
}

/** In the middle of the longest stretch. */
function addBreak(): void {
  const { from, to } = stretchesOf(ROW, breaks.value).reduce((longest, one) =>
    one.to - one.from > longest.to - longest.from ? one : longest,
  );
  breaks.value = [...breaks.value, Math.round((from + to) / 2)].sort((a, b) => a - b);
}

/** The description with each number of breaks. */
const BY_COUNT = byCount(ROW, SIGMA);
const MOST_BREAKS = 16;
const count = signal(1);
const bitsOf = (k: number) => describe(ROW, BY_COUNT.get(k) ?? [], SIGMA);

function CountBreaksFigure({ isRevealed }: { isRevealed: boolean }) {
  const ks = Array.from({ length: MOST_BREAKS + 1 }, (_, k) => k);
  const most = 700;
  const curve = (value: (k: number) => number) => ks.map((k): Vec2 => [k, Math.min(most, value(k))]);
  return (
    <>
      <Plot
        x={[0, MOST_BREAKS, "breaks"]}
        y={[0, most, "bits"]}
        label="Bits of model and deviations against the number of breaks"
      >
        {({ at, upright }) => (
          <>
            <Curve points={curve((k) => bitsOf(k).data).map(at)} class="s1" />
            {isRevealed && <Curve points={curve((k) => bitsOf(k).model).map(at)} class="s6" />}
            {isRevealed && <Curve points={curve((k) => bitsOf(k).total).map(at)} class="s0" />}
            <Label
              at={at([MOST_BREAKS, bitsOf(MOST_BREAKS).data])}
              dy={18}
              anchor="end"
              class="s1"
              text="deviations"
            />
            {isRevealed && (
              <>
                <Label at={at([3, bitsOf(3).model])} dy={18} class="s6" text="model" />
                <Label at={at([9, bitsOf(9).total])} dy={-8} anchor="end" text="both" />
                <Line {...upright(count.value)} class="s6 faint" />
              </>
            )}
          </>
        )}
      </Plot>
      {isRevealed && <Slider symbol="k" label="breaks" of={count} range={[0, MOST_BREAKS, 1]} />}
    </>
  );
}

export const OBJECT_SPACE: Lesson = {
  id: "object-space",
  title: "Object space and shortest descriptions",
  aim: "You can say why W96 compares no two images, and where it gets its thresholds from: nowhere.",
  minutes: 9,
  papers: "W96 2 and 3.3 to 3.6",
  screens: [
    {
      id: "count",
      title: "Whom to compare with whom",
      prose: () => [
        `$m$ = ${lineCount.value} in each view. B99 compares them image against image, and needs the epipolar beam to stay alive. W96 carries every line into object space once, and looks there where many meet.`,
      ],
      formula: () => 'frac { N ( N - 1 ) } { 2 } m ^2 "against" N m',
      figure: CountFigure,
      predict: {
        kind: "choice",
        question: "Six views with 200 lines each. How many pairs of lines are there, image against image?",
        options: ["1 200", "36 000", "600 000"],
        right: () => 2,
        why: () =>
          "15 pairs of images, 40 000 pairs of lines in each. Into space go 1 200 lines, and a seventh view adds 200 more.",
      },
      says: () =>
        `With ${counted(viewCount.value, "views")}, pairs of lines: ${thousands(comparisons(viewCount.value))}. Lines into space: ${thousands(accumulated(viewCount.value))}.`,
    },
    {
      id: "direction",
      title: "Drag α onto the peaks",
      prose: () => [
        "Most edges of a house are level and run in two perpendicular directions. The plane of an image line and its projection centre cuts a level plane in an azimuth: for a level edge, its own. Lines that are no edges of the house cut it anywhere.",
        "All lines of all views go into one histogram. Drag $alpha$; the dashed line stands across it.",
      ],
      figure: DirectionFigure,
      predict: {
        kind: "place",
        question: "At which $alpha$ do both lines stand on peaks?",
        how: () => {
          const off = Math.abs((((alpha.value - bestAlpha()) % (Math.PI / 2)) + Math.PI / 2) % (Math.PI / 2));
          return `Yours is ${degrees(Math.min(off, Math.PI / 2 - off))} off: the two peaks together are highest at ${degrees(bestAlpha())}, and the house was turned by ${degrees(TURN)}. One peak alone could be a road; two, perpendicular, are a house.`;
        },
      },
      says: () =>
        `At ${degrees(alpha.value)} and ${degrees((alpha.value + Math.PI / 2) % Math.PI)} there are ${num(crossSum(histogram.value, alpha.value), 0)} px of lines, of ${num(
          histogram.value.reduce((sum, one) => sum + one, 0),
          0,
        )}.`,
    },
    {
      id: "clusters",
      title: "Look along the ridge",
      prose: () => [
        "Look along the main direction: every edge that runs that way becomes a point, and every image line a ray from its camera. Six views, six colours.",
        "True edges are where rays of *many views* meet. Two rays meet anywhere; that says nothing. Find a place with all six.",
      ],
      figure: ClusterFigure,
      predict: {
        kind: "place",
        question: "Drag the mark to a place where all six views meet. There are three.",
        how: () =>
          `Your place has ${supporters(probe.value).size} of 6 views. The three true ones are the eaves and the ridge of the house that is drawn now. Each is an endless line of the roof, found without comparing two images.`,
      },
      says: () => {
        const views = supporters(probe.value).size;
        return `${views} of 6 views have a ray within ${metres(TOLERANCE_M)} of this place, ${metres(probe.value[1])} above the ground.`;
      },
    },
    {
      id: "describe",
      title: "How would you say it in few words?",
      prose: () => [
        "A row of 64 pixels across a garden, a roof and a path. Somebody is to write it down: where stretches of constant grey end, how grey each is, and by how much every pixel deviates.",
        "Each break costs bits; so does each deviation. Drag the breaks, add some, and make the sum small.",
      ],
      formula: () =>
        'DL = k log _ 2 n + ( k + 1 ) * 8 + sum _ i frac { r _ i ^2 } { 2 sigmaG ^2 ln 2 } + "const"',
      figure: DescriptionFigure,
      predict: {
        kind: "place",
        question: "How short can you make it?",
        how: () => {
          const best = describe(ROW, BEST, SIGMA).total;
          return `Yours has ${num(own().total, 0)} bits with $k$ = ${breaks.value.length}; the shortest found has ${num(best, 0)} with ${BEST.length} (dashed). The row was made with ${TRUE_BREAKS.length}.`;
        },
      },
      says: () => {
        const { model, data, total } = own();
        return `${num(model, 0)} bits of model and ${num(data, 0)} of deviations: ${num(total, 0)} together, with $k$ = ${breaks.value.length}.`;
      },
    },
    {
      id: "minimum",
      title: "Why it stops by itself",
      prose: () => [
        "With every further break the deviations become smaller, to the very end. Whoever only fits, splits until each pixel is a region.",
        "The model's own bits stop that. ORIS in W96 does this in two dimensions: it begins with many small regions, drops break points and merges regions, as long as the description becomes shorter.",
      ],
      figure: CountBreaksFigure,
      predict: {
        kind: "estimate",
        question:
          "The curve of the deviations only falls. At how many breaks is the *whole* description shortest?",
        unit: "breaks",
        range: [0, MOST_BREAKS, 1],
        truth: () => BEST.length,
        within: 0,
        why: () => "Nobody has set a threshold: a break that saves fewer bits than it costs is not made.",
      },
      says: () =>
        `With $k$ = ${count.value} it is ${num(bitsOf(count.value).total, 0)} bits long; the shortest has ${num(Math.min(...Array.from({ length: MOST_BREAKS + 1 }, (_, k) => bitsOf(k).total)), 0)}.`,
    },
    onScene("own-regions", "Regions of a whole photograph", realFigure("regions"), [
      "The partition of a photograph by its description length: regions of constant grey with straight, shared borders. Choose another view.",
    ]),
    onScene("own-directions", "Main directions of a whole scene", realFigure("main-directions"), [
      "The histogram of all views of the scene, and the two perpendicular directions that were taken from it.",
    ]),
    onScene("own", "Clusters of a whole scene", realFigure("clusters"), [
      "The plane across a main direction, with the rays of all views and the clusters that were kept. Pick one: it is projected back into the photographs.",
    ]),
  ],
};
