/** Answers one request with the core's Session: parse, call, convert. No geometry, no state but the session. */
import {
  type Args,
  type Bytes,
  type CallName,
  type InputFile,
  QUERY_NAMES,
  type Queries,
  type QueryName,
  type Request,
  type Result,
  type Shard,
} from "../shared/messages";
import type {
  Facet,
  HalfPlane,
  Inspection,
  LoadOptions,
  OpenedProject,
  Params,
  Region,
  SceneInfo,
  StageSummary,
  TileReport,
  ViewImage,
} from "../shared/results";
import type { WarpedPicture } from "../shared/traces";

/** The session's methods that answer questions. */
type Answers = { [K in QueryName]: (...args: Queries[K]["args"]) => Queries[K]["result"] | undefined };

/** The part of the wasm class that the page uses. */
export interface CoreSession extends Answers {
  addFile(path: string, bytes: Uint8Array): void;
  clearFiles(): void;
  inspect(options: LoadOptions): Inspection;
  load(options: LoadOptions): SceneInfo;
  setParams(params: Params): void;
  runStage(name: string, onProgress: (fraction: number) => void): StageSummary;
  segments(view: number): Float32Array;
  matchedSegments(view: number): Float32Array;
  lines(): Float64Array;
  halfPlanes(): HalfPlane[];
  facets(): Facet[];
  image(view: number): ViewImage;
  sharedMaps(stage: string): string[];
  sharesColours(stage: string): boolean;
  packView(view: number, withColours: boolean): Bytes;
  takeView(view: number, of: number, packed: Bytes): void;
  handOver(stage: string): Bytes;
  takeOver(stage: string, found: Bytes): void;
  share(stage: string, map: string, index: number, of: number, onProgress: (fraction: number) => void): Bytes;
  learn(map: string, shards: Bytes[]): void;
  exportFile(name: string): Bytes;
  exportNames(): string[];
  planTiles(options: LoadOptions, tileM: number): Region[];
  runTile(onProgress: (fraction: number) => void): TileReport | null | undefined;
  joinTiles(): void;
  exportProject(options: LoadOptions): Bytes;
  openedProject(): OpenedProject | null | undefined;
}

/** The wasm module once compiled: its class and what hangs on the class itself. */
export interface Core {
  session: CoreSession;
  stages: string[];
  defaults: Params;
}

export interface Answer {
  result: Result<CallName>;
  transfer: Transferable[];
}

/** Progress is a message at most every so often: the page cannot draw more. */
const PROGRESS_INTERVAL_MS = 40;

type OnProgress = (stage: string, fraction: number) => void;

/** Answers every request but `open`, which makes the core. */
export async function dispatch(
  core: Core,
  request: Exclude<Request, { type: "open" }>,
  onProgress: OnProgress,
): Promise<Answer> {
  const { session } = core;
  switch (request.type) {
    case "setFiles":
      return copied(await setFiles(session, request.args.files));
    case "inspect":
      return copied(session.inspect(request.args.options));
    case "load":
      return copied(session.load(request.args.options));
    case "image":
      return await imageAnswer(session.image(request.args.view));
    case "setParams":
      session.setParams(request.args.params);
      return copied(null);
    case "run":
      return copied(session.runStage(request.args.stage, throttled(request.args.stage, onProgress)));
    case "sharedMaps":
      return copied(sharedMaps(session, request.args.stage));
    case "packView":
      return moved(session.packView(request.args.view, request.args.withColours));
    case "takeView":
      session.takeView(request.args.view, request.args.of, request.args.packed);
      return copied(null);
    case "handOver":
      return moved(session.handOver(request.args.stage));
    case "takeOver":
      session.takeOver(request.args.stage, request.args.found);
      return copied(null);
    case "computeShard":
      return moved(shardOf(session, request.args, onProgress));
    case "mergeShards":
      session.learn(request.args.map, request.args.shards);
      return copied(null);
    case "segments":
      return moved(session.segments(request.args.view));
    case "matchedSegments":
      return moved(session.matchedSegments(request.args.view));
    case "lines":
      return moved(session.lines());
    case "halfPlanes":
      return copied(session.halfPlanes());
    case "facets":
      return copied(session.facets());
    case "ask":
      return queryAnswer(session, request.args.query, request.args.of);
    case "exportNames":
      return copied(session.exportNames());
    case "exportFile":
      return moved(session.exportFile(request.args.name));
    case "planTiles":
      return copied(session.planTiles(request.args.options, request.args.tileM));
    case "runTile":
      return copied(runTile(session, request.args, onProgress));
    case "joinTiles":
      session.joinTiles();
      return copied(null);
    case "exportProject":
      return moved(session.exportProject(request.args.options));
    case "openedProject":
      return copied(session.openedProject() ?? null);
  }
}

async function setFiles(session: CoreSession, files: InputFile[]): Promise<null> {
  session.clearFiles();
  for (const { path, blob } of files) {
    session.addFile(path, new Uint8Array(await readBlob(path, blob)));
  }
  return null;
}

/** A file may have vanished since it was dropped: the browser's own message does not name it. */
async function readBlob(path: string, blob: Blob): Promise<ArrayBuffer> {
  try {
    return await blob.arrayBuffer();
  } catch {
    throw new Error(`${path}: the file can no longer be read. Was it moved or changed? Add it again.`);
  }
}

function sharedMaps(session: CoreSession, stage: string): Result<"sharedMaps"> {
  return { maps: session.sharedMaps(stage), withColours: session.sharesColours(stage) };
}

function shardOf(session: CoreSession, { stage, map, index, of }: Shard, onProgress: OnProgress): Bytes {
  return session.share(stage, map, index, of, throttled(stage, onProgress));
}

/** A tile's progress as a part of the whole area's. */
function runTile(
  session: CoreSession,
  { stage, index, of }: Args<"runTile">,
  onProgress: OnProgress,
): TileReport | null {
  const onTileProgress = throttled(stage, onProgress);
  return session.runTile((fraction) => onTileProgress((index + fraction) / of)) ?? null;
}

/** Passes a stage's progress on, but not more often than the page can draw it. */
function throttled(stage: string, onProgress: OnProgress): (fraction: number) => void {
  let last = 0;
  return (fraction) => {
    const now = performance.now();
    if (now - last >= PROGRESS_INTERVAL_MS || fraction >= 1) {
      last = now;
      onProgress(stage, fraction);
    }
  };
}

/** What a query returns: pictures and arrays move, records are copied, nothing is null. */
function queryAnswer(session: CoreSession, query: QueryName, of: readonly unknown[]): Answer {
  if (!QUERY_NAMES.includes(query)) {
    throw new Error(`There is no query '${query}'.`);
  }
  const result = (session[query] as (...args: readonly unknown[]) => unknown)(...of) ?? null;
  if (result instanceof Float32Array || result instanceof Float64Array) {
    return moved(result);
  }
  if (query === "warped" && result !== null) {
    const { about, rgba } = result as WarpedPicture;
    return { result: { about, rgba }, transfer: [rgba.buffer] };
  }
  return copied(result as Result<CallName>);
}

/** The bitmap is made here: on the page it would hold everything else up. */
async function imageAnswer({ rgba, width, height }: ViewImage): Promise<Answer> {
  const bitmap = await createImageBitmap(new ImageData(rgba, width, height));
  return { result: bitmap, transfer: [bitmap] };
}

/** Arrays that the core hands out are copies of its memory, so their buffers may move. */
function moved(array: Float32Array | Float64Array | Uint8Array<ArrayBuffer>): Answer {
  return { result: array as Result<CallName>, transfer: [array.buffer as ArrayBuffer] };
}

function copied(result: Result<CallName>): Answer {
  return { result, transfer: [] };
}
