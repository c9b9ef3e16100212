/** A point of a photograph, and its epipolar lines in the others. */
import { useSignal } from "@preact/signals";
import { apply3, clipLine, homogeneous } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import { Line } from "../parts/draw";
import { fundamental } from "../toy/camera";
import { OnScene, Photo } from "./Photo";
import type { LoadedScene } from "./useScene";

const MOST_OTHERS = 5;

export const LinesInViews = () => <OnScene>{(scene) => <Lines scene={scene} />}</OnScene>;

function Lines({ scene }: { scene: LoadedScene }) {
  const [first, ...others] = scene.views as [LoadedScene["views"][number], ...LoadedScene["views"][number][]];
  const at = useSignal<Vec2>([0.5 * first.width, 0.5 * first.height]);
  return (
    <div class="pair">
      <Photo view={first} at={at} />
      <div class="parts wide">
        {others.slice(0, MOST_OTHERS).map((view) => {
          const line = apply3(fundamental(first.P, view.P), homogeneous(at.value));
          const part = clipLine(line, view.width, view.height);
          return (
            <Photo
              key={view.name}
              view={view}
              title={part === null ? `${view.name}: the line is beside the photograph` : view.name}
            >
              {part !== null && <Line from={part[0]} to={part[1]} class="s2 on-photo" />}
            </Photo>
          );
        })}
      </div>
    </div>
  );
}
