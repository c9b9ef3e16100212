/** What figures look like: as on the page. */
import chartsCss from "../app/parts/charts.css?inline";
import partsCss from "../app/parts/parts.css?inline";
import takeAlongCss from "../app/results/takeAlong/takeAlong.css?inline";
import figuresCss from "../app/view/figures/figures.css?inline";
import imagesCss from "../app/view/images/images.css?inline";
import glossaryCss from "../app/words/glossary.css?inline";
import elementCss from "./element.css?inline";
import { hostSheet } from "./hostSheet";

export const styleSheet = hostSheet(
  partsCss,
  chartsCss,
  imagesCss,
  figuresCss,
  glossaryCss,
  takeAlongCss,
  elementCss,
);
