/** Which view is shown. */
import type { ViewInfo } from "../../shared/records";

/** All views side by side. */
export const ALL_VIEWS = -1;

interface Props {
  views: readonly Pick<ViewInfo, "name">[];
  shown: number;
  /** Whether all of them can be shown at once. */
  withAll: boolean;
  show: (view: number) => void;
}

/** One button a view, and before them one for all, unless there is no room for them. */
export function ViewPicker({ views, shown, withAll, show }: Props) {
  const pressed = withAll ? shown : Math.max(0, shown);
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">View</legend>
      {withAll && (
        <button type="button" aria-pressed={pressed === ALL_VIEWS} onClick={() => show(ALL_VIEWS)}>
          All
        </button>
      )}
      {views.map(({ name }, view) => (
        <button key={name} type="button" aria-pressed={pressed === view} onClick={() => show(view)}>
          {name}
        </button>
      ))}
    </fieldset>
  );
}
