/** How many workers are of use. */

/** As many workers as there are cores, less one for the page where there are more than two; fewer for large scenes. */
export function automaticWorkers(cores: number, pixels: number): number {
  const byCores = Math.min(cores <= 2 ? cores : cores - 1, MOST_WORKERS);
  const byMemory = Math.floor(MEMORY_BYTES / (pixels * BYTES_PER_PIXEL));
  return Math.max(1, Math.min(byCores, byMemory));
}

/** More are waiting for each other more than working. */
const MOST_WORKERS = 8;
/** What all workers together may hold of the views. */
const MEMORY_BYTES = 2e9;
/** Grey values, colours, and the maps of a stage at work: measured, 22 to 43 (docs/results/page.md). */
const BYTES_PER_PIXEL = 45;
