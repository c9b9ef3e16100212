/**
 * A small picture of an image file, made once it comes into view. Of a format that the browser cannot show, and of a file in
 * an archive, there is one once the core has loaded it.
 */
import { useEffect, useRef } from "preact/hooks";
import { thumbnailOf } from "./thumbnails";

const WIDTH_PX = 112;

export function Thumbnail({ blob, loaded }: { blob: Blob | undefined; loaded: ImageBitmap | undefined }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let isCurrent = true;
    const frame = canvas.current;
    if (frame === null) {
      return;
    }
    // One that is closed has no size.
    const paintLoaded = () => loaded !== undefined && loaded.width > 0 && paint(frame, loaded);
    if (blob === undefined) {
      paintLoaded();
      return;
    }
    const observer = new IntersectionObserver((entries) => {
      if (!entries.some(({ isIntersecting }) => isIntersecting)) {
        return;
      }
      observer.disconnect();
      void thumbnailOf(blob, () => isCurrent).then((bitmap) => {
        if (isCurrent && bitmap !== null) {
          paint(frame, bitmap);
        } else if (isCurrent) {
          paintLoaded();
        }
      });
    });
    observer.observe(frame);
    return () => {
      isCurrent = false;
      observer.disconnect();
    };
  }, [blob, loaded]);
  return <canvas ref={canvas} class="thumbnail" width={WIDTH_PX} height={(WIDTH_PX * 3) / 4} />;
}

/** Fills the frame, cropping what is too much. */
function paint(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
  const scale = Math.max(canvas.width / bitmap.width, canvas.height / bitmap.height);
  const width = bitmap.width * scale;
  const height = bitmap.height * scale;
  const context = canvas.getContext("2d");
  context?.drawImage(bitmap, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
}
