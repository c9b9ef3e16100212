/** How far a run over tiles is: in photographs, tiles and minutes. */
import "./flight.css";
import { counted } from "../../parts/counted";
import { minutesText } from "../../parts/numberText";
import { doneTiles, flightPlan, photographsRead, tileRun, usedTiles } from "../tiles/flight";

export function FlightProgress() {
  const run = tileRun.value;
  const plan = flightPlan.value;
  if (run === null || plan === null) {
    return null;
  }
  const used = usedTiles.value.length;
  const done = usedTiles.value.filter((tile) => doneTiles.value.has(tile)).length;
  const { done: read, all } = photographsRead.value;
  const isJoining = done === used;
  const share = used === 0 ? 0 : Math.min(1, (done + (isJoining ? 0 : run.fraction)) / used);
  return (
    <div class="flight-progress" data-testid="flight-progress">
      <progress max={1} value={share} aria-label="Tiles that are done" />
      <p class="numbers">
        <b>
          {done} of {counted(used, "tiles")}
        </b>
        {run.tile === null ? (
          <span>looking for places where a roof may be</span>
        ) : (
          <>
            <span>
              {read} of {counted(all, "photographs")} read
            </span>
            <span>{isJoining ? "joining the tiles" : `${minutesText(run.secondsLeft)} left`}</span>
          </>
        )}
      </p>
    </div>
  );
}
