// Finds and starts a WebAssembly module, in browsers and in Node.
import { refuse } from "./check.js";

/** @typedef {string | URL | Request | Response | BufferSource | WebAssembly.Module} Source */

/**
 * Finds the bytes of a module: the caller's, or the file next to this one.
 * @param {Source | undefined} source
 * @param {URL} beside where the file is, unless the caller says otherwise
 * @returns {Promise<Request | Response | URL | BufferSource | WebAssembly.Module>}
 */
export async function locate(source, beside) {
  if (typeof source !== "string" && source !== undefined && !(source instanceof URL)) return source;
  const url = source === undefined ? beside : new URL(source, beside);
  if (url.protocol !== "file:") return url;
  // node's fetch does not read files
  const { readFile } = await import("node:fs/promises");
  return readFile(url);
}

/**
 * Starts a module once; a start that failed can be tried again.
 * @template T
 * @param {(source?: Source) => Promise<T>} start
 * @returns {(source?: Source) => Promise<T>}
 */
export function once(start) {
  /** @type {Promise<T> | undefined} */
  let started;
  return async (source) => {
    checkSource(source, [WebAssembly.Module], "an address, a Request, a Response, bytes or a WebAssembly.Module");
    started ??= start(source).catch((/** @type {unknown} */ error) => {
      started = undefined;
      throw error;
    });
    return started;
  };
}

/**
 * @param {unknown} source
 * @param {Function[]} more classes that it may have, besides those of a file
 * @param {string} expected
 */
export function checkSource(source, more, expected) {
  const kinds = [URL, Request, Response, ArrayBuffer, ...more];
  const right = (typeof source === "string" && source !== "") || ArrayBuffer.isView(source) || kinds.some((kind) => source instanceof kind);
  if (source !== undefined && !right) refuse("source", source, expected);
}
