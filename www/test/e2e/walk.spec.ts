/** A walk at random over all controls, files, keys and reloads: nothing on the page may fail, and the core goes on. */
import { expect, type Page, test } from "@playwright/test";
import { randomFrom } from "../../src/exercise/judging/random";
import {
  demoImages,
  demoOrientation,
  dronePhotographs,
  houseFiles,
  openDemo,
  showProject,
  type Upload,
  upload,
  waitForStage,
  watch,
} from "./helpers";

/** `WALK=5000 SEED=3 npx playwright test walk` walks further, from another start. */
const ACTIONS = Number(process.env["WALK"] ?? 60);
const SEED = Number(process.env["SEED"] ?? 1);

const FILES: Upload[][] = [
  houseFiles(),
  houseFiles("bundler").slice(0, 3),
  [...demoImages(4), ...demoOrientation()],
  dronePhotographs().slice(0, 4),
  [upload("house.jpg", Buffer.from("no photograph"))],
  [upload("survey.pdf", Buffer.from("%PDF-1.4"))],
  [upload("corrections.json", Buffer.from("[1, {"))],
];
const TEXTS = ["", "0", "-1", "3.5", "1e9", "abc", "25832", "<b>"];
const KEYS = [
  ...["Escape", "Tab", "Shift+Tab", "Enter", "Space", "Delete", "Home", "End", "?"],
  ...["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "Control+z", "Control+z", "Control+Shift+z"],
];

interface Target {
  kind: "click" | "select" | "text";
  name: string;
  x: number;
  y: number;
}

/** What can be clicked, chosen or filled in, at a place within it; `u` and `v` are shares of its size. Runs in the page. */
function targets([u, v]: [number, number]): Target[] {
  const wanted =
    "button, summary, select, input, textarea, label, canvas, svg, [role=tab], [role=option], [tabindex='0'], a[href^='#']";
  return [...document.querySelectorAll<HTMLElement>(wanted)].flatMap((element): Target[] => {
    const box = element.getBoundingClientRect();
    const [x, y] = [box.x + u * box.width, box.y + v * box.height];
    const isShown = box.width > 1 && box.height > 1 && x >= 0 && y >= 0;
    if (!isShown || x >= innerWidth || y >= innerHeight || element.closest("[inert]") !== null) {
      return [];
    }
    const name = element.getAttribute("aria-label") ?? element.textContent ?? "";
    const isText = element.matches(
      "textarea, input:not([type=checkbox], [type=radio], [type=range], [type=file])",
    );
    const kind = element.matches("select") ? "select" : isText ? "text" : "click";
    return [{ kind, name: `${element.tagName} ${name.trim().slice(0, 40)}`, x, y }];
  });
}

async function act(page: Page, chance: () => number): Promise<string> {
  const oneOf = <T>(list: readonly T[]): T => list[Math.floor(chance() * list.length)] as T;
  const turn = chance();
  if (turn < 0.02) {
    const files = oneOf(FILES);
    await page.getByTestId("file-input").setInputFiles(files);
    return `files ${files.map(({ name }) => name).join(", ")}`;
  }
  if (turn < 0.03) {
    const way = oneOf(["reload", "goBack", "goForward"] as const);
    await page[way]();
    return way;
  }
  if (turn < 0.2) {
    const key = oneOf(KEYS);
    await page.keyboard.press(key);
    return `key ${key}`;
  }
  const found = await page.evaluate(targets, [chance(), chance()] as [number, number]);
  const target = oneOf(found);
  if (target === undefined) {
    return "nothing to do";
  }
  const { kind, name, x, y } = target;
  if (turn > 0.97) {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 80 * (chance() - 0.5), y + 80 * (chance() - 0.5), { steps: 3 });
    await page.mouse.up();
    return `drag ${name}`;
  }
  await page.mouse.click(x, y);
  if (kind === "text") {
    const text = oneOf(TEXTS);
    await page.keyboard.press("Control+a");
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
    return `type '${text}' into ${name}`;
  }
  if (kind === "select") {
    await page.keyboard.press(oneOf(["ArrowDown", "ArrowUp"]));
    await page.keyboard.press("Enter");
  }
  return `${kind} ${name}`;
}

test("a walk at random over the page meets no error, and the core goes on", async ({ page }) => {
  test.setTimeout(120_000 + 2_000 * ACTIONS);
  const { problems } = watch(page);
  const [chance, actions] = [randomFrom(SEED), [] as string[]];
  page.on("console", (message) => {
    if (message.type() === "error") {
      problems.push(`console: ${message.text()}`);
    }
  });
  page.on("crash", () => problems.push("the page crashed"));
  page.on("popup", (popup) => void popup.close());
  page.on("filechooser", (chooser) => void chooser.setFiles([]).catch(() => undefined));
  // Its window waits for a person.
  await page.addInitScript(() => {
    window.print = () => undefined;
  });
  await page.goto("/");
  await openDemo(page);
  await waitForStage(page, "model");
  for (let i = 0; i < ACTIONS; i += 1) {
    actions.push(await act(page, chance));
    // What led there stands above the error.
    expect(problems, `action ${i} of seed ${SEED}:\n${actions.slice(-12).join("\n")}`).toEqual([]);
  }
  await page.goto("/");
  await page.keyboard.press("Escape");
  await showProject(page);
  await openDemo(page);
  await waitForStage(page, "model");
  expect(problems, actions.slice(-12).join("\n")).toEqual([]);
});
