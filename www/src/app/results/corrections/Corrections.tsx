/** Corrections of the model by hand: what can be done with the selected facet, and what has been done. */
import "./corrections.css";
import { signal, useSignalEffect } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { facetOf } from "../../../kinds/kinds";
import { obstructionText } from "../../../kinds/parts/obstructionText";
import { add, edgesOf } from "../../../shared/linear";
import type { Correction, Facet, NotApplied, Vec3 } from "../../../shared/records";
import { numberOf, pickedIndex } from "../../../shared/selection";
import { counted } from "../../parts/counted";
import { degreesOf, slopeOf } from "../../parts/numberText";
import { saveFile } from "../../parts/saveFile";
import { parseNumber, TextField } from "../../parts/TextField";
import { redo, undo } from "../../project/projectActions";
import { isBusy } from "../../state/activity";
import { notify } from "../../state/notices";
import { mainResults } from "../../state/results";
import { scene } from "../../state/scene";
import { aimAt, select, selection } from "../../state/viewState";
import { correctionWords, NOT_APPLIED_WORDS } from "./correctionWords";
import { doubtfulFacets, nextDoubtful } from "./doubtful";
import { drawn, forgetDrawn, showCorrecting } from "./drawn";
import { drawEdge, edgeStart, isDrawingEdge } from "./edgeDrawing";
import { type Ends, nearestEdge, nearestParallel, placeOf, ridgeOf, ringOf } from "./facetGeometry";
import { canRedo, canUndo, change, correct, corrections, remove } from "./history";

/** What is done with the next facet that is selected. */
interface Armed {
  kind: "set_symmetric" | "merge";
  facet: number;
}
const armed = signal<Armed | null>(null);

export function Corrections() {
  const { facets } = mainResults.value;
  useSignalEffect(takeSecond);
  useEffect(() => {
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, []);
  if (facets === null) {
    return null;
  }
  const doubtful = doubtfulFacets(facets).length;
  return (
    <section class="panel corrections" data-testid="corrections">
      <div class="row spread">
        <h2>Corrections</h2>
        <button type="button" class="quiet" onClick={() => showCorrecting(false)}>
          Done
        </button>
      </div>
      <div class="row wrap">
        <button type="button" disabled={doubtful === 0} onClick={goOn} title="Key N">
          Next doubtful
        </button>
        <button type="button" disabled={!canUndo.value || isBusy.value} onClick={() => void undo()}>
          Undo
        </button>
        <button type="button" disabled={!canRedo.value || isBusy.value} onClick={() => void redo()}>
          Redo
        </button>
        <span class="muted">
          {doubtful === 0 ? "No facet is doubtful" : `Doubtful: ${counted(doubtful, "facets")}`}
        </span>
      </div>
      <SelectedFacet facets={facets} />
      {(scene.value?.views.length ?? 0) > 0 && <EdgeTool />}
      <Done />
    </section>
  );
}

/** An edge is drawn by its two ends in one photograph. */
function EdgeTool() {
  return (
    <>
      <div class="row wrap">
        <button
          type="button"
          aria-pressed={isDrawingEdge.value}
          disabled={isBusy.value}
          onClick={() => drawEdge(!isDrawingEdge.value)}
        >
          Draw an edge in a photograph
        </button>
      </div>
      {isDrawingEdge.value && (
        <p role="status">
          {edgeStart.value === null
            ? "Click one end of the edge in a photograph. By keyboard: arrows move it below the cross in its middle, Enter takes that place, Escape ends the tool."
            : "Click the other end in the same photograph."}
        </p>
      )}
    </>
  );
}

/** The facet that is selected, in the model or among the facets. */
export function selectedFacet(): number | null {
  return facetOf(selection.value);
}

/** The camera turns to it, with the building about it. */
function goOn(): void {
  const facets = mainResults.value.facets ?? [];
  const index = nextDoubtful(facets, selectedFacet());
  select(index === null ? null : { kind: "facet", index });
  const building = facets[index ?? -1]?.building;
  if (building !== undefined) {
    aimAt(facets.flatMap((facet) => (facet.building === building ? facet.outer : [])));
  }
}

function onKeyDown(event: KeyboardEvent): void {
  const isTyped = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
  const isPlain = !event.ctrlKey && !event.metaKey && !event.altKey;
  if (!isTyped && isPlain && event.key.toLowerCase() === "n") {
    goOn();
  }
}

/** The second facet of a correction about two. */
function takeSecond(): void {
  const second = selectedFacet();
  const first = armed.value;
  const facets = mainResults.peek().facets ?? [];
  const [a, b] = [facets[first?.facet ?? -1], facets[second ?? -1]];
  if (first === null || a === undefined || b === undefined || second === first.facet) {
    return;
  }
  armed.value = null;
  const [facet, other] = [placeOf(a, origin()), placeOf(b, origin())];
  void correct(
    first.kind === "merge"
      ? { correction: "merge", facet, with: other }
      : { correction: "set_symmetric", facets: [facet, other] },
    facet.at,
  );
}

const origin = (): Vec3 => scene.peek()?.origin ?? [0, 0, 0];
const worldOf = (p: Vec3): Vec3 => add(p, origin());

/** A facet with these corners, local frame. */
function addFacet(ring: readonly Vec3[]): void {
  const outline = ring.map(worldOf);
  void correct({ correction: "add_facet", outline }, outline[0] ?? null);
}

/** Something to do, on its button; null where it cannot be done now. */
type Deed = readonly [title: string, act: () => void] | null;

function Deeds({ all }: { all: readonly Deed[] }) {
  return (
    <>
      {all
        .filter((one) => one !== null)
        .map(([title, act]) => (
          <button key={title} type="button" onClick={act}>
            {title}
          </button>
        ))}
    </>
  );
}

const worldEnds = ([p, q]: Ends): [Vec3, Vec3] => [worldOf(p), worldOf(q)];

function SelectedFacet({ facets }: { facets: readonly Facet[] }) {
  const index = selectedFacet();
  const facet = facets[index ?? -1];
  if (index === null || facet === undefined) {
    return (
      <>
        <p class="muted">Click a facet of the model to correct it.</p>
        <Uncovered />
        <Drawn facets={facets} index={null} />
      </>
    );
  }
  const place = placeOf(facet, origin());
  const act = (correction: Correction) => () => void correct(correction, place.at);
  const ridge = ridgeOf(facets, index);
  const arm = (kind: Armed["kind"]) => () => {
    armed.value = armed.value?.kind === kind ? null : { kind, facet: index };
  };
  const deeds: readonly Deed[] = [
    ["Confirm", act({ correction: "confirm", facet: place })],
    ["Delete facet", act({ correction: "delete_facet", facet: place })],
    ["Delete building", act({ correction: "delete_building", building: place.at })],
    ["Make level", act({ correction: "set_level", facet: place })],
    ridge && ["Add counterpart", act({ correction: "mirror", facet: place, over: worldEnds(ridge) })],
  ];
  return (
    <fieldset disabled={isBusy.value}>
      <legend>
        Facet {numberOf(index)}, probability {facet.probability.toFixed(2)}
      </legend>
      <div class="row wrap">
        <Deeds all={deeds} />
        <button
          type="button"
          aria-pressed={armed.value?.kind === "set_symmetric"}
          onClick={arm("set_symmetric")}
        >
          Symmetric with …
        </button>
        <button type="button" aria-pressed={armed.value?.kind === "merge"} onClick={arm("merge")}>
          Merge with …
        </button>
      </div>
      {armed.value !== null && (
        <p role="status">Click the other facet. The slope of this one stays where the two are merged.</p>
      )}
      <Obstructions facet={facet} />
      <Numbers facet={facet} place={place.at} />
      <Corners facet={facet} />
      <Parallel key={index} facet={facet} />
      <Drawn facets={facets} index={index} />
    </fieldset>
  );
}

/** What stands on the facet, each to be taken away. */
function Obstructions({ facet: { obstructions } }: { facet: Facet }) {
  const remove = (outline: readonly (readonly [number, number])[]) => () => {
    const middle = (axis: 0 | 1) => outline.reduce((sum, p) => sum + p[axis], 0) / outline.length;
    const at = worldOf([middle(0), middle(1), 0]);
    void correct({ correction: "delete_obstruction", at }, at);
  };
  return (
    obstructions.length > 0 && (
      <div class="row wrap">
        {obstructions.map((one, i) => (
          <button key={String(one.outline[0])} type="button" onClick={remove(one.outline)}>
            Delete obstruction {i + 1} ({obstructionText(one)})
          </button>
        ))}
      </div>
    )
  );
}

/** A place where a roof may be and the model has none becomes a facet. */
function Uncovered() {
  const roof = mainResults.value.uncovered?.[pickedIndex(selection.value, "uncoveredRoof")];
  if (roof === undefined) {
    return null;
  }
  return (
    <div class="row wrap">
      <button type="button" disabled={isBusy.value} onClick={() => addFacet(roof.outline)}>
        Add a facet here ({roof.area_m2.toFixed(0)} m²)
      </button>
    </div>
  );
}

/** Slope, ground and eave as numbers. */
function Numbers({ facet, place }: { facet: Facet; place: Vec3 }) {
  const slope = degreesOf(slopeOf(facet.plane.normal));
  const low = Math.min(...facet.outer.map(([, , z]) => z)) + origin()[2];
  return (
    <>
      <NumberField
        name="Slope"
        unit="°"
        value={slope.toFixed(1)}
        onTake={(slope_deg) =>
          correct({ correction: "set_slope", facet: placeOf(facet, origin()), slope_deg }, place)
        }
      />
      <NumberField
        name="Lowest eave"
        unit="m"
        value={low.toFixed(2)}
        onTake={(height) => correct({ correction: "set_eave", building: place, height }, place)}
      />
      <NumberField
        name="Ground"
        unit="m"
        value=""
        onTake={(height) => correct({ correction: "set_ground", building: place, height }, place)}
      />
    </>
  );
}

/** A corner, chosen and moved by its coordinates; in the 3D view it can be dragged. */
function Corners({ facet }: { facet: Facet }) {
  const [chosen, choose] = useState(0);
  const corner = facet.outer[chosen % facet.outer.length] as Vec3;
  const from = worldOf(corner);
  const move = (axis: number) => (metres: number) => {
    const to = from.map((x, i) => (i === axis ? metres : x)) as unknown as Vec3;
    return correct({ correction: "move_corner", from, to, sigma_m: BY_HAND_M }, placeOf(facet, origin()).at);
  };
  return (
    <>
      <div class="field">
        <label for="correct-corner">Corner</label>
        <select
          id="correct-corner"
          value={chosen % facet.outer.length}
          onChange={(event) => choose(Number(event.currentTarget.value))}
        >
          {facet.outer.map((_, i) => (
            <option key={i} value={i}>
              {i + 1}
            </option>
          ))}
        </select>
      </div>
      {["East", "North", "Height"].map((name, axis) => (
        <NumberField
          key={name}
          name={name}
          unit="m"
          value={(from[axis] as number).toFixed(2)}
          onTake={move(axis)}
        />
      ))}
      <p class="muted">Dots at corners and edges can be dragged: level, with Shift upright.</p>
    </>
  );
}

/** An edge of a facet is made parallel to another one of it, in plan and in slope. */
function Parallel({ facet }: { facet: Facet }) {
  const edges = edgesOf(facet.outer);
  const [chosen, choose] = useState<readonly number[]>(nearestParallel(facet.outer));
  const [turned, kept] = chosen.map((i) => i % edges.length) as [number, number];
  const make = () => {
    const [edge, to] = [worldEnds(edges[turned] as Ends), worldEnds(edges[kept] as Ends)];
    void correct({ correction: "set_parallel", edge, to }, placeOf(facet, origin()).at);
  };
  const choice = (which: number, name: string, value: number) => (
    <select
      aria-label={name}
      value={value}
      onChange={(event) => {
        const next = Number(event.currentTarget.value);
        choose(chosen.map((one, i) => (i === which ? next : one)));
      }}
    >
      {edges.map((_, i) => (
        <option key={i} value={i}>
          {i + 1}–{((i + 1) % edges.length) + 1}
        </option>
      ))}
    </select>
  );
  return (
    <div class="row wrap parallel">
      <span>Edge</span>
      {choice(0, "Edge that is turned", turned)}
      <span>along</span>
      {choice(1, "Edge that it follows", kept)}
      <button type="button" disabled={turned === kept} onClick={make}>
        Make parallel
      </button>
    </div>
  );
}

/** Standard deviation of what is put somewhere by hand, metres. */
export const BY_HAND_M = 0.02;

/** What can be made of the points that were drawn. */
function Drawn({ facets, index }: { facets: readonly Facet[]; index: number | null }) {
  const points = drawn.value;
  const facet = facets[index ?? -1];
  const edge = points.length === 2 ? (points as Ends) : null;
  const beside = edge === null || index === null ? null : nearestEdge(facets, index, edge);
  const add = (ring: readonly Vec3[]) => () => {
    forgetDrawn();
    addFacet(ring);
  };
  const divide = (own: Facet, along: Ends) => () => {
    const place = placeOf(own, origin());
    forgetDrawn();
    void correct({ correction: "split", facet: place, along: worldEnds(along) }, place.at);
  };
  const [a, b, c, d] = points;
  const corners = a && b && c && d && points.length === 4 ? ringOf([a, b], [c, d]) : points;
  const deeds: readonly Deed[] = [
    facet === undefined || edge === null ? null : ["Divide the facet here", divide(facet, edge)],
    edge && beside && ["Add a facet from here to the selected one", add(ringOf(edge, beside))],
    points.length < 3 ? null : ["Add facet", add(corners)],
  ];
  return (
    <div class="row wrap">
      {points.length === 0 && (
        <span class="muted">
          Draw (in the 3D view) marks the corners of a facet or of what stands on it, or an edge.
        </span>
      )}
      <Deeds all={deeds} />
      {facet !== undefined && points.length >= 3 && (
        <NumberField
          name="Something stands here, height above the facet"
          unit="m"
          value=""
          onTake={(height_m) => {
            forgetDrawn();
            const outline = corners.map(worldOf);
            return correct({ correction: "add_obstruction", outline, height_m }, outline[0] ?? null);
          }}
        />
      )}
      {points.length > 0 && (
        <button type="button" class="quiet" onClick={forgetDrawn}>
          Forget {counted(points.length, "points")}
        </button>
      )}
    </div>
  );
}

function NumberField({ name, unit, value, onTake }: NumberFieldProps) {
  const id = `correct-${name.toLowerCase().replaceAll(" ", "-")}`;
  return (
    <div class="field">
      <label for={id}>{name}</label>
      <TextField
        id={id}
        inputMode="decimal"
        value={value}
        parse={parseNumber}
        onValue={(next) => void onTake(next)}
      >
        <span class="unit muted">{unit}</span>
      </TextField>
    </div>
  );
}

interface NumberFieldProps {
  name: string;
  unit: string;
  value: string;
  onTake: (value: number) => Promise<void>;
}

/** The corrections so far, each with its state; saved, and opened again. */
function Done() {
  const outcomes: readonly (NotApplied | null)[] = mainResults.value.corrected?.outcomes ?? [];
  return (
    <>
      <ol class="done" aria-label="Corrections so far">
        {corrections.value.map((one, i) => {
          const why = outcomes[i] ?? null;
          return (
            <li key={`${i} ${one.correction}`}>
              <span>{correctionWords(one)}</span>
              {why !== null && <span class="error"> Not applied: {NOT_APPLIED_WORDS[why]}.</span>}
              <button
                type="button"
                class="quiet"
                disabled={isBusy.value}
                aria-label={`Remove correction ${i + 1}`}
                onClick={() => void remove(i)}
              >
                Remove
              </button>
            </li>
          );
        })}
      </ol>
      <div class="row wrap">
        <button
          type="button"
          disabled={corrections.value.length === 0}
          onClick={() => {
            const text = JSON.stringify(corrections.value, null, 2);
            saveFile("corrections.json", new Blob([text], { type: "application/json" }));
          }}
        >
          Save corrections
        </button>
        <label class="button">
          Open corrections
          <input
            type="file"
            accept=".json,application/json"
            class="visually-hidden"
            data-testid="corrections-file"
            disabled={isBusy.value}
            onChange={(event) => {
              const file = event.currentTarget.files?.[0];
              event.currentTarget.value = "";
              if (file !== undefined) {
                void openCorrections(file);
              }
            }}
          />
        </label>
      </div>
    </>
  );
}

/** Takes saved corrections in place of the present ones; the core says where one is none. */
async function openCorrections(file: File): Promise<void> {
  const list = parsed(await file.text());
  if (list === null) {
    notify({
      severity: "error",
      title: "These are no corrections",
      text: `${file.name} holds no list of corrections.`,
      advice: "Open a file that was saved here.",
    });
    return;
  }
  await change(list, `${file.name} opened`);
}

/** A list of things that name their correction; null for anything else. */
function parsed(text: string): readonly Correction[] | null {
  try {
    const value: unknown = JSON.parse(text);
    const names = (one: unknown) => typeof one === "object" && one !== null && "correction" in one;
    return Array.isArray(value) && value.every(names) ? (value as Correction[]) : null;
  } catch {
    return null;
  }
}
