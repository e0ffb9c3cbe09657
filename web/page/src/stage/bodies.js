// Everything visible of the model, as a few instanced meshes that each frame places again.
import { Color, Group, InstancedMesh, Matrix4, SRGBColorSpace } from "three";
import { geometry, shapeKey, stretch } from "./shapes.js";
import { material, mean, texture } from "./materials.js";

/** @typedef {import("../types").Scene} Scene */
/** @typedef {import("../types").Drawable} Drawable */

/** One instanced mesh and the drawables that it shows. */
/** @typedef {{ mesh: InstancedMesh, of: number[] }} Batch */

export class Bodies extends Group {
  /**
   * @param {Scene} scene
   * @param {{ rim: { value: Color }, focus: { value: number } }} shared
   * @param {boolean} plain whether shapes may be coarse
   */
  constructor(scene, shared, plain) {
    super();
    this.plain = plain;
    this.drawables = scene.drawables.map((d) => {
      const colour = d.texture === null ? null : mean(d, scene.textures[d.texture]);
      return colour ? { ...d, texture: null, rgba: /** @type {Drawable["rgba"]} */ ([...colour, d.rgba[3]]) } : d;
    });
    this.bodyNames = scene.bodies.map((b) => b.name);
    this.stretch = this.drawables.map(stretch);
    this.textures = scene.textures.map((faces) => texture(faces, plain));
    /** @type {Map<string, number[]>} */
    const groups = new Map();
    this.drawables.forEach((d, i) => {
      if (d.rgba[3] === 0) return;
      const place = this.furniture(d) ? "furniture" : "";
      const coat = d.texture === null ? "" : `${d.texture} ${d.textureScale} ${d.textureOffset} ${d.size}`;
      const key = [shapeKey(d), d.specular, d.exponent, d.rgba[3] < 1 ? d.rgba[3] : "", coat, place].join("|");
      groups.set(key, [...(groups.get(key) ?? []), i]);
    });
    /** @type {Batch[]} */
    this.batches = [...groups.values()].map((of) => this.batch(of, shared));
    this.matrix4 = new Matrix4();
  }

  /**
   * @param {number[]} of
   * @param {{ rim: { value: Color }, focus: { value: number } }} shared
   * @returns {Batch}
   */
  batch(of, shared) {
    const first = this.drawables[of[0]];
    const map = first.texture === null ? null : this.textures[first.texture];
    const mesh = new InstancedMesh(geometry(first, this.plain), material(first, map, shared, this.furniture(first)), of.length);
    of.forEach((i, k) => {
      const [r, g, b] = this.drawables[i].rgba;
      mesh.setColorAt(k, new Color().setRGB(r, g, b, SRGBColorSpace));
    });
    mesh.frustumCulled = false;
    mesh.castShadow = first.shape !== "plane" && first.rgba[3] === 1;
    mesh.receiveShadow = true;
    mesh.userData.batch = of;
    this.add(mesh);
    return { mesh, of };
  }

  /**
   * Whether a body surrounds MIMo and may hide him, like the bars of the crib.
   * @param {Drawable} d
   */
  furniture(d) {
    return /^crib_(feet|head|left|right)/.test(this.bodyNames[d.body]);
  }

  /**
   * Places everything; `poses` has the position and rotation of each drawable, row by row.
   * @param {Float32Array} poses
   */
  place(poses) {
    const m = this.matrix4;
    for (const { mesh, of } of this.batches) {
      for (let k = 0; k < of.length; k++) {
        const o = 12 * of[k];
        const [x, y, z] = this.stretch[of[k]];
        m.set(
          poses[o + 3] * x, poses[o + 4] * y, poses[o + 5] * z, poses[o],
          poses[o + 6] * x, poses[o + 7] * y, poses[o + 8] * z, poses[o + 1],
          poses[o + 9] * x, poses[o + 10] * y, poses[o + 11] * z, poses[o + 2],
          0, 0, 0, 1,
        );
        mesh.setMatrixAt(k, m);
      }
      mesh.instanceMatrix.needsUpdate = true;
      mesh.boundingSphere = null;
    }
  }

  /**
   * Bends the skins; `worn` has positions and normals of the vertices of each.
   * @param {Float32Array} worn
   */
  wear(worn) {
    let from = 0;
    for (const { mesh, of } of this.batches) {
      if (!this.drawables[of[0]].worn) continue;
      for (const name of ["position", "normal"]) {
        const attribute = /** @type {import("three").BufferAttribute} */ (mesh.geometry.getAttribute(name));
        attribute.set(worn.subarray(from, (from += attribute.array.length)));
        attribute.needsUpdate = true;
      }
      mesh.geometry.boundingSphere = null;
    }
  }

  /**
   * Finds what a ray meets first.
   * @param {import("three").Raycaster} ray
   * @returns {{ body: number, point: import("three").Vector3 } | null}
   */
  pick(ray) {
    for (const hit of ray.intersectObjects(this.children, false)) {
      const drawable = this.drawables[hit.object.userData.batch[hit.instanceId ?? 0]];
      if (!this.furniture(drawable)) return { body: drawable.body, point: hit.point };
    }
    return null;
  }

  dispose() {
    for (const { mesh } of this.batches) {
      mesh.geometry.dispose();
      /** @type {import("three").Material} */ (mesh.material).dispose();
      mesh.dispose();
    }
    for (const t of this.textures) t.dispose();
  }
}
