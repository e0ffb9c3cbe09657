// Pointers and keys on the scene: they pull a body under the pointer, and otherwise turn the camera.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import { toBody } from "./skin.js";

/** Milliseconds between checks of the body under a passing pointer. */
const HOVER = 60;

/** @typedef {{ body: number, point: [number, number, number], target: [number, number, number] }} Pull */

export class Pointer {
  /**
   * @param {import("./stage.js").Stage} stage
   * @param {{ pull: (pull: Pull) => void, release: () => void, mayPull: (body: number) => boolean }} to
   */
  constructor(stage, to) {
    this.stage = stage;
    this.to = to;
    this.ray = new Raycaster();
    /** @type {Map<number, Vector2>} */
    this.down = new Map();
    /** @type {{ pointer: number, body: number, point: [number, number, number], plane: Plane } | null} */
    this.held = null;
    this.panning = false;
    this.hovered = 0;
    const c = stage.canvas;
    c.addEventListener("pointerdown", (e) => this.start(e));
    c.addEventListener("pointermove", (e) => this.move(e));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      c.addEventListener(end, (e) => this.end(/** @type {PointerEvent} */ (e)));
    }
    c.addEventListener("contextmenu", (e) => e.preventDefault());
    c.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    c.addEventListener("keydown", (e) => this.key(e));
  }

  /** @param {{ clientX: number, clientY: number }} e */
  aim(e) {
    const r = this.stage.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (e.clientX - r.left)) / r.width - 1, 1 - (2 * (e.clientY - r.top)) / r.height);
    this.ray.setFromCamera(at, this.stage.orbit.camera);
  }

  /** @param {PointerEvent} e */
  start(e) {
    const { stage } = this;
    stage.canvas.setPointerCapture(e.pointerId);
    this.down.set(e.pointerId, new Vector2(e.clientX, e.clientY));
    this.panning = e.button === 2 || e.button === 1 || e.shiftKey;
    if (this.down.size > 1) return this.let();
    if (this.panning || e.button !== 0) return;
    this.aim(e);
    const hit = stage.pick(this.ray);
    if (!hit || !this.to.mayPull(hit.body)) return;
    const bodies = stage.bodyPoses;
    const o = 7 * hit.body;
    const local = hit.point.clone().sub(new Vector3(bodies[o], bodies[o + 1], bodies[o + 2]));
    toBody(local, bodies, o);
    const normal = stage.orbit.camera.getWorldDirection(new Vector3());
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, hit.point);
    this.held = { pointer: e.pointerId, body: hit.body, point: local.toArray(), plane };
    stage.canvas.classList.add("pulling");
    this.to.pull({ body: hit.body, point: this.held.point, target: hit.point.toArray() });
  }

  /** @param {PointerEvent} e */
  move(e) {
    const before = this.down.get(e.pointerId);
    if (!before) return this.hover(e);
    const { orbit, canvas } = this.stage;
    const [dx, dy] = [e.clientX - before.x, e.clientY - before.y];
    if (this.held) {
      this.aim(e);
      const target = this.ray.ray.intersectPlane(this.held.plane, new Vector3());
      if (target) this.to.pull({ body: this.held.body, point: this.held.point, target: target.toArray() });
    } else if (this.down.size === 2) {
      const other = [...this.down].find(([id]) => id !== e.pointerId)?.[1];
      if (other) {
        const [was, is] = [before.distanceTo(other), Math.hypot(e.clientX - other.x, e.clientY - other.y)];
        if (was > 0 && is > 0) orbit.zoom(was / is);
        orbit.pan(dx / 2 / canvas.clientHeight, dy / 2 / canvas.clientHeight);
      }
    } else if (this.panning) orbit.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    else orbit.turn(-dx * 0.007, dy * 0.007);
    before.set(e.clientX, e.clientY);
    this.stage.invalidate();
  }

  /** @param {PointerEvent} e */
  hover(e) {
    if (e.pointerType !== "mouse" || e.timeStamp - this.hovered < HOVER) return;
    this.hovered = e.timeStamp;
    this.aim(e);
    const hit = this.stage.pick(this.ray);
    this.stage.canvas.classList.toggle("grab", hit !== null && this.to.mayPull(hit.body));
  }

  /** @param {PointerEvent} e */
  end(e) {
    this.down.delete(e.pointerId);
    if (this.held?.pointer === e.pointerId) this.let();
  }

  let() {
    if (!this.held) return;
    this.held = null;
    this.stage.canvas.classList.remove("pulling");
    this.to.release();
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    e.preventDefault();
    this.stage.orbit.zoom(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.002));
    this.stage.invalidate();
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const { orbit } = this.stage;
    /** @type {Record<string, () => void>} */
    const keys = {
      ArrowLeft: () => orbit.turn(-0.08, 0),
      ArrowRight: () => orbit.turn(0.08, 0),
      ArrowUp: () => orbit.turn(0, 0.06),
      ArrowDown: () => orbit.turn(0, -0.06),
      "+": () => orbit.zoom(0.92),
      "=": () => orbit.zoom(0.92),
      "-": () => orbit.zoom(1.08),
    };
    const act = keys[e.key];
    if (!act || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    act();
    this.stage.invalidate();
  }
}
