/** What pictures are drawn with: on a canvas, or into an SVG file, in the coordinates of the image. */
import type { Size, Viewport } from "./viewport";

export interface PenPath {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
  closePath(): void;
  /** A whole circle. */
  circle(x: number, y: number, radius: number): void;
}

export interface Stroke {
  colour: string;
  /** Image pixels, as the dashes. */
  width: number;
  alpha: number;
  dash?: readonly number[];
  join?: "round";
}

export interface Fill {
  colour: string;
  alpha: number;
  rule?: "evenodd";
}

export interface Pen {
  image(image: ImageBitmap): void;
  path(): PenPath;
  stroke(path: PenPath, style: Stroke): void;
  fill(path: PenPath, style: Fill): void;
  /** From its left end, on its base line; `size` in image pixels. */
  text(text: string, x: number, y: number, size: number, colour: string): void;
  widthOf(text: string, size: number): number;
}

/** What of an image is shown, and how large, CSS pixels. */
export interface Window {
  viewport: Viewport;
  box: Size;
}

type Draw = (pen: Pen, window: Window) => void;

/** What was painted last on each canvas, for those who want it as lines. */
const painted = new WeakMap<HTMLCanvasElement, { window: Window; draw: Draw }>();

/** Paints a canvas of the size that it has, and remembers how. */
export function paint(canvas: HTMLCanvasElement, window: Window, pixelRatio: number, draw: Draw): void {
  const context = canvas.getContext("2d");
  if (context === null) {
    return;
  }
  const { viewport } = window;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  const scale = viewport.scale * pixelRatio;
  context.setTransform(scale, 0, 0, scale, viewport.x * pixelRatio, viewport.y * pixelRatio);
  context.imageSmoothingEnabled = viewport.scale < PIXELATED_FROM;
  context.imageSmoothingQuality = "high";
  context.lineCap = "round";
  draw(new CanvasPen(context), window);
  painted.set(canvas, { window, draw });
}

/** How a canvas was painted; undefined where it was painted in another way. */
export function paintingOf(canvas: HTMLCanvasElement): { window: Window; draw: Draw } | undefined {
  return painted.get(canvas);
}

/** From this zoom on, single pixels are what a viewer wants to see. */
const PIXELATED_FROM = 4;

export function fontOf(size: number): string {
  return `600 ${size}px system-ui, "Liberation Sans", sans-serif`;
}

class CanvasPath implements PenPath {
  readonly path = new Path2D();

  moveTo(x: number, y: number): void {
    this.path.moveTo(x, y);
  }

  lineTo(x: number, y: number): void {
    this.path.lineTo(x, y);
  }

  closePath(): void {
    this.path.closePath();
  }

  circle(x: number, y: number, radius: number): void {
    this.path.moveTo(x + radius, y);
    this.path.arc(x, y, radius, 0, 2 * Math.PI);
  }
}

class CanvasPen implements Pen {
  readonly #context: CanvasRenderingContext2D;

  constructor(context: CanvasRenderingContext2D) {
    this.#context = context;
  }

  image(image: ImageBitmap): void {
    this.#context.globalAlpha = 1;
    this.#context.drawImage(image, 0, 0);
  }

  path(): PenPath {
    return new CanvasPath();
  }

  stroke(path: PenPath, { colour, width, alpha, dash = [], join }: Stroke): void {
    const context = this.#context;
    context.globalAlpha = alpha;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.lineJoin = join ?? "miter";
    context.setLineDash([...dash]);
    context.stroke((path as CanvasPath).path);
  }

  fill(path: PenPath, { colour, alpha, rule }: Fill): void {
    this.#context.globalAlpha = alpha;
    this.#context.fillStyle = colour;
    this.#context.fill((path as CanvasPath).path, rule ?? "nonzero");
  }

  text(text: string, x: number, y: number, size: number, colour: string): void {
    this.#context.globalAlpha = 1;
    this.#context.font = fontOf(size);
    this.#context.fillStyle = colour;
    this.#context.fillText(text, x, y);
  }

  widthOf(text: string, size: number): number {
    this.#context.font = fontOf(size);
    return this.#context.measureText(text).width;
  }
}
