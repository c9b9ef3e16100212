/** The figures of the site's own core and demo scene. */
import type { FigurePlace } from "../../element/RidgelineFigure";

const DEMO = "./demo/";

/** Where the site has what figures need. */
export async function sitePlace(): Promise<FigurePlace> {
  const { OF_SITE } = await import("../../core/engine");
  return {
    startWorker: OF_SITE.startWorker,
    wasmUrl: OF_SITE.wasmUrl,
    demoUrl: new URL(DEMO, document.baseURI).href,
  };
}

/** Makes `<ridgeline-figure>` known. */
export async function needFigure(): Promise<void> {
  const { defineFigure } = await import("../../element/RidgelineFigure");
  defineFigure(await sitePlace());
}
