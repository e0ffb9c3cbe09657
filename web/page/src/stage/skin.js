// MIMo's touch: each sensor is a small disc on his skin, glowing with the force on it.
import {
  BufferAttribute,
  DataTexture,
  DynamicDrawUsage,
  FloatType,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Matrix3,
  Mesh,
  NearestFilter,
  RGBAFormat,
  ShaderMaterial,
  Vector3,
} from "three";
import { surface } from "./shapes.js";
import { HEAT_GLSL } from "./heat.js";

/** @typedef {import("../types").Scene} Scene */

/** Share of the previous value that remains after a second. */
const FADE = 0.004;

const VERTEX = /* glsl */ `
attribute vec3 at;
attribute vec4 normalSpacing;
attribute float body;
attribute float felt;
uniform sampler2D poses;
uniform float dot0;
uniform float glow;
uniform vec3 eyePoint;
varying vec2 vCorner;
varying float vHeat;
varying float vFacing;
vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
  vec3 origin = texelFetch(poses, ivec2(0, int(body)), 0).xyz;
  vec4 q = texelFetch(poses, ivec2(1, int(body)), 0).yzwx;
  vec3 n = turn(q, normalSpacing.xyz);
  vec3 p = origin + turn(q, at);
  vHeat = clamp(log(1.0 + 20.0 * felt) / log(201.0), 0.0, 1.0);
  float radius = vHeat > 0.0 ? glow * normalSpacing.w * (0.75 + 0.75 * vHeat) : dot0;
  vec3 side = normalize(abs(n.z) < 0.9 ? cross(n, vec3(0.0, 0.0, 1.0)) : cross(n, vec3(1.0, 0.0, 0.0)));
  vec3 up = cross(n, side);
  vCorner = position.xy;
  vFacing = dot(n, normalize(eyePoint - p));
  p += n * 0.0012 + (side * position.x + up * position.y) * radius;
  gl_Position = projectionMatrix * viewMatrix * vec4(p, 1.0);
  if (radius <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const FRAGMENT = /* glsl */ `
uniform float strength;
uniform vec3 dotColor;
varying vec2 vCorner;
varying float vHeat;
varying float vFacing;
${HEAT_GLSL}
void main() {
  float r = length(vCorner);
  if (r > 1.0) discard;
  if (vHeat <= 0.0) {
    gl_FragColor = vec4(dotColor, 0.42 * smoothstep(1.0, 0.6, r) * smoothstep(0.05, 0.4, vFacing));
  } else {
    float soft = exp(-2.6 * r * r) - exp(-2.6);
    gl_FragColor = vec4(heat(vHeat), strength * min(1.0, soft * (0.8 + 0.5 * vHeat)) * smoothstep(0.0, 0.4, vFacing));
  }
  #include <colorspace_fragment>
}`;

/** Numbers of a glowing sensor: position, normal and spacing, body, force. */
const GLOWING = { at: 3, normalSpacing: 4, body: 1, felt: 1 };
const STRIDE = 9;

/**
 * A geometry of discs.
 * @param {Record<string, InstancedBufferAttribute | InterleavedBufferAttribute>} attributes of each disc
 * @param {number} count
 */
function discs(attributes, count) {
  const g = new InstancedBufferGeometry();
  g.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  g.setIndex([0, 1, 2, 0, 2, 3]);
  for (const [name, attribute] of Object.entries(attributes)) g.setAttribute(name, attribute);
  g.instanceCount = count;
  return g;
}

export class Skin extends Group {
  /** @param {Scene} scene */
  constructor(scene) {
    super();
    const { at, of } = scene.skin;
    const count = of.length;
    this.felt = new InstancedBufferAttribute(new Float32Array(count), 1).setUsage(DynamicDrawUsage);
    this.poses = new DataTexture(new Float32Array(8 * scene.bodies.length), 2, scene.bodies.length, RGBAFormat, FloatType);
    this.poses.minFilter = this.poses.magFilter = NearestFilter;
    this.facing = new InstancedBufferAttribute(new Float32Array(4 * count), 4);
    this.scene = scene;
    this.oriented = false;
    this.uniforms = {
      poses: { value: this.poses },
      eyePoint: { value: new Vector3() },
      dot0: { value: 0 },
      dotColor: { value: new Vector3(1, 0.93, 0.84) },
    };
    // all sensors as dots, and apart from them those that glow: most feel nothing
    this.still = discs(
      { at: new InstancedBufferAttribute(at, 3), body: new InstancedBufferAttribute(Float32Array.from(of), 1), felt: this.felt, normalSpacing: this.facing },
      count,
    );
    this.glowing = new InstancedInterleavedBuffer(new Float32Array(STRIDE * count), STRIDE).setUsage(DynamicDrawUsage);
    let first = 0;
    const columns = Object.entries(GLOWING).map(([name, width]) => {
      first += width;
      return [name, new InterleavedBufferAttribute(this.glowing, width, first - width)];
    });
    this.glows = discs(Object.fromEntries(columns), 0);
    const pass = (/** @type {InstancedBufferGeometry} */ geometry, /** @type {number} */ strength, /** @type {boolean} */ behind) => {
      const own = geometry === this.still ? { glow: { value: 0 } } : { glow: { value: 1 }, dot0: { value: 0 } };
      const material = new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: { ...this.uniforms, strength: { value: strength }, ...own },
        transparent: true,
        depthWrite: false,
        depthTest: !behind,
      });
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = behind ? 4 : 3;
      this.add(mesh);
      return mesh;
    };
    this.all = pass(this.still, 0, false);
    pass(this.glows, 1, false);
    // sensors under a hand or below the back shine through faintly
    pass(this.glows, 0.22, true);
    this.visible = count > 0;
  }

  /** @param {boolean} on */
  set dots(on) {
    this.uniforms.dot0.value = on ? 0.0011 : 0;
    this.all.visible = on;
  }

  /**
   * Finds the normal of each sensor from the drawables of its body, once their poses are known.
   * @param {Float32Array} poses of the drawables
   * @param {Float32Array} bodies
   */
  orient(poses, bodies) {
    this.oriented = true;
    const { drawables, skin } = this.scene;
    /** @type {Map<number, number[]>} */
    const own = new Map();
    drawables.forEach((d, i) => own.set(d.body, [...(own.get(d.body) ?? []), i]));
    const [turn, p, local, normal, best] = [new Matrix3(), new Vector3(), new Vector3(), new Vector3(), new Vector3()];
    const spacing = spacings(skin.at, skin.of);
    for (let s = 0; s < skin.of.length; s++) {
      const body = skin.of[s];
      p.fromArray(skin.at, 3 * s);
      toWorld(p, bodies, 7 * body);
      let least = Infinity;
      best.set(0, 0, 1);
      for (const i of own.get(body) ?? []) {
        const o = 12 * i;
        turn.set(poses[o + 3], poses[o + 4], poses[o + 5], poses[o + 6], poses[o + 7], poses[o + 8], poses[o + 9], poses[o + 10], poses[o + 11]);
        local.set(p.x - poses[o], p.y - poses[o + 1], p.z - poses[o + 2]).applyMatrix3(turn.clone().transpose());
        const away = surface(drawables[i], local, normal);
        if (away < least) {
          least = away;
          best.copy(normal).applyMatrix3(turn);
        }
      }
      toBody(best, bodies, 7 * body);
      this.facing.setXYZW(s, best.x, best.y, best.z, spacing[s]);
    }
    this.facing.needsUpdate = true;
  }

  /**
   * @param {Float32Array} poses
   * @param {Float32Array} bodies
   * @param {Float32Array} felt
   * @param {number} seconds since the last call; touches fade, they do not flicker
   */
  feel(poses, bodies, felt, seconds) {
    if (!this.visible) return;
    if (!this.oriented) this.orient(poses, bodies);
    const texels = /** @type {Float32Array} */ (this.poses.image.data);
    for (let b = 0; b < bodies.length / 7; b++) {
      for (let k = 0; k < 3; k++) texels[8 * b + k] = bodies[7 * b + k];
      for (let k = 0; k < 4; k++) texels[8 * b + 4 + k] = bodies[7 * b + 3 + k];
    }
    this.poses.needsUpdate = true;
    const keep = FADE ** seconds;
    const shown = /** @type {Float32Array} */ (this.felt.array);
    const { at, of } = this.scene.skin;
    const [facing, glowing] = [this.facing.array, this.glowing.array];
    let end = 0;
    for (let i = 0; i < shown.length; i++) {
      const faded = shown[i] * keep;
      shown[i] = Math.max(felt[i], faded < 0.004 ? 0 : faded);
      if (shown[i] === 0) continue;
      for (let k = 0; k < 3; k++) glowing[end++] = at[3 * i + k];
      for (let k = 0; k < 4; k++) glowing[end++] = facing[4 * i + k];
      glowing[end++] = of[i];
      glowing[end++] = shown[i];
    }
    this.felt.needsUpdate = true;
    this.glows.instanceCount = end / STRIDE;
    this.glowing.clearUpdateRanges();
    this.glowing.addUpdateRange(0, end);
    this.glowing.needsUpdate = end > 0;
  }

  dispose() {
    this.still.dispose();
    this.glows.dispose();
    this.poses.dispose();
    for (const child of this.children) /** @type {any} */ (child).material.dispose();
  }
}

/**
 * Distance of each sensor to its nearest neighbour on the same body, estimated from a few of them.
 * @param {Float32Array} at
 * @param {Uint16Array} of
 * @returns {Float32Array}
 */
function spacings(at, of) {
  const out = new Float32Array(of.length);
  for (let first = 0; first < of.length; ) {
    let end = first;
    while (end < of.length && of[end] === of[first]) end++;
    const near = [];
    for (let i = first; i < end; i += Math.max(1, Math.floor((end - first) / 12))) {
      let least = Infinity;
      for (let j = first; j < end; j++) {
        if (j !== i) least = Math.min(least, Math.hypot(at[3 * i] - at[3 * j], at[3 * i + 1] - at[3 * j + 1], at[3 * i + 2] - at[3 * j + 2]));
      }
      near.push(least);
    }
    near.sort((a, b) => a - b);
    const typical = Number.isFinite(near[near.length >> 1]) ? near[near.length >> 1] : 0.01;
    out.fill(Math.min(0.03, Math.max(0.002, 1.7 * typical)), first, end);
    first = end;
  }
  return out;
}

/**
 * Rotates `v` by the quaternion of a body (w first) and moves it there.
 * @param {Vector3} v
 * @param {Float32Array} bodies
 * @param {number} o
 */
export function toWorld(v, bodies, o) {
  rotate(v, bodies[o + 3], bodies[o + 4], bodies[o + 5], bodies[o + 6]);
  v.set(v.x + bodies[o], v.y + bodies[o + 1], v.z + bodies[o + 2]);
}

/**
 * Rotates a direction of the world into a body.
 * @param {Vector3} v
 * @param {Float32Array} bodies
 * @param {number} o
 */
export function toBody(v, bodies, o) {
  rotate(v, bodies[o + 3], -bodies[o + 4], -bodies[o + 5], -bodies[o + 6]);
}

/**
 * @param {Vector3} v
 * @param {number} w
 * @param {number} x
 * @param {number} y
 * @param {number} z
 */
function rotate(v, w, x, y, z) {
  const tx = 2 * (y * v.z - z * v.y);
  const ty = 2 * (z * v.x - x * v.z);
  const tz = 2 * (x * v.y - y * v.x);
  v.set(v.x + w * tx + y * tz - z * ty, v.y + w * ty + z * tx - x * tz, v.z + w * tz + x * ty - y * tx);
}
