/** How far ground control points are from where the block puts them. */
import type { ControlResidual } from "../../../../shared/orientation";
import { rms, roleText } from "./residuals";

export function ControlPoints({ control }: { control: readonly ControlResidual[] }) {
  if (control.length === 0) {
    return null;
  }
  const checks = control.filter(({ role }) => role?.is_check);
  const [plan, height] = rms(checks);
  return (
    <section data-testid="control-points" aria-label="Ground control points">
      <h3>Ground control points</h3>
      <p class="muted">
        Distances of the block from the stated coordinates; σ is that of one coordinate. A point that
        disagrees with the others is left out of the frame. A check point is never in it.
      </p>
      {checks.length > 0 && (
        <p>
          Check points: {checks.length}, rms {plan?.toFixed(3) ?? "–"} m in plan, {height?.toFixed(3) ?? "–"}{" "}
          m in height.
        </p>
      )}
      <div class="facts-table">
        <table>
          <thead>
            <tr>
              <th scope="col">Point</th>
              <th scope="col">For</th>
              <th scope="col">Marks that agree</th>
              <th scope="col">x [m]</th>
              <th scope="col">y [m]</th>
              <th scope="col">z [m]</th>
              <th scope="col">σ [m]</th>
              <th scope="col">In the frame</th>
            </tr>
          </thead>
          <tbody class="numbers">
            {control.map((point) => (
              <ControlPoint key={point.name} point={point} />
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function ControlPoint({ point }: { point: ControlResidual }) {
  const { name, role, marks, residual_m: residual, sigma_m: sigma, agrees } = point;
  const used = agrees ? "yes" : "no, it disagrees";
  const checked = agrees ? "no, it checks and agrees" : "no, it checks and disagrees";
  const inFrame = residual === null ? "not seen by two rays" : role?.is_check ? checked : used;
  return (
    <tr class={agrees ? undefined : "disagreeing"}>
      <th scope="row">{name}</th>
      <td>{roleText(role)}</td>
      <td>
        {marks[1]} of {marks[0]}
      </td>
      {[0, 1, 2].map((axis) => (
        <td key={axis}>{residual?.[axis]?.toFixed(3) ?? "–"}</td>
      ))}
      <td>{sigma?.toFixed(3) ?? "–"}</td>
      <td>{inFrame}</td>
    </tr>
  );
}
