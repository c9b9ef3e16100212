import { deflateSync } from "node:zlib";
import { expect, test } from "@playwright/test";
import { zipSync } from "fflate";
import {
  demoImages,
  demoOrientation,
  give,
  houseFiles,
  housePmatrix,
  openDemo,
  runButton,
  runUpTo,
  showProject,
  type Upload,
  upload,
  waitForStage,
  watch,
} from "./helpers";

const truncated = (): Upload[] => {
  const [first, ...others] = demoImages(3) as [Upload, ...Upload[]];
  return [upload(first.name, first.buffer.subarray(0, 20_000)), ...others, ...demoOrientation()];
};

/** Three black images of 36 million pixels: small files, and far too much to compute with. */
function largeScene(): Upload[] {
  const size = 6000;
  const png = blackPng(size);
  const views = [-100, 0, 100].map((x) => ({
    file: `at${x}.png`,
    width: size,
    height: size,
    K: [
      [6000, 0, 3000],
      [0, 6000, 3000],
      [0, 0, 1],
    ],
    R: [
      [1, 0, 0],
      [0, -1, 0],
      [0, 0, -1],
    ],
    C: [x, 0, 1000],
  }));
  const orientation = upload("cameras.json", Buffer.from(JSON.stringify({ views })));
  return [...views.map(({ file }) => upload(file, png)), orientation];
}

function blackPng(size: number): Buffer {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(size, 0);
  header.writeUInt32BE(size, 4);
  header[8] = 8;
  const chunk = (type: string, data: Buffer) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc32(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const signature = Buffer.from("89504e470d0a1a0a", "hex");
  const pixels = deflateSync(Buffer.alloc((size + 1) * size));
  return Buffer.concat([
    signature,
    chunk("IHDR", header),
    chunk("IDAT", pixels),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

/** The check sum of PNG. */
function crc32(bytes: Buffer): number {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) {
      crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
    }
  }
  return (crc ^ 0xffffffff) >>> 0;
}

const BAD_INPUTS: { what: string; files: () => Upload[]; says: RegExp }[] = [
  {
    what: "an image without orientation",
    files: () => [
      ...demoImages(3),
      ...demoOrientation((text) => text.replace(/^s1_02.*$/m, "").replace(/^s2_.*$/gm, "")),
    ],
    says: /s1_02|orientation/,
  },
  { what: "a truncated JPEG", files: truncated, says: /s1_01\.jpg/ },
  {
    what: "a camera that is not a number",
    files: () => [
      ...demoImages(3),
      ...demoOrientation((text) => text.replace(/^(s1_01\.jpg) \S+/m, "$1 NaN")),
    ],
    says: /exterior\.txt/,
  },
  {
    what: "two views only, and an orientation whose other images are missing",
    files: () => [...demoImages(2), ...demoOrientation()],
    says: /three are needed/,
  },
  {
    what: "a file that is no image",
    files: () => [
      ...demoImages(3).slice(1),
      upload("s1_01.jpg", Buffer.from("<html>not found</html>")),
      ...demoOrientation(),
    ],
    says: /s1_01\.jpg.*neither JPEG nor PNG nor TIFF/,
  },
  {
    what: "two images of the same name",
    files: () => [
      ...demoImages(3),
      ...demoImages(1).map(({ buffer }) => upload("s1_01.jpeg", buffer)),
      ...demoOrientation((text) => text.replace(/^s1_01\.jpg/m, "s1_01")),
    ],
    says: /s1_01\.jpe?g.*same name/,
  },
  {
    what: "an image of another size than the orientation says",
    files: () => [
      ...demoImages(3),
      ...demoOrientation(undefined, (text) => text.replace(/^(crop s1_02.*) 600 600$/m, "$1 640 480")),
    ],
    says: /s1_02\.jpg.*600 x 600.*640 x 480/,
  },
  {
    what: "a singular camera",
    files: () => [
      ...houseFiles().filter(({ name }) => name !== "s1_02.P"),
      upload("s1_02.P", Buffer.from("1 0 0 0\n0 1 0 0\n1 1 0 5\n")),
    ],
    says: /s1_02\.P.*singular/,
  },
  {
    what: "views that do not overlap",
    files: () => [
      ...demoImages(6).filter(({ name }) => !name.includes("_03")),
      ...demoOrientation((text) =>
        text.replace(/^(s2_\S+ \S+) (\S+)/gm, (_, start, y) => `${start} ${Number(y) + 5000}`),
      ),
    ],
    says: /do not overlap/,
  },
  {
    what: "angles in the wrong order",
    files: () => [
      ...demoImages(6),
      ...demoOrientation((text) => text.replace(/^(s\S+ \S+ \S+ \S+) (\S+) (\S+)/gm, "$1 $3 $2")),
    ],
    says: /contradict.*phi, omega, kappa/,
  },
  {
    what: "rows counted from the bottom",
    files: () => [
      ...demoImages(6),
      ...demoOrientation(undefined, (text) =>
        text.replace(/^(crop \S+ \S+) (\S+)/gm, (_, start, row) => `${start} ${9000 - 600 - Number(row)}`),
      ),
    ],
    says: /contradict.*from the bottom/,
  },
  {
    what: "no image at all",
    files: () => [upload("notes.txt", Buffer.from("nothing of use"))],
    says: /image|photograph/i,
  },
];

test("bad input is rejected in words, and the page lives on", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  for (const { what, files, says } of BAD_INPUTS) {
    await test.step(what, async () => {
      await give(page, files());
      await expect(page.getByRole("alert").first()).toContainText(says);
      await showProject(page);
      await page.getByRole("button", { name: "New project" }).click();
      await expect(page.getByRole("alert")).toHaveCount(0);
    });
  }
  await openDemo(page);
  await waitForStage(page, "segments", 60_000);
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("files may be dropped anywhere on the page; what is being typed stays while others come", async ({
  page,
}) => {
  await page.goto("/");
  await expect(page.getByTestId("entrance")).toBeVisible();
  const given = houseFiles().map(({ name, buffer }) => ({ name, base64: buffer.toString("base64") }));
  const dataTransfer = await page.evaluateHandle((files) => {
    const transfer = new DataTransfer();
    for (const { name, base64 } of files) {
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    }
    return transfer;
  }, given);
  const zone = page.locator(".doors");
  await page.dispatchEvent("main", "dragover", { dataTransfer });
  await expect(zone).toHaveClass(/over/);
  await page.dispatchEvent("main", "drop", { dataTransfer });
  await expect(page.locator(".over:is(.doors, .dropzone)")).toHaveCount(0);
  await expect(page.locator(".view .status.good")).toHaveCount(6);

  await showProject(page);
  await page.getByText("Region, ground, reference system").click();
  const height = page.getByLabel(/Height of the ground/);
  await height.fill("99999");
  await give(page, [upload("notes.txt", Buffer.from("of the flight"))]);
  await expect(page.getByText("notes.txt").first()).toBeVisible();
  await expect(height).toHaveValue("99999");
  await height.press("Enter");
  await expect(page.getByRole("alert")).toContainText("below the ground");
});

test("a file name is text, whatever it says", async ({ page }) => {
  const { problems } = watch(page);
  const names = [
    '<img src=x onerror="alert(1)">.jpg',
    "<script>alert(2)<&sol;script>.jpg",
    "a&lt;b&#39;';--.jpg",
    "javascript:alert(3).jpg",
    `${"long".repeat(60)}.jpg`,
    "\u202egpj.exe.jpg",
    "'';!--\"<XSS>=&{()}.jpg",
    "<svg onload=alert(4)>.jpg",
    "$(alert 5)`alert(5)`.jpg",
    "{{constructor.constructor('alert(6)')()}}.jpg",
    "%3Cscript%3Ealert(7)%3C%2Fscript%3E.jpg",
    '"><b>bold.jpg',
    "' onfocus=alert(8) autofocus='.jpg",
    "data:text;html,alert(9).jpg",
    "__proto__.jpg",
    "constructor.jpg",
    "toString.jpg",
    "up\u2215..\u2215etc\u2215passwd.jpg",
    "CON.jpg",
    "nul.jpg",
    " leading and trailing .jpg",
    "hidden-not.jpg",
    "two..dots.jpg",
    "no-break\u00a0space.jpg",
    "zero\u200bwidth.jpg",
    "emoji-\u{1f3e0}\u{1f3fd}.jpg",
    "combining-e\u0301\u0323\u0308.jpg",
    "null-byte-\u2400.jpg",
    "line\u2028separator.jpg",
    "\ufeffbom.jpg",
    "100% #1?&a=b.jpg",
  ];
  const [image] = demoImages(1) as [Upload];
  await page.goto("/");
  await give(
    page,
    names.map((name) => upload(name, image.buffer)),
  );
  await expect(page.locator(".view")).toHaveCount(names.length);
  const shown = await page.locator(".view .name").allTextContents();
  expect([...shown].sort()).toEqual([...names].sort());
  await expect(page.locator("#app img")).toHaveCount(1);
  await expect(page.getByTestId("photographs-only").getByRole("row")).toHaveCount(names.length + 1);
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(width).toBeLessThanOrEqual(1280);
  expect(problems).toEqual([]);
});

test("the orientation, the views and the region can be chosen", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, [...houseFiles(), housePmatrix()]);
  const choice = page.getByLabel("Orientation", { exact: true });
  await expect(choice.getByRole("option")).toHaveCount(2);
  await expect(page.locator(".warnings")).toContainText("2 times");
  const second = await choice.getByRole("option").nth(1).getAttribute("value");
  await choice.selectOption(second);
  await expect(page.locator(".warnings")).toHaveCount(0);
  await expect(page.locator(".view .status.good").first()).toHaveAttribute("title", /\.P$/);

  await page.locator(".view input[type=checkbox]").nth(2).uncheck();
  await expect(page.getByRole("heading", { name: "5 of 6 views" })).toBeVisible();
  await expect(page.getByRole("group", { name: "View" }).getByRole("button")).toHaveCount(6);

  await showProject(page);
  await page.getByText("Region, ground, reference system").click();
  await page.getByLabel(/Region/).fill("1, 2, 3");
  await page.getByLabel(/Region/).press("Enter");
  await expect(page.getByText("four numbers")).toBeVisible();
  await page.getByLabel(/Height of the ground/).fill("99999");
  await page.getByLabel(/Height of the ground/).press("Enter");
  await expect(page.getByRole("alert")).toContainText("below the ground");
  await page.getByLabel(/Height of the ground/).fill("");
  await page.getByLabel(/Height of the ground/).press("Enter");
  await expect(page.getByRole("alert")).toHaveCount(0);
  await expect(runButton(page)).toBeEnabled();
  expect(problems).toEqual([]);
});

test("what is too large is loaded by a region of it", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, largeScene());
  await expect(page.getByRole("alert")).toContainText(/MB of memory, more than 1200 MB.*region of interest/);
  const ask = async (label: RegExp, value: string) => {
    await page.getByLabel(label).fill(value);
    await page.getByLabel(label).press("Enter");
  };
  await showProject(page);
  await page.getByText("Region, ground, reference system").click();
  await ask(/Height of the ground/, "0");
  await expect(page.getByRole("alert")).toContainText("MB of memory");
  await ask(/Region/, "5000, 0, 5040, 40");
  await expect(page.getByRole("alert")).toContainText("seen by 0 views");
  await ask(/Region/, "-20, -20, 20, 20");
  await expect(page.getByRole("alert")).toHaveCount(0);
  await expect(page.getByText(/about [2-9]\d\d MB of memory/)).toBeVisible();
  await expect(runButton(page)).toBeEnabled();
  // The parts of the views that show the region.
  await expect(page.getByRole("group", { name: "View" }).getByRole("button")).toHaveCount(4);
  // In tiles, all of it.
  await ask(/Region/, "-400, -400, 400, 400");
  await expect(page.getByRole("alert")).toContainText("MB of memory");
  await ask(/Tile size/, "60");
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("photographs in an archive have their small pictures once they are loaded", async ({ page }) => {
  await page.goto("/");
  const files = Object.fromEntries(houseFiles().map(({ name, buffer }) => [name, new Uint8Array(buffer)]));
  await give(page, [upload("house.zip", Buffer.from(zipSync(files)))]);
  const pictures = page.locator(".view canvas.thumbnail");
  await expect(pictures).toHaveCount(6);
  await runUpTo(page, "Segments");
  await waitForStage(page, "segments");
  const isPainted = (canvas: HTMLCanvasElement) => {
    const pixels = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
    return pixels.some((value) => value > 0);
  };
  for (let i = 0; i < 6; i += 1) {
    await expect.poll(() => pictures.nth(i).evaluate(isPainted)).toBe(true);
  }
});
