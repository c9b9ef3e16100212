/** The layout: the entrance while nothing is open, else the workbench. */
import "./shell.css";
import { useEffect, useState } from "preact/hooks";
import { ArrivalQuestion } from "../project/ArrivalQuestion";
import { Entrance } from "../project/entrance/Entrance";
import { undo } from "../project/projectActions";
import { isCorrecting } from "../results/corrections/drawn";
import * as corrections from "../results/corrections/history";
import { announcement } from "../state/notices";
import { face, tab } from "../state/viewState";
import { showsEntrance, showsWorkbench } from "../view/screen/opening";
import { Header } from "./Header";
import { Notices } from "./Notices";
import { PrintHead } from "./PrintHead";
import { Workbench } from "./Workbench";

/** The entrance's own pictures come first, milliseconds. */
const PREPARE_AFTER_MS = 1500;

export function App() {
  const isPrepared = useDelay(PREPARE_AFTER_MS);
  useEffect(() => {
    window.addEventListener("keydown", undoByKey);
    return () => window.removeEventListener("keydown", undoByKey);
  }, []);
  const isEntrance = showsEntrance.value;
  const isOpen = showsWorkbench.value;
  return (
    <>
      {isOpen && <SkipLink />}
      <Header />
      <PrintHead />
      {isEntrance && (
        <main class="door">
          <Notices />
          <Entrance />
        </main>
      )}
      {
        // Behind the entrance it gets its shaders ready, which would make the first run wait.
        (isOpen || (isEntrance && isPrepared)) && (
          <div class={isEntrance ? "behind" : "room"}>
            <Workbench />
          </div>
        )
      }
      <ArrivalQuestion />
      <div class="visually-hidden" aria-live="polite">
        {announcement}
      </div>
    </>
  );
}

/** Ctrl+Z: of the corrections while there are some to take back, else of the project. A field has its own. */
function undoByKey(event: KeyboardEvent): void {
  const isField = event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement;
  if (event.key.toLowerCase() !== "z" || !(event.ctrlKey || event.metaKey) || isField) {
    return;
  }
  event.preventDefault();
  if (event.shiftKey) {
    void corrections.redo();
  } else if (isCorrecting.value && corrections.canUndo.value) {
    void corrections.undo();
  } else {
    void undo();
  }
}

/** The first tab stop: past header and project to the views. No anchor, because the address holds the page's state. */
function SkipLink() {
  const skip = () => {
    const target =
      face.value === "method" ? `#tab-${tab.value}` : ".space-view:not([hidden]) canvas, .image-view canvas";
    document.querySelector<HTMLElement>(target)?.focus();
  };
  return (
    <button type="button" class="skip" onClick={skip}>
      Skip to the views
    </button>
  );
}

function useDelay(ms: number): boolean {
  const [isOver, setOver] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setOver(true), ms);
    return () => clearTimeout(timer);
  }, [ms]);
  return isOver;
}
