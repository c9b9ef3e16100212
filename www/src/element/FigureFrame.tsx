/** What stands around a figure: how far it is, what went wrong, its title and paper, and what can be taken along. */
import { useEffect, useRef } from "preact/hooks";
import { useSize } from "../app/parts/useDrawn";
import { TakeAlong } from "../app/results/takeAlong/TakeAlong";
import { AboutFigure } from "../app/view/figures/AboutFigure";
import type { FigureStore } from "./figureStore";
import type { Kind } from "./kinds";
import type { SharedScene } from "./sharedScene";

/** Narrower than this, CSS pixels, parts stand below each other, or close together. */
const PHONE_PX = 560;
const TIGHT_PX = 860;

export interface Seen {
  name: string;
  kind: Kind;
  scene: SharedScene;
  store: FigureStore;
  /** With the equation and what it says. */
  isExplained: boolean;
  link: () => string;
  /** Where a figure is drawn. */
  onBody: (body: HTMLElement | null) => void;
}

export function FigureFrame({ seen }: { seen: Seen }) {
  const { name, kind, scene, store, isExplained, link, onBody } = seen;
  const [layout, root] = useLayout();
  const body = useRef<HTMLDivElement>(null);
  const { progress, failure } = scene.state.value;
  const { title, source } = kind.of;
  const figure = store.figure.value;
  useEffect(() => onBody(body.current));
  return (
    <figure class="frame" aria-label={title} data-layout={layout} ref={root}>
      {failure !== null && (
        <p class="failure" role="alert">
          {failure}
        </p>
      )}
      {failure === null && !store.isReady && (
        <div class="waiting" role="status">
          <p class="muted">{progress?.words ?? "Waiting"}</p>
          <progress aria-label="Progress of the figure" max={1} value={progress?.fraction ?? 0} />
        </div>
      )}
      {store.isReady && (
        <>
          <div class={`body kind-${name}`} ref={body}>
            <kind.View figure={figure} />
          </div>
          {isExplained && <AboutFigure of={kind.of} />}
          <figcaption class="foot">
            <span class="muted">
              {title} · {source}
            </span>
            <TakeAlong
              of={kind.of}
              name={name}
              rows={() => kind.rows(store.figure.peek())}
              body={() => body.current}
              link={link}
            />
          </figcaption>
        </>
      )}
    </figure>
  );
}

/** How much room there is, by the names that the style sheets know. */
function useLayout() {
  const [root, { width }] = useSize<HTMLElement>();
  return [width === 0 || width >= TIGHT_PX ? "wide" : width < PHONE_PX ? "phone" : "tight", root] as const;
}
