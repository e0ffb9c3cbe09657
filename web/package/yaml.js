// Configurations as text.
import { refuse } from "./check.js";

/**
 * Writes values by key as YAML, one line each. A text is returned unchanged.
 * @param {import("./types.js").Settings | string} config
 * @returns {string}
 */
export function yamlOf(config) {
  if (typeof config === "string") return config;
  if (typeof config !== "object" || config === null || Array.isArray(config) || ArrayBuffer.isView(config)) refuse("config", config, "an object of values by key, or the text of a YAML file");
  return Object.entries(config)
    .filter(([, value]) => value !== undefined)
    .map(([key, value]) => `${scalar(key)}: ${written(key, value)}\n`)
    .join("");
}

/**
 * Writes the value of a key. What JSON would write as `null`, and so as a default, is refused.
 * @param {string} key
 * @param {unknown} value
 */
function written(key, value) {
  const name = `config.${key}`;
  if (typeof value === "number" && !Number.isFinite(value)) return refuse(name, value, "a finite number");
  if (Array.isArray(value) && value.every((v) => typeof v === "string")) return `[${value.map(scalar).join(", ")}]`;
  if (value === null || ["number", "string", "boolean"].includes(typeof value)) return scalar(value);
  return refuse(name, value, "a text, a number, true, false, null or an array of texts");
}

/**
 * Writes a value. Words stay plain; text that could be read as another value is quoted.
 * @param {unknown} value
 */
function scalar(value) {
  if (typeof value !== "string") return JSON.stringify(value);
  const plain = /^[A-Za-z][\w/.-]*$/.test(value) && !/^(true|false|yes|no|on|off|null|y|n)$/i.test(value);
  return plain ? value : JSON.stringify(value);
}
