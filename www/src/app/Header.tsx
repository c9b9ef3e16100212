/** The name, what the page does, and the theme. */
import { activity } from "./state";
import { theme, toggleTheme } from "./theme";

export function Header() {
  const other = theme.value === "dark" ? "light" : "dark";
  return (
    <header class="header">
      <img src="./icon.svg" alt="" width="22" height="22" />
      <h1>ridgeline</h1>
      <p class="muted">Aerial photographs in, textured roof models out. Nothing leaves this computer.</p>
      {activity.value !== "" && (
        <span class="activity">
          <span class="spinner" aria-hidden="true" />
          {activity}
        </span>
      )}
      <button type="button" class="quiet" onClick={toggleTheme}>
        {other === "dark" ? "Dark" : "Light"}
      </button>
    </header>
  );
}
