/** Starts the page. */
import "../parts/base.css";
import "../parts/parts.css";
import "../parts/charts.css";
import { render } from "preact";
import { storeProject, storeResults } from "../project/storedProject";
import { askAboutSelection } from "../selection/selectionQueries";
import { start } from "../session/session";
import { followState, opened } from "../settings/addressLink";
import { restoreTextScale } from "../state/textScale";
import { restoreFace } from "../state/viewState";
import { setOpening } from "../view/screen/opening";
import { App } from "./App";
import { isAwaited, restoreOpeningState } from "./openingState";
// After all others: on paper it has the last word.
import "./print.css";

restoreTextScale();
restoreFace(opened.face);
const root = document.getElementById("app");
if (root !== null) {
  render(<App />, root);
  void open();
}

async function open(): Promise<void> {
  // Whether something is on its way is known long before the core is.
  setOpening((await isAwaited()) ? "restoring" : "open");
  await start();
  performance.mark("core ready");
  askAboutSelection();
  await restoreOpeningState();
  setOpening("open");
  followState();
  storeProject();
  storeResults();
}

// Offline after the first load; only the built site has one.
if (import.meta.env.PROD && "serviceWorker" in navigator) {
  void navigator.serviceWorker.register("./sw.js").catch(() => undefined);
}
