// Faces that the module does not hold: their pictures are separate files.
import { refuse } from "./check.js";
import { bringFace, configKeys } from "./core.js";
import { MissingError } from "./errors.js";
import { checkSource, locate } from "./load.js";
import { guarded, memory } from "./module.js";

/** Faces that exist. */
const brought = new Set(["default"]);

/**
 * Fetches the picture of a face, 20 kB, so that `facial_expression` and {@link Env.swapFacialExpression} can show it. The face that MIMo
 * makes by default is always there.
 * @param {string} name such as `happy`
 * @param {string | URL | Request | Response | BufferSource} [source] by default the file `faces/face_NAME.png` next to this one
 */
export async function loadFace(name, source) {
  checkFace("name", name);
  checkSource(source, [], "an address, a Request, a Response or bytes");
  if (brought.has(name) && source === undefined) return;
  const found = await locate(source, new URL(`./faces/face_${name}.png`, import.meta.url));
  const bytes = await bytesOf(found);
  guarded(() => bringFace(name, bytes));
  brought.add(name);
}

/**
 * @param {Awaited<ReturnType<typeof locate>>} found
 * @returns {Promise<Uint8Array>}
 */
async function bytesOf(found) {
  if (ArrayBuffer.isView(found)) return new Uint8Array(found.buffer, found.byteOffset, found.byteLength);
  if (found instanceof ArrayBuffer) return new Uint8Array(found);
  const answer = found instanceof Response ? found : await fetch(/** @type {Request | URL} */ (found));
  if (!answer.ok) throw new MissingError(`the picture of a face could not be fetched: ${answer.url || "the server"} answered ${answer.status}`);
  return new Uint8Array(await answer.arrayBuffer());
}

/**
 * Refuses faces that the configuration does not have.
 * @param {string} argument
 * @param {unknown} value
 */
export function checkFace(argument, value) {
  memory();
  const { options } = guarded(() => configKeys()).find((/** @type {{ name: string }} */ key) => key.name === "facial_expression");
  if (!options.includes(value)) refuse(argument, value, `a face: ${options.join(", ")}`);
}
