/** What went wrong or needs attention, in words, until it is dismissed. */
import { dismiss } from "./actions";
import { notices } from "./state";

export function Notices() {
  return (
    <div class="notices">
      {notices.value.map(({ id, severity, title, text, advice }) => (
        <section key={id} class={`notice ${severity}`} role={severity === "error" ? "alert" : "status"}>
          <div>
            <strong>{title}</strong>
            <p>{text}</p>
            {advice !== undefined && <p class="muted">{advice}</p>}
          </div>
          <button type="button" class="quiet" aria-label={`Dismiss: ${title}`} onClick={() => dismiss(id)}>
            ✕
          </button>
        </section>
      ))}
    </div>
  );
}
