/** The layout: the entrance while nothing is open, else the workbench, or what of it fits into a hand. */
import "./shell.css";
import { useEffect, useState } from "preact/hooks";
import { Entrance } from "../project/entrance/Entrance";
import { announcement } from "../state/notices";
import { tab } from "../state/viewState";
import { isPhone } from "../view/screen/layout";
import { showsEntrance, showsWorkbench } from "../view/screen/opening";
import { Header } from "./Header";
import { Notices } from "./Notices";
import { Phone } from "./Phone";
import { PrintHead } from "./PrintHead";
import { Workbench } from "./Workbench";

/** The entrance's own pictures come first, milliseconds. */
const PREPARE_AFTER_MS = 1500;

export function App() {
  const isPrepared = useDelay(PREPARE_AFTER_MS);
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
          <div class={isEntrance ? "behind" : "room"}>{isPhone.value ? <Phone /> : <Workbench />}</div>
        )
      }
      <div class="visually-hidden" aria-live="polite">
        {announcement}
      </div>
    </>
  );
}

/** The first tab stop: past header and project to the views. No anchor, because the address holds the page's state. */
function SkipLink() {
  const skip = () => {
    const target = isPhone.value ? ".places button" : `#tab-${tab.value}`;
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
