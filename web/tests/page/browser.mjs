// A browser with the page in it. DIST names the folder with the built page; CHROMIUM another browser.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { serve } from "../../page/serve.mjs";
import { launch } from "../launch.mjs";

export const dist = process.env.DIST ?? fileURLToPath(new URL("../../dist", import.meta.url));
/** Maximum time that a test waits for the page, ms. */
const PATIENCE = Number(process.env.PATIENCE ?? 120_000);
const ARGS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb", "--font-render-hinting=none"];

/** Starts the browser and the server; the page lies in a subfolder, as it may. */
export async function start(how = {}) {
  const browser = await launch(...ARGS);
  const server = await serve(dist, 0, "/some/folder/", how);
  return {
    browser,
    url: server.url,
    /** Opens the page and waits for its first picture. */
    async open({ hash = "", query = "?paused", width = 900, height = 640, scheme = "light", before = undefined, wait = true, routes = {}, ...more } = {}) {
      const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, reducedMotion: "no-preference", acceptDownloads: true, bypassCSP: true, ...more });
      const page = await context.newPage();
      page.errors = [];
      page.on("pageerror", (e) => page.errors.push(e.message));
      page.on("console", (m) => m.type() === "error" && page.errors.push(m.text()));
      for (const [name, body] of Object.entries(routes)) await page.route(`**/${name}`, (route) => route.fulfill({ body }));
      if (before) await page.addInitScript(before);
      await page.goto(`${server.url}${query}${hash}`);
      if (wait) await ready(page);
      return page;
    },
    /** Stops the server, as a network that fails. */
    hangUp: () => server.close(),
    async stop() {
      await browser.close();
      server.close();
    },
  };
}

/** Waits until a scene has been drawn. */
export const ready = (page) => page.waitForFunction(() => globalThis.mimo?.scene && globalThis.mimo.stage.frames > 0 && document.getElementById("veil").classList.contains("gone"), null, { timeout: PATIENCE });

/** Waits until a predicate of the page holds. */
export const until = (page, predicate, argument) => page.waitForFunction(predicate, argument, { timeout: PATIENCE });

/** Steps the world without the clock and returns when it is drawn. */
export const steps = (page, n) => page.evaluate((k) => mimo.world.ask("step", k).then(() => new Promise((done) => { mimo.stage.after.push(done); mimo.stage.invalidate(); })), n);

/** Returns the checksum of the world. */
export const checksum = (page) => page.evaluate(() => mimo.world.ask("checksum"));

/** A network, what it was made for, and how a file is dropped on the page. */
export const network = (name) => readFileSync(join(import.meta.dirname, `../../../tests/data/policies/${name}.onnx`));
const parts = ["hands", "fingers", "arms", "feet", "legs", "body", "head"];
export const eyesOnly = {
  behavior: "self_touch",
  touch_active: false,
  vision_active: false,
  ...Object.fromEntries(["velocity", "torque", "limits", "actuation"].map((what) => [`proprio_${what}`, false])),
  ...Object.fromEntries(parts.map((part) => [`act_${part}`, false])),
};
export const drop = (page, name, bytes) => page.evaluate(([file, numbers]) => {
  const data = new DataTransfer();
  data.items.add(new File([Uint8Array.from(numbers)], file));
  document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
}, [name, [...bytes]]);

/** Opens a tab of the panel. */
export const tab = (page, name) => page.getByRole("tab", { name }).click();

/** Returns the mean and the largest difference of two pictures, of 255; the browser decodes them. */
export function difference(page, a, b) {
  return page.evaluate(async (pictures) => {
    const [x, y] = await Promise.all(pictures.map(async (text) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
      const c = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
      c.drawImage(bitmap, 0, 0);
      return c.getImageData(0, 0, bitmap.width, bitmap.height);
    }));
    if (x.width !== y.width || x.height !== y.height) return { mean: 255, most: 255 };
    let [sum, most] = [0, 0];
    for (let i = 0; i < x.data.length; i++) {
      const d = Math.abs(x.data[i] - y.data[i]);
      sum += d;
      most = Math.max(most, d);
    }
    return { mean: sum / (0.75 * x.data.length), most };
  }, [a, b].map((p) => p.toString("base64")));
}

/** Reads a file beside the tests; undefined where there is none. */
export function beside(name) {
  try {
    return readFileSync(join(import.meta.dirname, name));
  } catch {
    return undefined;
  }
}
