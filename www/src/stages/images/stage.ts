/** The photographs, before any stage. */
import type { Stage } from "../stage";

export const images = { about: "view" } satisfies Stage;
