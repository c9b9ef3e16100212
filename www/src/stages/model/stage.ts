import type { GroundTexture } from "../../shared/calls";
import type { UncoveredRoof } from "../../shared/records";
import type { Stage } from "../stage";

type Glb = Uint8Array<ArrayBuffer>;

export const model = {
  about: "facet",
  nothing: {
    glb: null as Glb | null,
    /** The models of the tiles that are done, as long as they are not joined. */
    tileGlbs: [] as readonly Glb[],
    ground: null as GroundTexture | null,
    /** Where a roof may be and the model has none. */
    uncovered: null as readonly UncoveredRoof[] | null,
  },
  fetch: async (from) => ({
    glb: await from.call("exportFile", "model.glb"),
    ground: await from.call("ground"),
    uncovered: await from.call("uncovered"),
  }),
  sections: { texture: "Texture" },
  mainCount: "textured faces",
} satisfies Stage;
