/** Style sheets of the page inside an element: what they say of the page holds for the element, by its theme and its own type. */
import baseCss from "../app/parts/base.css?inline";
import hostCss from "./host.css?inline";

const DARK = /:root\[data-theme="?dark"?\]\s*\{([^}]*)\}/;

/** Inside a shadow tree the host is the root; a page's `rem` is not the element's. */
function forHost(css: string): string {
  const dark = DARK.exec(css)?.[1] ?? "";
  return css
    .replace(
      DARK,
      `:host([theme="dark"]) {${dark}}\n@media (prefers-color-scheme: dark) { :host(:not([theme="light"])) {${dark}} }`,
    )
    .replaceAll(":root", ":host")
    .replace(/([\d.])rem\b/g, "$1em");
}

/** Makes a sheet, with what every element has, when it is first asked for: one for all elements of a kind. */
export function hostSheet(...sheets: readonly string[]): () => CSSStyleSheet {
  let made: CSSStyleSheet | null = null;
  return () => {
    if (made === null) {
      made = new CSSStyleSheet();
      made.replaceSync([baseCss, hostCss, ...sheets].map(forHost).join("\n"));
    }
    return made;
  };
}
