/** A point of a photograph at a height that the reader turns: where all other photographs see it, and how well it is known. */
import { useSignal } from "@preact/signals";
import type { Vec2 } from "../../shared/records";
import { Line, Slider } from "../parts/draw";
import { metres } from "../parts/say";
import { pointAtHeight } from "../toy/camera";
import { covarianceOf } from "../toy/triangulation";
import { heightsOf, transferred } from "./heights";
import { OnScene, Photo } from "./Photo";
import type { LoadedScene } from "./useScene";

/** Standard deviation that a mark set by hand is taken to have, pixels. */
const SIGMA_PX = 0.5;
const PART_PX = 90;
const MOST_VIEWS = 8;

export const PixelInViews = () => (
  <OnScene>{(scene) => <Marked scene={scene} hasAccuracy={false} />}</OnScene>
);

/** The same with the standard deviation of the height: of two views, and of all. */
export const PixelAccuracy = () => <OnScene>{(scene) => <Marked scene={scene} hasAccuracy />}</OnScene>;

function Marked({ scene, hasAccuracy }: { scene: LoadedScene; hasAccuracy: boolean }) {
  const views = scene.views.slice(0, MOST_VIEWS);
  const [first, ...others] = views as [LoadedScene["views"][number], ...LoadedScene["views"][number][]];
  const { middle, reach } = heightsOf(scene.views);
  const at = useSignal<Vec2>([0.5 * first.width, 0.5 * first.height]);
  const height = useSignal(middle);
  const x = at.value;
  const images = others.map(({ P }) => transferred(first.P, P, x, height.value));
  return (
    <>
      <div class="pair">
        <Photo view={first} at={at} />
        <div class="parts">
          {views.map((view, i) => {
            const centre = i === 0 ? x : (images[i - 1] as Vec2);
            return (
              <Photo key={view.name} view={view} part={{ centre, size: PART_PX }}>
                <Cross at={centre} colour={i === 0 ? "s1" : "s2"} />
              </Photo>
            );
          })}
        </div>
      </div>
      <Slider
        symbol="h"
        label="height of the point"
        of={height}
        range={[middle - reach, middle + reach, 0.05]}
        says={metres(height.value + scene.originZ, 2)}
      />
      {hasAccuracy && <Accuracy scene={scene} x={x} height={height.value} />}
    </>
  );
}

function Accuracy({ scene, x, height }: { scene: LoadedScene; x: Vec2; height: number }) {
  const all = scene.views.map(({ P }) => P);
  const X = pointAtHeight(all[0] as (typeof all)[number], x, height);
  const sigmaOf = (of: typeof all) => Math.sqrt(Math.max(0, covarianceOf(of, X, SIGMA_PX)[2]?.[2] ?? 0));
  return (
    <p class="says">
      With marks good to {SIGMA_PX} px, the height is known to {metres(sigmaOf(all.slice(0, 2)), 2)} from the
      first two views, and to {metres(sigmaOf(all), 2)} from all {all.length}.
    </p>
  );
}

function Cross({ at: [x, y], colour }: { at: Vec2; colour: string }) {
  const [near, far] = [6, 18];
  return (
    <>
      {(
        [
          [1, 0],
          [-1, 0],
          [0, 1],
          [0, -1],
        ] as const
      ).map(([dx, dy]) => (
        <Line
          key={`${dx} ${dy}`}
          from={[x + near * dx, y + near * dy]}
          to={[x + far * dx, y + far * dy]}
          class={`${colour} on-photo`}
        />
      ))}
    </>
  );
}
