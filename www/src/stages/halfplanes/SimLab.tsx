/** B99 figures 10 to 14: the half-plane turned by hand, the views warped onto it, and Sim(theta). */
import "../../app/view/figures/figures.css";
import { axesOf, Chart, closedPathOf, Fit, type Frame, pathOf } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { REJECTION_WORDS } from "../../app/parts/reasonText";
import { useDrawn } from "../../app/parts/useDrawn";
import { bestTheta } from "../../app/selection/inquiry";
import { questionOf } from "../../kinds/kinds";
import type { WarpedPicture } from "../../shared/calls";
import { DEGREE } from "../../shared/linear";
import { category } from "../../shared/palette";
import type { SideTrace } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { type Figure, viewName } from "../figure";

export function SimLab({ figure }: { figure: Figure }) {
  const { side, theta, warped } = figure.detail;
  const { turnTo } = figure.act;
  if (side === null) {
    return (
      <p class="lab-hint muted">
        Pick a 3D line or a half-plane: here the views are warped onto it by H(θ), and θ can be dragged.
      </p>
    );
  }
  return (
    <div class="sim-lab" data-testid="sim-lab">
      <div class="sim-chart">
        <SideHead figure={figure} side={side} />
        <Fit>{(frame) => <SimChart frame={frame} figure={figure} side={side} />}</Fit>
        <label class="theta">
          <span>θ</span>
          <input
            type="range"
            min={-75}
            max={75}
            step={0.5}
            value={theta / DEGREE}
            aria-label="Angle of the half-plane, degrees"
            aria-valuetext={`${(theta / DEGREE).toFixed(1)} degrees`}
            onInput={(event) => turnTo(Number(event.currentTarget.value) * DEGREE)}
          />
          <output class="numbers" data-testid="theta">
            {(theta / DEGREE).toFixed(1)}°
          </output>
          <button
            type="button"
            class="quiet"
            data-control
            onClick={() => turnTo(bestTheta(side, figure.results))}
          >
            Best
          </button>
        </label>
      </div>
      {warped === null ? (
        <p class="lab-hint muted">No view can be compared with another one on this side.</p>
      ) : (
        <Windows figure={figure} picture={warped} side={side} />
      )}
    </div>
  );
}

interface OfSide {
  figure: Figure;
  side: SideTrace;
}

/** Which side of which line, the other one at hand, and why it was rejected. */
function SideHead({ figure, side }: OfSide) {
  const other = side.side === "left" ? "right" : "left";
  const asked = questionOf(figure.selection, figure.results);
  const isPicked = asked?.about === "side" && asked.line === side.line;
  return (
    <div class="row spread">
      <p class="lab-head">
        Line {numberOf(side.line)}, {side.side} side
        <span class="muted" data-testid="plane-probability">
          {" "}
          · P(plane) {side.curve.posterior.plane.toFixed(2)}
        </span>
        {side.rejection !== null && (
          <span class="rejection"> · {REJECTION_WORDS[side.rejection] ?? side.rejection}</span>
        )}
      </p>
      {isPicked && (
        <button
          type="button"
          class="quiet other-side"
          data-control
          onClick={() => {
            figure.act.select({ kind: "side", line: side.line, side: other });
          }}
        >
          Show the {other} side
        </button>
      )}
    </div>
  );
}

function SimChart({ frame, figure, side }: OfSide & { frame: Frame }) {
  const { theta } = figure.detail;
  const { thetas, similarity, views, posterior } = side.curve;
  const limit = 75;
  const x = { min: -limit, max: limit };
  const y = { min: 0, max: 1 };
  const [toX, toY, upright, level] = axesOf(frame, x, y);
  const places = (values: readonly number[]) =>
    values.map((value, i) => [toX((thetas[i] ?? 0) / DEGREE), toY(value)] as const);
  const curve = (values: readonly number[]) => pathOf(places(values));
  const inside = places(scaled(posterior));
  const ends = [inside.at(-1), inside[0]].flatMap((end) =>
    end === undefined ? [] : [[end[0], toY(0)] as const],
  );
  const least = figure.params["sweep"]?.["min_similarity"];
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="θ (degrees)"
      yTitle="Sim(θ)"
      xTicks={[-60, -30, 0, 30, 60]}
      label={`Sim of theta for ${counted(views.length, "views")}; its maximum is ${Math.max(0, ...similarity).toFixed(2)}`}
      testid="sim-chart"
      onDrag={(value) => figure.act.turnTo(Math.round(2 * value) * 0.5 * DEGREE)}
    >
      <path class="posterior" data-testid="posterior" d={closedPathOf([...inside, ...ends])}>
        <title>Posterior over θ, as high as the probability that a plane is there</title>
      </path>
      {typeof least === "number" && <line class="threshold" {...level(least)} />}
      {views.map((view, i) => (
        <path
          key={view.view}
          class="view-curve"
          d={curve(view.similarity)}
          stroke={category(i)}
          opacity={view.valid ? 0.9 : 0.3}
          stroke-dasharray={view.valid ? undefined : "3 3"}
        />
      ))}
      <path class="curve" d={curve(similarity)} />
      <line class="cursor" {...upright(theta / DEGREE)} />
      <circle class="cursor-knob" cx={toX(theta / DEGREE)} cy={frame.height - frame.bottom} r={6} />
    </Chart>
  );
}

/** The density scaled so that its top is the probability that a plane is there. */
function scaled({ density, plane }: SideTrace["curve"]["posterior"]): number[] {
  const top = Math.max(...density, Number.MIN_VALUE);
  return density.map((value) => (value / top) * plane);
}

/** The reference first, then every other view under H(theta), with its own Sim at this angle. */
function Windows({ figure, picture: { about, rgba }, side }: OfSide & { picture: WarpedPicture }) {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls is reached by key
    <ul class="windows" data-testid="windows" tabIndex={0} aria-label="Warped views">
      {about.views.map(({ view, similarity, valid }, i) => {
        const place = side.curve.views.findIndex((one) => one.view === view);
        return (
          <li key={view} class={valid || similarity === null ? "" : "invalid"}>
            <Window picture={{ about, rgba }} index={i} />
            <span class="window-name" title={viewName(figure, view)}>
              {place >= 0 && <span class="dot" style={{ background: category(place) }} aria-hidden="true" />}
              {viewName(figure, view)}
            </span>
            <span class="numbers muted">
              {similarity === null ? "reference view" : `Sim ${similarity.toFixed(2)}`}
            </span>
          </li>
        );
      })}
    </ul>
  );
}

function Window({ picture: { about, rgba }, index }: { picture: WarpedPicture; index: number }) {
  const { columns, rows, points, line_row } = about;
  const draw = (context: CanvasRenderingContext2D) => {
    const size = 4 * columns * rows;
    context.clearRect(0, 0, columns, rows);
    context.putImageData(new ImageData(rgba.slice(index * size, (index + 1) * size), columns, rows), 0, 0);
    context.fillStyle = "#ffe11a";
    if (index === 0) {
      for (const [x, y] of points) {
        context.fillRect(Math.floor(x), Math.floor(y), 1, 1);
      }
    }
    context.globalAlpha = 0.8;
    context.fillRect(0, line_row - 0.5, columns, 1);
    context.globalAlpha = 1;
  };
  const canvas = useDrawn(draw, [rgba, index]);
  return <canvas ref={canvas} width={columns} height={rows} role="img" aria-label="Warped neighbourhood" />;
}
