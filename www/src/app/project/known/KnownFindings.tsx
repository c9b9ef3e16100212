/** What the images say of the terrain model, the footprints and the point cloud that are known beforehand. */
import type { CloudComparison, KnownComparison, RegisterTrace } from "../../../shared/records";
import { STAGE_FACTS } from "../../../stages/list";
import { Links } from "../../inspector/Inspector";
import { counted } from "../../parts/counted";
import { FOOTPRINT_WORDS, knownWords, outcomesOf } from "../../parts/knownText";
import { results } from "../../state/results";
import { tab } from "../../state/viewState";

export function KnownFindings() {
  const { terrain, dense, verification } = results.value;
  const { known = [] } = STAGE_FACTS[tab.value];
  const register = known.includes("register") ? verification?.register : undefined;
  const ground = known.includes("terrain") ? terrain : null;
  const cloud = known.includes("cloud") ? dense?.trace.point_cloud : undefined;
  return (
    <>
      {ground !== null && <Terrain found={ground} />}
      {register !== undefined && <Footprints found={register} />}
      {cloud !== undefined && <PointCloud found={cloud} />}
    </>
  );
}

function Terrain({ found }: { found: KnownComparison }) {
  return (
    <section class="panel" data-testid="known-terrain">
      <h2>Terrain</h2>
      <p class="muted">{found.file}</p>
      <p>{knownWords("terrain", found)}</p>
    </section>
  );
}

function PointCloud({ found }: { found: CloudComparison }) {
  return (
    <section class="panel" data-testid="known-point-cloud">
      <h2>Point cloud</h2>
      <p class="muted">
        {found.compared.file}: {counted(found.planes.length, "planes")}
      </p>
      <p>{knownWords("cloud", found.compared)}</p>
    </section>
  );
}

function Footprints({ found }: { found: RegisterTrace }) {
  return (
    <section class="panel" data-testid="known-footprints">
      <h2>Footprints</h2>
      <p class="muted">
        {found.compared.file}: {counted(found.footprints.length, "footprints")} in the scene
      </p>
      <p>{knownWords("footprints", found.compared)}</p>
      <dl class="facts known-outcomes">
        {outcomesOf(found).map(({ verdict, indices, range }) => (
          <div key={verdict} class="broad" data-outcome={verdict}>
            <dt>
              {indices.length} {FOOTPRINT_WORDS[verdict]}
              {range !== "" && <span class="muted numbers"> ({range})</span>}
            </dt>
            <dd>
              <Links
                to={indices.map((index) => ({
                  name: found.footprints[index]?.name ?? "",
                  selection: { kind: "footprint", index },
                }))}
              />
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
