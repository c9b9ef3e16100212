/** What colours mean. */
export type LegendEntry = readonly [colour: string, meaning: string];

export function Legend({ entries }: { entries: readonly LegendEntry[] }) {
  if (entries.length === 0) {
    return null;
  }
  return (
    <ul class="legend" aria-label="Colours">
      {entries.map(([colour, meaning]) => (
        <li key={meaning}>
          <span class={`swatch ${colour}`} aria-hidden="true" />
          {meaning}
        </li>
      ))}
    </ul>
  );
}
