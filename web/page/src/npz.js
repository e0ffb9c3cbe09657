// NumPy archives, read and written: what `babybench replay` takes, and what NumPy's savez and savez_compressed write.
import { unzip } from "./zip.js";

/** @typedef {{ shape: number[], data: Float64Array | Float32Array | Uint8Array }} NumpyArray */

const TYPES = /** @type {const} */ ({ "<f8": Float64Array, "<f4": Float32Array, "|u1": Uint8Array });
/** Largest array that is read, bytes. */
const MOST = 256 << 20;

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});

/** @param {Uint8Array} bytes */
function crc32(bytes) {
  let c = 0xffffffff;
  for (const b of bytes) c = CRC[(c ^ b) & 0xff] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/**
 * @param {NumpyArray} array
 * @returns {Uint8Array<ArrayBuffer>}
 */
function npy({ shape, data }) {
  const descr = Object.entries(TYPES).find(([, T]) => data instanceof T)?.[0];
  const tuple = shape.length === 1 ? `(${shape[0]},)` : `(${shape.join(", ")})`;
  let header = `{'descr': '${descr}', 'fortran_order': False, 'shape': ${tuple}, }`;
  header = header.padEnd(Math.ceil((10 + header.length + 1) / 64) * 64 - 11) + "\n";
  const out = new Uint8Array(10 + header.length + data.byteLength);
  out.set([0x93, ...new TextEncoder().encode("NUMPY"), 1, 0, header.length & 0xff, header.length >> 8]);
  out.set(new TextEncoder().encode(header), 10);
  out.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), 10 + header.length);
  return out;
}

/**
 * Writes an archive of arrays, not compressed.
 * @param {Record<string, NumpyArray>} arrays
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function write(arrays) {
  /** @type {Uint8Array[]} */
  const parts = [];
  /** @type {Uint8Array[]} */
  const directory = [];
  let at = 0;
  for (const [key, array] of Object.entries(arrays)) {
    const [name, body] = [new TextEncoder().encode(`${key}.npy`), npy(array)];
    // version 2.0, stored, 1980-01-01
    const common = new Uint8Array(26);
    const v = new DataView(common.buffer);
    v.setUint16(0, 20, true);
    v.setUint16(8, 0x21, true);
    v.setUint32(10, crc32(body), true);
    v.setUint32(14, body.length, true);
    v.setUint32(18, body.length, true);
    v.setUint16(22, name.length, true);
    parts.push(new Uint8Array([0x50, 0x4b, 3, 4]), common, name, body);
    const entry = new Uint8Array(46);
    entry.set([0x50, 0x4b, 1, 2, 20, 0]);
    entry.set(common, 6);
    new DataView(entry.buffer).setUint32(42, at, true);
    directory.push(entry, name);
    at += 30 + name.length + body.length;
  }
  const size = directory.reduce((n, d) => n + d.length, 0);
  const end = new Uint8Array(22);
  const v = new DataView(end.buffer);
  v.setUint32(0, 0x06054b50, true);
  v.setUint16(8, directory.length / 2, true);
  v.setUint16(10, directory.length / 2, true);
  v.setUint32(12, size, true);
  v.setUint32(16, at, true);
  const all = [...parts, ...directory, end];
  const out = new Uint8Array(at + size + 22);
  let o = 0;
  for (const part of all) {
    out.set(part, o);
    o += part.length;
  }
  return out;
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {string} name
 * @returns {NumpyArray | null} nothing for a type that the page has no use for
 */
function parse(bytes, name) {
  if (String.fromCharCode(...bytes.subarray(1, 6)) !== "NUMPY") throw new Error(`${name} in the archive is not a NumPy array.`);
  const v = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const wide = bytes[6] > 1;
  const [start, length] = wide ? [12, v.getUint32(8, true)] : [10, v.getUint16(8, true)];
  const header = new TextDecoder("latin1").decode(bytes.subarray(start, start + length));
  const descr = /'descr':\s*'([^']+)'/.exec(header)?.[1] ?? "";
  const shape = (/'shape':\s*\(([^)]*)\)/.exec(header)?.[1] ?? "").split(",").filter((s) => s.trim()).map(Number);
  const Type = TYPES[/** @type {keyof typeof TYPES} */ (descr)];
  if (!Type || /'fortran_order':\s*True/.test(header)) return null;
  const count = shape.reduce((a, b) => a * b, 1);
  const body = bytes.slice(start + length);
  if (!Number.isSafeInteger(count) || count * Type.BYTES_PER_ELEMENT > body.byteLength) throw new Error(`${name} in the archive is cut off.`);
  return { shape, data: new Type(body.buffer, 0, count) };
}

/**
 * Reads the arrays of an archive.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @returns {Promise<Record<string, NumpyArray>>}
 */
export async function read(bytes) {
  const files = await unzip(bytes, (_, size) => size <= MOST, MOST);
  if (!files) throw new Error("The file is not a NumPy archive (.npz).");
  /** @type {Record<string, NumpyArray>} */
  const out = {};
  for (const [file, body] of files) {
    const name = file.replace(/\.npy$/, "");
    const array = parse(body, name);
    if (array) out[name] = array;
  }
  return out;
}
