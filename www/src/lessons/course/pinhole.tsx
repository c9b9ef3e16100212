/** Lesson 1: what a camera does with a point, and why one matrix says it. */
import { signal } from "@preact/signals";
import { clamp, nearestParameter, point2 } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { Dot, Drawing, Handle, Label, Line, Shape, Slider, Switch } from "../parts/draw";
import { type Lesson, onScene } from "../parts/lesson";
import { degrees, metres, num, pixels, place } from "../parts/say";
import { ImagePane, inFrame, OBSERVER, Space, seen } from "../parts/scene";
import { PixelInViews } from "../scene/PixelInViews";
import { atDepth, atHeight, type Camera, depthOf, imageOf, projected, projection } from "../toy/camera";
import { aerial, CORNERS, VIEWS } from "../toy/house";

const [FIRST] = VIEWS;
const ON_RAY: Vec2 = [150, 96];
const FAR = 39;

const distance = signal(31);
const along = (s: number): Vec3 => atDepth(FIRST, ON_RAY, s);

function RayFigure({ isRevealed }: { isRevealed: boolean }) {
  const X = along(distance.value);
  return (
    <div class="pair">
      <Space label="A camera above the house and one of its rays" cameras={[FIRST]}>
        <Line from={seen(FIRST.C)} to={seen(along(FAR))} class="s1" />
        <Dot at={seen(inFrame(FIRST, ON_RAY))} class="s1" />
        <Handle
          at={seen(X)}
          class="s4"
          label="Point X on the ray"
          says={`${metres(distance.value)} from the camera`}
          of={distance}
          to={(to) => nearestParameter((s) => seen(along(s)), 9, FAR, to)}
          isFixed={!isRevealed}
        />
        <Label at={seen(X)} dx={12} dy={-6} class="s4 vector" text="X" />
      </Space>
      <ImagePane camera={FIRST} title="What the camera sees" label="Image of the house" colour={1}>
        <Dot at={imageOf(FIRST, X)} class="s1" />
        <Label at={imageOf(FIRST, X)} dx={8} dy={-8} class="s1 vector" text="x" />
      </ImagePane>
    </div>
  );
}

const ROOF_M = 10;
const above = signal(40);
const roofPx = (Z: number) => (FIRST.f * ROOF_M) / Z;

function TrianglesFigure({ isRevealed }: { isRevealed: boolean }) {
  const Z = above.value;
  const ground = 330;
  const scale = 3;
  const top = ground - Z * scale;
  const film = top + 34;
  const half = (ROOF_M / 2) * scale * 1.6;
  const filmHalf = (half * (film - top)) / (ground - top);
  const middle = 240;
  return (
    <Drawing width={480} height={370} label="The camera, its image and the roof from the side">
      <Line from={[30, ground + 14]} to={[450, ground + 14]} class="rule" />
      <Line from={[middle, top]} to={[middle - half, ground]} class="s1 faint" />
      <Line from={[middle, top]} to={[middle + half, ground]} class="s1 faint" />
      <Line from={[middle - half, ground]} to={[middle + half, ground]} class="s4 thick" />
      <Line from={[middle - 70, film]} to={[middle + 70, film]} class="rule" />
      <Line from={[middle - filmHalf, film]} to={[middle + filmHalf, film]} class="s1 thick" />
      <Line from={[390, top]} to={[390, ground]} class="s5" />
      <Line from={[345, top]} to={[345, film]} class="s5" />
      <Label at={[345, (top + film) / 2]} dx={-14} dy={4} class="s5 letter" text="f" />
      <Label at={[390, (top + ground) / 2]} dx={8} class="s5" letter="Z" text={`= ${metres(Z, 0)}`} />
      <Label at={[middle, ground]} dy={30} anchor="middle" class="s4" letter="W" text="= 10 m" />
      <Label
        at={[middle - 76, film]}
        anchor="end"
        dy={4}
        class="s1"
        letter="ℓ"
        text={isRevealed ? `= ${pixels(roofPx(Z), 0)}` : ""}
      />
      <Handle
        at={[middle, top]}
        class="s5"
        label="Height of the camera above the roof"
        says={metres(Z, 0)}
        step={6}
        of={above}
        to={([, y]) => clamp(Math.round((ground - y) / scale), 20, 100)}
        isFixed={!isRevealed}
      />
    </Drawing>
  );
}

const pixel = signal<Vec2>([2.5, 1.5]);
const CELL = 70;
const inTwentieths = (place: number, most: number) => clamp(Math.round((20 * place) / CELL) / 20, 0, most);

function PixelFigure({ isRevealed }: { isRevealed: boolean }) {
  const [x, y] = pixel.value;
  return (
    <Drawing width={480} height={330} label="The first pixels of an image, enlarged">
      <g transform="translate(40 40)">
        {[0, 1, 2, 3].flatMap((row) =>
          [0, 1, 2, 3, 4, 5].map((column) => (
            <rect
              key={`${row} ${column}`}
              class={`cell ${(row + column) % 2 === 0 ? "even" : ""}`}
              x={column * CELL}
              y={row * CELL}
              width={CELL}
              height={CELL}
            />
          )),
        )}
        {isRevealed &&
          [0, 1, 2, 3, 4, 5, 6].map((i) => (
            <Label key={i} at={[i * CELL, 0]} dy={-8} anchor="middle" class="tick" text={i} />
          ))}
        {isRevealed &&
          [0, 1, 2, 3, 4].map((i) => (
            <Label key={i} at={[0, i * CELL]} dx={-8} dy={4} anchor="end" class="tick" text={i} />
          ))}
        <Dot at={[CELL / 2, CELL / 2]} class="s1" />
        {isRevealed && (
          <Handle
            at={[x * CELL, y * CELL]}
            class="s1"
            label="Image point"
            says={place([x, y], 2)}
            value={x}
            step={CELL / 20}
            of={pixel}
            to={([px, py]): Vec2 => [inTwentieths(px, 6), inTwentieths(py, 4)]}
          />
        )}
      </g>
    </Drawing>
  );
}

const distancePx = signal(450);
const principal = signal<Vec2>([160, 120]);

function CalibrationFigure() {
  const [f, [cx, cy]] = [distancePx.value, principal.value];
  return (
    <>
      <ImagePane
        camera={{ ...FIRST, f, cx, cy }}
        title="320 × 240 pixels"
        label="The house through this calibration"
        colour={1}
      >
        <Line from={[cx - 10, cy]} to={[cx + 10, cy]} class="s5" />
        <Line from={[cx, cy - 10]} to={[cx, cy + 10]} class="s5" />
        <Handle
          at={[cx, cy]}
          class="s5"
          label="Principal point"
          says={place([cx, cy], 0)}
          of={principal}
          to={([x, y]): Vec2 => [Math.round(clamp(x, 0, 320)), Math.round(clamp(y, 0, 240))]}
        />
      </ImagePane>
      <Slider symbol="f" label="principal distance" of={distancePx} range={[200, 900, 10]} suffix=" px" />
    </>
  );
}

const centre = signal<Vec3>([-9, -4, 42]);
const turned = (): Camera => aerial(centre.value);

function OrientationFigure() {
  const camera = turned();
  return (
    <div class="pair">
      <Space label="The camera in space" cameras={[camera]}>
        <Line from={seen(camera.C)} to={seen([camera.C[0], camera.C[1], 0])} class="s5 faint" />
        <Handle
          at={seen(camera.C)}
          class="s5"
          label="Projection centre"
          says={`${metres(camera.C[0])} east, ${metres(camera.C[1])} north`}
          of={centre}
          to={(place): Vec3 => {
            const [x, y] = atHeight(OBSERVER, place, camera.C[2]);
            return [clamp(x, -18, 18), clamp(y, -16, 16), camera.C[2]];
          }}
        />
      </Space>
      <ImagePane camera={camera} title="What it sees" label="Image of the house" colour={1} />
      <Slider
        label="height"
        value={camera.C[2]}
        range={[26, 48, 1]}
        suffix=" m"
        onInput={(value) => {
          centre.value = [centre.value[0], centre.value[1], value];
        }}
      />
    </div>
  );
}

const PLACES = {
  ridge: ["ridge", CORNERS.ridgeWest],
  eave: ["eave", CORNERS.southEaveEast],
  foot: ["foot of the wall", [5, -4, 0]],
} as const satisfies Record<string, readonly [string, Vec3]>;
const picked = signal<keyof typeof PLACES>("ridge");
const product = () => projected(projection(FIRST), PLACES[picked.value][1]);

function ProductFigure() {
  const X = PLACES[picked.value][1];
  const x = imageOf(FIRST, X);
  return (
    <>
      <Switch legend="Point" names={{ ridge: "Ridge", eave: "Eave", foot: "Foot of the wall" }} of={picked} />
      <ImagePane camera={FIRST} title="The point in the image" label="The house and the point" colour={1}>
        <Shape points={[[0, 0], [x[0], 0], x, [0, x[1]]]} class="s1 measure" />
        <Dot at={x} class="s1" />
        <Label at={x} dx={8} dy={-8} class="s1" text={place(x)} />
      </ImagePane>
    </>
  );
}

const tuple = (values: readonly number[], digits: number) =>
  `matrix { ${values.map((one) => num(one, digits)).join(" ; ")} }`;

export const PINHOLE: Lesson = {
  id: "pinhole",
  title: "Pinhole and projection matrix",
  aim: "You can say where a point of the world is seen, with one matrix.",
  minutes: 8,
  papers: "B99 2; W96 3.2",
  screens: [
    {
      id: "ray",
      title: "A photograph is a bundle of rays",
      prose: () => [
        "Light goes straight. All light that reaches the camera's projection centre $C$ along one line leaves one image point $x$.",
        "So a photograph does not say where things are. It says, for each pixel, *on which ray* they are.",
      ],
      figure: RayFigure,
      predict: {
        kind: "choice",
        question: "The point $X$ moves down its ray, away from the camera. Where does its image $x$ go?",
        options: ["Outwards, to the border", "Towards the middle", "It stays where it is"],
        right: () => 2,
        why: () =>
          "Every point of the ray has the same image. Drag $X$ and see: only other views can tell how far it is.",
      },
      says: () =>
        `$X$ is ${metres(distance.value)} before the camera, ${metres(along(distance.value)[2])} above the ground; $x$ is at ${place(ON_RAY, 0)} px, as before.`,
    },
    {
      id: "triangles",
      title: "Twice as far, half as large",
      prose: () => [
        "The rays through the ends of a roof make two similar triangles: one out to the roof at depth $Z$, one to the image at the principal distance $f$.",
        "Measured in pixels, $f$ of this camera is 450 px. That is all one needs to turn metres into pixels.",
      ],
      formula: () => "len = f * frac { W } { Z }",
      figure: TrianglesFigure,
      predict: {
        kind: "estimate",
        question: `From ${metres(40, 0)} above it, a roof of $W$ = 10 m is ${pixels(roofPx(40), 0)} long. How long is it from 80 m?`,
        unit: "px",
        range: [10, 240, 2],
        truth: () => roofPx(80),
        within: 6,
        why: () => "Depth stands below the line: twice the depth, half the length. Drag the camera.",
      },
      says: () =>
        `From ${metres(above.value, 0)} above the roof it is ${pixels(roofPx(above.value), 0)} long, and a pixel shows ${num((100 * above.value) / FIRST.f)} cm of it.`,
    },
    {
      id: "pixels",
      title: "Where is a pixel?",
      prose: () => [
        "Image coordinates $u$ (to the right) and $v$ (*downwards*) are lengths, counted from the corner of the image. A pixel is a square, not a point.",
        "Half a pixel sounds like nothing. At 8 cm a pixel it is 4 cm on the roof, and in photographs that were flown in opposite directions it points in opposite directions.",
      ],
      figure: PixelFigure,
      predict: {
        kind: "choice",
        question: "Which coordinates has the centre of the first pixel, top left?",
        options: ["(0, 0)", "(0.5, 0.5)", "(1, 1)"],
        right: () => 1,
        why: () =>
          "The corner of the image is (0, 0), so the centre of the first pixel is (0.5, 0.5). Other programs count from the centre: that is why readers of orientations must know.",
      },
      says: () => {
        const [x, y] = pixel.value;
        return `The point is at ${place([x, y], 2)}: in the pixel of column ${Math.min(5, Math.floor(x))} and row ${Math.min(3, Math.floor(y))}, counted from 0.`;
      },
    },
    {
      id: "calibration",
      title: "Three numbers inside the camera",
      prose: () => [
        "The matrix $K$ holds what is inside the camera: the principal distance $f$, and the principal point, at which the camera's axis meets the image.",
        "Drag the principal point: the whole image goes with it. It need not be in the middle; in a crop of a large frame it may lie far outside.",
      ],
      formula: () => {
        const [f, [cx, cy]] = [distancePx.value, principal.value];
        return `K = matrix { f 0 cx ; 0 f cy ; 0 0 1 } = matrix { ${f} 0 ${cx} ; 0 ${f} ${cy} ; 0 0 1 }`;
      },
      figure: CalibrationFigure,
      says: () => {
        const [f, [cx, cy]] = [distancePx.value, principal.value];
        const angle = Math.atan((320 - cx) / f) + Math.atan(cx / f);
        return `At $f$ = ${pixels(f, 0)} the image is ${degrees(angle)} wide. The axis meets it at ${place([cx, cy], 0)}.`;
      },
    },
    {
      id: "orientation",
      title: "Where it stands, where it looks",
      prose: () => [
        "A point of the world is first moved into the camera: less $C$, then turned by $R$. Then $K$ makes pixels of it. Written as one matrix of 3 × 4, that is $P$.",
        "Drag the projection centre $C$: this camera keeps looking at the house, so $R$ turns with it. All twelve numbers change.",
      ],
      formula: () => {
        const rows = projection(turned()).map((row) => row.map((one) => num(one, 0)).join(" "));
        return `P = K [ R | - R C ] = matrix { ${rows.join(" ; ")} }`;
      },
      figure: OrientationFigure,
      says: () => {
        const [x, y, z] = centre.value;
        return `$C$ is ${metres(Math.abs(x))} ${x < 0 ? "west" : "east"} and ${metres(Math.abs(y))} ${y < 0 ? "south" : "north"} of the middle of the house, ${metres(z)} above the ground.`;
      },
    },
    {
      id: "product",
      title: "One product",
      prose: () => [
        "Write $X$ with a 1 behind it. Then $P X$ has three numbers. Divide the first two by the third: that is the image point. The sign ≃ says *up to that division*.",
        "The third number is no waste: it is the depth before the camera.",
      ],
      formula: () => {
        const [a, b, w] = product();
        const [x, y] = point2([a, b, w]);
        return `P X = ${tuple([a, b, w], 1)} ~ ${tuple([x, y, 1], 1)} = x`;
      },
      figure: ProductFigure,
      says: () => {
        const X = PLACES[picked.value][1];
        return `The ${PLACES[picked.value][0]} is seen at ${place(imageOf(FIRST, X))} px, and is ${metres(depthOf(FIRST, X))} before the camera.`;
      },
    },
    onScene(
      "own",
      "On whole photographs",
      PixelInViews,
      [
        "The same on photographs with their own $P$. Pick a point of a roof in the first one, and turn the height $h$ until the mark is on the same point in all others.",
        "One height fits all views at once: you have just measured it, with nothing but projection matrices.",
      ],
      "x2 ~ P2 X",
    ),
  ],
};
