/** The layout: project on the left, the stage views in the middle, what they mean and parameters on the right. */
import "./shell.css";
import { Comparison } from "../comparison/Comparison";
import { AboutFigure } from "../figures/AboutFigure";
import { Inspector } from "../inspector/Inspector";
import { Downloads } from "../project/Downloads";
import { Parameters } from "../project/Parameters";
import { Project } from "../project/Project";
import { StageRail } from "../stages/StageRail";
import { StageView } from "../stages/StageView";
import { announcement } from "../state/notices";
import { images } from "../state/scene";
import { lessonStep } from "../state/tour";
import { Lesson } from "../tour/Lesson";
import { Header } from "./Header";
import { Notices } from "./Notices";

export function App() {
  return (
    <>
      <Header />
      <div class="columns">
        <aside class="column" aria-label="Project">
          <Project />
          <Downloads />
        </aside>
        <main class="centre">
          <Notices />
          <StageView />
          <StageRail />
        </main>
        <aside class="column" aria-label="Details">
          {lessonStep.value !== null ? <Lesson /> : images.value.length > 0 && <AboutFigure />}
          <Comparison />
          <Inspector />
          <Parameters />
        </aside>
      </div>
      <div class="visually-hidden" aria-live="polite">
        {announcement}
      </div>
    </>
  );
}
