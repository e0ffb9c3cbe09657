// Makes the page's files: `node build.mjs OUT_DIR`. Sources are plain modules; esbuild joins and minifies them, and
// drops what the page does not use of three.js.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { brotliCompress, constants, gzipSync } from "node:zlib";
import { lean } from "./lean.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) throw new Error("Say where the page goes: node build.mjs OUT_DIR");
mkdirSync(out, { recursive: true });

/** The package is a separate file, not bundled with the page, because it loads its module from its own folder. */
const packageBeside = {
  name: "package beside the page",
  setup(b) {
    b.onResolve({ filter: /^babybench\// }, ({ path }) => ({ path: `./${path}`, external: true }));
  },
};
await build({
  entryPoints: { main: join(here, "src/main.js"), worker: join(here, "src/worker/main.js") },
  outdir: out,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  plugins: [lean(join(here, "../node_modules/three")), packageBeside],
  logLevel: "warning",
});
const css = ["tokens", "layout", "controls"].map((name) => readFileSync(join(here, `css/${name}.css`), "utf8")).join("\n");
await build({ stdin: { contents: css, loader: "css" }, outfile: join(out, "page.css"), minify: true, logLevel: "warning" });
// previews of links to the page need absolute addresses: PAGE_URL is that of the page
const home = process.env.PAGE_URL;
const html = readFileSync(join(here, "index.html"), "utf8");
writeFileSync(join(out, "index.html"), home ? html.replace('content="./card.png"', `content="${new URL("card.png", home.endsWith("/") ? home : `${home}/`).href}"`) : html);
for (const file of ["icon.svg", "page.webmanifest"]) copyFileSync(join(here, file), join(out, file));
copyFileSync(join(here, "../../cli/src/commands/scene/room.xml"), join(out, "room.xml"));
copyFileSync(join(here, "../../docs/page.png"), join(out, "card.png"));
mkdirSync(join(out, "policies"), { recursive: true });
for (const file of readdirSync(join(here, "../../policies")).filter((name) => name.endsWith(".onnx"))) copyFileSync(join(here, "../../policies", file), join(out, "policies", file));
const font = join(here, "../node_modules/@fontsource-variable/inter");
copyFileSync(join(font, "files/inter-latin-wght-normal.woff2"), join(out, "inter.woff2"));
const licenses = { "three.js": "three/LICENSE", Inter: "@fontsource-variable/inter/LICENSE" };
const texts = Object.entries(licenses).map(([name, file]) => `${name}\n\n${readFileSync(join(here, "../node_modules", file), "utf8")}`);
writeFileSync(join(out, "LICENSES.txt"), texts.join("\n\n----\n\n"));

// files that a visit needs are cached for the next one, by their contents; models and their module only after first use
const files = readdirSync(out, { recursive: true, withFileTypes: true })
  .filter((f) => f.isFile())
  .map((f) => relative(out, join(f.parentPath, f.name)).replaceAll("\\", "/"))
  .filter((f) => /^(index\.html|page\.css|main\.js|worker\.js|inter\.woff2|icon\.svg|room\.xml|page\.webmanifest)$|^babybench\/\w+\.(js|wasm)$|^babybench\/faces\/\w+\.png$|^policies\/\w+\.onnx$/.test(f))
  .sort();
const table = Object.fromEntries(files.map((f) => [f === "index.html" ? "" : f, { hash: createHash("sha256").update(readFileSync(join(out, f))).digest("hex"), wanted: !/onnx|remote|babybench\/(worker|faces)/.test(f) }]));
const sw = readFileSync(join(here, "src/sw.js"), "utf8").replace("const FILES = {};", `const FILES = ${JSON.stringify(table)};`);
await build({ stdin: { contents: sw }, outfile: join(out, "sw.js"), minify: true, logLevel: "warning" });

// compressed by Brotli, for hosts that serve such files; it takes too long for each request
const pack = promisify(brotliCompress);
const packed = readdirSync(out, { recursive: true, withFileTypes: true }).filter((f) => f.isFile() && /\.(html|js|css|wasm|onnx)$/.test(f.name));
await Promise.all(packed.map(async (f) => {
  const bytes = readFileSync(join(f.parentPath, f.name));
  writeFileSync(join(f.parentPath, `${f.name}.br`), await pack(bytes, { params: { [constants.BROTLI_PARAM_LGWIN]: constants.BROTLI_MAX_WINDOW_BITS, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } }));
}));

const scripts = ["main.js", "worker.js", "sw.js"].map((name) => ({ name, raw: statSync(join(out, name)).size, gzip: gzipSync(readFileSync(join(out, name)), { level: 9 }).length }));
for (const s of scripts) console.log(`${s.name}: ${s.raw} bytes, ${s.gzip} gzip`);
const total = scripts.reduce((n, s) => n + s.gzip, 0);
console.log(`JavaScript of the page: ${total} bytes gzip`);
if (total > 160 * 1024) throw new Error("The page's JavaScript is larger than 160 KB gzip.");
