/** Which orientation, which part of the ground, how high it lies. */
import { signal } from "@preact/signals";
import type { OrientationCandidate } from "../../shared/records";
import { type Parsed, TextField } from "../parts/TextField";
import { setParam } from "../session/stageRuns";
import { parseEpsg, parseHeight, parseRegion, parseTile } from "../settings/loadOptions";
import { SYSTEMS, systemWords } from "../settings/referenceSystems";
import { method, params } from "../state/parameters";
import { inspection, type RunOptions, runOptions } from "../state/project";
import { scene } from "../state/scene";
import { setRunOptions } from "./projectActions";

/** Where the files hold the orientation several times: which one is taken. */
export function OrientationChoice() {
  const found = inspection.value?.orientations ?? [];
  if (found.length < 2) {
    return null;
  }
  return (
    <div class="option">
      <label for="orientation">Orientation</label>
      <select
        id="orientation"
        value={chosen(found, runOptions.value.orientation)}
        onChange={(event) => void setRunOptions({ orientation: event.currentTarget.value })}
      >
        {found.map(({ label, path }) => (
          <option key={path} value={path}>
            {label}
          </option>
        ))}
      </select>
    </div>
  );
}

/** The path of the one that is taken: a file of several is taken by its first. */
function chosen(found: readonly OrientationCandidate[], wanted: string | null): string | undefined {
  const paths = found.map(({ path }) => path);
  if (wanted === null || paths.includes(wanted)) {
    return wanted ?? paths[0];
  }
  return paths.find((path) => path.startsWith(`${wanted}: `)) ?? wanted;
}

/** Whether the fields were open last; views that are read again draw them anew. */
const placeOpen = signal(false);

/** Region of interest and height of the ground, both in the frame of the orientation. */
export function PlaceFields() {
  const { roi, groundZ, epsg } = runOptions.value;
  return (
    <details
      class="params"
      open={placeOpen.value || roi !== null || groundZ !== null || epsg !== null || !isAdjusted()}
      onToggle={(event) => {
        placeOpen.value = event.currentTarget.open;
      }}
    >
      <summary>Region, ground, reference system</summary>
      <OptionField
        id="roi"
        label="Region x0, y0, x1, y1 (m)"
        placeholder="all"
        of="roi"
        parse={parseRegion}
      />
      <OptionField
        id="ground-z"
        label="Height of the ground (m)"
        placeholder="estimated"
        of="groundZ"
        parse={parseHeight}
      />
      <OptionField
        id="epsg"
        label="Reference system: EPSG code, or name"
        placeholder="as the files say"
        of="epsg"
        parse={parseEpsg}
        hint={systemWords(epsg, scene.value?.origin)}
        choices={SYSTEMS.map(({ code, name }) => [String(code), name])}
      />
      <OptionField id="tile" label="Tile size (m)" placeholder="no tiles" of="tileM" parse={parseTile} />
      {method.value !== "rectangles" && (
        <label class="option-check">
          <input type="checkbox" checked={isAdjusted()} onChange={() => setParam(ADJUSTED, !isAdjusted())} />
          Adjust small errors of single views
        </label>
      )}
    </details>
  );
}

/** Whether single views are adjusted: a parameter of the run. */
const ADJUSTED = "adjustment.enabled";

function isAdjusted(): boolean {
  return params.value["adjustment"]?.["enabled"] !== false;
}

interface FieldProps<K extends keyof RunOptions> {
  id: string;
  label: string;
  placeholder: string;
  of: K;
  parse: (text: string) => Parsed<RunOptions[K]>;
  hint?: string;
  choices?: readonly (readonly [string, string])[];
}

function OptionField<K extends keyof RunOptions>({ label, of, ...field }: FieldProps<K>) {
  const value = runOptions.value[of];
  return (
    <div class="option">
      <label for={field.id}>{label}</label>
      <TextField
        {...field}
        value={Array.isArray(value) ? value.join(", ") : String(value ?? "")}
        onValue={(next) =>
          void setRunOptions({ [of]: next, ...(of === "tileM" && { isAtOnce: next === null }) })
        }
      />
    </div>
  );
}
