/** What speaks for a thing, to the right of a middle line, and against it, to the left. */

import type { Bar } from "../../kinds/parts/rows";
import { signed } from "../parts/numberText";

/** The longest bar has at least this length, nats: what says little looks little. */
const LEAST_SCALE = 2;

export function EvidenceBars({ bars }: { bars: readonly Bar[] }) {
  const longest = Math.max(LEAST_SCALE, ...bars.map(({ nats }) => Math.abs(nats)));
  return (
    <ul class="evidence">
      {bars.map(({ name, nats }) => (
        <li key={name}>
          <span>{name}</span>
          <span class="nats">{signed(nats)}</span>
          <span class="track" aria-hidden="true">
            <span
              class={`bar ${nats < 0 ? "against" : "for"}`}
              style={{ width: `${((50 * Math.abs(nats)) / longest).toFixed(1)}%` }}
            />
          </span>
        </li>
      ))}
    </ul>
  );
}
