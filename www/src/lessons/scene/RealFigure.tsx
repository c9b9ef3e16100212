/** A figure of the page on the chosen scene: the element, driven by the lesson. */
import { h } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { theme } from "../../app/state/theme";
import type { RidgelineFigure } from "../../element/RidgelineFigure";
import { SceneBar } from "./SceneBar";
import { choice } from "./sceneChoice";

/** The figure of a kind, as a screen's own. */
export function realFigure(kind: string) {
  return function OnScene() {
    const now = choice.value;
    const element = useRef<RidgelineFigure>(null);
    useEffect(() => {
      if (element.current !== null && now !== null) {
        element.current.input = now.kind === "files" ? now.input : null;
      }
    }, [now]);
    return (
      <div class="real">
        <SceneBar />
        {now !== null &&
          h("ridgeline-figure", {
            ref: element,
            kind,
            scene: now.kind === "link" ? now.url : "demo",
            theme: theme.value,
          })}
      </div>
    );
  };
}
