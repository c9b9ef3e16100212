/** The photographs of a flight from above: what they show, how many show each place, the tiles, and the region, which is drawn here. */
import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { PALETTE } from "../../../shared/palette";
import type { FlightPlan, Overlap } from "../../../shared/records";
import { counted } from "../../parts/counted";
import { files } from "../../state/project";
import { Thumbnail } from "../Thumbnail";
import { thumbnailOf } from "../thumbnails";
import { cellsOf, doneTiles, type Region, tileRun, usedTiles, viewsOf, workPlan } from "../tiles/flight";
import { boxOf, coverOf, frameOf, type PlanFrame, regionBetween, spacingOf } from "./planGeometry";

/** A region is meant, and not a click, when it is so large, fractions of the drawing. */
const LEAST_DRAG = 0.012;

interface Props {
  plan: FlightPlan;
  region: Region | null;
  /** Small pictures in place of the overlap. */
  withPictures: boolean;
  /** Whether fingers draw, too; otherwise they scroll. */
  drawsByTouch: boolean;
  /** A run is going on, which another region would end. */
  isFixed: boolean;
  onRegion: (region: [number, number, number, number]) => void;
}

export function PlanDrawing({ plan, region, withPictures, drawsByTouch, isFixed, onRegion }: Props) {
  const { overview } = plan;
  const frame = useMemo(() => frameOf(overview.overlap.area), [overview.overlap.area]);
  const shading = useMemo(() => shadingOf(overview.overlap), [overview.overlap]);
  const named = useSignal<number | null>(null);
  const drag = useDrag(frame, drawsByTouch, isFixed, onRegion);
  const { width, height } = frame;
  const shown = drag.region ?? region;
  return (
    <div
      class={`plan-drawing ${isFixed ? "fixed" : ""} ${drawsByTouch ? "by-touch" : ""} ${withPictures ? "with-pictures" : ""}`}
    >
      <svg
        viewBox={`0 0 ${width} ${height}`}
        role="img"
        aria-label={`Plan, north up: ${counted(overview.footprints.length, "photographs")}, ${counted(plan.tiles.length, "tiles")}. Drag a rectangle to choose the region, or state its sides.`}
        data-testid="flight-drawing"
        {...drag.handlers}
      >
        {!withPictures && <image class="shading" href={shading} {...fill(width, height)} />}
        <g class="footprints">
          {overview.footprints.map(({ path, outline }) => (
            <polygon key={path} points={pointsOf(frame, outline)} />
          ))}
        </g>
        <LeftOutSquares plan={plan} frame={frame} />
        <Tiles plan={plan} frame={frame} />
        {withPictures && <Pictures plan={plan} frame={frame} />}
        <g class="cameras">
          {overview.footprints.map(({ path, view, center: [x, y] }, i) => {
            const [cx, cy] = frame.toDrawing([x, y]);
            return (
              <circle
                key={path}
                cx={cx}
                cy={cy}
                r={withPictures ? 12 : 5}
                onPointerEnter={() => {
                  named.value = i;
                }}
                onPointerLeave={() => {
                  named.value = null;
                }}
              >
                <title>{view}</title>
              </circle>
            );
          })}
        </g>
        <Named plan={plan} frame={frame} index={named.value} />
        {shown !== null && <rect class="region" {...boxOf(frame, shown)} />}
      </svg>
      <ScaleBar frame={frame} />
      <NamedCard plan={plan} index={named.value} />
    </div>
  );
}

function fill(width: number, height: number) {
  return { x: 0, y: 0, width, height, preserveAspectRatio: "none" };
}

function pointsOf(frame: PlanFrame, outline: readonly [number, number][]): string {
  return outline
    .map((place) =>
      frame
        .toDrawing(place)
        .map((v) => v.toFixed(1))
        .join(","),
    )
    .join(" ");
}

/** One pixel a cell; the browser smooths it. */
function shadingOf({ columns, rows, counts }: Overlap): string {
  const canvas = document.createElement("canvas");
  canvas.width = columns;
  canvas.height = rows;
  const context = canvas.getContext("2d");
  counts.forEach((count, i) => {
    const cover = coverOf(count);
    if (cover !== null && context !== null) {
      context.globalAlpha = cover.alpha;
      context.fillStyle = PALETTE.matched;
      context.fillRect(i % columns, rows - 1 - Math.floor(i / columns), 1, 1);
    }
  });
  return canvas.toDataURL();
}

/** What no tile reconstructs. */
function LeftOutSquares({ plan, frame }: { plan: FlightPlan; frame: PlanFrame }) {
  const { left_out, squares_left_out, why_left_out } = plan;
  if (left_out.length === 0) {
    return null;
  }
  const outline = left_out.map((core) => {
    const { x, y, width, height } = boxOf(frame, core);
    return `M${x.toFixed(1)} ${y.toFixed(1)}h${width.toFixed(1)}v${height.toFixed(1)}h${(-width).toFixed(1)}z`;
  });
  return (
    <path class="squares-left-out" data-count={squares_left_out} d={outline.join("")}>
      <title>{`Left out: ${why_left_out}`}</title>
    </path>
  );
}

function Tiles({ plan, frame }: { plan: FlightPlan; frame: PlanFrame }) {
  const running = useComputed(() => tileRun.value?.tile ?? null);
  return (
    <g class="tiles">
      {plan.tiles.map((core, i) => {
        const state = !usedTiles.value.includes(i)
          ? "left-out"
          : running.value === i
            ? "running"
            : doneTiles.value.has(i)
              ? "done"
              : "waiting";
        return (
          <rect
            key={core.join()}
            class={`tile ${state}`}
            data-tile={i}
            data-state={state}
            {...boxOf(frame, core)}
          >
            <title>
              {state === "left-out"
                ? `Tile ${i + 1} is left out: ${cellsOf(i)[0]?.left_out}`
                : `Tile ${i + 1}: ${doneTiles.value.get(i) ?? sizeText(i)}`}
            </title>
          </rect>
        );
      })}
      {plan.tiles.flatMap((_, i) =>
        cellsOf(i).map(({ place: { core } }) => (
          <rect key={core.join()} class="cell" {...boxOf(frame, core)} />
        )),
      )}
    </g>
  );
}

/** What a tile takes, as far as it is known. */
function sizeText(tile: number): string {
  const work = workPlan.value?.tiles[tile];
  if (work === undefined) {
    return "not looked at yet";
  }
  return work.cells.length === 0
    ? "nothing that may be a roof"
    : `${counted(viewsOf(tile).length, "photographs")}, about ${work.memory_mb} MB`;
}

/** The photograph that is pointed at: what it shows, and its name. */
function Named({ plan, frame, index }: { plan: FlightPlan; frame: PlanFrame; index: number | null }) {
  const one = index === null ? undefined : plan.overview.footprints[index];
  return one === undefined ? null : (
    <g class="named">
      <polygon points={pointsOf(frame, one.outline)} />
    </g>
  );
}

function NamedCard({ plan, index }: { plan: FlightPlan; index: number | null }) {
  const one = index === null ? undefined : plan.overview.footprints[index];
  return one === undefined ? null : (
    <div class="named-card">
      <Thumbnail blob={files.value.find(({ path }) => path === one.path)?.blob} loaded={undefined} />
      <span>{one.view}</span>
    </div>
  );
}

/** Small pictures where the photographs were taken, one after the other. */
function Pictures({ plan, frame }: { plan: FlightPlan; frame: PlanFrame }) {
  const urls = usePictures(plan);
  const places = plan.overview.footprints.map(({ center: [x, y] }) => frame.toDrawing([x, y]));
  const side = Math.min(Math.max(1.4 * spacingOf(places, frame.width), 34), 110);
  return (
    <g class="pictures">
      {plan.overview.footprints.map(({ path }, i) => {
        const [x, y] = places[i] as [number, number];
        const url = urls.get(path);
        const box = { x: x - side / 2, y: y - 0.375 * side, width: side, height: 0.75 * side };
        return url === undefined ? (
          <rect key={path} {...box} />
        ) : (
          <image key={path} href={url} preserveAspectRatio="xMidYMid slice" {...box} />
        );
      })}
    </g>
  );
}

function usePictures(plan: FlightPlan): ReadonlyMap<string, string> {
  const [urls, setUrls] = useState<ReadonlyMap<string, string>>(new Map());
  useEffect(() => {
    let isCurrent = true;
    const made = new Map<string, string>();
    const blobs = new Map(files.peek().map(({ path, blob }) => [path, blob]));
    for (const { path } of plan.overview.footprints) {
      const blob = blobs.get(path);
      if (blob !== undefined) {
        void thumbnailOf(blob, () => isCurrent).then(async (bitmap) => {
          const url = bitmap === null || !isCurrent ? null : await urlOf(bitmap);
          if (url !== null) {
            made.set(path, url);
            setUrls(new Map(made));
          }
        });
      }
    }
    return () => {
      isCurrent = false;
      for (const url of made.values()) {
        URL.revokeObjectURL(url);
      }
    };
  }, [plan.overview.footprints]);
  return urls;
}

async function urlOf(bitmap: ImageBitmap): Promise<string | null> {
  const canvas = document.createElement("canvas");
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/jpeg", 0.8));
  return blob === null ? null : URL.createObjectURL(blob);
}

/** A length that is easily read: 1, 2 or 5 times a power of ten, a fifth of the width at most. */
function ScaleBar({ frame }: { frame: PlanFrame }) {
  const most = frame.width / frame.scale / 5;
  const power = 10 ** Math.floor(Math.log10(most));
  const metres = power * ([5, 2].find((step) => step * power <= most) ?? 1);
  return (
    <p class="scale-bar muted numbers" style={{ width: `${(100 * metres * frame.scale) / frame.width}%` }}>
      {metres} m
    </p>
  );
}

function useDrag(frame: PlanFrame, drawsByTouch: boolean, isFixed: boolean, onRegion: Props["onRegion"]) {
  const [region, setRegion] = useState<[number, number, number, number] | null>(null);
  const from = useRef<{ u: number; v: number } | null>(null);
  const placeOf = (event: PointerEvent) => {
    const { left, top, width, height } = (event.currentTarget as Element).getBoundingClientRect();
    const within = (t: number) => Math.min(Math.max(t, 0), 1);
    return { u: within((event.clientX - left) / width), v: within((event.clientY - top) / height) };
  };
  const between = (event: PointerEvent) => {
    const [a, b] = [from.current, placeOf(event)];
    const isLarge = a !== null && Math.min(Math.abs(a.u - b.u), Math.abs(a.v - b.v)) > LEAST_DRAG;
    return isLarge ? regionBetween(frame.toWorld(a.u, a.v), frame.toWorld(b.u, b.v)) : null;
  };
  const end = () => {
    from.current = null;
    setRegion(null);
  };
  return {
    region,
    handlers: {
      onPointerDown: (event: PointerEvent) => {
        if (!isFixed && event.button === 0 && (event.pointerType === "mouse" || drawsByTouch)) {
          (event.currentTarget as Element).setPointerCapture(event.pointerId);
          from.current = placeOf(event);
          event.preventDefault();
        }
      },
      onPointerMove: (event: PointerEvent) => {
        if (from.current !== null) {
          setRegion(between(event));
        }
      },
      onPointerUp: (event: PointerEvent) => {
        const drawn = between(event);
        end();
        if (drawn !== null && drawn[0] < drawn[2] && drawn[1] < drawn[3]) {
          onRegion(drawn);
        }
      },
      onPointerCancel: end,
    },
  };
}
