// The state of the page in its link: JSON, deflated, in the fragment, which no server sees.

/** @typedef {import("./types").PageState} PageState */

/**
 * @param {Uint8Array} bytes
 * @returns {string}
 */
export function base64(bytes) {
  let text = "";
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

/**
 * @param {string} text
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function unbase64(text) {
  return Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (c) => c.charCodeAt(0));
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {CompressionStream | DecompressionStream} stream
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/**
 * @param {PageState} state
 * @param {Uint8Array<ArrayBuffer> | null} snapshot
 * @returns {Promise<string>} the fragment, without #
 */
export async function encode(state, snapshot) {
  const json = new TextEncoder().encode(JSON.stringify(state));
  const parts = [`s=${base64(await through(json, new CompressionStream("deflate-raw")))}`];
  if (snapshot) parts.push(`m=${base64(await through(snapshot, new CompressionStream("deflate-raw")))}`);
  return parts.join("&");
}

/**
 * @param {string} hash
 * @returns {Promise<{ state: Partial<PageState>, snapshot: Uint8Array<ArrayBuffer> | null } | null>} nothing for a link without state
 */
export async function decode(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const [s, m] = [query.get("s"), query.get("m")];
  if (!s) return null;
  const open = async (/** @type {string} */ text) => through(unbase64(text), new DecompressionStream("deflate-raw"));
  const state = JSON.parse(new TextDecoder().decode(await open(s)));
  if (typeof state !== "object" || state === null) throw new Error("the link holds no state");
  return { state, snapshot: m ? await open(m) : null };
}

/**
 * Puts the state into the address without a new entry in the history.
 * @param {string} fragment
 */
export function show(fragment) {
  history.replaceState(null, "", `#${fragment}`);
}
