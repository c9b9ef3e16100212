/** The charts of the figures: plain SVG, coloured by the style sheet, drawn from numbers that the core gave. */
import type { ComponentChildren } from "preact";
import { useRef } from "preact/hooks";
import { textScale } from "../state/textScale";
import { grouped } from "./numberText";
import { useSize } from "./useDrawn";

export interface Scale {
  min: number;
  max: number;
}

/** Where a chart's inner area lies, in the units of its view box. */
export interface Frame {
  width: number;
  height: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
}

const MARGINS = { left: 40, right: 10, top: 10, bottom: 30 };

export function frameOf(width: number, height: number): Frame {
  return { width, height, ...MARGINS };
}

/** From a value to its place between two ends. */
export function place(value: number, { min, max }: Scale, from: number, to: number): number {
  return from + ((value - min) / (max - min || 1)) * (to - from);
}

/** From values to the places of a chart, across and up, and to lines over all of it. */
export function axesOf({ width, height, left, right, top, bottom }: Frame, x: Scale, y: Scale) {
  const toX = (value: number) => place(value, x, left, width - right);
  const toY = (value: number) => place(value, y, height - bottom, top);
  const upright = (value: number) => ({ x1: toX(value), x2: toX(value), y1: top, y2: height - bottom });
  const level = (value: number) => ({ x1: left, x2: width - right, y1: toY(value), y2: toY(value) });
  return [toX, toY, upright, level] as const;
}

/** "M x y L x y ..."; what has no place, as a logarithm of nothing, is left out. */
export function pathOf(points: readonly (readonly [number, number])[]): string {
  return points
    .filter(hasPlace)
    .map(([x, y], i) => `${i === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`)
    .join("");
}

/** The same back to its start: no path at all where there are no points, which browsers would call invalid. */
export function closedPathOf(points: readonly (readonly [number, number])[]): string {
  const path = pathOf(points);
  return path === "" ? "" : `${path}Z`;
}

function hasPlace([x, y]: readonly [number, number]): boolean {
  return Number.isFinite(x) && Number.isFinite(y);
}

/** Dots as one path, for a style with round ends: thousands of elements would hold the page up. */
export function dotsOf(points: readonly (readonly [number, number])[]): string {
  return points
    .filter(hasPlace)
    .map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`)
    .join("");
}

/** Round numbers within a range, about `count` of them. */
export function ticks({ min, max }: Scale, count = 5): number[] {
  const raw = (max - min) / count;
  if (!(raw > 0)) {
    return [];
  }
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 5, 10].find((one) => one * power >= raw) ?? 10) * power;
  const first = Math.ceil(min / step - 1e-9);
  const last = Math.floor(max / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i) * step);
}

/** Gives what is drawn inside the size that there is, in units of the text's scale: so text has its own size, and grows as elsewhere. */
export function Fit({ children }: { children: (frame: Frame) => ComponentChildren }) {
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const scale = textScale.value;
  return (
    <div class="fit" ref={box}>
      {width > 0 && children(frameOf(width / scale, height / scale))}
    </div>
  );
}

interface ChartProps {
  frame: Frame;
  x: Scale;
  y: Scale;
  xTitle: string;
  yTitle: string;
  /** What the chart shows, for those who do not see it. */
  label: string;
  xTicks?: readonly number[];
  yTicks?: readonly number[];
  children: ComponentChildren;
  /** Hears the value under the pointer while it is pressed. */
  onDrag?: (x: number, y: number) => void;
  onClick?: (x: number, y: number) => void;
  /** Holds buttons: then it is a group of them, not one picture. */
  interactive?: boolean;
  testid?: string;
}

/** Axes, grid and titles about what is drawn inside. */
export function Chart(props: ChartProps) {
  const { frame, x, y, xTitle, yTitle, label, children, onDrag, onClick } = props;
  const svg = useRef<SVGSVGElement>(null);
  const [toX, toY, upright, level] = axesOf(frame, x, y);
  const valueAt = (event: PointerEvent): [number, number] => {
    const matrix = svg.current?.getScreenCTM()?.inverse();
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix ?? undefined);
    const clamp = (value: number, { min, max }: Scale) => Math.min(max, Math.max(min, value));
    return [
      clamp(place(at.x, { min: frame.left, max: frame.width - frame.right }, x.min, x.max), x),
      clamp(place(at.y, { min: frame.height - frame.bottom, max: frame.top }, y.min, y.max), y),
    ];
  };
  const drag = (event: PointerEvent) => {
    if (event.buttons === 1 && onDrag !== undefined) {
      onDrag(...valueAt(event));
    }
  };
  return (
    <svg
      ref={svg}
      class={`chart ${onDrag === undefined ? "" : "draggable"}`}
      viewBox={`0 0 ${frame.width} ${frame.height}`}
      role={props.interactive === true ? "group" : "img"}
      aria-label={label}
      data-testid={props.testid}
      onPointerDown={(event) => {
        if (onDrag !== undefined) {
          svg.current?.setPointerCapture(event.pointerId);
        }
        drag(event);
        onClick?.(...valueAt(event));
      }}
      onPointerMove={drag}
    >
      {(props.yTicks ?? ticks(y, 4)).map((value) => (
        <g key={value}>
          <line class="grid" {...level(value)} />
          <text class="tick" x={frame.left - 5} y={toY(value) + 4} text-anchor="end">
            {grouped(value)}
          </text>
        </g>
      ))}
      {(props.xTicks ?? ticks(x, 6)).map((value) => (
        <g key={value}>
          <line class="grid" {...upright(value)} />
          <text class="tick" x={toX(value)} y={frame.height - frame.bottom + 13} text-anchor="middle">
            {grouped(value)}
          </text>
        </g>
      ))}
      <text class="axis" x={frame.width - frame.right} y={frame.height - 3} text-anchor="end">
        {xTitle}
      </text>
      <text class="axis" transform={`translate(9 ${frame.top}) rotate(-90)`} text-anchor="end">
        {yTitle}
      </text>
      {children}
    </svg>
  );
}

/** What makes a shape of a picture a button, by pointer and key. */
export function buttonShape(name: string, isPressed: boolean, press: () => void) {
  return {
    role: "button",
    // In SVG the attribute has no capital.
    tabindex: 0,
    "aria-label": name,
    "aria-pressed": isPressed,
    onClick: press,
    onKeyDown: (event: KeyboardEvent) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        press();
      }
    },
  } as const;
}

/** How many values fall into each of `count` bins between two ends. */
export function histogramOf(values: readonly number[], { min, max }: Scale, count: number): number[] {
  const bins = new Array<number>(count).fill(0);
  for (const value of values) {
    const bin = Math.min(count - 1, Math.floor(((value - min) / (max - min)) * count));
    if (bin >= 0) {
      bins[bin] = (bins[bin] as number) + 1;
    }
  }
  return bins;
}
