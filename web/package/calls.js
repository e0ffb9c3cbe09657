// Calls of an environment that a worker answers, by name.

export const METHODS = /** @type {const} */ ([
  "reset", "resetTo", "setState", "setActivity", "setGoal", "step", "computeReward", "sampleAction", "seedActionSpace", "update",
  "texturePixels", "lock", "unlock", "swapFacialExpression", "snapshot", "restore", "applyForce", "releaseForces", "draw", "lookThroughEyes", "deferVision",
  "drawEyes", "checksum", "view", "free",
]);
export const PROPERTIES = /** @type {const} */ ([
  "config", "yaml", "observation", "action", "info", "time", "model", "look", "skin", "proprioceptionNames", "locked", "eyeSizes", "visionDelay",
]);

/** @typedef {typeof METHODS[number] | typeof PROPERTIES[number]} Asked */
/** @typedef {import("./env.js").Env} Env */
/**
 * The arguments of a method call; none for a property.
 * @template {Asked} K
 * @typedef {Env[K] extends (...args: infer A) => unknown ? A : []} Arguments
 */
/**
 * The result of a call, or the value of a property.
 * @template {Asked} K
 * @typedef {Env[K] extends (...args: any[]) => infer R ? R : Env[K]} Answer
 */
