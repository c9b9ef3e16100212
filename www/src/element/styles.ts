/** The page's style sheets inside an element: what they say of the page holds for the element, by its theme and its own type. */

import figuresCss from "../app/figures/figures.css?inline";
import imagesCss from "../app/images/images.css?inline";
import baseCss from "../app/parts/base.css?inline";
import chartsCss from "../app/parts/charts.css?inline";
import partsCss from "../app/parts/parts.css?inline";
import takeAlongCss from "../app/takeAlong/takeAlong.css?inline";
import elementCss from "./element.css?inline";

const DARK = /:root\[data-theme="?dark"?\]\s*\{([^}]*)\}/;

/** Inside a shadow tree the host is the root; a page's `rem` is not the figure's. */
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

let made: CSSStyleSheet | null = null;

/** One for all figures of a page. */
export function styleSheet(): CSSStyleSheet {
  if (made === null) {
    made = new CSSStyleSheet();
    const all = [baseCss, partsCss, chartsCss, imagesCss, figuresCss, takeAlongCss, elementCss];
    made.replaceSync(all.map(forHost).join("\n"));
  }
  return made;
}
