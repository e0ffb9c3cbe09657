// The state of the page in its link: JSON, deflated, in the fragment, which no server sees.

/** @typedef {import("./types").PageState} PageState */

/** Maximum unpacked size of a part of a link, bytes: a snapshot has less than a tenth of it. */
const MOST = 8 << 20;

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
 * @param {number} most bytes of output allowed
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function through(bytes, stream, most) {
  /** @type {Uint8Array<ArrayBuffer>[]} */
  const parts = [];
  let size = 0;
  for await (const part of new Blob([bytes]).stream().pipeThrough(stream)) {
    size += part.length;
    if (size > most) throw new Error(`it unpacks to more than ${most >> 20} MB`);
    parts.push(part);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** @param {Uint8Array<ArrayBuffer>} bytes */
export const pack = (bytes) => through(bytes, new CompressionStream("deflate-raw"), Infinity);

/** @typedef {import("./room.js").Files} Files */
/** The contents of a link: a state, its snapshot, the second MIMo, the network that moves MIMo, the files of a custom room. */
/** @typedef {{ state: Record<string, any>, snapshot: Uint8Array<ArrayBuffer> | null, second: Uint8Array<ArrayBuffer> | null, network: Uint8Array<ArrayBuffer> | null, room: Files | null }} Link */

/** @param {Files} files */
export const packFiles = (files) => pack(new TextEncoder().encode(JSON.stringify(Object.entries(files).map(([path, bytes]) => [path, base64(bytes)]))));

/**
 * @param {PageState} state
 * @param {Uint8Array<ArrayBuffer> | null} snapshot
 * @param {Uint8Array<ArrayBuffer> | null} second likewise, of the MIMo beside him
 * @param {Uint8Array<ArrayBuffer> | null} network packed
 * @param {Uint8Array<ArrayBuffer> | null} room packed
 * @returns {Promise<string>} the fragment, without #
 */
export async function encode(state, snapshot, second, network, room) {
  const parts = [`s=${base64(await pack(new TextEncoder().encode(JSON.stringify(state))))}`];
  if (snapshot) parts.push(`m=${base64(await pack(snapshot))}`);
  if (second) parts.push(`t=${base64(await pack(second))}`);
  if (room) parts.push(`r=${base64(room)}`);
  if (network) parts.push(`n=${base64(network)}`);
  return parts.join("&");
}

/**
 * @param {string} hash
 * @returns {Promise<Link | null>} nothing for a link without state
 */
export async function decode(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const open = async (/** @type {string} */ text) => through(unbase64(text), new DecompressionStream("deflate-raw"), MOST);
  const part = async (/** @type {string} */ name) => (query.get(name) ? open(/** @type {string} */ (query.get(name))) : null);
  const said = await part("s");
  if (!said) return null;
  const state = JSON.parse(new TextDecoder().decode(said));
  if (typeof state !== "object" || state === null) throw new Error("the link holds no state");
  const room = await part("r");
  /** @type {[string, string][] | null} */
  const files = room && JSON.parse(new TextDecoder().decode(room));
  return { state, snapshot: await part("m"), second: await part("t"), network: await part("n"), room: files && Object.fromEntries(files.map(([path, bytes]) => [path, unbase64(bytes)])) };
}
