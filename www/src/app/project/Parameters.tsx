/** The parameters of every stage, from the core's own defaults; what differs from them is marked. */
import "./project.css";
import type { ParamValue } from "../../shared/paramTree";
import { TextField } from "../parts/TextField";
import { dragParam, dropParam } from "../session/draggedParam";
import { resetParams, setParam } from "../session/stageRuns";
import {
  fieldText,
  type ParamField,
  type ParamSection,
  paramName,
  paramSections,
  parseField,
  WANTED,
  wantedFields,
} from "../settings/parameterForm";
import { defaults, params } from "../state/parameters";

export function Parameters() {
  const sections = paramSections(defaults.value, params.value);
  const changed = sections.reduce((sum, section) => sum + section.changed, 0);
  return (
    <section class="panel">
      <details class="parameters" open={changed > 0}>
        <summary>
          <h2>Parameters</h2>
          {changed > 0 && <span class="changed-mark">{changed} changed</span>}
        </summary>
        <p class="muted">
          Where a paper states a value, the default follows it unless another one proved better. A change
          makes its stage and all later ones outdated; a slider runs them again. Values that were run before
          in this visit show their result at once.
        </p>
        {changed > 0 && (
          <button type="button" onClick={resetParams}>
            Reset {changed}
          </button>
        )}
        <h3>Changed most often</h3>
        {wantedFields(sections).map(({ section, field }) => (
          <Field key={`${section.path}.${field.key}`} path={section.path} field={field} place="wanted" />
        ))}
        <h3>All, by stage</h3>
        {sections.map((section) => (
          <Section key={section.path} section={section} />
        ))}
      </details>
    </section>
  );
}

function Section({ section }: { section: ParamSection }) {
  return (
    <details class="params" open={section.changed > 0}>
      <summary>
        {section.title}
        {section.changed > 0 && <span class="changed-mark">{section.changed} changed</span>}
      </summary>
      {section.fields.map((field) => (
        <Field key={field.key} path={section.path} field={field} place="param" />
      ))}
    </details>
  );
}

function Field({ path, field, place }: { path: string; field: ParamField; place: "wanted" | "param" }) {
  const id = `${place}-${path.replaceAll(".", "-")}-${field.key}`;
  const parse = (text: string) => parseField(field, text);
  const take = (value: ParamValue) => setParam(`${path}.${field.key}`, value);
  const hint = field.changed ? `default ${fieldText(field.fallback)}` : "";
  const unit = <span class="unit muted">{field.unit}</span>;
  return (
    <div class={`field ${field.changed ? "changed" : ""}`}>
      <label for={id} title={`${path}.${field.key}`}>
        {place === "wanted" ? paramName(`${path}.${field.key}`, false) : field.label}
      </label>
      {field.kind === "boolean" ? (
        <input
          id={id}
          type="checkbox"
          checked={field.value === true}
          aria-describedby={`${id}-note`}
          onChange={(event) => take(event.currentTarget.checked)}
        />
      ) : field.kind === "choice" ? (
        <select
          id={id}
          value={fieldText(field.value)}
          aria-describedby={`${id}-note`}
          onChange={(event) => take(event.currentTarget.value)}
        >
          {field.choices.map((choice) => (
            <option key={choice}>{choice}</option>
          ))}
        </select>
      ) : (
        <TextField
          id={id}
          inputMode={field.kind === "number" ? "decimal" : "text"}
          value={fieldText(field.value)}
          parse={parse}
          onValue={take}
          hint={hint}
        >
          {unit}
          {place === "wanted" && field.kind === "number" && (
            <Slider path={`${path}.${field.key}`} field={field} />
          )}
        </TextField>
      )}
      {(field.kind === "boolean" || field.kind === "choice") && (
        <>
          {unit}
          <span id={`${id}-note`} class="muted note">
            {hint}
          </span>
        </>
      )}
    </div>
  );
}

/** A number that is dragged: its stage runs again meanwhile, and the later ones when it is let go. */
function Slider({ path, field }: { path: string; field: ParamField }) {
  const range = WANTED[path];
  if (range === null || range === undefined) {
    return null;
  }
  const [low, high, step] = range;
  return (
    <input
      type="range"
      aria-label={`${paramName(path)}, dragged`}
      min={low}
      max={high}
      step={step}
      value={Number(field.value)}
      onInput={(event) => dragParam(path, Number(event.currentTarget.value))}
      onChange={() => void dropParam(path)}
    />
  );
}
