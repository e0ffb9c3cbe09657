// Checks of arguments before they reach the module, which would take `1.5` for 1 and trap on a number instead of a text.
import { ArgumentError } from "./errors.js";

const MOST_SEED = 2n ** 64n - 1n;
/** Largest whole number that the module takes. */
const MOST_WHOLE = 2 ** 32 - 1;

/**
 * Describes a value, for messages.
 * @param {unknown} value
 */
export function shown(value) {
  if (typeof value === "string") return JSON.stringify(value.length > 40 ? `${value.slice(0, 40)}…` : value);
  if (typeof value === "bigint") return `${value}n`;
  if (typeof value === "function") return "a function";
  if (Array.isArray(value)) return `an array of ${value.length}`;
  if (typeof value === "object" && value !== null) return `an object (${value.constructor?.name ?? "without a class"})`;
  return String(value);
}

/**
 * @param {string} name
 * @param {unknown} value
 * @param {string} expected
 * @returns {never}
 */
export function refuse(name, value, expected) {
  throw new ArgumentError(name, `${shown(value)} is not ${expected}`);
}

/**
 * @param {string} name
 * @param {unknown} value
 * @returns {bigint}
 */
export function seed(name, value) {
  if (typeof value === "number" && Number.isSafeInteger(value) && value >= 0) return BigInt(value);
  if (typeof value === "bigint" && value >= 0n && value <= MOST_SEED) return value;
  return refuse(name, value, "a whole number from 0 to 2^53 - 1, or a bigint below 2^64");
}

/**
 * @param {string} name
 * @param {unknown} value
 * @param {number} [least]
 * @param {number} [most]
 * @returns {number}
 */
export function whole(name, value, least = 0, most = MOST_WHOLE) {
  if (typeof value === "number" && Number.isInteger(value) && value >= least && value <= most) return value;
  return refuse(name, value, `a whole number from ${least} to ${most}`);
}

/**
 * @param {string} name
 * @param {unknown} value
 * @returns {number}
 */
export function finite(name, value) {
  return typeof value === "number" && Number.isFinite(value) ? value : refuse(name, value, "a finite number");
}

/**
 * @param {string} name
 * @param {unknown} value
 * @returns {string}
 */
export function text(name, value) {
  return typeof value === "string" ? value : refuse(name, value, "a text");
}

/**
 * @param {string} name
 * @param {unknown} value
 * @returns {boolean}
 */
export function flag(name, value) {
  return typeof value === "boolean" ? value : refuse(name, value, "true or false");
}

/**
 * @param {string} name
 * @param {unknown} value
 * @returns {Uint8Array}
 */
export function bytes(name, value) {
  return value instanceof Uint8Array ? value : refuse(name, value, "a Uint8Array");
}

/**
 * Reads files by path; a text becomes UTF-8.
 * @param {string} name
 * @param {unknown} value
 * @returns {{ paths: string[], contents: Uint8Array[] }}
 */
export function files(name, value) {
  if (typeof value !== "object" || value === null || Array.isArray(value) || ArrayBuffer.isView(value)) return refuse(name, value, "an object of files by path");
  const entries = Object.entries(value);
  const contents = entries.map(([path, file]) => {
    if (typeof file === "string") return new TextEncoder().encode(file);
    return file instanceof Uint8Array ? file : refuse(`${name}[${JSON.stringify(path)}]`, file, "a text or a Uint8Array");
  });
  return { paths: entries.map(([path]) => path), contents };
}

/**
 * Whether something is an array or a typed array.
 * @param {unknown} value
 * @returns {value is ArrayLike<number>}
 */
const isList = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView) && !(value instanceof BigInt64Array) && !(value instanceof BigUint64Array));

/**
 * Reads finite numbers.
 * @param {string} name
 * @param {unknown} value
 * @param {number} [length] how many there must be
 * @returns {Float64Array}
 */
export function numbers(name, value, length) {
  if (!isList(value)) return refuse(name, value, "an array of numbers");
  if (length !== undefined && value.length !== length) throw new ArgumentError(name, `it has ${value.length} values but needs ${length}${emptied(value)}`);
  for (let i = 0; i < value.length; i++) if (!Number.isFinite(value[i])) refuse(`${name}[${i}]`, value[i], "a finite number");
  return Float64Array.from(value);
}

/**
 * Explains why a view of the module's memory has become empty, if it has.
 * @param {ArrayLike<number>} value
 */
function emptied(value) {
  if (!ArrayBuffer.isView(value) || value.buffer.byteLength > 0) return "";
  return "; it is a view from before the module's memory grew, read it again";
}

/**
 * Reads rows of numbers, one after the other.
 * @param {string} name
 * @param {unknown} value
 * @returns {Float64Array}
 */
export function rows(name, value) {
  if (!Array.isArray(value)) return refuse(name, value, "an array of rows of numbers");
  const read = value.map((row, i) => numbers(`${name}[${i}]`, row, i > 0 ? value[0].length : undefined));
  const all = new Float64Array(read.reduce((sum, row) => sum + row.length, 0));
  read.reduce((at, row) => (all.set(row, at), at + row.length), 0);
  return all;
}

/**
 * Reads a free camera: the point it looks at, distance, azimuth and elevation.
 * @param {string} name
 * @param {unknown} value
 * @returns {Float64Array}
 */
export function camera(name, value) {
  if (typeof value !== "object" || value === null) return refuse(name, value, "the name of a camera, or a free one");
  const { lookat, distance, azimuth, elevation } = /** @type {import("./types.js").FreeCamera} */ (value);
  const rest = Object.entries({ distance, azimuth, elevation }).map(([key, v]) => finite(`${name}.${key}`, v));
  return Float64Array.from([...numbers(`${name}.lookat`, lookat, 3), ...rest]);
}
