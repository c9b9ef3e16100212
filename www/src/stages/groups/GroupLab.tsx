/** B99 figures 17 to 20: the groups of coplanar half-planes. */
import "../../app/view/figures/figures.css";
import { counted } from "../../app/parts/counted";
import { degreesOf, slopeOf } from "../../app/parts/numberText";
import { Filmstrip } from "../../app/view/images/Filmstrip";
import { category } from "../../shared/palette";
import { densePlanesOf, type PlaneGroup, rectanglesOf } from "../../shared/records";
import { numberOf, pickedIndex } from "../../shared/selection";
import type { Figure } from "../figure";

/** Figures 17 to 20: the groups, largest first. */
export function GroupLab({ figure }: { figure: Figure }) {
  const { grouping } = figure.results;
  if (grouping === null) {
    return <p class="lab-hint muted">Run the stage: its groups of coplanar half-planes appear here.</p>;
  }
  const order = grouping.groups
    .map((group, index) => ({ group, index }))
    .sort((a, b) => b.group.members.length - a.group.members.length);
  return (
    <div class="split-lab even">
      <ol class="groups" data-testid="groups">
        {order.map(({ group, index }) => {
          const isChosen = pickedIndex(figure.selection, "group") === index;
          const fans = group.members.filter(({ half_plane }) => half_plane !== null).length;
          return (
            <li key={index}>
              <button
                type="button"
                class="quiet"
                aria-pressed={isChosen}
                onClick={() => {
                  figure.act.select({ kind: "group", index });
                }}
              >
                <span class="dot" style={{ background: category(index) }} aria-hidden="true" />
                <span>Group {numberOf(index)}</span>
                <span class="muted numbers">
                  {counted(new Set(group.members.map(({ line }) => line)).size, "lines")} ·{" "}
                  {counted(fans, "half-planes")} · {proposalWords(group)}
                  {degreesOf(slopeOf(group.plane.normal)).toFixed(0)}°
                </span>
              </button>
            </li>
          );
        })}
      </ol>
      <Filmstrip figure={figure} />
    </div>
  );
}

/** What else proposed a group's plane. */
function proposalWords(group: Pick<PlaneGroup, "proposals">): string {
  const counts = [
    [densePlanesOf(group).length, "dense planes"],
    [rectanglesOf(group).length, "rectangles"],
  ] as const;
  return counts.map(([count, what]) => (count === 0 ? "" : `${counted(count, what)} · `)).join("");
}
