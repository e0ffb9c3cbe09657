// Geometry of the model's shapes, in true size where stretching would deform them.
import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry, PlaneGeometry, SphereGeometry } from "three";

/** @typedef {import("../types").Drawable} Drawable */

/** Planes extend beyond what is visible; the renderer needs a finite size. */
const FAR = 12;

/**
 * Returns the scale of a drawable's instances: its size, or nothing if the geometry already has it.
 * @param {Drawable} d
 * @returns {[number, number, number]}
 */
export function stretch(d) {
  if (d.shape === "capsule") return [1, 1, 1];
  if (d.shape === "plane") return [Math.min(d.size[0] || FAR, FAR), Math.min(d.size[1] || FAR, FAR), 1];
  return d.size;
}

/**
 * Returns a key that drawables of the same geometry share.
 * @param {Drawable} d
 */
export function shapeKey(d) {
  if (d.mesh) return `mesh ${d.mesh.id}`;
  return d.shape === "capsule" ? `capsule ${d.size.map((v) => v.toFixed(5)).join(" ")}` : d.shape;
}

/**
 * @param {Drawable} d
 * @param {boolean} plain whether a third of the corners will do
 * @returns {import("three").BufferGeometry}
 */
export function geometry(d, plain) {
  const small = plain || Math.max(...d.size) < 0.02;
  switch (d.shape) {
    case "plane":
      return new PlaneGeometry(2, 2);
    case "sphere":
      return plain ? new SphereGeometry(1, 24, 14) : new SphereGeometry(1, 40, 24);
    case "cylinder":
      return new CylinderGeometry(1, 1, 2, plain ? 32 : 64).rotateX(Math.PI / 2);
    case "box":
      return new BoxGeometry(2, 2, 2);
    case "capsule":
      return new CapsuleGeometry(d.size[0], 2 * d.size[2], small ? 6 : 12, small ? 14 : 32).rotateX(Math.PI / 2);
    case "mesh":
      return triangles(d.mesh);
  }
}

/**
 * @param {import("../types").Mesh | null} mesh
 * @returns {BufferGeometry}
 */
function triangles(mesh) {
  const geometry = new BufferGeometry();
  if (!mesh) return geometry;
  geometry.setAttribute("position", new BufferAttribute(mesh.position, 3));
  geometry.setAttribute("normal", new BufferAttribute(mesh.normal, 3));
  if (mesh.texcoord) geometry.setAttribute("uv", new BufferAttribute(mesh.texcoord, 2));
  geometry.setIndex(new BufferAttribute(mesh.index, 1));
  return geometry;
}

/**
 * Distance from a point to the surface of a drawable, and the outward direction there, in the drawable's frame.
 * @param {Drawable} d
 * @param {import("three").Vector3} p
 * @param {import("three").Vector3} out the unit normal
 * @returns {number}
 */
export function surface(d, p, out) {
  const [x, y, z] = d.size;
  if (d.shape === "capsule") {
    out.set(p.x, p.y, p.z - Math.max(-z, Math.min(z, p.z)));
    const r = out.length();
    out.divideScalar(r || 1);
    return Math.abs(r - x);
  }
  if (d.shape === "sphere") {
    const r = Math.hypot(p.x / x, p.y / y, p.z / z);
    out.set(p.x / (x * x), p.y / (y * y), p.z / (z * z)).normalize();
    return Math.abs(r - 1) * Math.min(x, y, z);
  }
  if (d.shape === "cylinder") {
    const side = Math.hypot(p.x, p.y);
    const [toSide, toCap] = [Math.abs(side - x), Math.abs(Math.abs(p.z) - z)];
    if (toSide <= toCap) out.set(p.x, p.y, 0).normalize();
    else out.set(0, 0, Math.sign(p.z));
    return Math.min(toSide, toCap) + Math.max(0, side - x) + Math.max(0, Math.abs(p.z) - z);
  }
  if (d.shape === "box") {
    const over = [Math.abs(p.x) - x, Math.abs(p.y) - y, Math.abs(p.z) - z];
    const axis = over.indexOf(Math.max(...over));
    out.set(0, 0, 0).setComponent(axis, Math.sign(p.getComponent(axis)) || 1);
    return Math.abs(over[axis]) + over.reduce((sum, v, i) => sum + (i === axis ? 0 : Math.max(0, v)), 0);
  }
  out.set(0, 0, 1);
  return Infinity;
}
