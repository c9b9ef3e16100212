/** The tabs, and below them either images with overlays or the 3D view, above the figure's own laboratory. */
import "./stages.css";
import type { ComponentType } from "preact";
import { useRef } from "preact/hooks";
import { AdjacencyLab } from "../../stages/adjacency/AdjacencyLab";
import { ClusterLab } from "../../stages/clusters/ClusterLab";
import { CoplanarLab } from "../../stages/coplanar/CoplanarLab";
import { DenseLab } from "../../stages/dense/DenseLab";
import { DirectionLab } from "../../stages/directions/DirectionLab";
import { FacetLab } from "../../stages/facets/FacetLab";
import type { Figure } from "../../stages/figure";
import { SimLab } from "../../stages/halfplanes/SimLab";
import { GroupLab, LineLab } from "../../stages/lines/LineLab";
import { PointLab } from "../../stages/matches/PointLab";
import { RectangleLab } from "../../stages/rectangles/RectangleLab";
import { RefinementLab } from "../../stages/refinement/RefinementLab";
import { isCorrecting } from "../corrections/drawn";
import { FlightProgress } from "../flight/FlightProgress";
import { Filmstrip } from "../images/Filmstrip";
import { ImageViews } from "../images/ImageViews";
import { pageFigure } from "../selection/selectionQueries";
import { SpaceView } from "../space/SpaceView";
import { TABS, type Tab } from "../state/methods";
import { method } from "../state/parameters";
import { images } from "../state/scene";
import { showTab, tab } from "../state/viewState";
import { EmptyStage } from "./EmptyStage";
import { edgeTool } from "./edgeTool";

const TITLES: Record<Tab, string> = {
  images: "Images",
  segments: "Segments",
  matches: "Matches",
  lines: "3D lines",
  halfplanes: "Half-planes",
  coplanar: "Coplanar sets",
  adjacency: "Adjacency",
  dense: "Dense planes",
  groups: "Groups",
  facets: "Facets",
  refinement: "Refinement",
  regions: "Regions",
  directions: "Directions",
  clusters: "Clusters",
  rectangles: "Rectangles",
  model: "Model",
};

/** Tabs that show images; the others show space. */
const IMAGE_TABS: readonly Tab[] = ["images", "segments", "matches", "regions", "directions", "clusters"];

/** What stands below the images or the space of a tab. */
const LABS: Partial<Record<Tab, ComponentType<{ figure: Figure }>>> = {
  matches: PointLab,
  lines: LineLab,
  halfplanes: SimLab,
  coplanar: CoplanarLab,
  adjacency: AdjacencyLab,
  dense: DenseLab,
  groups: GroupLab,
  facets: FacetLab,
  refinement: RefinementLab,
  directions: DirectionLab,
  clusters: ClusterLab,
  rectangles: RectangleLab,
  model: Filmstrip,
};

/** Drawn anew with whatever of the page's state changes; the tabs and the space are not. */
function PageImages() {
  const figure = pageFigure();
  const tool = tab.value === "images" && isCorrecting.value ? edgeTool(figure) : undefined;
  return <ImageViews figure={figure} empty={<EmptyStage />} tool={tool} />;
}

function PageLab({ Lab }: { Lab: ComponentType<{ figure: Figure }> }) {
  return <Lab figure={pageFigure()} />;
}

export function StageView() {
  const list = useRef<HTMLDivElement>(null);
  const isImageTab = IMAGE_TABS.includes(tab.value);
  const names: readonly Tab[] = TABS[method.value];
  const Lab = images.value.length > 0 ? LABS[tab.value] : undefined;
  const onKeyDown = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step !== 0) {
      event.preventDefault();
      const next = (names.indexOf(tab.value) + step + names.length) % names.length;
      showTab(names[next] as Tab);
      (list.current?.children[next] as HTMLElement | undefined)?.focus();
    }
  };
  return (
    <>
      <div
        class="tabs"
        role="tablist"
        aria-label="Stage views"
        tabIndex={-1}
        ref={list}
        onKeyDown={onKeyDown}
      >
        {names.map((name) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls="stage-view"
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              showTab(name);
            }}
          >
            {TITLES[name]}
          </button>
        ))}
      </div>
      <div id="stage-view" class="stage-view" role="tabpanel" aria-labelledby={`tab-${tab.value}`}>
        <FlightProgress />
        {isImageTab && <PageImages />}
        <SpaceView hidden={isImageTab} />
        {Lab !== undefined && (
          <section class="lab" aria-label={`${TITLES[tab.value]}: figure`}>
            <PageLab Lab={Lab} />
          </section>
        )}
      </div>
    </>
  );
}
