/** Elements that are drawn by hand: how large they are, and the keys that move what is in them. */
import { useEffect, useRef, useState } from "preact/hooks";
import type { Vec2 } from "../../shared/records";

/** Of a canvas that is drawn anew when what it shows changes. */
export function useDrawn(draw: (context: CanvasRenderingContext2D) => void, of: readonly unknown[]) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (context != null) {
      draw(context);
    }
  }, of);
  return canvas;
}

/** Of an element, with its size in CSS pixels: that which it had when it was last seen, 0 before. */
export function useSize<E extends Element>() {
  const element = useRef<E>(null);
  const [size, setSize] = useState({ width: 0, height: 0 });
  useEffect(() => {
    const shown = element.current;
    if (shown === null) {
      return undefined;
    }
    const observer = new ResizeObserver(() => {
      const { clientWidth: width, clientHeight: height } = shown;
      if (width > 0 && height > 0) {
        setSize({ width, height });
      }
    });
    observer.observe(shown);
    return () => observer.disconnect();
  }, []);
  return [element, size] as const;
}

/** Where the arrow keys lead, in an image: x to the right, y down. */
export const ARROWS: Readonly<Record<string, Vec2>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
