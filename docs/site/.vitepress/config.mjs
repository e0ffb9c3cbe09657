// The site: https://vitepress.dev/reference/site-config. `scripts/site.sh` builds it and says where its parts are.
import { sidebar } from "./sidebar.mjs";

const { SITE_SOURCE, SITE_OUT, SITE_VERSION = "", SITE_BASE = "/", SITE_QUICK } = process.env;

/** Settings for a build that only checks the pages: code is not highlighted, scripts are not minified. */
const escape = (text) => text.replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);
const quick = { markdown: { highlight: (text) => `<pre v-pre><code>${escape(text)}</code></pre>` }, vite: { build: { minify: false } } };

/** Anchors as code hosts make them, so that a link to a heading works in both places. */
const slugify = (heading) =>
  heading
    .toLowerCase()
    .replace(/[^\p{L}\p{N}\p{M}\s_-]/gu, "")
    .trim()
    .replace(/\s/g, "-");

export default {
  title: "babybench",
  description: "An infant who learns about his own body, for Rust, Python and web pages",
  lang: "en",
  base: SITE_BASE,
  srcDir: SITE_SOURCE,
  outDir: SITE_OUT,
  cacheDir: `${SITE_SOURCE}-cache`,
  cleanUrls: false,
  metaChunk: true,
  head: [["link", { rel: "icon", href: `${SITE_BASE}icon.svg` }]],
  markdown: {
    html: false, // what looks like an element in these pages is text
    anchor: { slugify },
    toc: { slugify },
    image: { lazyLoading: true },
    theme: { light: "github-light-high-contrast", dark: "github-dark" },
    ...(SITE_QUICK ? quick.markdown : {}),
  },
  ...(SITE_QUICK ? { vite: quick.vite } : {}),
  // other parts of the site, which VitePress does not build; scripts/site.sh checks these links
  ignoreDeadLinks: [/^\/(reference|live|files)\//],
  themeConfig: {
    outline: { level: [2, 3], label: "On this page" },
    nav: [
      { text: "Start", link: "/tutorials/", activeMatch: "^/tutorials/" },
      { text: "Guide", link: "/guide/", activeMatch: "^/(guide|python|rust|web)/" },
      {
        text: "Reference",
        items: [
          { text: "Python", link: "/reference/python/babybench.html", target: "_self" },
          { text: "Rust", link: "/reference/rust/babybench/index.html", target: "_self" },
          { text: "JavaScript", link: "/reference/npm/index.html", target: "_self" },
          { text: "Configuration keys", link: "/guide/configuration.html" },
          { text: "Glossary", link: "/guide/glossary.html" },
        ],
      },
      { text: "Results", link: "/results/benchmark.html", activeMatch: "^/results/" },
      { text: "Gallery", link: "/gallery.html" },
      { text: "Live", link: "/live/index.html", target: "_self" },
      ...(SITE_VERSION ? [{ text: SITE_VERSION.split(" ")[0], link: "/results/versions.html" }] : []),
    ],
    sidebar,
    docFooter: { prev: "Before", next: "Next" },
    footer: { message: `babybench ${SITE_VERSION} · MIT or Apache-2.0` },
  },
};
