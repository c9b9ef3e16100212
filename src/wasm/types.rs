//! TypeScript's names for what other crates declare, and for the ids. All other types of what
//! crosses to the page are derived where they are declared (`tsify`), and stand with them in the
//! package's `.d.ts`.

use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES_OF_OTHER_CRATES: &str = r#"
/** Image positions are in pixels: x right, y down, the centre of the top-left pixel is (0.5, 0.5). */
export type Point2<T> = readonly [x: T, y: T];
export type Vector2<T> = readonly [x: T, y: T];
/** Metres in the local frame: the map frame of the input minus `SceneInfo.origin`, Z up. */
export type Point3<T> = readonly [x: T, y: T, z: T];
export type Vector3<T> = readonly [x: T, y: T, z: T];

export type Vec2 = Point2<number>;
export type Vec3 = Point3<number>;

/** Index into the views of the scene. */
export type ViewId = number;
/** Index into the segments of a view. */
export type SegmentId = number;
/** Index into the 3D lines. */
export type LineId = number;
/** Index into the half-planes. */
export type HalfPlaneId = number;
/** Index into the facets. */
export type FacetId = number;
/** Index into the buildings. */
export type BuildingId = number;
"#;
