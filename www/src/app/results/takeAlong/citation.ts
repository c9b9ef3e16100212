/** Whom to cite for a figure: the paper, and the section where it stands. */
import type { FigureText } from "../../view/figures/AboutFigure";

const PAPERS = {
  B99: (note: string) => `@inproceedings{Baillard1999,
  author    = {C. Baillard and C. Schmid and A. Zisserman and A. Fitzgibbon},
  title     = {Automatic Line Matching and {3D} Reconstruction of Buildings from Multiple Views},
  booktitle = {ISPRS Conference on Automatic Extraction of {GIS} Objects from Digital Imagery},
  series    = {IAPRS},
  volume    = {32, part 3-2W5},
  year      = {1999},
  note      = {${note}}
}`,
  W96: (note: string) => `@inproceedings{Wiman1996,
  author    = {H. Wiman and P. Axelsson},
  title     = {Finding {3D}-Structures in Multiple Aerial Images Using Lines and Regions},
  series    = {IAPRS},
  volume    = {31, part B3},
  year      = {1996},
  note      = {${note}}
}`,
} as const;

/** As BibTeX; sections and figures are the note, as are other works that the figure draws on. */
export function citationOf({ title, source }: Pick<FigureText, "title" | "source">): string {
  const parts = source.split(/; (?=B99|W96)/);
  const cited = parts.map((part) => {
    const paper = part.startsWith("W96") ? "W96" : "B99";
    return PAPERS[paper](`Section ${part.slice(paper.length + 1)}`);
  });
  return `% ${title}\n${cited.join("\n")}\n`;
}
