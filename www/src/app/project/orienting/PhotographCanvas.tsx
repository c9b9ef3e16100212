/** A photograph with something drawn over it, that hears where it is clicked, in its own pixels. */
import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { useDrawn } from "../../parts/useDrawn";
import { readPhotographs } from "./orientation";
import { PICTURE_PX, pictureOf } from "./photographPicture";

interface Props {
  file: string;
  label: string;
  /** Draws over it; `scale` is pixels of the canvas per pixel of the photograph. */
  draw: (context: CanvasRenderingContext2D, scale: number) => void;
  /** What is drawn. */
  of: readonly unknown[];
  onPlace: (x: number, y: number) => void;
  onKey?: (event: KeyboardEvent, size: readonly [width: number, height: number]) => void;
  /** Above and below it. */
  head?: ComponentChildren;
  children: ComponentChildren;
}

export function PhotographCanvas({ file, label, draw, of, onPlace, onKey, head, children }: Props) {
  const bitmap = useSignal<ImageBitmap | null>(null);
  const size = readPhotographs.value.find((one) => one.file === file)?.size ?? null;
  useEffect(() => {
    let isCurrent = true;
    bitmap.value = null;
    void pictureOf(file).then((found) => {
      if (isCurrent) {
        bitmap.value = found;
      }
    });
    return () => {
      isCurrent = false;
    };
  }, [file]);
  const drawAll = (context: CanvasRenderingContext2D) => {
    if (size !== null) {
      const { width, height } = context.canvas;
      context.clearRect(0, 0, width, height);
      if (bitmap.value !== null) {
        context.drawImage(bitmap.value, 0, 0, width, height);
      }
      draw(context, width / size[0]);
    }
  };
  const canvas = useDrawn(drawAll, [bitmap.value, size, ...of]);
  if (size === null) {
    return null;
  }
  const [width, height] = size;
  return (
    <figure>
      {head}
      <canvas
        ref={canvas}
        width={PICTURE_PX}
        height={Math.round((PICTURE_PX * height) / width)}
        role="img"
        tabIndex={onKey === undefined ? undefined : 0}
        aria-label={label}
        onClick={(event) => {
          const { left, top, width: shown } = event.currentTarget.getBoundingClientRect();
          onPlace(((event.clientX - left) * width) / shown, ((event.clientY - top) * width) / shown);
        }}
        onKeyDown={(event) => onKey?.(event, size)}
      />
      {children}
    </figure>
  );
}
