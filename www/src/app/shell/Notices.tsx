/** What went wrong or needs attention, in words, until it is dismissed. */

import "./notices.css";
import { OrientationCheck } from "../project/OrientationCheck";
import { Remedies } from "../project/Remedies";
import { dismiss, notices } from "../state/notices";

export function Notices() {
  return (
    <div class="notices">
      {notices.value.map(({ id, severity, title, text, advice, orientationCheck, asked, action }) => (
        <section key={id} class={`notice ${severity}`} role={severity === "error" ? "alert" : "status"}>
          <div>
            <strong>{title}</strong>
            {text !== "" && <p>{text}</p>}
            {advice !== undefined && <p class="muted">{advice}</p>}
            {orientationCheck !== undefined && <OrientationCheck report={orientationCheck} />}
            {asked !== undefined && <Remedies asked={asked} />}
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
