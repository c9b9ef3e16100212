/** Parts of drawn figures: SVG whose type keeps its size, things that are dragged by pointer and key, sliders, plots. */
import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useId } from "preact/hooks";
import { Choice } from "../../app/parts/Choice";
import { axesOf, type Frame, pathOf, place as placeOn, ticks } from "../../app/parts/charts";
import { ARROWS, useDrawn, useSize } from "../../app/parts/useDrawn";
import { add, clamp } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import { Formula } from "./Formula";
import { digitsOf, num, place } from "./say";

interface DrawingProps {
  width: number;
  height: number;
  /** Where it begins, if not at 0. */
  top?: number;
  /** What it shows, for those who do not see it. */
  label: string;
  children: ComponentChildren;
  /** Cuts off what is outside, as an image does. */
  isImage?: boolean;
  class?: string;
}

/** A drawing in units of its own. `--u` is one CSS pixel in these units, so that text and handles keep their size. */
export function Drawing({
  width,
  height,
  label,
  children,
  top = 0,
  isImage = false,
  class: name = "",
}: DrawingProps) {
  const [svg, shown] = useSize<SVGSVGElement>();
  const unit = Math.max(width / shown.width, height / shown.height);
  return (
    // biome-ignore lint/a11y/useSemanticElements: a drawing is no form
    <svg
      ref={svg}
      class={`drawing ${isImage ? "image" : ""} ${name}`}
      style={Number.isFinite(unit) ? { "--u": unit.toFixed(4) } : undefined}
      viewBox={`0 ${top} ${width} ${height}`}
      role="group"
      aria-label={label}
    >
      {children}
    </svg>
  );
}

/** A drawing in metres, upwards from a place of it: its size, where a place is drawn, and which place that is. */
export function inMetres(width: number, height: number, scale: number, [x0, y0]: Vec2) {
  return {
    width,
    height,
    scale,
    at: (x: number, y: number): Vec2 => [x0 + scale * x, y0 - scale * y],
    place: ([px, py]: Vec2): Vec2 => [(px - x0) / scale, (y0 - py) / scale],
  };
}

/** Text in a drawing, with an edge of paper so that lines do not cross it; `dx` and `dy` in CSS pixels. */
export function Label(props: {
  at: Vec2;
  text: string | number;
  /** A symbol that stands before the text. */
  letter?: string;
  class?: string;
  dx?: number;
  dy?: number;
  anchor?: "start" | "middle" | "end";
}) {
  const { at, text, letter, class: name = "", dx = 0, dy = 0, anchor = "start" } = props;
  return (
    <g transform={`translate(${at[0].toFixed(2)} ${at[1].toFixed(2)})`}>
      <text
        class={`label ${name}`}
        text-anchor={anchor}
        style={{ transform: `translate(calc(var(--u, 1) * ${dx}px), calc(var(--u, 1) * ${dy}px))` }}
      >
        {letter !== undefined && <tspan class="letter">{letter} </tspan>}
        {text}
      </text>
    </g>
  );
}

export function Line({ from, to, class: name }: { from: Vec2; to: Vec2; class: string }) {
  return <line class={`stroke ${name}`} x1={from[0]} y1={from[1]} x2={to[0]} y2={to[1]} />;
}

export function Shape({ points, class: name }: { points: readonly Vec2[]; class: string }) {
  return (
    <polygon class={name} points={points.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" ")} />
  );
}

export function Dot({ at, class: name }: { at: Vec2; class: string }) {
  return <circle class={`point ${name}`} cx={at[0]} cy={at[1]} r={4} />;
}

/** A rectangle between two opposite corners. */
export function Bar({ from, to, class: name }: { from: Vec2; to: Vec2; class: string }) {
  return (
    <rect
      class={`bar ${name}`}
      x={Math.min(from[0], to[0])}
      y={Math.min(from[1], to[1])}
      width={Math.abs(to[0] - from[0])}
      height={Math.abs(to[1] - from[1])}
    />
  );
}

interface HandleProps<T> {
  at: Vec2;
  /** What it moves. */
  label: string;
  /** Where it is, in words. */
  says: string;
  /** One number of it, for those who hear it; otherwise that which it moves, or its first coordinate. */
  value?: number;
  /** What it moves, and to what, where it is taken to a place of the drawing. */
  of: Signal<T>;
  to: (place: Vec2) => T;
  class?: string;
  /** How far a key moves it, in units of the drawing. */
  step?: number;
  /** Only a dot as yet. */
  isFixed?: boolean;
}

/** Something that is dragged: by pointer or finger, and with the arrow keys when it has the focus. */
export function Handle<T>(props: HandleProps<T>) {
  const { at, label, says, of: moved, to, class: name = "s6", step = 2, isFixed = false } = props;
  const own = moved.value;
  const value = props.value ?? (typeof own === "number" ? own : at[0]);
  const move = (place: Vec2) => {
    moved.value = to(place);
  };
  const placeOf = (event: PointerEvent): Vec2 => {
    const of = event.currentTarget as SVGGraphicsElement;
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(of.getScreenCTM()?.inverse());
    return [point.x, point.y];
  };
  const byKey = (event: KeyboardEvent) => {
    const by = ARROWS[event.key];
    if (by !== undefined) {
      event.preventDefault();
      event.stopPropagation();
      move(add(at, by, event.shiftKey ? 5 * step : step));
    }
  };
  if (isFixed) {
    return <Dot at={at} class={name} />;
  }
  return (
    <g
      class={`handle ${name}`}
      role="slider"
      tabindex={0}
      aria-label={label}
      aria-valuenow={Math.round(100 * value) / 100}
      aria-valuetext={says}
      onKeyDown={byKey}
      onPointerDown={(event) => {
        event.preventDefault();
        (event.currentTarget as SVGElement).setPointerCapture(event.pointerId);
        (event.currentTarget as SVGElement).focus();
      }}
      onPointerMove={(event) => {
        if (event.buttons === 1) {
          move(placeOf(event));
        }
      }}
    >
      <circle class="reach" cx={at[0]} cy={at[1]} r={20} />
      <circle class="knob" cx={at[0]} cy={at[1]} r={8} />
    </g>
  );
}

/** A place of an image that is dragged about, within the image less a margin. */
export function PointHandle(props: {
  of: Signal<Vec2>;
  size: { width: number; height: number };
  margin?: number;
  label: string;
  class: string;
  says?: string;
  step?: number;
  isFixed?: boolean;
}) {
  const { size, margin = 0, ...of } = props;
  const at = of.of.value;
  const to = ([x, y]: Vec2): Vec2 => [
    clamp(x, margin, size.width - margin),
    clamp(y, margin, size.height - margin),
  ];
  return <Handle at={at} says={place(at, 0)} to={to} {...of} />;
}

/** One of a few, each by what is written on its button. */
export function Switch<T extends string>(props: {
  legend: string;
  names: Readonly<Record<T, string>>;
  of: Signal<T>;
}) {
  const { legend, names, of } = props;
  return <Choice legend={legend} choices={Object.entries(names) as [T, string][]} of={of} />;
}

type SliderProps = {
  /** The symbol that it moves. */
  symbol?: string;
  label: string;
  range: readonly [min: number, max: number, step: number];
  /** The value in words, where a number alone does not say it. */
  says?: string;
  /** What stands behind the number: " m". */
  suffix?: string;
  disabled?: boolean;
} & (
  | {
      of: Signal<number>;
      /** In which it is moved, where that is not the signal's own. */
      unit?: number;
    }
  | { value: number; onInput: (value: number) => void }
);

export function Slider({
  symbol,
  label,
  range: [min, max, step],
  suffix = "",
  disabled = false,
  ...moved
}: SliderProps) {
  const id = useId();
  const unit = "of" in moved ? (moved.unit ?? 1) : 1;
  const value = "of" in moved ? moved.of.value / unit : moved.value;
  const says = moved.says ?? `${num(value, digitsOf(step))}${suffix}`;
  return (
    <div class="slider">
      <label for={id}>
        {symbol !== undefined && <Formula text={symbol} />} {label}
      </label>
      <output for={id} class="numbers">
        {says}
      </output>
      <input
        id={id}
        type="range"
        min={min}
        max={max}
        step={step}
        disabled={disabled}
        value={value}
        aria-valuetext={says}
        onInput={(event) => {
          const next = Number(event.currentTarget.value);
          if ("of" in moved) {
            moved.of.value = next * unit;
          } else {
            moved.onInput(next);
          }
        }}
      />
    </div>
  );
}

type Axis = readonly [min: number, max: number, title: string];

interface PlotProps {
  x: Axis;
  y: Axis;
  label: string;
  height?: number;
  children: (places: Places) => ComponentChildren;
}

/** Where values are in a plot. */
interface Places {
  at: (values: Vec2) => Vec2;
  /** The value across under a place. */
  under: (place: Vec2) => number;
  /** Lines over the whole plot, at a value across and at one up. */
  upright: (x: number) => { from: Vec2; to: Vec2 };
  level: (y: number) => { from: Vec2; to: Vec2 };
  frame: Frame;
}

const PLOT_WIDTH = 480;

/** Axes about what is drawn inside. */
export function Plot({ x: [xMin, xMax, xTitle], y: [yMin, yMax, yTitle], ...of }: PlotProps) {
  const { label, height = 270, children } = of;
  const [x, y] = [
    { min: xMin, max: xMax },
    { min: yMin, max: yMax },
  ];
  const frame: Frame = { width: PLOT_WIDTH, height, left: 46, right: 12, top: 24, bottom: 54 };
  const [toX, toY] = axesOf(frame, x, y);
  const [right, bottom] = [frame.width - frame.right, frame.height - frame.bottom];
  const upright: Places["upright"] = (value) => ({
    from: [toX(value), frame.top],
    to: [toX(value), bottom],
  });
  const level: Places["level"] = (value) => ({ from: [frame.left, toY(value)], to: [right, toY(value)] });
  const places: Places = {
    at: ([across, up]) => [toX(across), toY(up)],
    under: ([px]) => placeOn(px, { min: frame.left, max: right }, x.min, x.max),
    upright,
    level,
    frame,
  };
  return (
    <Drawing width={frame.width} height={frame.height} label={label} class="plot">
      {ticks(y, 4).map((value) => (
        <g key={`y${value}`}>
          <Line {...level(value)} class="grid" />
          <Label at={[frame.left, toY(value)]} dx={-5} dy={4} anchor="end" class="tick" text={tick(value)} />
        </g>
      ))}
      {ticks(x, 5).map((value) => (
        <g key={`x${value}`}>
          <Line {...upright(value)} class="grid" />
          <Label at={[toX(value), bottom]} dy={15} anchor="middle" class="tick" text={tick(value)} />
        </g>
      ))}
      <Label at={[right, bottom]} dy={33} anchor="end" class="tick" text={xTitle} />
      <Label at={[4, frame.top]} dy={-9} class="tick" text={yTitle} />
      {children(places)}
    </Drawing>
  );
}

const tick = (value: number) => String(Math.round(1000 * value) / 1000).replace("-", "−");

/** A curve in a plot. */
export function Curve({ points, class: name }: { points: readonly Vec2[]; class: string }) {
  return <path class={`stroke curve ${name}`} d={pathOf(points)} />;
}

/** Grey values as a picture of square pixels. */
export function Grey(props: {
  values: ArrayLike<number>;
  width: number;
  height: number;
  label: string;
  class?: string;
}) {
  const { values, width, height, label, class: name = "" } = props;
  const draw = (context: CanvasRenderingContext2D) => {
    const image = context.createImageData(width, height);
    for (let i = 0; i < width * height; i += 1) {
      image.data.fill(values[i] ?? 0, 4 * i, 4 * i + 3);
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  };
  const canvas = useDrawn(draw, [values, width, height]);
  return (
    <canvas ref={canvas} class={`grey ${name}`} width={width} height={height} role="img" aria-label={label} />
  );
}

/** A window of a view, what it is, and what is measured of it. */
export function WindowCard(props: {
  values: readonly number[];
  /** Pixels in a row. */
  size: number;
  colour: 1 | 2;
  title: string;
  label?: string;
  score?: string;
}) {
  const { values, size, colour, title, label = `Window ${title}`, score } = props;
  return (
    <div class={`window-card s${colour}`}>
      <Grey values={values} width={size} height={values.length / size} label={label} />
      <strong>{title}</strong>
      {score !== undefined && <span class="numbers">{score}</span>}
    </div>
  );
}
