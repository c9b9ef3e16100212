/** Lesson 10: no row of thresholds, one sum. */
import { computed, signal } from "@preact/signals";
import { counted } from "../../app/parts/counted";
import { clamp } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import { Bar, Curve, Dot, Drawing, Handle, Label, Line, Plot, Slider } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { num } from "../parts/say";
import { realFigure } from "../scene/RealFigure";
import {
  density,
  edgeNats,
  natsOf,
  normal,
  OFF_PLANE,
  ON_PLANE,
  probabilityOf,
  reliability,
  stream,
} from "../toy/evidence";

const signed = (value: number, digits = 1) => `${value > 0 ? "+" : ""}${num(value, digits)}`;
const percent = (p: number, digits = 0) => `${num(100 * p, digits)} %`;
const correlation = signal(0.61);
const STEPS = Array.from({ length: 100 }, (_, i) => -0.99 + 0.02 * i);

function DensitiesFigure({ isRevealed }: { isRevealed: boolean }) {
  const c = correlation.value;
  const [on, off] = [density(ON_PLANE, c), density(OFF_PLANE, c)];
  return (
    <Plot x={[-1, 1, "correlation"]} y={[0, 2.6, "density"]} label="Correlations on a plane and beside it">
      {({ at, under, upright }) => (
        <>
          <Curve points={STEPS.map((x): Vec2 => at([x, density(OFF_PLANE, x)]))} class="s7" />
          <Curve points={STEPS.map((x): Vec2 => at([x, density(ON_PLANE, x)]))} class="s4" />
          <Label
            at={at([0, density(OFF_PLANE, 0)])}
            dy={-8}
            anchor="middle"
            class="s7"
            text="beside the plane"
          />
          <Label at={at([0.62, 2.2])} anchor="end" class="s4" text="on the plane" />
          <Line {...upright(0.6)} class="rule dashed" />
          {isRevealed && (
            <>
              <Line from={at([c, 0])} to={at([c, Math.max(on, off)])} class="s6" />
              <Dot at={at([c, on])} class="s4" />
              <Dot at={at([c, off])} class="s7" />
              <Handle
                at={at([c, 0])}
                class="s6"
                label="Measured correlation"
                says={`${num(c, 2)}: ${signed(natsOf(c))} nats`}
                step={2.1}
                of={correlation}
                to={(place) => clamp(Math.round(100 * under(place)) / 100, -0.95, 0.97)}
              />
            </>
          )}
        </>
      )}
    </Plot>
  );
}

const views = signal<readonly number[]>([0.72, 0.55, 0.41, 0.8, 0.3]);
const prior = signal(0.1);
const VIEW_NAMES = ["1", "2", "3", "4", "5"] as const;
const total = (hidden = 0) => views.value.reduce((sum, c) => sum + natsOf(c, hidden), 0);
const priorNats = () => Math.log(prior.value / (1 - prior.value));

/** Nats as bars to the right (for) and to the left (against), one below the other, and their sum. */
function Bars({ all, label }: { all: readonly (readonly [name: string, nats: number])[]; label: string }) {
  const sum = all.reduce((now, [, nats]) => now + nats, 0);
  const rows = [...all, ["sum", sum] as const];
  const most = Math.max(6, ...rows.map(([, nats]) => Math.abs(nats)));
  const [middle, half, row] = [250, 165, 30];
  return (
    <Drawing width={480} height={rows.length * row + 14} label={label}>
      {rows.map(([name, nats], i) => {
        const [y, to] = [i * row + 6, middle + (half * nats) / most];
        return (
          <g key={name}>
            {i === rows.length - 1 && <Line from={[20, y - 1]} to={[460, y - 1]} class="rule" />}
            <Bar from={[middle, y + 4]} to={[to, y + row - 6]} class={nats < 0 ? "s7" : "s4"} />
            <Label at={[76, y + 15]} dy={5} anchor="end" text={name} />
            <Label
              at={[Math.max(to, middle), y + 15]}
              dx={6}
              dy={5}
              class={nats < 0 ? "s7" : "s4"}
              text={signed(nats)}
            />
          </g>
        );
      })}
      <Line from={[middle, 4]} to={[middle, rows.length * row + 8]} class="rule" />
    </Drawing>
  );
}

function ViewSliders() {
  return (
    <>
      {views.value.map((c, i) => (
        <Slider
          key={i.toString()}
          symbol="c"
          label={`in view ${i + 1}`}
          value={c}
          range={[-0.5, 0.95, 0.01]}
          says={`${num(c, 2)}: ${signed(natsOf(c))} nats`}
          onInput={(value) => {
            views.value = views.value.with(i, value);
          }}
        />
      ))}
    </>
  );
}

function SumFigure() {
  return (
    <>
      <Bars
        label="What each view says, in nats, and their sum"
        all={[
          ...views.value.map((c, i) => [`view ${i + 1}`, natsOf(c)] as const),
          ["before", priorNats()] as const,
        ]}
      />
      <div class="sliders">
        <ViewSliders />
        <Slider
          label="true before anything is seen"
          of={prior}
          range={[0.01, 0.9, 0.01]}
          says={percent(prior.value)}
        />
      </div>
    </>
  );
}

const contrast = signal(2.5);
const viewCount = signal(5);
const edgeSum = () => viewCount.value * edgeNats(contrast.value, contrast.value);

function WeakFigure({ isRevealed }: { isRevealed: boolean }) {
  const n = isRevealed ? viewCount.value : 1;
  const z = contrast.value;
  const joint = z * Math.sqrt(n);
  const bell = (x: number, mean: number) => Math.exp(-((x - mean) ** 2) / 2) / Math.sqrt(2 * Math.PI);
  const xs = Array.from({ length: 141 }, (_, i) => -4 + 0.1 * i);
  return (
    <>
      <Plot
        x={[-4, 10, "contrast over its standard deviation, all views together"]}
        y={[0, 0.45, "density"]}
        label="Contrast across an edge that is there, and across nothing"
      >
        {({ at }) => (
          <>
            <Curve points={xs.map((x): Vec2 => at([x, bell(x, 0)]))} class="s7" />
            <Curve points={xs.map((x): Vec2 => at([x, bell(x, joint)]))} class="s4" />
            <Label at={at([0, 0.4])} dy={-8} anchor="middle" class="s7" text="nothing" />
            <Label
              at={at([joint, 0.4])}
              dy={-8}
              anchor="middle"
              class="s4"
              text={n === 1 ? "an edge" : counted(n, "views")}
            />
          </>
        )}
      </Plot>
      {isRevealed && (
        <>
          <Slider symbol="mu" label="in each view" of={contrast} range={[0.5, 4, 0.1]} suffix=" σ" />
          <Slider symbol="N" label="views" of={viewCount} range={[1, 6, 1]} />
        </>
      )}
    </>
  );
}

const hidden = signal(0);
const OCCLUDED: readonly number[] = [0.72, 0.68, 0.81, 0.75, -0.35];
const occluded = (q: number) => OCCLUDED.reduce((sum, c) => sum + natsOf(c, q), 0);

function HiddenFigure({ isRevealed }: { isRevealed: boolean }) {
  const q = isRevealed ? hidden.value : 0;
  return (
    <>
      <Bars
        label="What each view says; the last one sees a tree"
        all={OCCLUDED.map((c, i) => [`view ${VIEW_NAMES[i]}`, natsOf(c, q)] as const)}
      />
      {isRevealed && (
        <Slider
          symbol="q"
          label="view does not see the place"
          of={hidden}
          range={[0, 0.5, 0.01]}
          says={percent(q)}
        />
      )}
    </>
  );
}

const copies = signal(4);
const CANDIDATES = 6000;
/** True and false candidates with the nats of three independent windows each; they are counted `copies` times. */
const candidates = computed(() => {
  const random = stream(17);
  return Array.from({ length: CANDIDATES }, () => {
    const isTrue = random() < 0.5;
    const mean = isTrue ? 0.9 : -0.9;
    // Nats of a Gaussian ratio have a variance of twice their mean: then they are calibrated.
    return { isTrue, nats: mean + Math.sqrt(1.8) * normal(random) };
  });
});
const curve = () => reliability(candidates.value, copies.value, 10);
/** Of the candidates that are said to be at least 90 % sure, how many are true. */
const ofSure = () => {
  const sure = candidates.value.filter(({ nats }) => probabilityOf(copies.value * nats) >= 0.9);
  return sure.filter(({ isTrue }) => isTrue).length / sure.length;
};

function ReliabilityFigure({ isRevealed }: { isRevealed: boolean }) {
  return (
    <>
      <Plot
        x={[0, 1, "stated probability"]}
        y={[0, 1, "share that is true"]}
        label="How many candidates are true, by what was stated of them"
        height={320}
      >
        {({ at }) => (
          <>
            <Line from={at([0, 0])} to={at([1, 1])} class="rule" />
            {isRevealed && (
              <>
                <Curve points={curve().map(([x, y]): Vec2 => at([x, y]))} class="s6" />
                {curve().map(([x, y]) => (
                  <Dot key={x} at={at([x, y])} class="s6" />
                ))}
              </>
            )}
          </>
        )}
      </Plot>
      {isRevealed && <Slider label="times that each window is counted" of={copies} range={[1, 6, 1]} />}
    </>
  );
}

export const EVIDENCE: Lesson = {
  id: "evidence",
  title: "One model of evidence",
  aim: "You can add up what speaks for a plane, and say how sure you are in a way that can be checked.",
  minutes: 10,
  papers: "B99 5 (future work); ridgeline's own",
  screens: [
    {
      id: "threshold",
      title: "0.59 and 0.61",
      prose: () => [
        "The lessons so far were full of thresholds: 0.6 for a correlation, 0.4 for a peak. A threshold turns a number into yes or no, and forgets by how much.",
        "Measured on many scenes, correlations on true planes and beside them look like these two curves. The question is not whether $c$ is above a line, but *how much likelier* it is on the plane than beside it.",
      ],
      formula: () => "ln frac { p ( c | on ) } { p ( c | off ) }",
      figure: DensitiesFigure,
      predict: {
        kind: "choice",
        question:
          "One window correlates with 0.59, the other with 0.61; the threshold is 0.6. How different is what they say?",
        options: ["As yes and no", "Hardly", "By a factor of ten"],
        right: () => 1,
        why: () =>
          `0.59 says ${signed(natsOf(0.59), 2)}, 0.61 says ${signed(natsOf(0.61), 2)}: nearly the same. Drag the measured value on the axis: at 0 it says ${signed(natsOf(0))}, at 0.9 ${signed(natsOf(0.9))}.`,
      },
      says: () => {
        const c = correlation.value;
        const ratio = Math.exp(Math.abs(natsOf(c)));
        return `At $c$ = ${num(c, 2)} the window is ${ratio > 100 ? "more than 100" : num(ratio)} times likelier ${natsOf(c) > 0 ? "on the plane" : "beside it"}: ${signed(natsOf(c), 2)} nats.`;
      },
    },
    {
      id: "sum",
      title: "Likelihoods multiply, nats add",
      prose: () => [
        "Five views measure independently. Their ratios multiply, so the logarithms add: that sum is the evidence $E$, in nats. What was known before is one more number in the sum: of all candidates of this kind, so many are true.",
        "A weak view does not veto, a strong one does not decide alone. From $E$ follows the probability.",
      ],
      formula: () =>
        "E = sum _ i ln frac { p ( c _ i | on ) } { p ( c _ i | off ) } , p = frac { 1 } { 1 + exp ( - E ) }",
      figure: SumFigure,
      says: () => {
        const nats = total() + priorNats();
        const passing = views.value.filter((c) => c > 0.6).length;
        return `${signed(nats)} nats: ${percent(probabilityOf(nats), nats > 4 ? 1 : 0)}. With the threshold of 0.6, ${passing} of 5 views would have said yes.`;
      },
    },
    {
      id: "weak",
      title: "Five times nearly nothing",
      prose: () => [
        "The hip of a roof in the shade: in each view the contrast across it is 2.5 standard deviations $zed$ of noise. No edge detector reports that; it would report noise at every other place, too.",
      ],
      formula: () => "E = sum _ i ( mu zed _ i - frac { mu ^2 } { 2 } )",
      figure: WeakFigure,
      predict: {
        kind: "estimate",
        question:
          "Five views, 2.5 standard deviations each, added up at the place where the hip would be. How many standard deviations is that together?",
        unit: "σ",
        range: [1, 13, 0.1],
        truth: () => 2.5 * Math.sqrt(5),
        within: 0.5,
        why: () =>
          "Contrasts add fivefold, noise only by √5. Who decides view by view has thrown it away before.",
      },
      says: () =>
        `${counted(viewCount.value, "views")} of ${num(contrast.value)} σ ${viewCount.value === 1 ? "is" : "make"} ${num(contrast.value * Math.sqrt(viewCount.value))} σ: ${signed(edgeSum())} nats.`,
    },
    {
      id: "hidden",
      title: "A tree in one view",
      prose: () => [
        "Four views see the roof, one sees a tree before it. Its correlation is −0.35.",
        "A view may be hidden: with probability $q$ it says nothing about the plane. That is no rule and no exception, it stands in the likelihood.",
      ],
      formula: () => "ln frac { ( 1 - q ) p ( c | on ) + q p ( c | off ) } { p ( c | off ) } >= ln q",
      figure: HiddenFigure,
      predict: {
        kind: "choice",
        question: "What does a small $q$ of 5 % do to the sum?",
        options: [
          "Almost nothing",
          "It bounds what the hidden view can say against the plane",
          "It makes all views say less, by 5 %",
        ],
        right: () => 1,
        why: () =>
          `No view can then say worse than ln 0.05 = ${num(Math.log(0.05))}. The sum goes from ${signed(occluded(0))} to ${signed(occluded(0.05))}. Views that agree lose nothing worth speaking of.`,
      },
      says: () =>
        `With $q$ = ${percent(hidden.value)} the hidden view says ${signed(natsOf(-0.35, hidden.value))}, the four others ${signed(occluded(hidden.value) - natsOf(-0.35, hidden.value))}: together ${signed(occluded(hidden.value))} nats.`,
    },
    {
      id: "calibrated",
      title: "Keep your word",
      prose: () => [
        "Nats add only if observations are independent. Neighbouring windows overlap: they are the same pixels, seen four times. Count them four times, and every roof is “certain”.",
        "There is a check: of all candidates that were said to be 80 % sure, 80 % must be true. Here are 6000 drawn candidates whose truth is known.",
      ],
      figure: ReliabilityFigure,
      predict: {
        kind: "choice",
        question:
          "Each window is counted four times. Of the candidates that are then called 90 % sure or more, how many are true?",
        options: ["More than 90 %", "Just 90 %", "Fewer"],
        right: () => 2,
        why: () =>
          "Too sure at both ends: the curve is flatter than the diagonal. Count each window once, and it lies on it. ridgeline measures one factor for this, and checks in the diagram.",
      },
      says: () =>
        `Counted ${copies.value === 1 ? "once" : `${copies.value} times`}: of those called 90 % sure or more, ${percent(ofSure())} are true.`,
    },
    onScene("own", "The posterior of a half-plane", realFigure("theta-sweep"), [
      "B99 wished for “a posterior estimate for the plane angle and the likelihood that a plane is there”. The grey area is that: as high as the probability of a plane, as wide as its angle is uncertain. Compare lines with much and with little texture.",
    ]),
  ],
};
