// Light and ground: a soft studio around the scene, in the colours of the theme.
import {
  CircleGeometry,
  Color,
  DirectionalLight,
  Fog,
  Group,
  HemisphereLight,
  Mesh,
  MeshLambertMaterial,
  PCFShadowMap,
} from "three";

/** @typedef {{ background: string, ground: string, line: string, sky: string, bounce: string, key: number, fill: number, rim: string }} Theme */

/** @type {Record<"light" | "dark", Theme>} */
export const THEMES = {
  light: { background: "#e9ebee", ground: "#eceef0", line: "#c9cdd3", sky: "#ffffff", bounce: "#cbb9a8", key: 2.5, fill: 1.75, rim: "#3a342e" },
  dark: { background: "#15181d", ground: "#1b1f25", line: "#2d333c", sky: "#aebdd6", bounce: "#4a3f3a", key: 2.8, fill: 1.7, rim: "#5a6478" },
};

export class Studio extends Group {
  /** @param {import("three").WebGLRenderer} renderer */
  constructor(renderer) {
    super();
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    this.rim = { value: new Color() };
    this.hemisphere = new HemisphereLight();
    this.hemisphere.position.set(0, 0, 1);
    this.key = new DirectionalLight("#fff1df", 1);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.radius = 5;
    this.key.shadow.bias = -4e-4;
    this.key.shadow.normalBias = 0.008;
    this.key.shadow.intensity = 0.85;
    Object.assign(this.key.shadow.camera, { left: -1.1, right: 1.1, top: 1.1, bottom: -1.1, near: 0.5, far: 7 });
    this.fill = new DirectionalLight("#c9dcff", 0.5);
    this.lineColor = { value: new Color() };
    this.ground = ground(this.lineColor);
    this.add(this.hemisphere, this.key, this.key.target, this.fill, this.fill.target, this.ground);
  }

  /**
   * @param {import("three").Scene} scene
   * @param {Theme} theme
   */
  paint(scene, theme) {
    scene.background = new Color(theme.background);
    scene.fog = new Fog(theme.background, 5, 13);
    this.hemisphere.color.set(theme.sky);
    this.hemisphere.groundColor.set(theme.bounce);
    this.hemisphere.intensity = theme.fill;
    this.key.intensity = theme.key;
    this.fill.intensity = 0.3 * theme.key;
    this.rim.value.set(theme.rim);
    this.lineColor.value.set(theme.line);
    this.ground.material.color.set(theme.ground);
  }

  /**
   * Keeps the light, and the sharpest part of its shadows, at the viewed point.
   * @param {import("three").Vector3} at
   */
  aim(at) {
    // whole steps: shadows must not swim while the camera follows
    const step = 0.05;
    const [x, y, z] = [at.x, at.y, at.z].map((v) => Math.round(v / step) * step);
    this.key.target.position.set(x, y, z);
    this.key.position.set(x + 1.1, y - 1.3, z + 3);
    this.fill.target.position.set(x, y, z);
    this.fill.position.set(x - 2, y + 1.5, z + 1.2);
  }
}

/**
 * The floor: a disc with a fine grid of 10 cm that is lost in the distance.
 * @param {{ value: Color }} lineColor
 * @returns {Mesh<CircleGeometry, MeshLambertMaterial>}
 */
function ground(lineColor) {
  const material = new MeshLambertMaterial();
  material.onBeforeCompile = (shader) => {
    shader.uniforms.lineColor = lineColor;
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec2 vGround;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvGround = position.xy;");
    shader.fragmentShader = shader.fragmentShader
      .replace(
        "#include <common>",
        `#include <common>
varying vec2 vGround;
uniform vec3 lineColor;
float lines(float pitch, float width) {
  vec2 p = vGround / pitch, w = fwidth(p);
  vec2 a = 1.0 - smoothstep(w * width, w * (width + 1.0), abs(fract(p - 0.5) - 0.5));
  return max(a.x, a.y) * clamp(0.35 / max(w.x, w.y) - 1.0, 0.0, 1.0);
}`,
      )
      .replace(
        "#include <map_fragment>",
        "float far = 1.0 - smoothstep(1.0, 4.0, length(vGround));\ndiffuseColor.rgb = mix(diffuseColor.rgb, lineColor, far * max(0.4 * lines(0.1, 0.2), lines(0.5, 0.4)));",
      );
  };
  const mesh = new Mesh(new CircleGeometry(16, 96), material);
  mesh.position.z = -0.0105;
  mesh.receiveShadow = true;
  return mesh;
}
