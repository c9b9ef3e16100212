/** Lesson 5: from image points to a point in space, and how well it is known. */
import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { counted } from "../../app/parts/counted";
import { clamp, ellipseOf, type Mat, norm, sub } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { Curve, Dot, Drawing, Handle, inMetres, Label, Line, Plot, Slider } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { metres, num, pixels } from "../parts/say";
import { ImagePane, Space, seen } from "../parts/scene";
import { PixelAccuracy } from "../scene/PixelInViews";
import { atDepth, type Camera, imageOf, projection } from "../toy/camera";
import { aerial, CORNERS, VIEWS } from "../toy/house";
import { type Ends3, nearestOnRays } from "../toy/lines";
import { covarianceOf, reprojectionError, triangulated } from "../toy/triangulation";

const [FIRST, SECOND] = VIEWS;
const X0 = CORNERS.ridgeEast;
const off = signal(8);
const measured = (): readonly [Vec2, Vec2] => {
  const [x, y] = imageOf(SECOND, X0);
  return [imageOf(FIRST, X0), [x, y + off.value]];
};
const PAIR = [projection(FIRST), projection(SECOND)];
const found = () => triangulated(PAIR, measured(), X0);
const rays = (): readonly [Ends3, Ends3] => {
  const [x, x2] = measured();
  return [
    [FIRST.C, atDepth(FIRST, x, 42)],
    [SECOND.C, atDepth(SECOND, x2, 42)],
  ];
};

function SkewFigure() {
  const [a, b] = rays();
  const [p, q] = nearestOnRays(a, b);
  const X = found();
  const [x, x2] = measured();
  const mark = (camera: Camera, at: Vec2, colour: 1 | 2) => (
    <ImagePane camera={camera} colour={colour}>
      <Line from={at} to={imageOf(camera, X)} class="s7 thick" />
      <Dot at={imageOf(camera, X)} class="s4" />
      {colour === 1 ? (
        <Dot at={at} class="s1" />
      ) : (
        <Handle
          at={at}
          class="s2"
          label="The measured point of the second view"
          says={`off by ${pixels(off.value)}`}
          step={1}
          of={off}
          to={([, y]) => clamp(y - imageOf(SECOND, X0)[1], -25, 25)}
        />
      )}
    </ImagePane>
  );
  return (
    <div class="pair three">
      <Space label="Two rays in space" cameras={[FIRST, SECOND]}>
        <Line from={seen(a[0])} to={seen(a[1])} class="s1" />
        <Line from={seen(b[0])} to={seen(b[1])} class="s2" />
        <Line from={seen(p)} to={seen(q)} class="s7 thick" />
        <Dot at={seen(X)} class="s4" />
        <Label at={seen(X)} dx={10} dy={-6} class="s4 vector" text="X" />
      </Space>
      {mark(FIRST, x, 1)}
      {mark(SECOND, x2, 2)}
    </div>
  );
}

/** The point on the ground below the middle of the baseline, and the flying height. */
const TARGET: Vec3 = [0, 0, 0];
const FLYING_M = 40;
const SIGMA = 0.5;
const ENLARGED = 40;
const baseline = signal(20);
const strip = (B: number, count: number): Camera[] =>
  Array.from({ length: count }, (_, i) => aerial([-B / 2 + (B * i) / (count - 1), 0, FLYING_M], TARGET));
const sigmasOf = (cameras: readonly Camera[], sigma = SIGMA): { x: number; z: number; full: Mat } => {
  const full = covarianceOf(cameras.map(projection), TARGET, sigma);
  return { x: Math.sqrt(full[0]?.[0] ?? 0), z: Math.sqrt(full[2]?.[2] ?? 0), full };
};
const sigmaZ = (B: number) => sigmasOf(strip(B, 2)).z;

const GROUND_PX = 250;
const SIDE = inMetres(480, 330, 5.4, [240, GROUND_PX]);
const inSide = SIDE.at;

/** The plane through the baseline, from the side: cameras, rays and the ellipse of the point, enlarged. */
function FromSide(props: {
  cameras: readonly Camera[];
  sigma: number;
  label: string;
  children?: ComponentChildren;
}) {
  const { cameras, sigma, label, children } = props;
  const { full } = sigmasOf(cameras, sigma);
  const [a, b, d] = [full[0]?.[0] ?? 0, full[0]?.[2] ?? 0, full[2]?.[2] ?? 0];
  const { major, minor, angle } = ellipseOf(a, b, d);
  const [cx, cy] = inSide(0, 0);
  const by = ENLARGED * SIDE.scale;
  return (
    <Drawing width={SIDE.width} height={SIDE.height} label={label}>
      <Line from={inSide(-42, 0)} to={inSide(42, 0)} class="rule" />
      {cameras.map(({ C }) => (
        <Line key={C[0]} from={inSide(C[0], C[2])} to={[cx, cy]} class="s1 faint" />
      ))}
      <ellipse
        class="outline s7"
        rx={by * major}
        ry={by * minor}
        transform={`translate(${cx} ${cy}) rotate(${(-angle * 180) / Math.PI})`}
      />
      <Dot at={[cx, cy]} class="s4" />
      {cameras.map(({ C }) => (
        <Dot key={C[0]} at={inSide(C[0], C[2])} class="s5" />
      ))}
      {children}
    </Drawing>
  );
}

function BaselineFigure({ isRevealed }: { isRevealed: boolean }) {
  const B = baseline.value;
  const at = inSide(B / 2, FLYING_M);
  return (
    <FromSide cameras={strip(B, 2)} sigma={SIGMA} label="Two cameras and the ellipse of the point">
      <Line from={inSide(-B / 2, FLYING_M)} to={at} class="s5" />
      <Label
        at={inSide(0, FLYING_M)}
        dy={-8}
        anchor="middle"
        class="s5"
        letter="B"
        text={`= ${metres(B, 0)}`}
      />
      <Label
        at={[SIDE.width - 6, GROUND_PX]}
        dy={30}
        anchor="end"
        class="s7"
        text={`σ of the height: ${metres(sigmaZ(B), 3)}`}
      />
      {isRevealed && (
        <Handle
          at={at}
          class="s5"
          label="Second camera"
          says={`baseline ${metres(B, 0)}`}
          step={SIDE.scale / 2}
          of={baseline}
          to={(at) => clamp(Math.round(2 * SIDE.place(at)[0]), 3, 70)}
        />
      )}
    </FromSide>
  );
}

/** The rule of thumb for two parallel cameras. */
const ruleOf = (B: number) => ((FLYING_M ** 2 * Math.SQRT2) / (FIRST.f * B)) * SIGMA;

function RuleFigure() {
  const B = baseline.value;
  const baselines = Array.from({ length: 68 }, (_, i) => 3 + i);
  const curve = (sigmaOf: (b: number) => number) =>
    baselines.map((b): Vec2 => [b, sigmaOf(b)]).filter(([, value]) => value < most);
  const most = 0.35;
  return (
    <>
      <Plot
        x={[3, 70, "baseline, m"]}
        y={[0, most, "σ of the height, m"]}
        label="Standard deviation of the height against the baseline"
      >
        {({ at, under, upright }) => (
          <>
            <Curve points={curve(ruleOf).map(at)} class="s5 dashed" />
            <Curve points={curve(sigmaZ).map(at)} class="s7" />
            <Line {...upright(B)} class="s5 faint" />
            <Handle
              at={at([B, Math.min(most, sigmaZ(B))])}
              class="s7"
              label="Baseline"
              says={metres(B, 0)}
              step={6}
              of={baseline}
              to={(place) => Math.round(clamp(under(place), 3, 70))}
            />
            <Label at={at([70, 0.3])} anchor="end" class="s5" text="- - rule" />
            <Label at={at([70, 0.255])} anchor="end" class="s7" text="— computed" />
          </>
        )}
      </Plot>
      <Slider symbol="B" label="baseline" of={baseline} range={[3, 70, 1]} suffix=" m" />
    </>
  );
}

const views = signal(2);
const LONG_M = 40;
const ofViews = (count: number) => sigmasOf(strip(LONG_M, count)).z;

function ViewsFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      <FromSide
        cameras={strip(LONG_M, isRevealed ? views.value : 2)}
        sigma={SIGMA}
        label="Several cameras over one baseline"
      />
      {isRevealed && <Slider symbol="N" label="views over the same 40 m" of={views} range={[2, 8, 1]} />}
    </>
  );
}

const sigma = signal(0.5);
function CovarianceFigure() {
  return (
    <>
      <FromSide
        cameras={strip(baseline.value, 2)}
        sigma={sigma.value}
        label="The ellipse by the accuracy of the image points"
      />
      <Slider symbol="sigma" label="of the image points" of={sigma} range={[0.1, 1.5, 0.05]} suffix=" px" />
      <Slider symbol="B" label="baseline" of={baseline} range={[3, 70, 1]} suffix=" m" />
    </>
  );
}

export const TRIANGULATION: Lesson = {
  id: "triangulation",
  title: "Triangulation and its uncertainty",
  aim: "You can say how accurate a height will be before anything is flown.",
  minutes: 8,
  papers: "B99 3.2 and 3.4, figures 4 and 9",
  screens: [
    {
      id: "skew",
      title: "Rays miss each other",
      prose: () => [
        "Two image points of one corner give two rays. With perfect points they meet. Measured points are off, and the rays pass each other.",
        "Not the middle between the rays is taken for $X$, but the point whose images are nearest to what was measured: it is the *images* that were measured. Drag the point of the second view.",
      ],
      formula: () => "min _ X sum _ i d _ i ^2",
      figure: SkewFigure,
      says: () => {
        const [p, q] = nearestOnRays(...rays());
        return `The rays pass each other at ${metres(norm(sub(p, q)), 2)}. The best $X$ leaves ${pixels(reprojectionError(PAIR, measured(), found()))} in the images, and is ${metres(norm(sub(found(), X0)), 2)} from the corner.`;
      },
    },
    {
      id: "baseline",
      title: "Drag the baseline",
      prose: () => [
        `Image points are good to half a pixel: $sigma$ = ${SIGMA} px. So $X$ is not a point but a cloud; the ellipse, drawn ${ENLARGED} times too large, holds one standard deviation of it.`,
        "Across the rays it is thin. Along them it is as long as the rays are parallel.",
      ],
      figure: BaselineFigure,
      predict: {
        kind: "estimate",
        question: `With $B$ = 20 m the height is good to ${metres(sigmaZ(20), 3)}. And with 10 m?`,
        unit: "m",
        range: [0.02, 0.4, 0.005],
        truth: () => sigmaZ(10),
        within: 0.02,
        why: () => "Half the baseline, twice the error. Now drag the camera.",
      },
      says: () => {
        const { x, z } = sigmasOf(strip(baseline.value, 2));
        return `From ${metres(FLYING_M, 0)} with a baseline of ${metres(baseline.value, 0)}: ${metres(z, 3)} in height, ${metres(x, 3)} along the flight: ${num(z / x)} times as much.`;
      },
    },
    {
      id: "rule",
      title: "The rule for planning",
      prose: () => [
        "For two cameras that look straight down the error has a formula. Depth counts twice: once because pixels grow, once because rays become parallel.",
        "Drag along the curve. The rule is good as long as the baseline is short against the height.",
      ],
      formula: () => "sigmaZ ≈ frac { Z ^2 } { f B } * sqrt { 2 } * sigma",
      figure: RuleFigure,
      says: () =>
        `At $B$ = ${metres(baseline.value, 0)} the rule says ${metres(ruleOf(baseline.value), 3)}, the computation ${metres(sigmaZ(baseline.value), 3)}.`,
    },
    {
      id: "covariance",
      title: "Where the ellipse comes from",
      prose: () => [
        "Move $X$ by a little, and its images move by $J$ times that. Turn this round: image errors of $sigma$ come from errors of $X$ with the covariance $sigmaX$.",
        "Each view adds its part to the sum before it is inverted. ridgeline keeps $sigmaX$ for every line, and says so in its files.",
      ],
      formula: () => "sigmaX = sigma ^2 ( sum _ i J _ i ^T J _ i ) ^ -1",
      figure: CovarianceFigure,
      says: () => {
        const { x, z } = sigmasOf(strip(baseline.value, 2), sigma.value);
        return `With image points good to ${pixels(sigma.value, 2)}: ${metres(x, 3)} along, ${metres(z, 3)} up.`;
      },
    },
    {
      id: "views",
      title: "More views",
      prose: () => [
        "More views make more observations. But what counts is how far they are apart: views between the two outer ones say little that these have not said.",
        "What more views really buy is something else: a wrong match that two views accept does not survive eight.",
      ],
      figure: ViewsFigure,
      predict: {
        kind: "choice",
        question: "Two views 40 m apart become eight over the same 40 m. How much better is the height?",
        options: ["Four times", "Twice", "By about a quarter"],
        right: () => 2,
        why: () =>
          `From ${metres(ofViews(2), 3)} to ${metres(ofViews(8), 3)}. Six views on the ends of a longer line would do more.`,
      },
      says: () =>
        `${counted(views.value, "views")}: ${metres(ofViews(views.value), 3)}, that is ${num(100 * (1 - ofViews(views.value) / ofViews(2)), 0)} % less than with two.`,
    },
    onScene(
      "own",
      "How accurate is your scene?",
      PixelAccuracy,
      [
        "The same formula with the cameras of whole photographs: pick a point and its height as in lesson 1. What it says holds before anything is matched.",
      ],
      "sigmaX = sigma ^2 ( sum _ i J _ i ^T J _ i ) ^ -1",
    ),
  ],
};
