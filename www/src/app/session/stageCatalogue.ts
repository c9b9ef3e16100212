/** The stages as the page names them, and what depends on which parameter: all from the core's own table. */
import { type Method, STAGES, type StageName } from "../../shared/stages";

interface StageWords {
  title: string;
  section: string;
}

type Stage = (typeof STAGES)[number];
const BY_NAME = new Map<string, Stage>(STAGES.map((stage) => [stage.name, stage]));

/** The stages of a method, in their order. */
export function stagesOf(method: Method): StageName[] {
  const has = ({ methods }: Stage) => (methods as readonly Method[]).includes(method);
  return STAGES.filter(has).map(({ name }) => name);
}

/** The words for a stage. */
export function stageWords(name: StageName): StageWords {
  return BY_NAME.get(name) as Stage;
}

/** The first stage that a change of the parameter at `path` makes outdated; one that none reads outdates everything. */
export function firstStageOf(path: string, stageNames: readonly StageName[]): number {
  const isRead = ({ reads }: Stage) => reads.some((read) => isWithin(path, read) || isWithin(read, path));
  const readers = new Set<string>(STAGES.filter(isRead).map(({ name }) => name));
  if (readers.size === 0) {
    return 0;
  }
  const first = stageNames.findIndex((name) => readers.has(name));
  // Stages of the other method: nothing here depends on them.
  return first < 0 ? stageNames.length : first;
}

/** Is a parameter, or a group of them, the group at `path` or a part of it? */
function isWithin(parameter: string, path: string): boolean {
  return `${parameter}.`.startsWith(`${path}.`);
}
