// Copies the project's Markdown into one folder, as VitePress reads it: `node assemble.mjs FOLDER`. Links between pages lead to their pages
// there. Every other file of the repository that a page links to is copied beside them, so that the site needs no other host.
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { basename, dirname, join, posix, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const HERE = dirname(fileURLToPath(import.meta.url));
const ROOT = resolve(HERE, "../..");

/** Pages outside `docs`, by their place on the site. */
const ELSEWHERE = {
  "python/README.md": "python/index.md",
  "python/docs/from-the-kit.md": "python/from-the-kit.md",
  "python/docs/from-mimo.md": "python/from-mimo.md",
  "python/docs/programs.md": "python/programs.md",
  "python/docs/mujoco.md": "python/mujoco.md",
  "python/docs/learners.md": "python/learners.md",
  "engine/README.md": "rust/engine.md",
  "web/package/README.md": "web/npm.md",
  "policies/README.md": "results/policies.md",
  "conformance/data/README.md": "project/reference-data.md",
  "fuzz/README.md": "project/fuzzing.md",
  "ARCHITECTURE.md": "project/architecture.md",
  "CONTRIBUTING.md": "project/contributing.md",
  "CODE_OF_CONDUCT.md": "project/code-of-conduct.md",
  "SECURITY.md": "project/security.md",
  "CHANGELOG.md": "project/changes.md",
  "changes/README.md": "project/fragments.md",
  "docs/adding.md": "project/adding.md",
};
/** Pages directly in `docs`, not in one of its folders. */
const RESULTS = "results/";

/** The Markdown of `docs`, and where each page goes. */
function pages() {
  const found = new Map(Object.entries(ELSEWHERE));
  for (const file of readdirSync(join(ROOT, "docs"), { recursive: true })) {
    const name = file.replaceAll("\\", "/");
    if (!name.endsWith(".md") || name.includes("node_modules/") || found.has(`docs/${name}`)) continue;
    let place = name.replace(/^site\//, "").replace(/README\.md$/, "index.md");
    if (!name.includes("/")) place = RESULTS + name;
    found.set(`docs/${name}`, place);
  }
  found.set("README.md", "index.md"); // links to the README lead to the front page
  return found;
}

const target = process.argv[2];
if (!target) {
  console.error("usage: node assemble.mjs FOLDER");
  process.exit(2);
}
const folder = resolve(target);
const all = pages();
const problems = [];
rmSync(folder, { recursive: true, force: true });

/** Copies a file that pages link to, and returns its address. */
function copied(file) {
  const place = posix.join("files", file);
  const into = join(folder, "public", place);
  mkdirSync(dirname(into), { recursive: true });
  if (statSync(join(ROOT, file)).isDirectory()) {
    const names = readdirSync(join(ROOT, file)).filter((name) => statSync(join(ROOT, file, name)).isFile());
    mkdirSync(into, { recursive: true });
    for (const name of names) copyFileSync(join(ROOT, file, name), join(into, name));
    const items = names.map((name) => `<li><a href="${encodeURI(name)}">${name}</a></li>`).join("");
    writeFileSync(join(into, "index.html"), `<!doctype html><meta charset="utf-8"><title>${file}</title><h1>${file}</h1><ul>${items}</ul>`);
    return `/${place}/index.html`;
  }
  // browsers show text files only under names that they know
  const text = /\.(rs|py|toml|yml|sh|cff|xml|ipynb)$|\/[A-Z][A-Za-z-]*$/.test(file);
  copyFileSync(join(ROOT, file), into + (text ? ".txt" : ""));
  return `/${place}${text ? ".txt" : ""}`;
}

/** Returns the target of a page's link on the site. */
function moved(page, link) {
  if (/^(https?:|mailto:|#|\/)/.test(link) || link.includes("::")) return link;
  const [path, anchor = ""] = link.split(/(?=#)/);
  const file = posix.join(posix.dirname(page), path);
  const place = all.get(file);
  const from = posix.dirname(all.get(page));
  if (place) return (posix.relative(from, place) || posix.basename(place)) + anchor;
  if (!existsSync(join(ROOT, file))) {
    problems.push(`${page}: ${link} leads nowhere`);
    return link;
  }
  if (/\.(png|svg|gif|webp|webm)$/.test(file)) {
    const into = join(folder, "images", file);
    mkdirSync(dirname(into), { recursive: true });
    copyFileSync(join(ROOT, file), into);
    return posix.join(posix.relative(from, "images") || ".", file).replace(/^(?!\.)/, "./");
  }
  return copied(file) + anchor;
}

/** Adjusts the links of a page, except those in its code. */
function rewritten(page, text) {
  let fence = "";
  const lines = text.split("\n").map((line) => {
    const mark = line.match(/^\s*(```+|~~~+)/)?.[1];
    if (mark && (!fence || line.trim() === fence)) fence = fence ? "" : mark;
    if (fence || mark) return line;
    // code that is not in a link's text holds no links
    return line.replace(/`[^`]*`|(\]\()([^)\s]+)\)/g, (whole, open, link) => (open ? `${open}${moved(page, link)})` : whole));
  });
  return lines.join("\n");
}

for (const [page, place] of all) {
  if (page === "README.md") continue;
  const text = readFileSync(join(ROOT, page), "utf8");
  const into = join(folder, place);
  mkdirSync(dirname(into), { recursive: true });
  writeFileSync(into, rewritten(page, text));
}
// what the front page shows, and the icon
for (const file of ["docs/page.png", "docs/site/public/icon.svg"]) {
  mkdirSync(join(folder, "public"), { recursive: true });
  copyFileSync(join(ROOT, file), join(folder, "public", basename(file)));
}
// readers find the pages of the sidebar only
const listed = JSON.stringify((await import("./.vitepress/sidebar.mjs")).sidebar);
for (const place of all.values()) {
  const link = place === "index.md" || place === "gallery.md" ? "" : `"/${place.replace(/(index)?\.md$/, (_, index) => (index ? "" : ".html"))}"`;
  if (!listed.includes(link)) problems.push(`docs/site/.vitepress/sidebar.mjs lists no ${link}`);
}
for (const problem of problems) console.error(problem);
if (problems.length) process.exit(1);
console.log(`${all.size - 1} pages in ${basename(folder)}`);
