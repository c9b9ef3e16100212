/** `import "ridgeline/figure"`: makes `<ridgeline-figure>` known, with worker, core and demo scene beside this module. */
import { defineFigure } from "./RidgelineFigure";

export { RidgelineFigure } from "./RidgelineFigure";

const here = (path: string) => new URL(/* @vite-ignore */ path, import.meta.url).href;

defineFigure({
  startWorker: () => {
    const url = here("./worker.js");
    if (new URL(url).origin === location.origin) {
      return new Worker(url, { type: "module" });
    }
    // A worker must be of the page's own origin, what it imports need not.
    const start = new Blob([`import ${JSON.stringify(url)};`], { type: "text/javascript" });
    return new Worker(URL.createObjectURL(start), { type: "module" });
  },
  wasmUrl: here("../pkg/ridgeline_bg.wasm"),
  demoUrl: here("../demo/"),
});
