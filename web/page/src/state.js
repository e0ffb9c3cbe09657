// The state of the page: the one for a first visitor, and the valid values from a link or an earlier visit.

/** @typedef {import("./types").PageState} PageState */
/** @typedef {import("./types").PolicyName} PolicyName */

/** The speeds to choose from, in simulated seconds per second. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 16];
/** @type {PolicyName[]} */
const POLICIES = ["babbling", "random", "sine", "zero", "model"];
export const MOST_SEED = 2 ** 32 - 1;

/** The state for a first visitor: an infant in the crib, all senses on. */
/** @type {PageState} */
export const FIRST = {
  settings: { behavior: "self_touch", scene: "crib", vision_active: false, max_episode_steps: 12_000 },
  seed: 0,
  policy: "babbling",
  held: {},
  vigour: 0.6,
  speed: 1,
  locks: [],
  twin: null,
};

const isObject = (/** @type {unknown} */ v) => typeof v === "object" && v !== null && !Array.isArray(v);
const isNumber = (/** @type {unknown} */ v) => typeof v === "number" && Number.isFinite(v);
const isSetting = (/** @type {unknown} */ v) => v === null || typeof v === "string" || typeof v === "boolean" || isNumber(v) || (Array.isArray(v) && v.every((x) => typeof x === "string"));

/** The valid values of each part. @type {Record<keyof PageState, (v: any) => boolean>} */
const ALLOWED = {
  settings: isObject,
  seed: (v) => Number.isInteger(v) && v >= 0 && v <= MOST_SEED,
  policy: (v) => POLICIES.includes(v),
  held: (v) => isObject(v) && Object.entries(v).every(([i, x]) => /^\d+$/.test(i) && isNumber(x)),
  vigour: (v) => isNumber(v) && v >= 0 && v <= 1,
  speed: (v) => SPEEDS.includes(v),
  view: (v) => Array.isArray(v) && v.length === 7 && v.every(isNumber),
  locks: (v) => Array.isArray(v) && v.every((x) => typeof x === "string"),
  twin: (v) => v === null || (isObject(v) && (v.age === null || isNumber(v.age)) && POLICIES.includes(v.policy) && isNumber(v.sensory) && isNumber(v.motor)),
  network: (v) => isObject(v) && typeof v.name === "string" && isNumber(v.size) && (v.url === null || typeof v.url === "string"),
};

/**
 * Reads an external state: keeps valid values, replaces others by defaults and names them.
 * @param {Record<string, unknown>} said
 * @returns {{ state: PageState, refused: string[] }}
 */
export function checked(said) {
  /** @type {string[]} */
  const refused = [];
  const state = structuredClone(FIRST);
  const name = (/** @type {string} */ key, /** @type {unknown} */ value) => refused.push(`${key} ${(JSON.stringify(value) ?? "undefined").slice(0, 40)}`);
  for (const [key, allowed] of Object.entries(ALLOWED)) {
    if (said[key] === undefined) continue;
    if (allowed(said[key])) Object.assign(state, { [key]: said[key] });
    else name(key, said[key]);
  }
  for (const [key, value] of Object.entries(state.settings)) {
    if (isSetting(value)) continue;
    name(key, value);
    delete state.settings[key];
  }
  return { state, refused };
}
