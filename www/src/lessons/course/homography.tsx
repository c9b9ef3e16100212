/** Lesson 7: a plane maps image to image; one angle of it is free, and the images choose it. */
import { computed, signal } from "@preact/signals";
import { clamp, DEGREE, distance2 } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import {
  Curve,
  Dot,
  Drawing,
  Handle,
  inMetres,
  Label,
  Line,
  Plot,
  PointHandle,
  Slider,
  Switch,
  WindowCard,
} from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, num, pixels } from "../parts/say";
import { ImagePane } from "../parts/scene";
import { realFigure } from "../scene/RealFigure";
import { type Camera, imageOf, mapped, planeHomography } from "../toy/camera";
import { aerial, photograph, SLOPE, SOUTH_EAVE, surfaceAt } from "../toy/house";
import { type InterestPoint, ncc, peakOf, planeAt, similarity, warpedWindow, windowAt } from "../toy/windows";

const FIRST = aerial([-3, -8, 42]);
const SECOND = aerial([7, -5, 42]);
const NEAR = aerial([0, -7.5, 42]);
const FAR = aerial([13, 3, 40]);

const PLANES = { roof: "H of the south roof", ground: "H of the ground" } as const;
type PlaneName = keyof typeof PLANES;
const plane = signal<PlaneName>("roof");
const at = signal<Vec2>([150, 130]);
const planeOf = (name: PlaneName) =>
  name === "roof" ? planeAt(SOUTH_EAVE, SLOPE) : { n: [0, 0, 1] as const, d: 0 };
const matrixOf = (name: PlaneName) => {
  const { n, d } = planeOf(name);
  return planeHomography(FIRST, SECOND, n, d);
};
const taken = () => mapped(matrixOf(plane.value), at.value);
const really = () => imageOf(SECOND, surfaceAt(FIRST, at.value).X);

function PlaneFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      {isRevealed && <Switch legend="Plane of the homography" names={PLANES} of={plane} />}
      <div class="pair">
        <ImagePane camera={FIRST} colour={1}>
          <PointHandle of={at} size={FIRST} margin={5} class="s1" label="Point x" isFixed={!isRevealed} />
        </ImagePane>
        <ImagePane camera={SECOND} colour={2}>
          <Line from={taken()} to={really()} class="s7" />
          <Dot at={really()} class="s2" />
          <Dot at={taken()} class="s6" />
          <Label at={taken()} dx={9} dy={-7} class="s6" text="Hx" />
        </ImagePane>
      </div>
    </>
  );
}

/** A function that works once for each of its arguments. */
function remembered<Args extends readonly unknown[], Made>(make: (...of: Args) => Made) {
  const known = new Map<string, Made>();
  return (...of: Args): Made => {
    const made = known.get(of.join()) ?? make(...of);
    known.set(of.join(), made);
    return made;
  };
}

/** Of the camera, grey values: without it the faintest texture would correlate as well as the strongest. */
const NOISE = 4;
/** How much texture the roof has; pictures are made again for each amount. */
const texture = signal(1);
interface Shot {
  camera: Camera;
  picture: ReturnType<typeof photograph>;
}
const shotsWith = remembered((own: number): readonly Shot[] =>
  [FIRST, SECOND, NEAR, FAR].map((camera) => ({
    camera,
    picture: photograph(camera, { texture: own, noise: NOISE }),
  })),
);
const shots = computed(() => shotsWith(texture.value));
const shot = (i: number) => shots.value[i] as Shot;

const theta = signal(5 * DEGREE);
/** The strip of the first view above the eave: columns and rows of pixels. */
const STRIP = { x: 168, y: 142, size: 33 };
const strip = () => {
  const { x, y, size } = STRIP;
  return windowAt(shot(0).picture, [x, y], size);
};
const warped = (angle: number) => {
  const { n, d } = planeAt(SOUTH_EAVE, angle);
  const { x, y, size } = STRIP;
  return warpedWindow(shot(1).picture, planeHomography(FIRST, SECOND, n, d), [x, y], size);
};

const SECTION = inMetres(320, 250, 16, [70, 190]);
const inSection = (y: number, z: number): Vec2 => SECTION.at(y + 4, z - 5);
const FAN_M = 9;

/** The roof cut across, with the half-plane that is tried. */
function Section({ isRevealed }: { isRevealed: boolean }) {
  const angle = theta.value;
  const end: Vec2 = inSection(-4 + FAN_M * Math.cos(angle), 5 + FAN_M * Math.sin(angle));
  const foot = inSection(-4, 5);
  return (
    <Drawing width={SECTION.width} height={SECTION.height} label="The eave from its end, and the half-plane">
      {isRevealed && (
        <>
          <Line from={foot} to={inSection(0, 8)} class="s4 thick" />
          <Line from={inSection(0, 8)} to={inSection(4, 5)} class="s4 faint" />
        </>
      )}
      <Line from={foot} to={inSection(-4, 3)} class="rule" />
      <Line from={foot} to={inSection(8, 5)} class="rule" />
      <Line from={foot} to={end} class="s6 thick" />
      <Dot at={foot} class="s4" />
      <Label at={foot} dx={-8} dy={-8} anchor="end" class="s4 letter" text="L" />
      <Label at={end} dx={14} dy={4} class="s6" letter="θ" text={`= ${degrees(angle)}`} />
      <Handle
        at={end}
        class="s6"
        label="Half-plane, angle theta"
        says={degrees(angle)}
        value={angle / DEGREE}
        step={3}
        of={theta}
        to={([x, y]) => clamp(Math.atan2(foot[1] - y, x - foot[0]), -75 * DEGREE, 75 * DEGREE)}
      />
    </Drawing>
  );
}

function Strips() {
  const [own, other] = [strip(), warped(theta.value)];
  return (
    <div class="windows-row">
      <WindowCard
        values={own}
        size={STRIP.size}
        colour={1}
        title="First view"
        label="The roof above the eave in the first view"
      />
      <WindowCard
        values={other}
        size={STRIP.size}
        colour={2}
        title="Second view by H(θ)"
        label="The second view, warped by the half-plane"
      />
    </div>
  );
}

function FanFigure() {
  return (
    <div class="pair">
      <Section isRevealed={false} />
      <Strips />
    </div>
  );
}

function GuessFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      <div class="pair">
        <Section isRevealed={isRevealed} />
        <Strips />
      </div>
      {isRevealed && <SimPlot isAtTheta curves={[{ values: curveOf("roof", 1), class: "s6" }]} />}
    </>
  );
}

const SIDES = { roof: "The roof's side", ground: "The other side" } as const;
type Side = keyof typeof SIDES;
const side = signal<Side>("roof");
/** Points of interest: a grid beside the eave, upwards on the roof or downwards before it. */
const pointsOf = (of: Side): InterestPoint[] =>
  [0.7, 1.3, 1.9, 2.5].flatMap((away) =>
    [-3.4, -2, -0.6, 0.8, 2.2, 3.6].map((x): InterestPoint => {
      const X =
        of === "roof" ? ([x, -4 + away, 5 + away * Math.tan(SLOPE)] as const) : ([x, -4 - away, 0] as const);
      return { x: imageOf(FIRST, X), distance: away };
    }),
  );
const ANGLES = Array.from({ length: 61 }, (_, i) => (-75 + 2.5 * i) * DEGREE);
const curves = computed(() => {
  const all = shots.value;
  return remembered((of: Side, other: number) => {
    const points = pointsOf(of);
    return ANGLES.map((angle) => similarity(all[0] as Shot, all[other] as Shot, SOUTH_EAVE, angle, points));
  });
});
const curveOf = (of: Side, other: number) => curves.value(of, other);

function SimPlot(props: {
  curves: readonly { values: readonly number[]; class: string }[];
  /** Marks the angle that the reader has turned to. */
  isAtTheta?: boolean;
}) {
  const { curves: all, isAtTheta = false } = props;
  return (
    <Plot
      x={[-75, 75, "θ, degrees"]}
      y={[0, 1, "Sim(θ)"]}
      label="Similarity against the angle of the half-plane"
      height={230}
    >
      {({ at: place, level, upright }) => (
        <>
          <Line {...level(0.4)} class="s7 dashed" />
          {all.map(({ values, class: name }) => (
            <Curve
              key={name}
              class={name}
              points={values.map((value, i) => place([(ANGLES[i] as number) / DEGREE, value]))}
            />
          ))}
          {isAtTheta && <Line {...upright(theta.value / DEGREE)} class="s6 faint" />}
        </>
      )}
    </Plot>
  );
}

const peak = () => peakOf(ANGLES, curveOf(side.value, 1));
/** B99 figure 12. */
const LEAST = { height: 0.4, curvature: 4, amplitude: 0.2 } as const;
const failed = () => {
  const { height, curvature, amplitude } = peak();
  return [
    ...(height < LEAST.height ? ["its peak is below 0.4"] : []),
    ...(curvature < LEAST.curvature ? ["it bends too little at the peak"] : []),
    ...(amplitude < LEAST.amplitude ? ["it falls by less than 0.2"] : []),
  ];
};

function AcceptFigure() {
  return (
    <>
      <Switch legend="Side of the eave" names={SIDES} of={side} />
      <SimPlot curves={[{ values: curveOf(side.value, 1), class: "s6" }]} />
      <Slider
        label="texture of the roof"
        of={texture}
        range={[0, 1, 0.25]}
        says={`${num(100 * texture.value, 0)} %`}
      />
    </>
  );
}

function BaselineFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <SimPlot
      curves={[
        { values: curveOf("roof", 2), class: "s5" },
        ...(isRevealed ? [{ values: curveOf("roof", 3), class: "s2" }] : []),
      ]}
    />
  );
}
/** How far from the peak the curve has lost half of its height, degrees. */
const widthOf = (values: readonly number[]) => {
  const top = Math.max(...values);
  return 2.5 * values.filter((one) => one > top / 2).length;
};

export const HOMOGRAPHY: Lesson = {
  id: "homography",
  title: "Plane homographies and Sim(θ)",
  aim: "You can find a roof's slope from a single line, by letting the images agree.",
  minutes: 10,
  papers: "B99 4.1, figures 10 to 15",
  screens: [
    {
      id: "map",
      title: "A plane carries points over",
      prose: () => [
        "From one view alone, $x$ could be anywhere on its ray. Say that it lies on a known plane, and its place in space is fixed, so its place in the second view is, too.",
        "For all points of the plane together that is one matrix of 3 × 3: the homography $H$.",
      ],
      formula: () => "x2 ~ H x",
      figure: PlaneFigure,
      predict: {
        kind: "choice",
        question: "$H$ is made of the plane of the south roof. Where does it take a point of the ground?",
        options: ["To its right place", "Beside it: as if the ground were on the roof's plane", "Nowhere"],
        right: () => 1,
        why: () =>
          "A homography takes every point over as if it lay on its plane. Drag $x$ off the roof, and the two marks part.",
      },
      says: () => {
        const off = distance2(taken(), really());
        const { name } = surfaceAt(FIRST, at.value);
        return `$x$ is on the ${name === "ground" ? "ground" : name.endsWith("roof") ? name : `${name} wall`}. $H$ takes it ${off < 0.5 ? "to its right place." : `${pixels(off)} beside its right place.`}`;
      },
    },
    {
      id: "fan",
      title: "One angle is free",
      prose: () => [
        "Through the eave $L$ passes a fan of planes, told apart by one angle $theta$. Each makes a homography $H$. Where the first matrix is [I | 0] and the second has the columns $A2$ and $a2$, only $vn$ depends on the plane: its normal, divided by minus its distance.",
        "Drag the half-plane. The second view is fetched through its $H$, pixel by pixel.",
      ],
      formula: () => "H ( theta ) = A2 + a2 vn ^T ( theta )",
      figure: FanFigure,
      says: () =>
        `At $theta$ = ${degrees(theta.value)} the two pieces correlate with ${num(ncc(strip(), warped(theta.value)), 2)}.`,
    },
    {
      id: "guess",
      title: "Find the slope by eye",
      prose: () => [
        "Turn the half-plane until both pieces show the same tiles. Then see what the curve says: it is the similarity at every angle.",
      ],
      formula: () => "Sim ( theta ) = sum _ i w Cor ^2 ( x , H ( theta ) x )",
      figure: GuessFigure,
      predict: {
        kind: "place",
        question: "At which $theta$ do the two pieces agree?",
        how: () =>
          `You chose ${degrees(theta.value)}, the roof has ${degrees(SLOPE)}, and the curve has its peak at ${degrees(peakOf(ANGLES, curveOf("roof", 1)).theta)}. No second line was needed.`,
      },
      says: () =>
        `At ${degrees(theta.value)} the pieces correlate with ${num(ncc(strip(), warped(theta.value)), 2)}.`,
    },
    {
      id: "accept",
      title: "When is it a plane?",
      prose: () => [
        "Any curve has a highest place. A plane is accepted only if the peak is at least 0.4, the curve bends there by at least 4.0 (per square radian), and it falls from there by at least 0.2.",
        "Look at the other side of the eave, where there is nothing but ground far below. Then take the texture away.",
      ],
      figure: AcceptFigure,
      says: () => {
        const { height, curvature, amplitude, theta: top } = peak();
        const why = failed();
        return `Peak ${num(height, 2)} at ${degrees(top)}, bend ${num(curvature, 1)}, fall ${num(amplitude, 2)}. ${why.length === 0 ? "It is accepted." : `It is rejected: ${why.join(", ")}.`}`;
      },
    },
    {
      id: "baseline",
      title: "Near views, far views",
      prose: () => [
        "The curve of two neighbouring views is shown. A view from far away looks at the roof from another side.",
      ],
      figure: BaselineFigure,
      predict: {
        kind: "choice",
        question: "How is the curve of the far view different?",
        options: ["Higher and wider", "Lower and narrower", "The same"],
        right: () => 1,
        why: () =>
          "Windows that look different correlate less, so the peak is lower; but a wrong angle moves them further, so it is narrower. The mean over views has something of both.",
      },
      says: () =>
        `Near: peak ${num(Math.max(...curveOf("roof", 2)), 2)}, half of it over ${num(widthOf(curveOf("roof", 2)), 0)}°. Far: peak ${num(Math.max(...curveOf("roof", 3)), 2)}, half of it over ${num(widthOf(curveOf("roof", 3)), 0)}°.`,
    },
    onScene("own", "Turn a half-plane of a whole scene", realFigure("theta-sweep"), [
      "Drag $theta$ on the curve: the windows of all views are warped by it. Show the other side of the line, too; at the border of a roof it agrees at no angle.",
    ]),
  ],
};
