/** B99 figures 2 to 4: the candidates of a segment, pointwise correspondence, and the two windows that are compared. */
import { numberOf } from "../../shared/selection";
import "../../app/view/figures/figures.css";
import { counted } from "../../app/parts/counted";
import { outcomeWords } from "../../app/parts/reasonText";
import { useDrawn } from "../../app/parts/useDrawn";
import { type Figure, viewName } from "../figure";

const WINDOW_PX = 15;

export function PointLab({ figure }: { figure: Figure }) {
  const { story, candidate, at, correspondence } = figure.detail;
  const { compareAt } = figure.act;
  if (figure.selection?.kind !== "segment" || story === null) {
    return (
      <p class="lab-hint muted">
        Pick a segment: its epipolar beam appears in the other views, with the candidates in it and their
        scores.
      </p>
    );
  }
  return (
    <div class="point-lab" data-testid="point-lab">
      <div class="candidates">
        <p class="lab-head">{outcomeWords(story.outcome)}</p>
        {story.candidates.length === 0 ? (
          <p class="muted">No segment in any beam scored above the threshold.</p>
        ) : (
          <table>
            <thead>
              <tr>
                <th scope="col">Candidate</th>
                <th scope="col">Score</th>
                <th scope="col">Verified in</th>
              </tr>
            </thead>
            <tbody>
              {story.candidates.map((one, i) => (
                <tr key={`${one.view}.${one.segment}`} aria-selected={i === candidate}>
                  <td>
                    <button type="button" class="link" onClick={() => compareAt(i, at)}>
                      {viewName(figure, one.view)} · {numberOf(one.segment)}
                    </button>
                  </td>
                  <td class="numbers">
                    <span
                      class="bar"
                      style={{ inlineSize: `${Math.round(40 * one.score)}px` }}
                      aria-hidden="true"
                    />
                    {one.score.toFixed(2)}
                  </td>
                  <td class="numbers">
                    {counted(one.predictions.filter(({ verified }) => verified !== null).length, "views")}
                    {one.line !== null && ` · match ${numberOf(one.line)}`}
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        )}
      </div>
      {story.candidates.length > 0 && (
        <div class="correspond">
          <label data-control>
            <span>Point x along the segment</span>
            <input
              type="range"
              min={0}
              max={1}
              step={0.01}
              value={at}
              data-testid="along"
              onInput={(event) => compareAt(candidate, Number(event.currentTarget.value))}
            />
          </label>
          {correspondence === null ? (
            <p class="muted">Here the two lines have no common point.</p>
          ) : (
            <div class="pair-of-windows">
              <p>
                Correlation of {correspondence.channel === "warmth" ? "red less blue" : "grey values"}
                <strong class="numbers" data-testid="correlation">
                  {correspondence.correlation === null ? "–" : correspondence.correlation.toFixed(2)}
                </strong>
              </p>
              <Grey values={correspondence.window} title="about x" />
              <Grey values={correspondence.other_window} title="about x′ = l′ × F x" />
            </div>
          )}
        </div>
      )}
    </div>
  );
}

/** A window of grey values (or of warmth), each pixel a square; stretched to its own range, as correlation takes it. */
function Grey({ values, title }: { values: readonly number[]; title: string }) {
  const draw = (context: CanvasRenderingContext2D) => {
    const image = new ImageData(WINDOW_PX, WINDOW_PX);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    values.forEach((value, i) => {
      const grey = Math.round((255 * (value - low)) / (high - low || 1));
      image.data.set([grey, grey, grey, 255], 4 * i);
    });
    context.putImageData(image, 0, 0);
  };
  const canvas = useDrawn(draw, [values]);
  return (
    <figure>
      <canvas
        ref={canvas}
        class="pixels"
        width={WINDOW_PX}
        height={WINDOW_PX}
        role="img"
        aria-label={`Window ${title}`}
      />
      <figcaption class="muted">{title}</figcaption>
    </figure>
  );
}
