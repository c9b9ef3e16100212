/** In the hand: the model, the photographs, the tour. What a workbench needs a table for is left out. */
import type { ComponentChildren } from "preact";
import { Downloads } from "../project/Downloads";
import { Project } from "../project/Project";
import { tourStep } from "../state/tour";
import { showTab, tab } from "../state/viewState";
import { endTour, startTour } from "../tour/steps";
import { TourPanel } from "../tour/TourPanel";
import { showsEntrance } from "../view/screen/opening";
import { StageRail } from "../view/stages/StageRail";
import { StageView } from "../view/stages/StageView";
import { Notices } from "./Notices";

type Place = "model" | "photographs" | "tour";

export function Phone() {
  const isBehind = showsEntrance.value;
  const place: Place = tourStep.value !== null ? "tour" : tab.value === "images" ? "photographs" : "model";
  const go = (name: "model" | "images") => () => {
    if (tourStep.value !== null) {
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
        <PlaceButton isHere={place === "tour"} onClick={startTour}>
          Tour
        </PlaceButton>
      </nav>
      <main class="centre">
        {!isBehind && <Notices />}
        {place === "tour" && <TourPanel />}
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
