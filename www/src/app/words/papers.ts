/** Where a paper is first met it has its authors, and the letters by which it is named from then on. */
export function spelledOut(source: string): string {
  return source
    .replace("B99", "Baillard et al. 1999 (B99),")
    .replace("W96", "Wiman and Axelsson 1996 (W96),")
    .replace(/,(?= and | \(|$)/g, "");
}
