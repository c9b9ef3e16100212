/** The layout: project on the left, the stage views in the middle, what they mean and parameters on the right. */
import { Comparison } from "./Comparison";
import { Downloads } from "./Downloads";
import { AboutFigure } from "./figures";
import { Header } from "./Header";
import { Inspector } from "./Inspector";
import { Lesson } from "./Lesson";
import { Notices } from "./Notices";
import { Parameters } from "./Parameters";
import { Project } from "./Project";
import { StageRail } from "./StageRail";
import { StageView } from "./StageView";
import { announcement, images, lessonStep } from "./state";

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
