/** Lesson 3: are two windows the same piece of the world? */
import { computed, signal } from "@preact/signals";
import { apply3, cross, homogeneous, lineThrough, mix, nearestParameter, point2 } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import {
  Bar,
  Curve,
  Dot,
  Drawing,
  Grey,
  Handle,
  Label,
  Line,
  Plot,
  Slider,
  Switch,
  WindowCard,
} from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { metres, num, pixels } from "../parts/say";
import { ImageLine } from "../parts/scene";
import { realFigure } from "../scene/RealFigure";
import { atHeight, fundamental, imageOf, planeHomography, projection } from "../toy/camera";
import { aerial, photograph, SOUTH_EAVE, surfaceAt } from "../toy/house";
import { meanOf, meanSquare, ncc, planeAt, relit, warpedWindow, windowAt } from "../toy/windows";

/** Nearer to each other than in other lessons, as on one strip: B99 matches neighbouring views for this. */
const FIRST = aerial([-3, -9, 42]);
const SECOND = aerial([-1, -1, 42]);
const pictures = computed(() => [photograph(FIRST), photograph(SECOND)] as const);

/** A place on the south roof. */
const PLACE: Vec2 = imageOf(FIRST, [-1.5, -1.9, 6.575]);
const TRUE_HEIGHT = surfaceAt(FIRST, PLACE).X[2];
const inSecond = (h: number): Vec2 => imageOf(SECOND, atHeight(FIRST, PLACE, h));

const SIZE = 15;
/** Candidates on the epipolar line, by height; the right one is not the first. */
const CANDIDATES = [TRUE_HEIGHT + 2.9, TRUE_HEIGHT - 3.1, TRUE_HEIGHT, TRUE_HEIGHT + 6.2];
const RIGHT = 2;
const NAMES = ["A", "B", "C", "D"] as const;

const reference = computed(() => windowAt(pictures.value[0], PLACE, SIZE));
const candidate = (i: number) => windowAt(pictures.value[1], inSecond(CANDIDATES[i] as number), SIZE);

function WhichFigure({ isRevealed }: { isRevealed: boolean }) {
  const own = reference.value;
  return (
    <div class="windows-row">
      <WindowCard values={own} size={SIZE} colour={1} title="First view" />
      {NAMES.map((name, i) => {
        const values = candidate(i);
        return (
          <WindowCard
            key={name}
            values={values}
            size={SIZE}
            colour={2}
            title={name}
            {...(isRevealed && { score: num(ncc(own, values), 2) })}
          />
        );
      })}
    </div>
  );
}

const gain = signal(1);
const offset = signal(0);
const relitWindow = () => relit(candidate(RIGHT), gain.value, offset.value);

function LightFigure({ isRevealed }: { isRevealed: boolean }) {
  const values = relitWindow();
  return (
    <>
      <div class="windows-row">
        <WindowCard values={reference.value} size={SIZE} colour={1} title="First view" />
        <WindowCard values={values} size={SIZE} colour={2} title="Second view" />
      </div>
      <Slider symbol="gain" label="contrast" of={gain} range={[0.2, 1.4, 0.05]} />
      <Slider symbol="offset" label="brightness" of={offset} range={[-60, 80, 2]} />
      {isRevealed && (
        <p class="muted">
          Without normalising, the mean squared difference is {num(meanSquare(reference.value, values), 0)}{" "}
          grey values².
        </p>
      )}
    </>
  );
}

const height = signal(3.4);
const size = signal(15);
const [LOW, HIGH] = [0, 14];
const scores = computed(() => {
  const own = windowAt(pictures.value[0], PLACE, size.value);
  return Array.from({ length: 281 }, (_, i): Vec2 => {
    const h = mix(LOW, HIGH, i / 280);
    return [h, ncc(own, windowAt(pictures.value[1], inSecond(h), size.value))];
  });
});
const scoreAt = (h: number) => (scores.value[Math.round((280 * (h - LOW)) / (HIGH - LOW))] as Vec2)[1];
const bestHeight = () => scores.value.reduce((best, one) => (one[1] > best[1] ? one : best))[0];
/** Maxima that a greedy search could take for the right one. */
const peaks = () =>
  scores.value.filter(([, c], i, all) => {
    const [before, after] = [all[i - 1]?.[1] ?? 1, all[i + 1]?.[1] ?? 1];
    return c > 0.5 && c >= before && c > after;
  }).length;

function Picture({ which, children }: { which: 0 | 1; children: preact.ComponentChildren }) {
  const { width, height: rows, grey } = pictures.value[which];
  return (
    <div class="stack">
      <Grey values={grey} width={width} height={rows} label={which === 0 ? "First view" : "Second view"} />
      <Drawing width={width} height={rows} label="Marks" isImage>
        {children}
      </Drawing>
    </div>
  );
}

function Frame({ at: [x, y], side, class: name }: { at: Vec2; side: number; class: string }) {
  return (
    <rect class={`stroke on-photo ${name}`} x={x - side / 2} y={y - side / 2} width={side} height={side} />
  );
}

function AlongFigure() {
  const h = height.value;
  return (
    <>
      <div class="pair">
        <Picture which={0}>
          <Frame at={PLACE} side={size.value} class="s1" />
        </Picture>
        <Picture which={1}>
          <Line from={inSecond(LOW)} to={inSecond(HIGH)} class="s2 on-photo" />
          <Frame at={inSecond(h)} side={size.value} class="s2" />
          <Handle
            at={inSecond(h)}
            class="s2 on-photo"
            label="Window on the epipolar line"
            says={`height ${metres(h, 2)}, correlation ${num(scoreAt(h), 2)}`}
            step={0.5}
            of={height}
            to={(to) => nearestParameter(inSecond, LOW, HIGH, to)}
          />
        </Picture>
      </div>
      <Plot
        x={[LOW, HIGH, "height on the epipolar line, m"]}
        y={[-0.6, 1, "correlation"]}
        label="Correlation along the epipolar line"
        height={210}
      >
        {({ at, upright }) => (
          <>
            <Curve points={scores.value.map(at)} class="s6" />
            <Line {...upright(h)} class="s2" />
            <Dot at={at([h, scoreAt(h)])} class="s2" />
          </>
        )}
      </Plot>
      <Slider label="side of the window" of={size} range={[3, 31, 2]} suffix=" px" />
    </>
  );
}

const SHAPES = { none: "As a square", level: "By a level plane", roof: "By the roof's plane" } as const;
type Shape = keyof typeof SHAPES;
const shape = signal<Shape>("none");
const WARPED = 25;
const shaped = (of: Shape) => {
  if (of === "none") {
    return windowAt(pictures.value[1], inSecond(TRUE_HEIGHT), WARPED);
  }
  const { X } = surfaceAt(FIRST, PLACE);
  const { n } = planeAt(SOUTH_EAVE, of === "level" ? 0 : Math.atan2(3, 4));
  const H = planeHomography(FIRST, SECOND, n, -(n[0] * X[0] + n[1] * X[1] + n[2] * X[2]));
  return warpedWindow(pictures.value[1], H, PLACE, WARPED);
};
const large = computed(() => windowAt(pictures.value[0], PLACE, WARPED));

function WarpFigure() {
  const values = shaped(shape.value);
  return (
    <>
      <Switch legend="How the window is taken" names={SHAPES} of={shape} />
      <div class="windows-row">
        <WindowCard values={large.value} size={WARPED} colour={1} title="First view" />
        <WindowCard
          values={values}
          size={WARPED}
          colour={2}
          title="Second view"
          score={num(ncc(large.value, values), 2)}
        />
      </div>
    </>
  );
}

const F = fundamental(projection(FIRST), projection(SECOND));
const onEave = signal(0.35);
const EAVE_LINES = [FIRST, SECOND].map((camera) =>
  SOUTH_EAVE.map((X) => imageOf(camera, X)),
) as unknown as readonly [readonly [Vec2, Vec2], readonly [Vec2, Vec2]];
const eavePoint = (t: number): Vec2 => {
  const [p, q] = EAVE_LINES[0];
  return [mix(p[0], q[0], t), mix(p[1], q[1], t)];
};
/** x' = l' x (F x) (B99 3.1). */
const corresponding = (x: Vec2): Vec2 =>
  point2(cross(lineThrough(...EAVE_LINES[1]), apply3(F, homogeneous(x))));
/** The roof's half of a window about a point of the eave. */
const roofHalf = (which: 0 | 1, at: Vec2) =>
  windowAt(pictures.value[which], at, SIZE).slice(0, (SIZE * (SIZE - 1)) / 2);
const pointScore = () => {
  const x = eavePoint(onEave.value);
  return ncc(roofHalf(0, x), roofHalf(1, corresponding(x)));
};

function PointFigure() {
  const x = eavePoint(onEave.value);
  const x2 = corresponding(x);
  return (
    <>
      <div class="pair">
        <Picture which={0}>
          <Line from={EAVE_LINES[0][0]} to={EAVE_LINES[0][1]} class="s1 on-photo" />
          <Handle
            at={x}
            class="s1 on-photo"
            label="Point x on the segment"
            says={`${num(10 * onEave.value)} m along it`}
            step={1}
            of={onEave}
            to={(to) => nearestParameter(eavePoint, 0, 1, to)}
          />
        </Picture>
        <Picture which={1}>
          <Line from={EAVE_LINES[1][0]} to={EAVE_LINES[1][1]} class="s2 on-photo" />
          <ImageLine of={apply3(F, homogeneous(x))} camera={SECOND} class="s2 faint on-photo" />
          <Dot at={x2} class="s2 on-photo" />
        </Picture>
      </div>
      <div class="windows-row">
        <WindowCard values={roofHalf(0, x)} size={SIZE} colour={1} title="above x" />
        <WindowCard
          values={roofHalf(1, x2)}
          size={SIZE}
          colour={2}
          title="above x′"
          score={num(pointScore(), 2)}
        />
      </div>
    </>
  );
}

const SIDES = { both: "Whole windows", roof: "The roof's side", ground: "The ground's side" } as const;
type Side = keyof typeof SIDES;
const side = signal<Side>("both");
const THRESHOLD = 0.6;
const EDGELS = 36;
/** Correlation at every edgel of the eave, of the chosen side of it. */
const edgels = computed(() => {
  const [one, other] = pictures.value;
  return Array.from({ length: EDGELS }, (_, i) => {
    const X = [mix(-4.6, 4.6, i / (EDGELS - 1)), -4, 5] as const;
    const [x, x2] = [imageOf(FIRST, X), imageOf(SECOND, X)];
    const [a, b] = [windowAt(one, x, SIZE), windowAt(other, x2, SIZE)];
    const half = (SIZE - 1) / 2;
    // The eave runs from left to right in both images: above it is the roof.
    const isKept = (j: number) => {
      const dy = Math.floor(j / SIZE) - half;
      return side.value === "both" || (side.value === "roof" ? dy < 0 : dy > 0);
    };
    const [ka, kb] = [a.filter((_, j) => isKept(j)), b.filter((_, j) => isKept(j))];
    return ncc(ka, kb);
  });
});
const kept = () => edgels.value.filter((c) => c > THRESHOLD);

function EdgelFigure() {
  return (
    <>
      <Switch legend="Side of the line" names={SIDES} of={side} />
      <Plot
        x={[0, EDGELS, "edgel along the eave"]}
        y={[-0.5, 1, "correlation"]}
        label="Correlation of every edgel of the eave"
      >
        {({ at, level }) => (
          <>
            {edgels.value.map((c, i) => (
              <Bar
                key={i.toString()}
                from={at([i + 0.15, 0])}
                to={at([i + 0.85, c])}
                class={c > THRESHOLD ? "s6" : "s0"}
              />
            ))}
            <Line {...level(THRESHOLD)} class="s7 dashed" />
            <Label at={at([EDGELS, THRESHOLD])} dy={-5} anchor="end" class="s7" text="0.6" />
          </>
        )}
      </Plot>
    </>
  );
}

export const CORRELATION: Lesson = {
  id: "correlation",
  title: "Correspondence and correlation",
  aim: "You can measure whether two windows show the same thing, and know when the measure lies.",
  minutes: 8,
  papers: "B99 3.1",
  screens: [
    {
      id: "which",
      title: "Which window is it?",
      prose: () => [
        "The epipolar line says where to look, not what to take. Four windows of the second view, all on the line, stand beside a window of the first: 15 × 15 pixels each, as in B99.",
      ],
      figure: WhichFigure,
      predict: {
        kind: "choice",
        question: "Which one shows the same tiles?",
        options: NAMES,
        right: () => RIGHT,
        why: () =>
          `The numbers below are correlations: ${NAMES[RIGHT]} has ${num(ncc(reference.value, candidate(RIGHT)), 2)}, the best of the others ${num(Math.max(...[0, 1, 3].map((i) => ncc(reference.value, candidate(i)))), 2)}.`,
      },
    },
    {
      id: "light",
      title: "Sunlight must not count",
      prose: () => [
        "Two photographs of one roof are never equally bright. So each window loses its mean, and is divided by its own size: what remains is the *pattern*.",
        "1 says: the same pattern. 0: nothing in common. −1: the negative of it. Below, every $I2$ becomes $gain I2 + offset$.",
      ],
      formula: () =>
        "c = frac { sum ( I - mean1 ) ( I2 - mean2 ) } { sqrt { sum ( I - mean1 ) ^2 sum ( I2 - mean2 ) ^2 } }",
      figure: LightFigure,
      predict: {
        kind: "choice",
        question:
          "A cloud passes: the second window becomes darker and flatter. What does its correlation do?",
        options: ["It falls", "It stays", "It rises"],
        right: () => 1,
        why: () => "Brightness goes with the mean, contrast with the size. Turn both and watch the sentence.",
      },
      says: () =>
        `At contrast ${num(gain.value, 2)} and brightness ${num(offset.value, 0)} the correlation is ${num(ncc(reference.value, relitWindow()), 2)}.`,
    },
    {
      id: "along",
      title: "Along the line",
      prose: () => [
        "Each place on the epipolar line is a height. Drag the window along it: the curve is the correlation at every height.",
        "Tiles repeat, so the curve has more than one hill. A small window finds many, a large one mixes surfaces. 15 pixels is a compromise; no number is right.",
      ],
      figure: AlongFigure,
      says: () =>
        `At ${metres(height.value, 2)} the correlation is ${num(scoreAt(height.value), 2)}. With ${pixels(size.value, 0)} the curve has ${peaks() === 1 ? "one peak" : `${peaks()} peaks`} above 0.5; the highest is at ${metres(bestHeight(), 2)}, the roof is at ${metres(TRUE_HEIGHT, 2)}.`,
    },
    {
      id: "warp",
      title: "A square is not a square over there",
      prose: () => [
        "A roof that slopes towards one camera looks longer from there. Pixels of equal place in the two windows are then not the same tiles.",
        "If the plane is known, each pixel can be fetched from where the plane takes it. So a *wrong* plane lowers the correlation: lesson 7 makes a tool of that.",
      ],
      figure: WarpFigure,
      says: () =>
        `${{ none: "As a square", level: "By a level plane", roof: "By the roof's own plane" }[shape.value]}, the windows correlate with ${num(ncc(large.value, shaped(shape.value)), 2)}.`,
    },
    {
      id: "points",
      title: "Point by point along a segment",
      prose: () => [
        "Two segments $l$ and $l2$ may be the same edge. Nobody knows their ends well, so ends are not compared. But each point $x$ of the one has its place on the other: where its epipolar line $F x$ crosses $l2$. The cross product of two lines is the point in which they meet.",
        "Drag $x$ along the segment itself.",
      ],
      formula: () => "x2 = l2 × ( F x )",
      figure: PointFigure,
      says: () => {
        const [x, y] = corresponding(eavePoint(onEave.value));
        return `${num(10 * onEave.value)} m along the eave $x2$ is at (${num(x)}, ${num(y)}); the roof above the two points correlates with ${num(pointScore(), 2)}.`;
      },
    },
    {
      id: "edgels",
      title: "A line is many windows",
      prose: () => [
        "A match of two segments is judged at all its edgels. Only correlations above 0.6 are counted, so that a chimney in front spoils its own edgels only; B99 asks for 15 of them.",
        "An eave has the roof on one side. On the other, one view sees the wall below it, the next one the ground. Look at the sides one at a time.",
      ],
      figure: EdgelFigure,
      says: () =>
        `${{ both: "With whole windows", roof: "On the roof's side", ground: "On the ground's side" }[side.value]} ${kept().length} of ${EDGELS} edgels count${kept().length === 0 ? "" : `, and their mean is ${num(meanOf(kept()), 2)}`}. ${kept().length >= 15 ? "That is a match." : "That is no match."}`,
    },
    onScene("own", "Candidates of a whole scene", realFigure("correlation-windows"), [
      "The picked segment, its candidates in the other views with their scores, and the two windows. Drag the point along the segment.",
    ]),
  ],
};
