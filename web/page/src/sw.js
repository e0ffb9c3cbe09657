// Caches the page's files, so that it opens without a network and fetches nothing twice, regardless of the host's
// caching headers. Files are identified by their contents: a rebuilt page has another table, and fetches what differs.
/// <reference lib="webworker" />
const scope = /** @type {ServiceWorkerGlobalScope} */ (/** @type {unknown} */ (self));
const CACHE = "babybench files";
const FOLDER = new URL("./", location.href).href;
/**
 * Every file with its SHA-256 and whether a visit needs it; replaced by the build.
 * @type {Record<string, { hash: string, wanted: boolean }>}
 */
const FILES = {};

/** The cache key of a file with these contents. @param {string} name */
const place = (name) => `${FOLDER}${name}?${FILES[name].hash}`;

/** @param {Response} answer */
async function hashOf(answer) {
  const digest = await crypto.subtle.digest("SHA-256", await answer.arrayBuffer());
  return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/**
 * Gets a file: from the cache, from what the browser has just fetched for the page, or from the network.
 * @param {string} name
 * @returns {Promise<Response>}
 */
async function get(name) {
  const cache = await caches.open(CACHE);
  const kept = await cache.match(place(name));
  if (kept) return kept;
  for (const how of /** @type {RequestCache[]} */ (["force-cache", "reload"])) {
    const answer = await fetch(FOLDER + name, { cache: how });
    if (!answer.ok) continue;
    if ((await hashOf(answer.clone())) !== FILES[name].hash) continue; // of another build
    await cache.put(place(name), answer.clone());
    return answer;
  }
  return fetch(FOLDER + name); // the host changes files, or has newer ones
}

/** Deletes files of other builds, and caches of earlier versions. */
async function tidy() {
  for (const key of await caches.keys()) if (key !== CACHE) await caches.delete(key);
  const cache = await caches.open(CACHE);
  const own = new Set(Object.keys(FILES).map(place));
  for (const { url } of await cache.keys()) if (!own.has(url)) await cache.delete(url);
}

scope.addEventListener("install", (e) => {
  const wanted = Object.keys(FILES).filter((name) => FILES[name].wanted);
  e.waitUntil(Promise.all(wanted.map(get)).then(() => scope.skipWaiting()));
});
scope.addEventListener("activate", (e) => e.waitUntil(tidy().then(() => scope.clients.claim())));
scope.addEventListener("fetch", (e) => {
  const url = new URL(e.request.url);
  if (e.request.method !== "GET" || !url.href.startsWith(FOLDER)) return;
  const name = url.href.slice(FOLDER.length).replace(/[?#].*$/, "").replace(/^index\.html$/, "");
  if (name in FILES) e.respondWith(get(name));
});
