/** The outcomes of tiles, kept in this browser (IndexedDB) one by one: a run goes on from them after a reload. */

import { storeOf } from "./database";

const request = storeOf("ridgeline-tiles", "outcomes");

/** Outcomes of one plan, those of its first looks by the numbers below 0; those of another one are forgotten when the first is kept. */
export class KeptTiles {
  readonly #plan: string;
  /** What could not be kept in the browser lasts as long as the page. */
  readonly #beside = new Map<number, Blob>();

  /** @param plan by what it is told from others: same text, same bytes */
  constructor(plan: string) {
    this.#plan = plan;
  }

  /** Which tiles are there. */
  async tiles(): Promise<Set<number>> {
    try {
      const keys = await request<IDBValidKey[]>("readonly", (store) => store.getAllKeys());
      return tilesOf(keys.flatMap((key) => this.#tileOf(key) ?? []));
    } catch {
      return tilesOf([...this.#beside.keys()]);
    }
  }

  async read(tile: number): Promise<Uint8Array<ArrayBuffer> | null> {
    const beside = this.#beside.get(tile);
    try {
      const kept = beside ?? (await request<Blob | undefined>("readonly", (s) => s.get(this.#key(tile))));
      return kept === undefined ? null : new Uint8Array(await kept.arrayBuffer());
    } catch {
      return null;
    }
  }

  async keep(tile: number, outcome: Uint8Array<ArrayBuffer>): Promise<void> {
    // A blob is stored as a file, and not held in memory.
    const blob = new Blob([outcome]);
    try {
      await this.#forgetOthers();
      await request("readwrite", (store) => store.put(blob, this.#key(tile)));
    } catch {
      // Private windows and full disks.
      this.#beside.set(tile, blob);
    }
  }

  async forget(tile: number): Promise<void> {
    this.#beside.delete(tile);
    await request("readwrite", (store) => store.delete(this.#key(tile))).catch(() => undefined);
  }

  async #forgetOthers(): Promise<void> {
    const keys = await request<IDBValidKey[]>("readonly", (store) => store.getAllKeys());
    for (const key of keys.filter((one) => this.#tileOf(one) === null)) {
      await request("readwrite", (store) => store.delete(key));
    }
  }

  #key(tile: number): IDBValidKey {
    return [this.#plan, tile];
  }

  #tileOf(key: IDBValidKey): number | null {
    const [plan, tile] = Array.isArray(key) ? key : [];
    return plan === this.#plan && typeof tile === "number" ? tile : null;
  }
}

function tilesOf(numbers: readonly number[]): Set<number> {
  return new Set(numbers.filter((number) => number >= 0));
}

export async function forgetKeptTiles(): Promise<void> {
  await request("readwrite", (store) => store.clear()).catch(() => undefined);
}
