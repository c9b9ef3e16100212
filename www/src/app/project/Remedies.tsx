/** Buttons for what a message of the core asks for by an option of the command line. */
import { counted } from "../parts/counted";
import type { Asked } from "../state/notices";
import { runOptions } from "../state/project";
import { setRunOptions } from "./projectActions";

interface Remedy {
  name: string;
  run: () => void;
}

/** By the option; `files` are those that the message is about. */
export const REMEDIES: Readonly<Record<string, (files: readonly string[]) => Remedy | null>> = {
  "apply-fix": () => ({
    name: "Apply the fix",
    run: () => void setRunOptions({ applyFix: true, ignoreCheck: false }),
  }),
  "ignore-check": () => ({
    name: "Go on nevertheless",
    run: () => void setRunOptions({ applyFix: false, ignoreCheck: true }),
  }),
  without: (files) => {
    const leftOut = [...new Set([...runOptions.value.leftOut, ...files])];
    const [first] = files;
    const what = files.length === 1 ? first : counted(files.length, "files");
    return first === undefined
      ? null
      : { name: `Leave out ${what}`, run: () => void setRunOptions({ leftOut }) };
  },
  reduce: () => ({ name: "Use them in full", run: () => void setRunOptions({ reduction: 1 }) }),
  tile: () => ({
    name: "Work without tiles",
    run: () => void setRunOptions({ tileM: null, isAtOnce: true }),
  }),
  crs: () => ({ name: "State the system", run: () => openField("epsg") }),
  roi: () => ({ name: "Give a region", run: () => openField("roi") }),
  orientation: () => ({ name: "Choose the orientation", run: () => openField("orientation") }),
};

export function Remedies({ asked: { options, files } }: { asked: Asked }) {
  const known = options.flatMap((option) => REMEDIES[option]?.(files) ?? []);
  return (
    <>
      {known.map(({ name, run }) => (
        <button key={name} type="button" onClick={run}>
          {name}
        </button>
      ))}
    </>
  );
}

/** Shows a field of the project, wherever it is folded away. */
function openField(id: string): void {
  const field = document.getElementById(id);
  const folded = field?.closest("details");
  if (folded) {
    folded.open = true;
  }
  field?.scrollIntoView({ block: "center" });
  field?.focus();
}
