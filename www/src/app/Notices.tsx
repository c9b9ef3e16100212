/** What went wrong or needs attention, in words, until it is dismissed. */
import { dismiss, setRunOptions } from "./actions";
import type { Fix } from "./notices";
import { notices } from "./state";

export function Notices() {
  return (
    <div class="notices">
      {notices.value.map(({ id, severity, title, text, advice, fix, action }) => (
        <section key={id} class={`notice ${severity}`} role={severity === "error" ? "alert" : "status"}>
          <div>
            <strong>{title}</strong>
            {text !== "" && <p>{text}</p>}
            {advice !== undefined && <p class="muted">{advice}</p>}
            {fix !== undefined && <Diagnosis fix={fix} />}
            {action !== undefined && (
              <button type="button" onClick={action.run}>
                {action.name}
              </button>
            )}
          </div>
          <button type="button" class="quiet" aria-label={`Dismiss: ${title}`} onClick={() => dismiss(id)}>
            ✕
          </button>
        </section>
      ))}
    </div>
  );
}

/** How well images and orientation agree, as stated and without the mistake; and the cure. */
function Diagnosis({ fix: { before, after } }: { fix: Fix }) {
  return (
    <div class="diagnosis" data-testid="diagnosis">
      <dl class="facts">
        {(
          [
            ["Agreement as stated", before],
            ["Without the mistake", after],
          ] as const
        ).map(([name, score]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd class="numbers">
              <meter min={0} max={1} value={score} aria-label={name} /> {score.toFixed(2)}
            </dd>
          </div>
        ))}
      </dl>
      <button type="button" class="primary" onClick={() => void setRunOptions({ applyFix: true })}>
        Apply the fix
      </button>
    </div>
  );
}
