/** Starts the page. */
import "./base.css";
import "../parts/parts.css";
import "../parts/charts.css";
import { render } from "preact";
import { storeProject, storeResults } from "../project/storedProject";
import { askAboutSelection } from "../selection/selectionQueries";
import { start } from "../session/session";
import { followState } from "../settings/addressLink";
import { App } from "./App";
import { restoreOpeningState } from "./openingState";

const root = document.getElementById("app");
if (root !== null) {
  render(<App />, root);
  void open();
}

async function open(): Promise<void> {
  await start();
  askAboutSelection();
  await restoreOpeningState();
  followState();
  storeProject();
  storeResults();
}

// Offline after the first load; only the built site has one.
if (import.meta.env.PROD && "serviceWorker" in navigator) {
  void navigator.serviceWorker.register("./sw.js").catch(() => undefined);
}
