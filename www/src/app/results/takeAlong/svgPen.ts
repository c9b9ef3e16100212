/** Draws a picture into an SVG file: the photograph as a JPEG, and lines as lines. */
import { type Fill, fontOf, type Pen, type PenPath, type Stroke, type Window } from "../../view/images/pen";
import { escaped } from "../../words/linkedText";

/** So many pixels of a photograph are embedded at most, along a side. */
const MOST_PX = 2400;
const JPEG_QUALITY = 0.9;

class SvgPath implements PenPath {
  d = "";

  moveTo(x: number, y: number): void {
    this.d += `M${at(x)} ${at(y)}`;
  }

  lineTo(x: number, y: number): void {
    this.d += `L${at(x)} ${at(y)}`;
  }

  closePath(): void {
    this.d += "Z";
  }

  circle(x: number, y: number, radius: number): void {
    const [r, across] = [at(radius), at(2 * radius)];
    this.d += `M${at(x - radius)} ${at(y)}a${r} ${r} 0 1 0 ${across} 0a${r} ${r} 0 1 0 -${across} 0Z`;
  }
}

export class SvgPen implements Pen {
  #body = "";
  readonly #window: Window;
  readonly #measure = document.createElement("canvas").getContext("2d");

  constructor(window: Window) {
    this.#window = window;
  }

  /** What was drawn, in the coordinates of the window's box. */
  get body(): string {
    const { scale, x, y } = this.#window.viewport;
    return `<g transform="translate(${at(x)} ${at(y)}) scale(${scale})" stroke-linecap="round">${this.#body}</g>`;
  }

  /** The part that is seen. */
  image(image: ImageBitmap): void {
    const { viewport, box } = this.#window;
    const clamp = (value: number, most: number) => Math.min(most, Math.max(0, value));
    const x0 = Math.floor(clamp(-viewport.x / viewport.scale, image.width));
    const y0 = Math.floor(clamp(-viewport.y / viewport.scale, image.height));
    const x1 = Math.ceil(clamp((box.width - viewport.x) / viewport.scale, image.width));
    const y1 = Math.ceil(clamp((box.height - viewport.y) / viewport.scale, image.height));
    const [width, height] = [x1 - x0, y1 - y0];
    if (width <= 0 || height <= 0) {
      return;
    }
    const shrink = Math.min(1, MOST_PX / Math.max(width, height));
    const canvas = document.createElement("canvas");
    canvas.width = Math.max(1, Math.round(width * shrink));
    canvas.height = Math.max(1, Math.round(height * shrink));
    canvas.getContext("2d")?.drawImage(image, x0, y0, width, height, 0, 0, canvas.width, canvas.height);
    const data = canvas.toDataURL("image/jpeg", JPEG_QUALITY);
    this.#body += `<image x="${x0}" y="${y0}" width="${width}" height="${height}" preserveAspectRatio="none" href="${data}"/>`;
  }

  path(): PenPath {
    return new SvgPath();
  }

  stroke(path: PenPath, { colour, width, alpha, dash = [], join }: Stroke): void {
    const { d } = path as SvgPath;
    if (d !== "") {
      const dashes = dash.length === 0 ? "" : ` stroke-dasharray="${dash.map(at).join(" ")}"`;
      const joined = join === undefined ? "" : ` stroke-linejoin="${join}"`;
      this.#body += `<path d="${d}" fill="none" stroke="${hex(colour)}" stroke-width="${at(width)}" stroke-opacity="${at(alpha)}"${dashes}${joined}/>`;
    }
  }

  fill(path: PenPath, { colour, alpha, rule }: Fill): void {
    const { d } = path as SvgPath;
    if (d !== "") {
      const ruled = rule === undefined ? "" : ` fill-rule="${rule}"`;
      this.#body += `<path d="${d}" fill="${hex(colour)}" fill-opacity="${at(alpha)}"${ruled}/>`;
    }
  }

  text(text: string, x: number, y: number, size: number, colour: string): void {
    this.#body += `<text x="${at(x)}" y="${at(y)}" font-family="system-ui, Liberation Sans, sans-serif" font-weight="600" font-size="${at(size)}" fill="${hex(colour)}">${escaped(text)}</text>`;
  }

  widthOf(text: string, size: number): number {
    if (this.#measure === null) {
      return 0.6 * size * text.length;
    }
    this.#measure.font = fontOf(size);
    return this.#measure.measureText(text).width;
  }
}

/** A number with three decimals at most. */
export function at(value: number): string {
  return String(Math.round(1000 * value) / 1000);
}

const known = new Map<string, string>();

/** A colour as every program reads it: mixtures and new notations are worked out. */
export function hex(colour: string): string {
  if (/^#[0-9a-f]{6}$|^none$/i.test(colour)) {
    return colour;
  }
  const found = known.get(colour) ?? workedOut(colour);
  known.set(colour, found);
  return found;
}

function workedOut(colour: string): string {
  const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  if (context === null) {
    return colour;
  }
  context.fillStyle = colour;
  context.fillRect(0, 0, 1, 1);
  const [r = 0, g = 0, b = 0, a = 255] = context.getImageData(0, 0, 1, 1).data;
  const opaque = `#${[r, g, b].map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
  return a === 255 ? opaque : `${opaque}${a.toString(16).padStart(2, "0")}`;
}
