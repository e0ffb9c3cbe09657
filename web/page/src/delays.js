// Delays of MIMo's senses and actions, in milliseconds.

/** @typedef {import("./types").Settings} Settings */

/** Every key that counts in `delay_unit`. */
const DELAYS = ["delay_sensory", "delay_motor", "delay_proprioception", "delay_touch", "delay_vestibular", "delay_vision"];

/**
 * Returns the length of a configuration's unit of delay, ms.
 * @param {Settings} settings
 * @param {number} [seconds] of a step
 */
export const unit = (settings, seconds = 0.005) => (settings.delay_unit === "ms" ? 1 : 1000 * seconds);

/**
 * Returns all delays of a configuration in milliseconds.
 * @param {Settings} settings
 * @param {number} [seconds] of a step
 * @returns {Settings}
 */
export function inMilliseconds(settings, seconds) {
  const counted = DELAYS.filter((name) => typeof settings[name] === "number");
  return { ...Object.fromEntries(counted.map((name) => [name, unit(settings, seconds) * Number(settings[name])])), delay_unit: "ms" };
}
