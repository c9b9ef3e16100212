/** A chart or a list beside the photographs in which the selection lights up. */
import "./figures.css";
import type { ComponentChildren } from "preact";
import type { Selection } from "../../../shared/selection";
import type { Figure } from "../../../stages/figure";
import { Filmstrip } from "../images/Filmstrip";

interface Props {
  figure: Figure;
  testid: string;
  /** What is lit while nothing is selected. */
  unpicked?: Selection | null;
  children: ComponentChildren;
}

export function SplitLab({ figure, testid, unpicked = null, children }: Props) {
  return (
    <div class="split-lab even">
      <div class="chart-lab" data-testid={testid}>
        {children}
      </div>
      <Filmstrip figure={figure} unpicked={unpicked} />
    </div>
  );
}
