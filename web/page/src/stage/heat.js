// The colours of touch: from a warm blush over orange to a bright core. Their lightness rises with the force, so they
// read in grey, too.

/** Colours at equal distances, sRGB. */
export const HEAT = /** @type {const} */ ([
  [0.55, 0.09, 0.36],
  [0.86, 0.16, 0.3],
  [0.98, 0.42, 0.16],
  [1.0, 0.75, 0.2],
  [1.0, 0.96, 0.72],
]);

/** Forces at the ends of the scale, N: a sensor glows from the first force on, and is brightest at the last. */
export const SCALE = /** @type {const} */ ([0, 0.1, 1, 10]);

/**
 * Returns the place of a force on the scale, 0 to 1: logarithmic, as perceived intensity is.
 * @param {number} newton
 */
export const place = (newton) => Math.min(1, Math.log(1 + 20 * newton) / Math.log(201));

const vec = (/** @type {readonly number[]} */ c) => `vec3(${c.map((v) => v.toFixed(3)).join(",")})`;

/** The same scale as a shader function. The result is linear light. */
export const HEAT_GLSL = /* glsl */ `
vec3 heat(float x) {
  vec3 c[${HEAT.length}] = vec3[${HEAT.length}](${HEAT.map(vec).join(",")});
  float s = clamp(x, 0.0, 1.0) * ${(HEAT.length - 1).toFixed(1)};
  int i = min(int(s), ${HEAT.length - 2});
  return pow(mix(c[i], c[i + 1], s - float(i)), vec3(2.2));
}`;

/** The scale as a CSS gradient. */
export const heatGradient = () =>
  `linear-gradient(90deg, ${HEAT.map((c) => `rgb(${c.map((v) => Math.round(255 * v)).join(" ")})`).join(", ")})`;
