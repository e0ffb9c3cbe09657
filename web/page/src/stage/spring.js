// The spring between a pulled body and the pointer: a coil that thins as it stretches.
import { BufferGeometry, Color, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";

const TURNS = 12;
const POINTS = 16 * TURNS;
const RADIUS = 0.009;

export class Spring extends Group {
  constructor() {
    super();
    const color = new Color("#0c8ce9");
    this.points = new Float32BufferAttribute(new Float32Array(3 * (POINTS + 1)), 3);
    this.coil = new Line(new BufferGeometry().setAttribute("position", this.points), new LineBasicMaterial({ color, depthTest: false, transparent: true }));
    this.coil.frustumCulled = false;
    const ball = new MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.9 });
    this.ends = [0.009, 0.012].map((r) => new Mesh(new SphereGeometry(r, 16, 12), ball));
    this.add(this.coil, ...this.ends);
    for (const c of this.children) c.renderOrder = 7;
    this.visible = false;
  }

  /**
   * @param {Vector3} from on the body
   * @param {Vector3} to the pointer
   */
  stretch(from, to) {
    this.visible = true;
    const way = to.clone().sub(from);
    const length = way.length();
    way.divideScalar(length || 1);
    const side = new Vector3(0, 0, 1).cross(way);
    if (side.lengthSq() < 1e-4) side.set(1, 0, 0);
    side.normalize();
    const other = way.clone().cross(side);
    const radius = RADIUS / (1 + 3 * length);
    for (let i = 0; i <= POINTS; i++) {
      const s = i / POINTS;
      const taper = radius * Math.min(1, 8 * s, 8 * (1 - s));
      const angle = 2 * Math.PI * TURNS * s;
      const [c, d] = [taper * Math.cos(angle), taper * Math.sin(angle)];
      this.points.setXYZ(
        i,
        from.x + way.x * length * s + side.x * c + other.x * d,
        from.y + way.y * length * s + side.y * c + other.y * d,
        from.z + way.z * length * s + side.z * c + other.z * d,
      );
    }
    this.points.needsUpdate = true;
    this.ends[0].position.copy(from);
    this.ends[1].position.copy(to);
  }
}
