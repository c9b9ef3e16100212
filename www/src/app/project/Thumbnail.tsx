/** A small picture of an image file; formats that the browser cannot show stay an empty frame. */
import { useEffect, useRef } from "preact/hooks";

const WIDTH_PX = 112;

export function Thumbnail({ blob }: { blob: Blob | undefined }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let isCurrent = true;
    if (blob !== undefined) {
      decode(blob).then((bitmap) => {
        if (isCurrent && bitmap !== null && canvas.current !== null) {
          paint(canvas.current, bitmap);
        }
        bitmap?.close();
      });
    }
    return () => {
      isCurrent = false;
    };
  }, [blob]);
  return <canvas ref={canvas} class="thumbnail" width={WIDTH_PX} height={(WIDTH_PX * 3) / 4} />;
}

async function decode(blob: Blob): Promise<ImageBitmap | null> {
  try {
    return await createImageBitmap(blob, { resizeWidth: 2 * WIDTH_PX, resizeQuality: "medium" });
  } catch {
    return null;
  }
}

/** Fills the frame, cropping what is too much. */
function paint(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
  const scale = Math.max(canvas.width / bitmap.width, canvas.height / bitmap.height);
  const width = bitmap.width * scale;
  const height = bitmap.height * scale;
  const context = canvas.getContext("2d");
  context?.drawImage(bitmap, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
}
