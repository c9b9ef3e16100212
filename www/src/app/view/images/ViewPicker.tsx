/** Which view is shown. */
import type { ViewInfo } from "../../../shared/records";
import { ALL_VIEWS } from "../../../stages/figure";
import { Choice } from "../../parts/Choice";

interface Props {
  views: readonly Pick<ViewInfo, "name">[];
  shown: number;
  /** Whether all of them can be shown at once. */
  withAll: boolean;
  show: (view: number) => void;
}

/** One button a view, and before them one for all, unless there is no room for them. */
export function ViewPicker({ views, shown, withAll, show }: Props) {
  const own = views.map(({ name }, view) => [view, name] as const);
  return (
    <Choice
      legend="View"
      choices={withAll ? [[ALL_VIEWS, "All"], ...own] : own}
      chosen={withAll ? shown : Math.max(0, shown)}
      choose={show}
    />
  );
}
