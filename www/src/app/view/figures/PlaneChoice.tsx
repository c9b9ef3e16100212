/** Which of several planes, or buildings, a figure shows. */
import { Choice } from "../../parts/Choice";

export function PlaneChoice({
  names,
  shown,
  onShow,
}: {
  names: readonly string[];
  shown: number;
  onShow: (i: number) => void;
}) {
  if (names.length > 7) {
    return (
      <label class="pair-choice">
        Plane
        <select value={shown} onChange={(event) => onShow(Number(event.currentTarget.value))}>
          {names.map((name, i) => (
            <option key={name} value={i}>
              {name}
            </option>
          ))}
        </select>
      </label>
    );
  }
  return <Choice legend="Plane" choices={names.map((name, i) => [i, name])} chosen={shown} choose={onShow} />;
}
