/** Small pictures of photographs: made one at a time, because a browser decodes a large photograph whole for each. */

/** Width of a picture, pixels: twice what is shown, for fine screens. */
const WIDTH_PX = 224;

const made = new WeakMap<Blob, Promise<ImageBitmap | null>>();
let last: Promise<unknown> = Promise.resolve();

/** The small picture of an image file; null for formats that the browser cannot show, and when nobody waits for it any more. */
export function thumbnailOf(blob: Blob, isWanted: () => boolean): Promise<ImageBitmap | null> {
  const present = made.get(blob);
  if (present !== undefined) {
    return present;
  }
  const making = last.then(() => {
    if (!isWanted()) {
      made.delete(blob);
      return null;
    }
    return createImageBitmap(blob, { resizeWidth: WIDTH_PX, resizeQuality: "medium" });
  });
  const found = making.catch(() => null);
  made.set(blob, found);
  last = found;
  return found;
}
