/** The model beside that of somebody else, from a CityJSON file: what both have, and by how much it differs. */
import "./comparison.css";
import { useState } from "preact/hooks";
import type { ComparedModels } from "../../../shared/records";
import { counted } from "../../parts/counted";
import { percentText, signed } from "../../parts/numberText";
import { compareModel } from "../../session/stageRuns";
import { isBusy } from "../../state/activity";
import { results } from "../../state/results";

type Part = ComparedModels["buildings"][number];

interface Found {
  name: string;
  /** The results that were compared: of others it says nothing. */
  of: object;
  models: ComparedModels;
}

export function ModelComparison() {
  const [found, show] = useState<Found | null>(null);
  const compare = async (input: HTMLInputElement) => {
    const file = input.files?.[0];
    input.value = "";
    const models = file === undefined ? null : await compareModel(file);
    show(file === undefined || models === null ? null : { name: file.name, of: results.value, models });
  };
  const isCurrent = found !== null && found.of === results.value;
  return (
    <section class="model-comparison" data-testid="model-comparison">
      <label>
        Compare with another model (CityJSON){" "}
        <input
          type="file"
          accept=".json"
          disabled={isBusy.value}
          onChange={(event) => void compare(event.currentTarget)}
        />
      </label>
      {isCurrent && <Table name={found.name} models={found.models} />}
    </section>
  );
}

function Table({ name, models: { buildings, facets } }: { name: string; models: ComparedModels }) {
  const inBoth = (parts: readonly Part[]) => parts.filter(({ above_m }) => above_m !== null);
  const alone = (which: "first" | "second") =>
    buildings.filter((part) => part.above_m === null && part[which] !== null).length;
  return (
    <>
      <p>
        {counted(inBoth(buildings).length, "buildings")} in both, {alone("first")} only here,{" "}
        {alone("second")} only in {name}; {counted(inBoth(facets).length, "faces")} in both.
      </p>
      <div class="facts-table">
        <table class="comparison">
          <thead>
            <tr>
              <th scope="col">Here</th>
              <th scope="col">{name}</th>
              <th scope="col">Overlap</th>
              <th scope="col">Roof [m²]</th>
              <th scope="col">Higher by [m]</th>
            </tr>
          </thead>
          <tbody class="numbers">
            {buildings.map((part) => (
              <tr key={`${part.first} ${part.second}`}>
                <td>{part.first ?? "–"}</td>
                <td>{part.second ?? "–"}</td>
                <td>{percentText(part.overlap)}</td>
                <td>{part.area_m2.map((area) => area.toFixed(1)).join(" / ")}</td>
                <td title={part.largest_m === null ? "" : `At most ${part.largest_m.toFixed(2)} m`}>
                  {part.above_m === null ? "–" : signed(part.above_m, 2)}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}
