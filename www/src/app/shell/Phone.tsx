/** In the hand: the model, the photographs, the lessons. What a workbench needs a table for is left out. */
import type { ComponentChildren } from "preact";
import { Downloads } from "../project/Downloads";
import { Project } from "../project/Project";
import { showsEntrance } from "../screen/opening";
import { StageRail } from "../stages/StageRail";
import { StageView } from "../stages/StageView";
import { lessonStep } from "../state/tour";
import { showTab, tab } from "../state/viewState";
import { Lesson } from "../tour/Lesson";
import { endTour, startTour } from "../tour/lessons";
import { Notices } from "./Notices";

type Place = "model" | "photographs" | "lessons";

export function Phone() {
  const isBehind = showsEntrance.value;
  const place: Place =
    lessonStep.value !== null ? "lessons" : tab.value === "images" ? "photographs" : "model";
  const go = (name: "model" | "images") => () => {
    if (lessonStep.value !== null) {
      endTour();
    }
    showTab(name);
  };
  return (
    <div class={`phone ${place}`}>
      <nav class="places" aria-label="Places">
        <PlaceButton isHere={place === "model"} onClick={go("model")}>
          Model
        </PlaceButton>
        <PlaceButton isHere={place === "photographs"} onClick={go("images")}>
          Photographs
        </PlaceButton>
        <PlaceButton isHere={place === "lessons"} onClick={startTour}>
          Lessons
        </PlaceButton>
      </nav>
      <main class="centre">
        {!isBehind && <Notices />}
        {place === "lessons" && <Lesson />}
        <StageView />
        <StageRail />
      </main>
      {place === "photographs" && <Project />}
      {place === "model" && <Downloads />}
    </div>
  );
}

function PlaceButton(props: { isHere: boolean; onClick: () => void; children: ComponentChildren }) {
  return (
    <button type="button" aria-pressed={props.isHere} onClick={props.onClick}>
      {props.children}
    </button>
  );
}
