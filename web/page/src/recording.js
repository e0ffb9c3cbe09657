// Recordings as files: from the worker's arrays to an archive and back.
import * as npz from "./npz.js";

/** @typedef {import("./types").Recording} Recording */

/**
 * @param {Recording} r
 * @returns {Blob}
 */
export function toFile(r) {
  const width = r.steps ? r.actions.length / r.steps : 0;
  /** @type {Record<string, npz.NumpyArray>} */
  const arrays = {
    qpos0: { shape: [r.qpos0.length], data: r.qpos0 },
    qvel0: { shape: [r.qvel0.length], data: r.qvel0 },
    activity0: { shape: [r.activity0.length], data: r.activity0 },
    actions: { shape: [r.steps, width], data: r.actions },
  };
  if (r.end) arrays.qpos_end = { shape: [r.end.length], data: r.end };
  if (r.yaml !== null) {
    const data = new TextEncoder().encode(r.yaml);
    arrays.config = { shape: [data.length], data };
  }
  return new Blob([npz.write(arrays)], { type: "application/zip" });
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @returns {Promise<Recording>}
 */
export async function fromFile(bytes) {
  const a = await npz.read(bytes);
  const doubles = (/** @type {string} */ name) => (a[name] ? Float64Array.from(a[name].data) : null);
  const [qpos0, qvel0, actions] = [doubles("qpos0"), doubles("qvel0"), a.actions];
  if (!qpos0 || !qvel0 || !actions || actions.shape.length !== 2) {
    throw new Error("The archive is not a recording: it needs the arrays qpos0, qvel0 and actions (steps × actuators).");
  }
  return {
    qpos0,
    qvel0,
    activity0: doubles("activity0") ?? new Float64Array(0),
    actions: Float32Array.from(actions.data),
    steps: actions.shape[0],
    yaml: a.config ? new TextDecoder().decode(/** @type {Uint8Array<ArrayBuffer>} */ (a.config.data)) : null,
    end: doubles("qpos_end") ?? lastRow(a.qpos),
  };
}

/** @param {npz.NumpyArray | undefined} a */
function lastRow(a) {
  if (!a || a.shape.length !== 2 || !(a.data instanceof Float64Array) || a.shape[0] === 0) return null;
  return a.data.slice(-a.shape[1]);
}
