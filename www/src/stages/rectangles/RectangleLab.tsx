/** W96 3.6: the window of a plane between parallel lines, and the histogram of positions (figures 10 and 11). */
import { numberOf } from "../../shared/selection";
import "../../app/view/figures/figures.css";
import { ListChoice } from "../../app/parts/Choice";
import { axesOf, Chart, Fit, type Frame, histogramOf, type Scale } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { PAIR_WORDS } from "../../app/parts/reasonText";
import { SplitLab } from "../../app/view/figures/SplitLab";
import { category } from "../../shared/palette";
import type { PlaneTrace } from "../../shared/records";
import type { Figure } from "../figure";

/** Figures 10 and 11: the window between two parallel lines, the lines that cross it, and their positions. */
export function RectangleLab({ figure }: { figure: Figure }) {
  const found = figure.results.rectangles;
  if (found === null || found.pairs.length === 0) {
    return <p class="lab-hint muted">Run the stage: the windows between parallel lines appear here.</p>;
  }
  const shown = shownPair(figure);
  const pair = found.pairs[shown] as PlaneTrace;
  const isChosen = (index: number) =>
    found.chosen.some((k) => samePair(found.candidates[k]?.lines, found.pairs[index]?.lines));
  return (
    <SplitLab figure={figure} testid="rectangle-lab" unpicked={{ kind: "pair", index: shown }}>
      <ListChoice
        title="Pair of lines"
        names={found.pairs.map(({ lines, rejection }, i) => {
          const outcome = rejection === null ? "candidate" : PAIR_WORDS[rejection];
          return `${lines.map(numberOf).join(" and ")} · ${isChosen(i) ? "selected" : outcome}`;
        })}
        shown={shown}
        onShow={(index) => figure.act.select({ kind: "pair", index })}
      />
      <Fit>{(frame) => <PlaneWindow outer={frame} pair={pair} />}</Fit>
    </SplitLab>
  );
}

/** The selected pair, or the one of the best plane. */
function shownPair({ results, selection: picked }: Figure): number {
  const found = results.rectangles;
  if (found === null) {
    return 0;
  }
  if (picked?.kind === "pair") {
    return Math.min(picked.index, found.pairs.length - 1);
  }
  const facet = picked?.kind === "facet" ? picked.index : 0;
  const lines = found.candidates[found.chosen[facet] ?? -1]?.lines;
  return Math.max(
    0,
    found.pairs.findIndex((one) => samePair(lines, one.lines)),
  );
}

function samePair(a: readonly number[] | undefined, b: readonly number[] | undefined): boolean {
  return a?.length === 2 && b !== undefined && a.includes(b[0] as number) && a.includes(b[1] as number);
}

function PlaneWindow({ outer, pair }: { outer: Frame; pair: PlaneTrace }) {
  const along = pair.crossings.flatMap(({ at }) => at);
  const width = Math.max(1, ...pair.crossings.flatMap(({ across }) => across));
  const x: Scale =
    along.length === 0
      ? { min: 0, max: 10 }
      : { min: Math.min(...along) - 0.5, max: Math.max(...along) + 0.5 };
  const frame = { ...outer, bottom: 92 };
  const y = { min: 0, max: width };
  const [toX, toY] = axesOf(frame, x, y);
  const bins = histogramOf(
    pair.crossings.map(({ at }) => (at[0] + at[1]) / 2),
    x,
    60,
  );
  const top = Math.max(...bins, 1);
  const base = outer.height - outer.bottom;
  const step = (outer.width - outer.left - outer.right) / bins.length;
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="position along the lines (m)"
      yTitle="across (m)"
      label={`Window with ${counted(pair.crossings.length, "crossing image lines")} and ${counted(pair.ends.length, "ends")}`}
      testid="plane-window"
    >
      {pair.crossings.map(({ view, at, across, contrast }, i) => (
        <line
          key={i}
          class="crossing"
          x1={toX(at[0] + ((at[1] - at[0]) * across[0]) / width)}
          x2={toX(at[0] + ((at[1] - at[0]) * across[1]) / width)}
          y1={toY(across[0])}
          y2={toY(across[1])}
          stroke={category(view)}
          opacity={0.35 + 0.65 * Math.min(1, 5 * contrast)}
        />
      ))}
      {pair.ends.map(({ at, support }) => (
        <line
          key={at.join()}
          class="end"
          x1={toX(at[0])}
          x2={toX(at[1])}
          y1={toY(0)}
          y2={toY(width)}
          opacity={0.4 + 0.6 * support}
        />
      ))}
      {bins.map((count, i) => (
        <rect
          key={i}
          class="bin"
          x={outer.left + i * step}
          width={Math.max(1, step - 1)}
          y={base - (44 * count) / top}
          height={(44 * count) / top}
        />
      ))}
      {pair.ends.map(({ at }) => (
        <path key={at.join()} class="end-mark" d={`M${toX((at[0] + at[1]) / 2)} ${base + 2}l-5 8h10z`} />
      ))}
    </Chart>
  );
}
