/** Which of several planes, or buildings, a figure shows. */

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
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">Plane</legend>
      {names.map((name, i) => (
        <button key={name} type="button" aria-pressed={shown === i} onClick={() => onShow(i)}>
          {name}
        </button>
      ))}
    </fieldset>
  );
}
