/** The photographs, before any stage. */
import type { Stage } from "../stage";

export const images = { isCorrected: true } satisfies Stage;
