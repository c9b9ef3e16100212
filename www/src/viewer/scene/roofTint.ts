/** The tint of a plane: azimuth as hue, slope as chroma, equal lightness for all. */
import type { Facet } from "../../shared/records";

/** From this slope on, radians, the tint has its full saturation. */
const FULL_TINT_SLOPE = (40 * Math.PI) / 180;

type Rgb = readonly [red: number, green: number, blue: number];

/** In linear light, 0 to 1. */
export function roofTint({ plane }: Pick<Facet, "plane">): Rgb {
  const [x, y, z] = plane.normal;
  const slope = Math.atan2(Math.hypot(x, y), Math.abs(z));
  const chroma = 0.1 * Math.min(1, slope / FULL_TINT_SLOPE);
  return fromOklch(0.76, chroma, Math.atan2(y, x));
}

/** The same for style sheets and SVG: "#rrggbb". */
export function roofTintHex(facet: Pick<Facet, "plane">): string {
  const bytes = roofTint(facet).map((value) => Math.round(255 * encoded(value)));
  return `#${bytes.map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
}

/** Oklch (Ottosson 2020) in linear light, clipped. */
function fromOklch(lightness: number, chroma: number, hue: number): Rgb {
  const a = chroma * Math.cos(hue);
  const b = chroma * Math.sin(hue);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    clip(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    clip(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    clip(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** From linear light to sRGB. */
function encoded(value: number): number {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

function clip(value: number): number {
  return Math.min(1, Math.max(0, value));
}
