// Configurations as text.

/**
 * Writes values by key as YAML, one line each; a text stays as it is.
 * @param {import("./types.js").Settings | string} config
 * @returns {string}
 */
export function yamlOf(config) {
  if (typeof config === "string") return config;
  return Object.entries(config)
    .filter(([, value]) => value !== undefined)
    .map(([key, value]) => `${scalar(key)}: ${scalar(value)}\n`)
    .join("");
}

/**
 * Writes a value. Words stay plain, as choices are; what could be read as something else goes into quotes.
 * @param {unknown} value
 */
function scalar(value) {
  if (typeof value !== "string") return JSON.stringify(value) ?? "null";
  const plain = /^[A-Za-z][\w/.-]*$/.test(value) && !/^(true|false|yes|no|on|off|null|y|n)$/i.test(value);
  return plain ? value : JSON.stringify(value);
}
