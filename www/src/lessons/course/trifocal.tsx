/** Lesson 4: two views never contradict each other about a line; the third one can. */
import { signal } from "@preact/signals";
import { clamp, DEGREE, lineDistance, lineThrough, replaced } from "../../shared/linear";
import type { Vec3 } from "../../shared/records";
import { Dot, Handle, Label, Line, Slider, Switch } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, metres, pixels, place } from "../parts/say";
import { ImageLine, ImagePane, PlaneOfLine, Space, seen } from "../parts/scene";
import { realFigure } from "../scene/RealFigure";
import { type Camera, projection } from "../toy/camera";
import { noisy, stream } from "../toy/evidence";
import { ACROSS, aerial, CORNERS, RIDGE, SOUTH_EAVE } from "../toy/house";
import {
  type Ends2,
  type Ends3,
  inView,
  lineOfTwo,
  partBetween,
  predicted,
  transferredLine,
  trifocal,
} from "../toy/lines";

const [FIRST, SECOND, THIRD] = ACROSS;
const IN_FIRST = inView(FIRST, RIDGE);
/** By how much the line of the second view is moved down, pixels, at its two ends. */
const moved = signal<readonly [number, number]>([0, 0]);
const inSecond = (): Ends2 => {
  const [p, q] = inView(SECOND, RIDGE);
  return [
    [p[0], p[1] + moved.value[0]],
    [q[0], q[1] + moved.value[1]],
  ];
};
const spaceLine = () => partBetween(lineOfTwo([FIRST, SECOND], [IN_FIRST, inSecond()]), 0, -6, 6);

function MovedLine({ end }: { end: 0 | 1 }) {
  const at = inSecond()[end];
  return (
    <Handle
      at={at}
      class="s2"
      label={`${end === 0 ? "West" : "East"} end of the line l′`}
      says={`moved by ${pixels(moved.value[end], 0)}`}
      value={moved.value[end]}
      step={1}
      of={moved}
      to={([, y]) => replaced(moved.value, end, clamp(moved.value[end] + y - at[1], -28, 28))}
    />
  );
}

function TwoPlanesFigure({ isRevealed }: { isRevealed: boolean }) {
  const L = spaceLine();
  return (
    <div class="pair">
      <Space label="The planes of two image lines" cameras={[FIRST, SECOND]}>
        <PlaneOfLine camera={FIRST} ends={IN_FIRST} class="s1 area" down={4} />
        <PlaneOfLine camera={SECOND} ends={inSecond()} class="s2 area" down={4} />
        <Line from={seen(L[0])} to={seen(L[1])} class="s4 thick" />
        <Label at={seen(L[1])} dx={8} dy={-4} class="s4 letter" text="L" />
      </Space>
      <ImagePane camera={SECOND} title="The line l′ of the second view" colour={2}>
        <Line from={inSecond()[0]} to={inSecond()[1]} class="s2 thick" />
        {isRevealed && <MovedLine end={0} />}
        {isRevealed && <MovedLine end={1} />}
      </ImagePane>
    </div>
  );
}

/** The reader's guess of the line in the third view, by its ends. */
const guess = signal<Ends2>([
  [60, 200],
  [260, 200],
]);
/** A line that is no edge of the drawing: a wire over the house. */
const WIRE: Ends3 = [
  [-9, 5, 11],
  [9, -3, 7],
];

function PredictFigure({ isRevealed }: { isRevealed: boolean }) {
  const [a, b] = [inView(FIRST, WIRE), inView(SECOND, WIRE)];
  const line = predicted([FIRST, SECOND], [a, b], THIRD);
  return (
    <div class="pair three">
      <ImagePane camera={FIRST} colour={1}>
        <Line from={a[0]} to={a[1]} class="s1" />
      </ImagePane>
      <ImagePane camera={SECOND} colour={2}>
        <Line from={b[0]} to={b[1]} class="s2" />
      </ImagePane>
      <ImagePane camera={THIRD} colour={3}>
        {isRevealed && <ImageLine of={line} camera={THIRD} class="s3" />}
        <Line from={guess.value[0]} to={guess.value[1]} class="s6 dashed" />
        {([0, 1] as const).map((end) => (
          <Handle
            key={end}
            at={guess.value[end]}
            class="s6"
            label={`${end === 0 ? "One" : "Other"} end of your line`}
            says={place(guess.value[end], 0)}
            of={guess}
            to={(place) => replaced(guess.value, end, place)}
          />
        ))}
      </ImagePane>
    </div>
  );
}

const offLine = () => {
  const line = predicted([FIRST, SECOND], [inView(FIRST, WIRE), inView(SECOND, WIRE)], THIRD);
  return guess.value.map((x) => lineDistance(line, x)) as [number, number];
};

const T = trifocal(projection(THIRD), projection(FIRST), projection(SECOND));
const transferred = () => transferredLine(T, lineThrough(...IN_FIRST), lineThrough(...inSecond()));

function TensorFigure() {
  return (
    <div class="pair">
      <ImagePane camera={SECOND} colour={2}>
        <Line from={inSecond()[0]} to={inSecond()[1]} class="s2 thick" />
        <MovedLine end={0} />
        <MovedLine end={1} />
      </ImagePane>
      <ImagePane camera={THIRD} title="Third view: what both predict" colour={3}>
        <ImageLine of={transferred()} camera={THIRD} class="s3 thick" />
      </ImagePane>
    </div>
  );
}

const DECOYS = {
  A: SOUTH_EAVE,
  B: RIDGE,
  C: [CORNERS.northEaveWest, CORNERS.northEaveEast],
} as const satisfies Record<string, Ends3>;
type Decoy = keyof typeof DECOYS;
const decoy = signal<Decoy>("A");
const decoyLine = (of: Decoy) => predicted([FIRST, SECOND], [IN_FIRST, inView(SECOND, DECOYS[of])], THIRD);
/** How far the prediction is from the ridge in the third view, pixels. */
const decoyOff = (of: Decoy) => Math.max(...inView(THIRD, RIDGE).map((x) => lineDistance(decoyLine(of), x)));
const decoyHeight = (of: Decoy) =>
  partBetween(lineOfTwo([FIRST, SECOND], [IN_FIRST, inView(SECOND, DECOYS[of])]), 0, -5, 5).map(
    ([, , z]) => z,
  );

function DecoyFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      {isRevealed && <Switch legend="Candidate" names={{ A: "A", B: "B", C: "C" }} of={decoy} />}
      <div class="pair three">
        <ImagePane camera={FIRST} title="First view: the line l" colour={1}>
          <Line from={IN_FIRST[0]} to={IN_FIRST[1]} class="s1 thick" />
        </ImagePane>
        <ImagePane camera={SECOND} title="Second view: three candidates" colour={2}>
          {(Object.keys(DECOYS) as Decoy[]).map((name) => {
            const [p, q] = inView(SECOND, DECOYS[name]);
            const isShown = !isRevealed || name === decoy.value;
            return (
              <g key={name}>
                <Line from={p} to={q} class={`s2 ${isShown ? "thick" : "faint"}`} />
                <Label at={q} dx={8} dy={5} class="s2" text={name} />
              </g>
            );
          })}
        </ImagePane>
        <ImagePane camera={THIRD} colour={3}>
          {isRevealed && <ImageLine of={decoyLine(decoy.value)} camera={THIRD} class="s3" />}
        </ImagePane>
      </div>
    </>
  );
}

const azimuth = signal(60 * DEGREE);
/** Two views of one strip, whose baseline runs east, and one of the next. */
const STRIPS = [aerial([-9, 0, 42]), aerial([9, 0, 42]), aerial([0, 14, 42])] as const;
const NOISE_PX = 0.5;
const SAMPLES = 24;
const edge = (): Ends3 => {
  const [c, s] = [5 * Math.cos(azimuth.value), 5 * Math.sin(azimuth.value)];
  return [
    [-c, -s, 8],
    [c, s, 8],
  ];
};

/** The line as it is predicted in the third view, with noise in the two others. */
function samples(): Vec3[] {
  const random = stream(11);
  const seenIn = (camera: Camera) =>
    inView(camera, edge()).map((x) => noisy(x, NOISE_PX, random)) as unknown as Ends2;
  return Array.from({ length: SAMPLES }, () =>
    predicted([STRIPS[0], STRIPS[1]], [seenIn(STRIPS[0]), seenIn(STRIPS[1])], STRIPS[2]),
  );
}
const spread = () => {
  const [p, q] = inView(STRIPS[2], edge());
  const all = samples().flatMap((line) => [lineDistance(line, p), lineDistance(line, q)]);
  return Math.sqrt(all.reduce((sum, one) => sum + one ** 2, 0) / all.length);
};

function DegenerateFigure() {
  const [p, q] = inView(STRIPS[2], edge());
  return (
    <>
      <ImagePane camera={STRIPS[2]} title="View from the next strip: 24 predictions" colour={3}>
        {samples().map((line, i) => (
          <ImageLine key={i.toString()} of={line} camera={STRIPS[2]} class="s3 faint" />
        ))}
        <Line from={p} to={q} class="s4 thick" />
        <Dot at={p} class="s4" />
        <Dot at={q} class="s4" />
      </ImagePane>
      <Slider
        symbol="phi"
        label="between edge and baseline"
        of={azimuth}
        unit={DEGREE}
        range={[1, 90, 1]}
        suffix="°"
      />
    </>
  );
}

export const TRIFOCAL: Lesson = {
  id: "trifocal",
  title: "Trifocal transfer",
  aim: "You can predict a line in a third view, and know for which lines that is worth nothing.",
  minutes: 8,
  papers: "B99 3.2",
  screens: [
    {
      id: "planes",
      title: "Two lines always fit",
      prose: () => [
        "A line $l$ in an image and the projection centre make a plane $plane1$: the line in space lies somewhere in it. The second view's line $l2$ makes another one, $plane2$.",
      ],
      formula: () => "plane1 = P ^T l , plane2 = P2 ^T l2",
      figure: TwoPlanesFigure,
      predict: {
        kind: "choice",
        question: "We move $l2$ by 20 pixels, off the ridge. Do $l$ and $l2$ then contradict each other?",
        options: [
          "Yes: the planes no longer meet",
          "No: they meet in another line",
          "Only if it is also turned",
        ],
        right: () => 1,
        why: () =>
          "Two planes always meet. With two views every pair of lines makes a line in space, also the wrong one. Points are different: they had the epipolar line.",
      },
      says: () => {
        const [p, q] = spaceLine();
        return `With $l2$ moved by ${pixels(moved.value[0], 0)} and ${pixels(moved.value[1], 0)}, $L$ is at heights of ${metres(p[2])} and ${metres(q[2])}. The ridge is at 8 m; but who knows that?`;
      },
    },
    {
      id: "predict",
      title: "The third view knows",
      prose: () => [
        "A wire hangs over the house. Two views show it. The line in space is fixed by that, and so is its image in the third view.",
        "Put your line where the wire must be in the third view.",
      ],
      figure: PredictFigure,
      predict: {
        kind: "place",
        question: "Where is the wire in the third view? Drag both ends of the dashed line.",
        how: () => {
          const [a, b] = offLine();
          return `Your ends are ${pixels(a, 0)} and ${pixels(b, 0)} from the prediction. It needs no search: the two planes meet in $L$, and $P3$ projects it.`;
        },
      },
      says: () => {
        const [a, b] = offLine();
        return `Your line passes the prediction at ${pixels(a)} and ${pixels(b)}.`;
      },
    },
    {
      id: "tensor",
      title: "The same as one product",
      prose: () => [
        "Going through space is not needed. Three matrices, the trifocal tensor $tensor$, made from the three projection matrices once, turn the two lines into the third at once: each gives one of its coefficients.",
        "Drag the ends of $l2$ and see the line in the third view follow.",
      ],
      formula: () => "l3 _ i = l ^T tensor _ i l2 , i = 1 , 2 , 3",
      figure: TensorFigure,
      says: () => {
        const [p, q] = inView(THIRD, RIDGE);
        const line = transferred();
        return `At the ends of the ridge the predicted line is ${pixels(lineDistance(line, p))} and ${pixels(lineDistance(line, q))} away from it.`;
      },
    },
    {
      id: "verify",
      title: "One of three",
      prose: () => [
        "The line $l$ of the first view has three candidates in the beam of the second. Each makes a line in space, and each predicts a line in the third view.",
        "Only a prediction on which a segment lies, or the views correlate very well, is confirmed. In B99 the threshold for the correlation is then half of what it is for a pair; without a segment, one and a half times.",
      ],
      figure: DecoyFigure,
      predict: {
        kind: "choice",
        question: "Which candidate will the third view confirm?",
        options: ["A", "B", "C"],
        right: () => 1,
        why: () => "Choose A and C above the figure: they predict lines at which there is no edge.",
      },
      says: () => {
        const [p = 0, q = 0] = decoyHeight(decoy.value);
        return `${decoy.value} would put the line at heights of ${metres(p)} and ${metres(q)}; in the third view that is ${pixels(decoyOff(decoy.value))} off the ridge at most.`;
      },
    },
    {
      id: "degenerate",
      title: "Along the flight",
      prose: () => [
        "Two views of one strip, and a third from the next. If an edge runs along the baseline, both planes contain the baseline too: they are nearly the same plane, and where they meet is anybody's guess.",
        "Half a pixel of noise in the two images gives 24 predictions. Turn the edge towards the baseline.",
      ],
      figure: DegenerateFigure,
      says: () =>
        `At $phi$ = ${degrees(azimuth.value)} half a pixel becomes ${pixels(spread())} in the third view. ${spread() > 3 ? "Such a line needs a pair of views across the flight." : "That is a good prediction."}`,
    },
    onScene("own", "Transfer in a whole scene", realFigure("point-transfer"), [
      "The segment, the candidate that it is compared with, and the line that both predict in a third view. Pick other candidates: false ones predict nothing.",
    ]),
  ],
};
