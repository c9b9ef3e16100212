/** The layout: the entrance while nothing is open, else the workbench. */
import "./shell.css";
import { useEffect, useState } from "preact/hooks";
import { ArrivalQuestion } from "../project/ArrivalQuestion";
import { Entrance } from "../project/entrance/Entrance";
import { redo, undo } from "../project/projectActions";
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

const TEXT_FIELDS = "textarea, input:not([type=checkbox], [type=radio], [type=range], [type=file])";

/** Ctrl+Z takes back the last step, Ctrl+Shift+Z does it again. A field of text has its own. */
function undoByKey(event: KeyboardEvent): void {
  const isText = event.target instanceof Element && event.target.matches(TEXT_FIELDS);
  if (event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey) && !isText) {
    event.preventDefault();
    void (event.shiftKey ? redo() : undo());
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
