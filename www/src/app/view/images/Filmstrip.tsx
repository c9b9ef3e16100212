/** The selected thing in every view, each picture zoomed to it: "it lights up in every image". */
import { marksOf } from "../../../kinds/kinds";
import type { Mark } from "../../../kinds/parts/marks";
import { boundsOf } from "../../../shared/linear";
import "./images.css";
import { useEffect, useRef } from "preact/hooks";
import type { Selection } from "../../../shared/selection";
import type { Figure } from "../../../stages/figure";
import { textScale } from "../../state/textScale";
import { drawView } from "./drawing";
import { paint } from "./pen";
import { fitPoints, type Size } from "./viewport";

const WIDTH_PX = 190;
const HEIGHT_PX = 128;
/** Image pixels about the marked thing. */
const MARGIN_PX = 30;
const MAX_SCALE = 5;

/** `unpicked` is shown while nothing is selected. */
export function Filmstrip({ figure, unpicked = null }: { figure: Figure; unpicked?: Selection | null }) {
  void textScale.value;
  const picked = figure.selection ?? unpicked;
  const shown = (figure.scene?.views ?? [])
    .map((info, view) => ({ info, view, marks: marksOf(picked, view, figure) }))
    .filter(({ info, marks }) => marks.length > 0 && isInside(marks, info));
  const { openView } = figure.act;
  if (shown.length === 0) {
    return <p class="lab-hint muted">Pick something: it lights up here in every view that shows it.</p>;
  }
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls is reached by key
    <ul class="filmstrip" data-testid="filmstrip" tabIndex={0} aria-label="The selection in the views">
      {shown.map(({ info: { name }, view, marks }) => (
        <li key={view}>
          <Picture image={figure.images[view]} name={name} marks={marks} />
          {openView === null ? (
            <span>{name}</span>
          ) : (
            <button type="button" class="link" title={`Open ${name}`} onClick={() => openView(view)}>
              {name}
            </button>
          )}
        </li>
      ))}
    </ul>
  );
}

interface PictureProps {
  image: ImageBitmap | undefined;
  name: string;
  marks: readonly Mark[];
}

function Picture({ image, name, marks }: PictureProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (canvas.current !== null && image !== undefined) {
      const points = marks.flatMap((mark) => mark.points);
      const box = { width: WIDTH_PX, height: HEIGHT_PX };
      const viewport = fitPoints(points, box, MARGIN_PX, MAX_SCALE) ?? { scale: 1, x: 0, y: 0 };
      paint(canvas.current, { viewport, box }, ratio(), (pen, of) =>
        drawView(pen, of, image, { segments: null, supports: null }, null, marks),
      );
    }
  });
  return (
    <canvas
      ref={canvas}
      width={WIDTH_PX * ratio()}
      height={HEIGHT_PX * ratio()}
      role="img"
      aria-label={`The selection in ${name}`}
    />
  );
}

function ratio(): number {
  return Math.max(1, Math.round(window.devicePixelRatio));
}

/** Does the view show the middle of the marks? */
function isInside(marks: readonly Mark[], { width, height }: Size): boolean {
  const [x0, y0, x1, y1] = boundsOf(marks.flatMap(({ points }) => points));
  const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2];
  return x > 0 && y > 0 && x < width && y < height;
}
