/** The head of both pages, and where else to go. */
import type { ComponentChildren } from "preact";
import { theme, toggleTheme } from "../../app/state/theme";

interface Props {
  title: string;
  /** Address and words of the other page. */
  other: readonly [href: string, words: string];
  children: ComponentChildren;
}

export function PageFrame({ title, other: [href, words], children }: Props) {
  return (
    <div class="exercises">
      <header class="head row">
        <img src="./icon.svg" alt="" width="22" height="22" />
        <h1>{title}</h1>
        <nav class="row" aria-label="Pages">
          <a href="./">ridgeline</a>
          <a href={href}>{words}</a>
          <button type="button" class="quiet" onClick={toggleTheme}>
            {theme.value === "dark" ? "Light" : "Dark"}
          </button>
        </nav>
      </header>
      {children}
    </div>
  );
}
