// Archives (.zip, and so .npz) are read by the browser's own means.
import { through } from "./link.js";

const damaged = (/** @type {string} */ how) => new Error(`The archive is ${how}.`);

/**
 * Reads files of an archive.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {(name: string, size: number) => boolean} wanted whether to read a file; `size` is the one that it claims, bytes
 * @param {number} most bytes of a file, even if it claims fewer
 * @returns {Promise<[string, Uint8Array<ArrayBuffer>][] | null>} names and contents; null for files that are not archives
 */
export async function unzip(bytes, wanted, most) {
  const v = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - 22;
  while (end >= 0 && v.getUint32(end, true) !== 0x06054b50) end--;
  if (end < 0) return null;
  /** @type {[string, Uint8Array<ArrayBuffer>][]} */
  const out = [];
  let at = v.getUint32(end + 16, true);
  for (let i = v.getUint16(end + 10, true); i > 0; i--) {
    if (at + 46 > bytes.length) throw damaged("cut off");
    const [flags, method] = [v.getUint16(at + 8, true), v.getUint16(at + 10, true)];
    const [packed, size] = [v.getUint32(at + 20, true), v.getUint32(at + 24, true)];
    const length = v.getUint16(at + 28, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + length));
    const local = v.getUint32(at + 42, true);
    at += 46 + length + v.getUint16(at + 30, true) + v.getUint16(at + 32, true);
    if (!wanted(name, size)) continue;
    if (flags & 1) throw damaged("encrypted");
    if (method !== 0 && method !== 8) throw damaged(`packed in a way that browsers cannot read: ${name} has method ${method}`);
    if (local + 30 > bytes.length) throw damaged("cut off");
    const start = local + 30 + v.getUint16(local + 26, true) + v.getUint16(local + 28, true);
    const raw = bytes.slice(start, start + packed);
    if (method === 0) out.push([name, raw]);
    else out.push([name, await through(raw, new DecompressionStream("deflate-raw"), most).catch((e) => {
      throw /unpacks to/.test(e.message) ? e : damaged(`damaged at ${name}`);
    })]);
  }
  return out;
}
