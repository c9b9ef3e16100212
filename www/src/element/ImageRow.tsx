/** Photographs beside each other, with what a stage found drawn over. */
import { ImageCanvas } from "../app/images/ImageCanvas";
import { overlayOf } from "../app/images/overlays";
import type { Tab } from "../app/state/methods";
import { marksOf } from "../kinds/kinds";
import { type Figure, viewName } from "../shared/figure";

interface Props {
  figure: Figure;
  tab: Tab;
  views: readonly number[];
  /** Zooms to the selection. */
  follows?: boolean;
}

export function ImageRow({ figure, tab, views, follows = false }: Props) {
  const { selection, images, act } = figure;
  return (
    <div class="image-row">
      {views.map((view) => {
        const image = images[view];
        return (
          image !== undefined && (
            <ImageCanvas
              key={view}
              view={view}
              name={viewName(figure, view)}
              image={image}
              overlay={overlayOf(tab, view, figure)}
              selection={selection}
              marks={marksOf(selection, view, figure)}
              follows={follows}
              inText={figure.inText}
              onPick={act.select}
            />
          )
        );
      })}
    </div>
  );
}
