// Contacts as arrows: from where bodies touch, along the force, as long as its logarithm.
import { ConeGeometry, Color, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from "three";
import { CONTACT, CONTACTS } from "../frame.js";
import { place } from "./heat.js";

/** Length of an arrow at the end of the scale, m. */
const LENGTH = 0.16;
const WIDTH = 0.0028;

export class Arrows extends Group {
  constructor() {
    super();
    const material = new MeshBasicMaterial({ color: new Color("#0c8ce9"), depthTest: false, transparent: true, opacity: 0.92 });
    const shaft = new CylinderGeometry(1, 1, 1, 10).translate(0, 0.5, 0);
    const head = new ConeGeometry(1, 1, 14).translate(0, 0.5, 0);
    this.shafts = new InstancedMesh(shaft, material, CONTACTS);
    this.heads = new InstancedMesh(head, material, CONTACTS);
    for (const m of [this.shafts, this.heads]) {
      m.frustumCulled = false;
      m.renderOrder = 6;
      m.count = 0;
      this.add(m);
    }
    this.visible = false;
  }

  /**
   * @param {Float32Array} contacts
   * @param {number} count
   */
  show(contacts, count) {
    if (!this.visible) return;
    const [from, way, q, m, scale, tip] = [new Vector3(), new Vector3(), new Quaternion(), new Matrix4(), new Vector3(), new Vector3()];
    const up = new Vector3(0, 1, 0);
    let k = 0;
    for (let i = 0; i < Math.min(count, CONTACTS); i++) {
      const o = CONTACT * i;
      from.set(contacts[o], contacts[o + 1], contacts[o + 2]);
      way.set(contacts[o + 3], contacts[o + 4], contacts[o + 5]);
      const force = way.length();
      if (force < 0.02) continue;
      way.divideScalar(force);
      const length = 0.02 + LENGTH * place(force);
      q.setFromUnitVectors(up, way);
      this.shafts.setMatrixAt(k, m.compose(from, q, scale.set(WIDTH, length - 4 * WIDTH, WIDTH)));
      tip.copy(from).addScaledVector(way, length - 4.5 * WIDTH);
      this.heads.setMatrixAt(k, m.compose(tip, q, scale.set(2.6 * WIDTH, 4.5 * WIDTH, 2.6 * WIDTH)));
      k++;
    }
    for (const mesh of [this.shafts, this.heads]) {
      mesh.count = k;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}
