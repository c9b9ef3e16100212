/** Starts the page. */
import "../styles/base.css";
import "../styles/layout.css";
import "../styles/parts.css";
import { render } from "preact";
import { App } from "./App";
import { start } from "./actions";

const root = document.getElementById("app");
if (root !== null) {
  render(<App />, root);
  void start();
}
