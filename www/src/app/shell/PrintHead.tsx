/** What a printed page has that the screen says elsewhere: which project, by which method, and what was found. */
import { stageWords } from "../../stages/catalogue";
import { counted } from "../parts/counted";
import { method } from "../state/parameters";
import { projectName } from "../state/project";
import { mainResults } from "../state/results";
import { scene } from "../state/scene";
import { stages } from "../state/stages";
import { buildings } from "../view/result/buildings";

export function PrintHead() {
  const views = scene.value?.views ?? [];
  const done = stages.value.filter(({ status }) => status === "done");
  if (views.length === 0) {
    return null;
  }
  return (
    <header class="print-only print-head">
      <h1>{projectName}</h1>
      <p>
        Method: {method}. {counted(views.length, "photographs")}: {views.map(({ name }) => name).join(", ")}.
      </p>
      {done.length > 0 && (
        <table>
          <caption>What was found</caption>
          <tbody>
            {done.map(({ name, counts }) => (
              <tr key={name}>
                <th scope="row">{stageWords(name).title}</th>
                <td>
                  {Object.entries(counts)
                    .map(([what, count]) => counted(count, what.replaceAll("_", " ")))
                    .join(", ")}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
      <RoofAreas />
    </header>
  );
}

/** Sloped area and number of roof faces, building by building. */
function RoofAreas() {
  const all = buildings(mainResults.value.facets ?? []);
  if (all.length === 0) {
    return null;
  }
  return (
    <table>
      <caption>Roofs</caption>
      <thead>
        <tr>
          <th scope="col">Building</th>
          <th scope="col">Facets</th>
          <th scope="col">Area along the slope</th>
        </tr>
      </thead>
      <tbody>
        {all.map(({ number, faces, area }) => (
          <tr key={number}>
            <td>{number}</td>
            <td>{faces.length}</td>
            <td>{area.toFixed(1)} m²</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
