// Compiling shaders takes longer than loading the world. They are compiled meanwhile, for objects that are like those of the
// scenes but never drawn.
import { Group } from "three";
import { Bodies } from "./bodies.js";
import { Skin } from "./skin.js";

/** @typedef {import("../types").Drawable} Drawable */

/** @type {Omit<Drawable, "texture" | "body">} */
const THING = { name: "", shape: "sphere", mesh: null, size: [1, 1, 1], rgba: [1, 1, 1, 1], specular: 0, exponent: 1, emission: 0, textureScale: [1, 1, 1], textureOffset: 0 };
const PIXEL = { width: 1, height: 1, pixels: new Uint8Array(4) };

/**
 * Makes one object of each kind of material: plain, reflective, and transparent in front of MIMo.
 * @param {ConstructorParameters<typeof Bodies>[1]} shared
 */
export function rehearsal(shared) {
  const scene = /** @type {import("../types").Scene} */ ({
    drawables: [{ ...THING, body: 0, texture: null }, { ...THING, body: 0, texture: 0 }, { ...THING, body: 1, texture: null }],
    textures: [Array(6).fill(PIXEL)],
    bodies: ["world", "crib_feet"].map((name) => ({ name, parent: 0, mass: 0, invweight: 0, movable: false })),
    skin: { at: new Float32Array(3), of: new Uint16Array(1) },
  });
  return new Group().add(new Bodies(scene, shared, true), new Skin(scene));
}
