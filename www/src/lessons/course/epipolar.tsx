/** Lesson 2: where a point of one view may be in another. */
import { signal } from "@preact/signals";
import {
  add,
  apply3,
  DEGREE,
  determinant,
  distance2,
  dot,
  homogeneous,
  lineDistance,
  nearestParameter,
  point2,
  scaled,
} from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { Dot, Handle, Label, Line, PointHandle, Shape, Slider } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { metres, num, pixels, place } from "../parts/say";
import { ImageLine, ImagePane, Space, seen } from "../parts/scene";
import { LinesInViews } from "../scene/LinesInViews";
import { realFigure } from "../scene/RealFigure";
import { atDepth, atHeight, centreOf, fundamental, imageOf, projected, projection } from "../toy/camera";
import { aerial, CORNERS, VIEWS } from "../toy/house";

const [FIRST, SECOND] = VIEWS;
const F = fundamental(projection(FIRST), projection(SECOND));
const [WIDTH, HEIGHT] = [FIRST.width, FIRST.height];

const INSIDE = { size: FIRST, margin: 4 } as const;

/** The bird: seen at this place, at a height that only the lesson knows. */
const BIRD: Vec2 = [196, 172];
const BIRD_HEIGHT = 14;
const bird = atHeight(FIRST, BIRD, BIRD_HEIGHT);
const guess = signal<Vec2>([150, 60]);

function EpipolarLine({ of, F: matrix = F, class: name = "s2" }: { of: Vec2; F?: typeof F; class?: string }) {
  return <ImageLine of={apply3(matrix, homogeneous(of))} camera={SECOND} class={name} />;
}

function BirdFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <div class="pair">
      <ImagePane camera={FIRST} colour={1}>
        <Dot at={BIRD} class="s1" />
        <Label at={BIRD} dx={9} dy={5} class="s1 vector" text="x" />
      </ImagePane>
      <ImagePane camera={SECOND} colour={2}>
        {isRevealed && <EpipolarLine of={BIRD} />}
        {isRevealed && <Dot at={imageOf(SECOND, bird)} class="s2" />}
        <PointHandle of={guess} {...INSIDE} class="s6" label="Your guess in the second view" />
      </ImagePane>
    </div>
  );
}

const depth = signal(31);

function RayFigure() {
  const ray = (s: number): Vec3 => atDepth(FIRST, BIRD, s);
  const X = ray(depth.value);
  const [near, far] = [20, 42];
  return (
    <div class="pair">
      <Space label="The ray in space" cameras={[FIRST, SECOND]}>
        <Shape points={[seen(FIRST.C), seen(SECOND.C), seen(X)]} class="s5 area" />
        <Line from={seen(FIRST.C)} to={seen(ray(far))} class="s1" />
        <Line from={seen(SECOND.C)} to={seen(X)} class="s2" />
        <Handle
          at={seen(X)}
          class="s4"
          label="Point X on the ray"
          says={metres(depth.value)}
          of={depth}
          to={(to) => nearestParameter((s) => seen(ray(s)), near, far, to)}
        />
        <Label at={seen(X)} dx={12} dy={-6} class="s4 vector" text="X" />
      </Space>
      <ImagePane camera={SECOND} label="The ray in the second view" colour={2}>
        <EpipolarLine of={BIRD} class="s2 faint" />
        <Line from={imageOf(SECOND, ray(near))} to={imageOf(SECOND, X)} class="s2" />
        <Dot at={imageOf(SECOND, X)} class="s2" />
        <Label at={imageOf(SECOND, X)} dx={9} dy={-7} class="s2 vector" text="x′" />
      </ImagePane>
    </div>
  );
}

const left = signal<Vec2>([140, 92]);
const right = signal<Vec2>([150, 110]);
/** F is of any scale: here its product with e.g. pixels is in pixels from the line. */
const productOf = () => {
  const line = apply3(F, homogeneous(left.value));
  return dot(homogeneous(right.value), line) / Math.hypot(line[0], line[1]);
};

function ConstraintFigure() {
  return (
    <div class="pair">
      <ImagePane camera={FIRST} colour={1}>
        <PointHandle of={left} {...INSIDE} class="s1" label="x in the first view" />
      </ImagePane>
      <ImagePane camera={SECOND} colour={2}>
        <EpipolarLine of={left.value} />
        <PointHandle of={right} {...INSIDE} class="s2" label="x′ in the second view" />
      </ImagePane>
    </div>
  );
}

/** How steeply the second camera is above the first, radians: 0 beside it, 90 degrees above it. */
const rise = signal(0);
const STEP_M = 14;
const lower = aerial([-3, -3, 24]);
const raised = () => aerial([-3 + STEP_M * Math.cos(rise.value), -3, 24 + STEP_M * Math.sin(rise.value)]);
const epipole = () => point2(projected(projection(raised()), lower.C));
const STARS: readonly Vec2[] = [
  [30, 20],
  [290, 45],
  [90, 70],
  [200, 95],
  [40, 130],
  [280, 150],
  [150, 180],
  [90, 205],
  [240, 225],
];

function PencilFigure({ isRevealed }: { isRevealed: boolean }) {
  const camera = raised();
  const matrix = fundamental(projection(lower), projection(camera));
  return (
    <>
      <div class="pair">
        <Space label="Both cameras" cameras={[lower, camera]}>
          <Line from={seen(lower.C)} to={seen(camera.C)} class="s5 thick" />
        </Space>
        <ImagePane
          camera={camera}
          title="Epipolar lines in the second view"
          label="Epipolar lines"
          colour={2}
        >
          {STARS.map((x) => (
            <EpipolarLine key={x.join()} of={x} F={matrix} class="s2" />
          ))}
          <Dot at={epipole()} class="s2" />
        </ImagePane>
      </div>
      {isRevealed && (
        <Slider
          label="direction from the first camera to the second"
          of={rise}
          unit={DEGREE}
          range={[0, 90, 1]}
          suffix="° upwards"
        />
      )}
    </>
  );
}

/** Heights between which the eave may be, by handles on the beam. */
const heights = signal<readonly [number, number]>([0, 14]);
const VERGE: readonly [Vec2, Vec2] = [
  imageOf(FIRST, CORNERS.southEaveWest),
  imageOf(FIRST, CORNERS.ridgeWest),
];
const onBeam = (end: 0 | 1, h: number): Vec2 => imageOf(SECOND, atHeight(FIRST, VERGE[end], h));
const middleOfBeam = (h: number): Vec2 => scaled(add(onBeam(0, h), onBeam(1, h)), 0.5);

function BeamFigure() {
  const [low, high] = heights.value;
  const handle = (which: 0 | 1, h: number) => (
    <Handle
      at={onBeam(0, h)}
      class="s6"
      label={which === 0 ? "Least height" : "Greatest height"}
      says={metres(h)}
      value={h}
      of={heights}
      to={(place): Vec2 => {
        const found = nearestParameter((t) => onBeam(0, t), -2, 24, place);
        return which === 0 ? [Math.min(found, high - 0.5), high] : [low, Math.max(found, low + 0.5)];
      }}
    />
  );
  return (
    <div class="pair">
      <ImagePane camera={FIRST} title="A segment of the first view" colour={1}>
        <Line from={VERGE[0]} to={VERGE[1]} class="s1 thick" />
      </ImagePane>
      <ImagePane camera={SECOND} title="Its beam in the second view" colour={2}>
        <EpipolarLine of={VERGE[0]} class="s2 faint" />
        <EpipolarLine of={VERGE[1]} class="s2 faint" />
        <Shape
          points={[onBeam(0, low), onBeam(1, low), onBeam(1, high), onBeam(0, high)]}
          class="s6 outline"
        />
        {handle(0, low)}
        {handle(1, high)}
      </ImagePane>
    </div>
  );
}

const rows = (matrix: typeof F) =>
  matrix.map((row) => row.map((one) => num(1000 * one, 2)).join(" ")).join(" ; ");

export const EPIPOLAR: Lesson = {
  id: "epipolar",
  title: "Epipolar geometry and F",
  aim: "You can draw the line on which a point must be in another view, and say why.",
  minutes: 9,
  papers: "B99 3.1, figures 2 and 3",
  screens: [
    {
      id: "bird",
      title: "Where is the bird?",
      prose: () => [
        "A bird flies over the house. The first view sees it at $x$. Nobody knows how high it flies.",
        "In the second view it is drawn nowhere. Drag the mark to where you would look for it.",
      ],
      figure: BirdFigure,
      predict: {
        kind: "place",
        question: "Where might the bird be in the second view?",
        how: () =>
          `Your mark is ${pixels(lineDistance(apply3(F, homogeneous(BIRD)), guess.value), 0)} from the line on which it must be. The bird, at ${metres(BIRD_HEIGHT, 0)}, is at the point. No place beside the line is possible, whatever the height.`,
      },
      says: () =>
        `Your mark is ${pixels(lineDistance(apply3(F, homogeneous(BIRD)), guess.value))} beside the line. Drag it on.`,
    },
    {
      id: "ray",
      title: "The line is the ray, seen from the side",
      prose: () => [
        "The first view says on which ray $X$ is. The second camera sees that ray as a line: the *epipolar line* $le$.",
        "Drag $X$ along the ray. The plane through $C$, $C2$ and $X$ stays the same all the time: it is what cuts the second image in that line.",
      ],
      figure: RayFigure,
      says: () => {
        const X = atDepth(FIRST, BIRD, depth.value);
        return `At a depth of ${metres(depth.value)} the point is ${metres(X[2])} above the ground, and $x2$ is at ${place(imageOf(SECOND, X), 0)}.`;
      },
    },
    {
      id: "constraint",
      title: "One equation for every pair of points",
      prose: () => [
        "The fundamental matrix $F$ turns the point $x$ into the coefficients of its epipolar line $le$. A point lies on a line when their product is 0.",
        "So two points can be images of one point in space only if the equation holds. Drag both.",
      ],
      formula: () => "le = F x , x2 ^T F x = 0",
      figure: ConstraintFigure,
      says: () => {
        const off = productOf();
        return Math.abs(off) < 1
          ? `$x2 ^T F x$ is zero to within a pixel: the two may be one point.`
          : `$x2$ is ${pixels(Math.abs(off))} ${off > 0 ? "on the one side of" : "on the other side of"} the line: these two are never images of one point.`;
      },
    },
    {
      id: "epipole",
      title: "All lines meet",
      prose: () => [
        "Every epipolar line passes through one point, the epipole $e2$: the place at which the second view sees the first camera, $C$.",
        "Beside each other on a strip, cameras see each other far outside their images, and the lines are nearly parallel.",
      ],
      formula: () => "e2 ~ P2 C",
      figure: PencilFigure,
      predict: {
        kind: "choice",
        question:
          "The second camera rises until it is straight above the first. What become the epipolar lines?",
        options: ["Parallels, as now", "A star, from one point of the image", "Circles about one point"],
        right: () => 1,
        why: () =>
          "From above, the first camera is inside the image, and every line passes through it. Raise it.",
      },
      says: () => {
        const e = epipole();
        const isInside = e[0] > 0 && e[0] < WIDTH && e[1] > 0 && e[1] < HEIGHT;
        const by = distance2(e, [WIDTH / 2, HEIGHT / 2]);
        return isInside
          ? `The epipole is inside the image, at ${place(e, 0)}. Near it, depth cannot be told.`
          : `The epipole is ${pixels(by, 0)} from the middle of the image, outside of it.`;
      },
    },
    {
      id: "matrix",
      title: "F from two projection matrices",
      prose: () => [
        "With known cameras nothing is estimated. Where the columns of $P$ and $P2$ are known, $F$ follows: take $x$ out along its ray, project, and join the result with the epipole by a cross product.",
        "The cross product with $e2$ has rank 2, so $F$ has, too: $F e1 = 0v$. The first view's epipole has no epipolar line.",
      ],
      formula: () => `F = [ e2 ] _ × P2 P ^ + = 10 ^ { -3 } matrix { ${rows(F)} }`,
      figure: ConstraintFigure,
      says: () => {
        const back = apply3(
          F,
          homogeneous(point2(projected(projection(FIRST), centreOf(projection(SECOND))))),
        );
        return `The determinant is ${num(determinant(F), 6)}, and $F e1$ is (${back.map((one) => num(one, 4)).join(", ")}). For lines in the first view of points in the second one takes $F ^T$: nothing else is needed.`;
      },
    },
    {
      id: "beam",
      title: "A segment has a beam",
      prose: () => [
        "The end points of a segment have two epipolar lines. Between them lies the *epipolar beam*: whatever matches the segment must cross it.",
        "And nobody builds 100 m up. If the heights of roofs are roughly known, the beam is cut at both ends. Drag the heights on the beam itself.",
      ],
      figure: BeamFigure,
      says: () => {
        const [low, high] = heights.value;
        const length = distance2(middleOfBeam(low), middleOfBeam(high));
        return `From ${metres(low)} to ${metres(high)} the beam is ${pixels(length, 0)} long: ${pixels(length / (high - low))} for a metre of height.`;
      },
    },
    onScene(
      "own",
      "Lines on whole photographs",
      LinesInViews,
      [
        "Drag the mark to the corner of a roof. Its epipolar line passes through the same corner in every other photograph: check it.",
        "Where it does not, the orientation is wrong. This is how ridgeline finds out.",
      ],
      "le = F x",
    ),
    onScene("beams", "Beams in use", realFigure("epipolar-beam"), [
      "Here the core matches segments: the picked one, its beam, and the candidates in it. Pick another segment; drag the point along it.",
    ]),
  ],
};
