/** How the page looks: the size of its text, and light or dark. */
import { biggerText, textScale } from "../state/textScale";
import { theme, toggleTheme } from "../state/theme";

export function LookButtons() {
  return (
    <>
      <button
        type="button"
        class="quiet"
        aria-label={`Text size: ${Math.round(100 * textScale.value)} %, next`}
        title="Text size"
        onClick={biggerText}
      >
        Aa
      </button>
      <button type="button" class="quiet" onClick={toggleTheme}>
        {theme.value === "dark" ? "Light" : "Dark"}
      </button>
    </>
  );
}
