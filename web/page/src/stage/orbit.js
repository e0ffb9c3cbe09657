// A camera that circles a point: turned, moved and brought closer by pointer, wheel and keys.
import { PerspectiveCamera, Vector3 } from "three";

/** The camera stays above the viewed point, because below a mattress or a floor nothing is visible. */
const LOW = 0.03;
const HIGH = 1.5;

export class Orbit {
  constructor() {
    this.camera = new PerspectiveCamera(30, 1, 0.02, 60);
    this.camera.up.set(0, 0, 1);
    this.at = new Vector3(0, 0, 0.2);
    this.azimuth = 0.8;
    this.elevation = 0.5;
    this.distance = 2;
    this.follow = true;
    /** The viewed point relative to the followed body. */
    this.offset = new Vector3();
  }

  /** @returns {number[]} what makes the view, for links */
  get view() {
    const round = (/** @type {number} */ v) => Math.round(v * 1e4) / 1e4;
    return [this.azimuth, this.elevation, this.distance, ...this.offset.toArray(), this.follow ? 1 : 0].map(round);
  }

  set view(v) {
    if (v.length !== 7 || !v.every(Number.isFinite)) return;
    this.azimuth = v[0];
    this.elevation = Math.min(HIGH, Math.max(LOW, v[1]));
    this.distance = Math.min(12, Math.max(0.15, v[2]));
    this.offset.set(v[3], v[4], v[5]);
    this.follow = v[6] === 1;
  }

  /**
   * Moves the centre towards the followed body.
   * @param {Vector3} target
   * @param {number} seconds 0 jumps there
   */
  track(target, seconds) {
    if (!this.follow && seconds > 0) return;
    const share = seconds > 0 ? 1 - Math.exp(-3 * seconds) : 1;
    this.at.lerp(target, share);
  }

  /**
   * @param {number} azimuth rad
   * @param {number} elevation rad
   */
  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(HIGH, Math.max(LOW, this.elevation + elevation));
  }

  /** @param {number} factor */
  zoom(factor) {
    this.distance = Math.min(12, Math.max(0.15, this.distance * factor));
  }

  /**
   * Moves the centre in the plane of the picture.
   * @param {number} x shares of the picture's height
   * @param {number} y
   */
  pan(x, y) {
    const size = 2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.offset.addScaledVector(right, -x * size).addScaledVector(up, y * size);
    this.offset.clampLength(0, 4);
  }

  /** Moves the camera to the angles. */
  update() {
    const { camera, distance, azimuth, elevation } = this;
    const centre = this.at.clone().add(this.offset);
    camera.position
      .set(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation))
      .multiplyScalar(distance)
      .add(centre);
    camera.position.z = Math.max(0.02, camera.position.z);
    camera.lookAt(centre);
    camera.updateMatrixWorld();
  }
}
