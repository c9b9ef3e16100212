/** Beside the model: its buildings, or of what is selected the numbers, or corrections. */
import "./result.css";
import { facetOf } from "../../../kinds/kinds";
import { numberOf } from "../../../shared/selection";
import { Inspector } from "../../inspector/Inspector";
import { counted } from "../../parts/counted";
import { ModelComparison } from "../../results/comparison/ModelComparison";
import { Corrections } from "../../results/corrections/Corrections";
import { isCorrecting } from "../../results/corrections/drawn";
import { mainResults } from "../../state/results";
import { aimAt, select, selection } from "../../state/viewState";
import { type Building, buildings, type RoofFace } from "./buildings";

export function ResultPanel() {
  return (
    <>
      {isCorrecting.value && <Corrections />}
      {!isCorrecting.value && <Buildings />}
      {selection.value !== null && <Inspector />}
    </>
  );
}

function Buildings() {
  const { facets } = mainResults.value;
  if (facets === null) {
    return (
      <section class="panel">
        <h2>Buildings</h2>
        <p class="muted">The model is joined from tiles: the report and the files list its buildings.</p>
        <ModelComparison />
      </section>
    );
  }
  const all = buildings(facets);
  const area = all.reduce((sum, building) => sum + building.area, 0);
  return (
    <section class="panel" data-testid="buildings">
      <h2>
        {counted(all.length, "buildings")}{" "}
        <span class="muted numbers">
          {counted(facets.length, "roof facets")}, {area.toFixed(0)} m²
        </span>
      </h2>
      {all.length === 0 && <p class="muted">No building was found in these photographs.</p>}
      <ul class="buildings">
        {all.map((building) => (
          <BuildingRow key={building.number} building={building} />
        ))}
      </ul>
      <ModelComparison />
    </section>
  );
}

function BuildingRow({ building }: { building: Building }) {
  const { number, faces, area, probability, doubtful } = building;
  const picked = facetOf(selection.value);
  const isOpen = faces.some(({ index }) => index === picked);
  const go = (face: RoofFace | undefined) => () => {
    if (face !== undefined) {
      aimAt(faces.flatMap(({ outer }) => outer));
      select({ kind: "facet", index: face.index });
    }
  };
  return (
    <li>
      <button type="button" class="building" aria-expanded={isOpen} onClick={go(faces[0])}>
        <b>Building {number}</b>
        <span class="numbers">{area.toFixed(1)} m²</span>
        <span class="muted numbers">{counted(faces.length, "roof facets")}</span>
        <span class={doubtful > 0 ? "doubtful numbers" : "muted numbers"} title="Of its least probable facet">
          {doubtful > 0 && `${doubtful} doubtful, `}
          {Math.round(100 * probability)}&nbsp;%
        </span>
      </button>
      {isOpen && (
        <ul class="faces-of">
          {faces.map((face) => (
            <li key={face.index}>
              <button type="button" aria-pressed={face.index === picked} onClick={go(face)}>
                <span>Facet {numberOf(face.index)}</span>
                <span class="numbers">{face.area.toFixed(1)} m²</span>
                <span class="numbers">{face.slopeDeg.toFixed(0)}°</span>
                <span class={face.isDoubtful ? "doubtful numbers" : "muted numbers"}>
                  {Math.round(100 * face.probability)} %
                </span>
              </button>
            </li>
          ))}
        </ul>
      )}
    </li>
  );
}
