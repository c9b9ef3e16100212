/**
 * A figure as an SVG file, as it stands on the page: charts and marks as lines, text as text, photographs and windows as embedded
 * pictures; and the same as a PNG in print size. Controls are left out.
 */
import { paintingOf } from "../../view/images/pen";
import { escaped } from "../../words/linkedText";
import { at, hex, SvgPen } from "./svgPen";

/** What a style sheet says of a chart, and a file has to say itself. */
const STYLES = [
  "fill",
  "fill-opacity",
  "stroke",
  "stroke-width",
  "stroke-opacity",
  "stroke-dasharray",
  "stroke-linecap",
  "stroke-linejoin",
  "opacity",
  "font-family",
  "font-size",
  "font-weight",
  "text-anchor",
  "paint-order",
  "display",
  "visibility",
] as const;

const CONTROLS = "input, select, summary, .choice, .toolbar, [data-control], .visually-hidden";

/** Of paper around what is drawn, CSS pixels. */
const MARGIN = 12;

/** 16 cm at 300 dots per inch. */
const PRINT_WIDTH_PX = 1890;
const LARGEST_SCALE = 6;
/** Dots per metre. */
const PRINT_DENSITY = 11_811;

/** What an element shows, as a whole SVG file. */
export function svgOf(root: HTMLElement, title: string): string {
  const frame = root.getBoundingClientRect();
  // On a slide a figure may be shown larger or smaller than it is laid out.
  const shrink = root.offsetWidth / frame.width || 1;
  const origin: Origin = { x: frame.left, y: frame.top, shrink };
  const paper = getComputedStyle(root).backgroundColor;
  const [width, height] = [frame.width, frame.height].map((side) => at(side * shrink + 2 * MARGIN));
  const box = `viewBox="${-MARGIN} ${-MARGIN} ${width} ${height}"`;
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" ${box}>` +
    `<title>${escaped(title)}</title>` +
    `<rect x="${-MARGIN}" y="${-MARGIN}" width="${width}" height="${height}" fill="${hex(paper)}"/>` +
    `${childrenOf(root, origin)}</svg>`
  );
}

/** An SVG file as a PNG, at least as wide as a page's text in print. */
export async function pngOf(svg: string): Promise<Blob> {
  const [, width = "1", height = "1"] = /width="([\d.]+)" height="([\d.]+)"/.exec(svg) ?? [];
  const scale = Math.min(LARGEST_SCALE, Math.max(2, PRINT_WIDTH_PX / Number(width)));
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(Number(width) * scale);
  canvas.height = Math.round(Number(height) * scale);
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  const png = await new Promise<Blob | null>((resolve) => {
    canvas.toBlob(resolve, "image/png");
  });
  if (png === null) {
    throw new Error("The browser cannot write a picture of this size.");
  }
  return new Blob([withDensity(new Uint8Array(await png.arrayBuffer()))], { type: "image/png" });
}

interface Origin {
  x: number;
  y: number;
  /** From what is seen to what was laid out. */
  shrink: number;
}

function childrenOf(parent: Element, origin: Origin): string {
  return [...parent.childNodes]
    .map((node) => {
      if (node instanceof Text) {
        return textOf(node, origin);
      }
      return node instanceof Element ? elementOf(node, origin) : "";
    })
    .join("");
}

function elementOf(element: Element, origin: Origin): string {
  const style = getComputedStyle(element);
  const box = element.getBoundingClientRect();
  const isSeen = style.display !== "none" && style.visibility === "visible" && box.width > 0;
  if (!isSeen || element.matches(CONTROLS)) {
    return "";
  }
  if (element instanceof SVGSVGElement) {
    return chartOf(element, box, origin);
  }
  if (element instanceof HTMLCanvasElement) {
    return pictureOf(element, box, origin);
  }
  const inside = childrenOf(element, origin);
  const frame = frameOf(box, origin);
  // What a scrolled or shortened part hides.
  const isCut = style.overflowX !== "visible" && inside !== "";
  const cut = isCut
    ? `<svg ${frame} viewBox="${viewBoxOf(frame)}" overflow="hidden">${inside}</svg>`
    : inside;
  return backgroundOf(style, box, origin) + cut;
}

function frameOf({ left, top, width, height }: DOMRect, origin: Origin): string {
  const own = (seen: number) => at(seen * origin.shrink);
  return `x="${own(left - origin.x)}" y="${own(top - origin.y)}" width="${own(width)}" height="${own(height)}"`;
}

/** That of a part of a file which keeps the coordinates of the whole. */
function viewBoxOf(frame: string): string {
  return [...frame.matchAll(/"([^"]*)"/g)].map(([, number]) => number).join(" ");
}

function chartOf(chart: SVGSVGElement, box: DOMRect, origin: Origin): string {
  const copy = chart.cloneNode(true) as SVGSVGElement;
  const originals = [chart, ...chart.querySelectorAll("*")];
  const copies = [copy, ...copy.querySelectorAll("*")];
  originals.forEach((original, i) => {
    const own = copies[i] as Element;
    const style = getComputedStyle(original);
    for (const name of [...own.getAttributeNames()]) {
      if (/^(class|style|on.*|tabindex|role|aria-.*|data-.*)$/.test(name)) {
        own.removeAttribute(name);
      }
    }
    for (const name of STYLES) {
      const value = style.getPropertyValue(name);
      own.setAttribute(name, name === "fill" || name === "stroke" ? hex(value) : value.replaceAll('"', "'"));
    }
  });
  const inner = copies.slice(1).length === 0 ? "" : new XMLSerializer().serializeToString(copy);
  const content = inner.replace(/^<svg[^>]*>/, "").replace(/<\/svg>$/, "");
  return `<svg ${frameOf(box, origin)} viewBox="${chart.getAttribute("viewBox") ?? ""}" overflow="visible">${content}</svg>`;
}

/** As it was drawn, where that is known; otherwise its pixels. */
function pictureOf(canvas: HTMLCanvasElement, box: DOMRect, origin: Origin): string {
  const painting = paintingOf(canvas);
  if (painting === undefined) {
    return `<image ${frameOf(box, origin)} preserveAspectRatio="none" image-rendering="pixelated" href="${canvas.toDataURL("image/png")}"/>`;
  }
  const pen = new SvgPen(painting.window);
  painting.draw(pen, painting.window);
  const { width, height } = painting.window.box;
  return `<svg ${frameOf(box, origin)} viewBox="0 0 ${at(width)} ${at(height)}" overflow="hidden">${pen.body}</svg>`;
}

function backgroundOf(style: CSSStyleDeclaration, box: DOMRect, origin: Origin): string {
  // Of a gradient the first colour: swatches of dashed lines have one.
  const colour = /rgba?\([^)]*\)/.exec(style.backgroundImage)?.[0] ?? style.backgroundColor;
  if (colour === "transparent" || /[,/]\s*0\)$/.test(colour)) {
    return "";
  }
  const radius = Math.min(Number.parseFloat(style.borderTopLeftRadius) || 0, box.height / 2);
  return `<rect ${frameOf(box, origin)} rx="${at(radius)}" fill="${hex(colour)}"/>`;
}

/** Each line of a text where it stands. */
function textOf(node: Text, origin: Origin): string {
  const parent = node.parentElement;
  if (parent === null || node.data.trim() === "") {
    return "";
  }
  const style = getComputedStyle(parent);
  const lines: { text: string; box: DOMRect }[] = [];
  for (const { 0: word, index } of node.data.matchAll(/\S+\s*/g)) {
    const range = document.createRange();
    range.setStart(node, index);
    range.setEnd(node, index + word.trimEnd().length);
    const box = range.getBoundingClientRect();
    const last = lines.at(-1);
    if (last !== undefined && Math.abs(last.box.top - box.top) < 2) {
      last.text += word;
    } else if (box.width > 0) {
      lines.push({ text: word, box });
    }
  }
  const size = Number.parseFloat(style.fontSize);
  const font = `font-family="${escaped(style.fontFamily)}" font-size="${at(size)}" font-weight="${style.fontWeight}" fill="${hex(style.color)}"`;
  return lines
    .map(({ text, box }) => {
      // The middle of a line box is a third of the size above the base line.
      const base = (box.top + box.height / 2 - origin.y) * origin.shrink + 0.35 * size;
      return `<text x="${at((box.left - origin.x) * origin.shrink)}" y="${at(base)}" ${font}>${escaped(text.trimEnd())}</text>`;
    })
    .join("");
}

/** Puts how large the picture is to be printed before its pixels (chunk pHYs). */
function withDensity(png: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer> {
  const afterHeader = 33;
  const chunk = new Uint8Array(21);
  const view = new DataView(chunk.buffer);
  view.setUint32(0, 9);
  chunk.set(new TextEncoder().encode("pHYs"), 4);
  view.setUint32(8, PRINT_DENSITY);
  view.setUint32(12, PRINT_DENSITY);
  chunk[16] = 1;
  view.setUint32(17, checksum(chunk.subarray(4, 17)));
  const all = new Uint8Array(png.length + chunk.length);
  all.set(png.subarray(0, afterHeader));
  all.set(chunk, afterHeader);
  all.set(png.subarray(afterHeader), afterHeader + chunk.length);
  return all;
}

/** CRC-32 as PNG has it. */
function checksum(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) {
      crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
    }
  }
  return (crc ^ 0xffffffff) >>> 0;
}
