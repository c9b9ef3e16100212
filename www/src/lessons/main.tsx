/** Starts the lessons: a page of its own, so that the first load of the other one does not grow. */
import "../app/parts/base.css";
import "../app/parts/parts.css";
import "./lessons.css";
import { render } from "preact";
import { restoreTextScale } from "../app/state/textScale";
import { OF_SITE } from "../core/engine";
import { defineFigure } from "../element/RidgelineFigure";
import { followAddress, linkedScene } from "./address";
import { followPrinting } from "./handout";
import { LessonsPage } from "./LessonsPage";
import { beginWith, followDrops } from "./scene/sceneChoice";
import { DEMO_URL } from "./scene/useScene";

restoreTextScale();
defineFigure({ ...OF_SITE, wasmUrl: OF_SITE.wasmUrl, demoUrl: DEMO_URL });
followAddress();
followPrinting();
followDrops();
const root = document.getElementById("app");
if (root !== null) {
  render(<LessonsPage />, root);
}
void beginWith(linkedScene());
