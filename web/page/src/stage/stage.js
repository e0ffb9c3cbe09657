// The scene on the page: draws when something changed, and only then.
import { NeutralToneMapping, Scene as Root, Vector3, WebGLRenderer } from "three";
import { CONTACT } from "../frame.js";
import { sceneOf } from "../room.js";
import { Arrows } from "./arrows.js";
import { Bodies } from "./bodies.js";
import { Studio, THEMES } from "./lights.js";
import { Orbit } from "./orbit.js";
import { rehearsal } from "./rehearsal.js";
import { Skin, toWorld } from "./skin.js";
import { Spring } from "./spring.js";

/** @typedef {import("../types").Scene} Scene */
/** @typedef {import("../types").Moment} Moment */

/** Starting views: azimuth, elevation, distance. */
/** @type {Record<string, [number, number, number]>} */
const VIEWS = { crib: [-0.98, 0.8, 1.72], cubes: [-0.42, 0.26, 1.7], base: [-0.8, 0.5, 1.7], mobile: [-0.98, 0.7, 2.2], playroom: [-0.6, 0.5, 1.9], blanket: [-0.8, 0.5, 1.7] };

export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {boolean} plain whether to draw coarsely, without shadows and smooth edges
   */
  constructor(canvas, plain) {
    this.canvas = canvas;
    this.plain = plain;
    /** Maximum number of pixels drawn per pixel of the page. */
    this.sharpness = plain ? 0.7 : 2;
    this.renderer = new WebGLRenderer({ canvas, antialias: !plain, powerPreference: "high-performance" });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.info.autoReset = false;
    // a check for errors waits for the compiler of the graphics card
    this.renderer.debug.checkShaderErrors = false;
    this.root = new Root();
    this.orbit = new Orbit();
    this.studio = new Studio(this.renderer);
    this.studio.key.castShadow = !plain;
    this.arrows = new Arrows();
    this.spring = new Spring();
    this.root.add(this.studio, this.arrows, this.spring);
    /** @type {Bodies | null} */
    this.bodies = null;
    /** @type {Skin | null} */
    this.skin = null;
    /** @type {Scene | null} */
    this.scene = null;
    this.bodyPoses = new Float32Array(0);
    /** @type {[number, number, number] | null} where the pointer pulls to */
    this.target = null;
    /** Milliseconds of script of the last frames, for measurements. */
    this.cost = new Float32Array(120);
    this.frames = 0;
    this.busy = false;
    this.pending = 0;
    /** @type {(() => void)[]} */
    this.after = [];
    this.dots = true;
    this.glow = true;
    this.jump = true;
    this.shown = 0;
    /** The stage beside this one, which has the same view; and the last view of both. */
    /** @type {Stage | null} */
    this.peer = null;
    this.agreed = { view: "" };
    this.followed = new Vector3();
    /** Distance of the camera, m. */
    this.focus = { value: 2 };
    this.shared = { rim: this.studio.rim, focus: this.focus };
    /** Whether the whole scene is loaded; before, nothing is drawn. */
    this.placed = false;
    /** Whether the shaders are compiled; before, nothing is drawn. */
    this.compiled = false;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** @param {"light" | "dark"} name */
  set theme(name) {
    this.studio.paint(this.root, THEMES[name]);
    this.invalidate();
  }

  /** Compiles the shaders while the world is loaded. */
  async compile() {
    // kept, so that the compiled shaders are
    this.rehearsed = rehearsal(this.shared).add(this.studio.ground.clone());
    await this.renderer.compileAsync(this.rehearsed, this.orbit.camera, this.root);
    // some graphics finish a shader only when something is drawn with it; the scene is still veiled
    this.root.add(this.rehearsed);
    this.renderer.render(this.root, this.orbit.camera);
    this.root.remove(this.rehearsed);
    this.compiled = true;
    performance.mark("shaders");
    this.invalidate();
  }

  /** @param {Scene} scene */
  build(scene) {
    const fresh = this.scene?.settings.scene !== scene.settings.scene;
    this.bodies?.dispose();
    this.skin?.dispose();
    this.root.remove(...[this.bodies, this.skin].filter((o) => o !== null));
    this.scene = scene;
    // the page has its own ground
    this.bodies = new Bodies({ ...scene, drawables: sceneOf(scene.settings) === null ? scene.drawables.map(ofThePage) : scene.drawables.map(ofARoom) }, this.shared, this.plain);
    this.skin = new Skin(scene);
    this.skin.dots = this.dots;
    this.skin.visible &&= this.glow;
    this.root.add(this.bodies, this.skin);
    this.jump = true;
    this.placed = false;
    if (fresh) this.home();
  }

  /** Returns to the view with which the scene starts. */
  home() {
    const [azimuth, elevation, distance] = VIEWS[String(this.scene?.settings.scene)] ?? VIEWS.base;
    // one of two may be cut off at the sides, rather than be small
    const narrow = Math.min(this.peer ? 1.9 : Infinity, Math.max(1, 1.15 / (this.orbit.camera.aspect || 1)));
    this.orbit.view = [azimuth, elevation, distance * narrow, 0, 0, 0, 1];
    this.jump = true;
    this.invalidate();
  }

  /**
   * Shows a frame.
   * @param {Float32Array} frame
   * @param {Moment} moment
   * @param {number} seconds since the last frame
   */
  show(frame, moment, seconds) {
    const start = performance.now();
    const { scene, bodies, skin } = this;
    if (!scene || !bodies || !skin) return;
    const l = scene.layout;
    const poses = frame.subarray(l.poses, l.bodies);
    const bodyPoses = frame.subarray(l.bodies, l.felt);
    if (this.bodyPoses.length !== bodyPoses.length) this.bodyPoses = new Float32Array(bodyPoses.length);
    this.bodyPoses.set(bodyPoses);
    bodies.place(poses);
    bodies.wear(frame.subarray(l.worn, l.action));
    this.placed = true;
    skin.feel(poses, bodyPoses, frame.subarray(l.felt, l.worn), this.jump ? 1e3 : seconds);
    this.arrows.show(frame.subarray(l.contacts, l.contacts + CONTACT * moment.contacts), moment.contacts);
    this.centre(this.followed);
    this.orbit.track(this.followed, this.jump ? 0 : seconds);
    this.jump = false;
    this.stretch(moment);
    this.shown = performance.now() - start;
    this.invalidate();
  }

  /** @param {Moment} moment */
  stretch(moment) {
    const { pull } = moment;
    if (!pull || !this.target) {
      this.spring.visible = false;
      return;
    }
    const from = new Vector3(...pull.at);
    toWorld(from, this.bodyPoses, 7 * pull.body);
    this.spring.stretch(from, new Vector3(...this.target));
  }

  /**
   * MIMo's centre of mass.
   * @param {Vector3} out
   */
  centre(out) {
    const { scene, bodyPoses } = this;
    if (!scene) return;
    const first = scene.bodies.findIndex((b) => b.name === "hip");
    out.set(0, 0, 0);
    let mass = 0;
    scene.bodies.forEach((b, i) => {
      if (i < first || b.mass === 0) return;
      if (i !== first && !descends(scene, i, first)) return;
      mass += b.mass;
      out.x += b.mass * bodyPoses[7 * i];
      out.y += b.mass * bodyPoses[7 * i + 1];
      out.z += b.mass * bodyPoses[7 * i + 2];
    });
    out.divideScalar(mass || 1);
  }

  /** @param {import("three").Raycaster} ray */
  pick(ray) {
    return this.bodies?.pick(ray) ?? null;
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (!w || !h) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, this.sharpness));
    this.renderer.setSize(w, h, false);
    this.orbit.camera.aspect = w / h;
    this.orbit.camera.updateProjectionMatrix();
    this.invalidate();
  }

  /**
   * Copies the view of another stage, and draws.
   * @param {Stage} other
   */
  pair(other) {
    [this.peer, other.peer, this.agreed] = [other, this, other.agreed];
    this.dots = other.dots;
    this.glow = other.glow;
    this.arrows.visible = other.arrows.visible;
    this.studio.key.castShadow = other.studio.key.castShadow;
    this.orbit.view = other.orbit.view;
    other.agreed.view = other.orbit.view.join();
  }

  /** Copies this stage's view to the stage beside it. */
  agree() {
    const view = this.orbit.view.join();
    if (!this.peer || view === this.agreed.view) return;
    this.agreed.view = view;
    this.peer.orbit.view = this.orbit.view;
    this.peer.invalidate();
  }

  /** Frees the graphics. */
  dispose() {
    if (this.peer) this.peer.peer = null;
    cancelAnimationFrame(this.pending);
    this.placed = false;
    this.bodies?.dispose();
    this.skin?.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Draws in the next frame of the screen. */
  invalidate() {
    if (this.pending || !this.placed || !this.compiled) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.draw();
    });
  }

  draw() {
    const start = performance.now();
    const { orbit, skin, renderer } = this;
    this.agree();
    orbit.update();
    this.studio.aim(orbit.at);
    this.focus.value = orbit.distance;
    skin?.uniforms.eyePoint.value.copy(orbit.camera.position);
    renderer.info.reset();
    renderer.render(this.root, orbit.camera);
    this.cost[this.frames % this.cost.length] = performance.now() - start + this.shown;
    this.shown = 0;
    this.frames++;
    for (const done of this.after.splice(0)) done();
  }
}

/** A felt-like look, because the model's image of the rug could be mistaken for water. @type {[number, number, number, number]} */
const FELT = [0.8, 0.76, 0.71, 1];

/**
 * Leaves out what the page replaces, and gives the rug a distinct look.
 * @param {import("../types").Drawable} d
 * @returns {import("../types").Drawable}
 */
function ofThePage(d) {
  if (d.shape === "plane" && d.body === 0) return { ...d, rgba: [0, 0, 0, 0] };
  return d.name === "rug" ? { ...d, texture: null, specular: 0, rgba: FELT } : d;
}

/** The colour of geoms that have none. */
const GREY = "0.5,0.5,0.5,1";

/**
 * Leaves out the floor of a custom room without colours, because the page has a ground.
 * @param {import("../types").Drawable} d
 * @returns {import("../types").Drawable}
 */
const ofARoom = (d) => (d.shape === "plane" && d.body === 0 && d.texture === null && d.rgba.join() === GREY ? { ...d, rgba: [0, 0, 0, 0] } : d);

/**
 * @param {Scene} scene
 * @param {number} body
 * @param {number} ancestor
 */
function descends(scene, body, ancestor) {
  for (let b = body; b > 0; b = scene.bodies[b].parent) if (b === ancestor) return true;
  return false;
}
