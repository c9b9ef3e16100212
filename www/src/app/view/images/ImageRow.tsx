/** Photographs beside each other, with what a stage found drawn over. */
import "./images.css";
import type { ComponentProps } from "preact";
import { marksOf } from "../../../kinds/kinds";
import type { Mark } from "../../../kinds/parts/marks";
import { type Figure, viewName } from "../../../stages/figure";
import type { Overlay } from "./drawing";
import { ImageCanvas } from "./ImageCanvas";
import { ViewPicker } from "./ViewPicker";

interface Props {
  figure: Figure;
  overlay: (view: number, figure: Figure) => Overlay;
}

export function ImageRow(of: Props & { views: readonly number[]; follows?: boolean }) {
  return (
    <div class="image-row">
      {of.views.map((view) => (
        <FigureImage key={view} {...of} view={view} />
      ))}
    </div>
  );
}

/** One view, of the reader's choice. */
export function PickedImage({ figure, overlay }: Props) {
  return (
    <div class="picked-image">
      <OwnViewPicker figure={figure} />
      <ImageRow figure={figure} overlay={overlay} views={[Math.max(0, figure.view)]} />
    </div>
  );
}

export function OwnViewPicker({ figure: { scene, view, act } }: { figure: Figure }) {
  const shown = Math.max(0, view);
  return <ViewPicker views={scene?.views ?? []} shown={shown} withAll={false} show={act.showView} />;
}

interface ImageProps extends Props {
  view: number;
  /** What is drawn beside the selection. */
  marks?: readonly Mark[] | undefined;
  /** Zooms to the selection. */
  follows?: boolean;
  onPlace?: ComponentProps<typeof ImageCanvas>["onPlace"];
}

/** A photograph with its overlay and what is selected. */
export function FigureImage(of: ImageProps) {
  const { figure, overlay, view, marks = [], follows = false } = of;
  const image = figure.images[view];
  return image === undefined ? null : (
    <ImageCanvas
      view={view}
      name={viewName(figure, view)}
      image={image}
      overlay={overlay(view, figure)}
      selection={figure.selection}
      marks={[...marksOf(figure.selection, view, figure), ...marks]}
      follows={follows}
      inText={figure.inText}
      onPick={figure.act.select}
      onPlace={of.onPlace}
    />
  );
}
