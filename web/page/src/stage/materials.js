// The page's materials for the model's: its colours and images under the page's light.
import {
  Color,
  CubeTexture,
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  MeshPhongMaterial,
  RepeatWrapping,
  SRGBColorSpace,
} from "three";

/** @typedef {import("../types").Drawable} Drawable */
/** @typedef {import("../types").TextureFace} TextureFace */

/**
 * @param {TextureFace} face
 * @returns {DataTexture}
 */
function image(face) {
  const t = new DataTexture(face.pixels, face.width, face.height);
  t.colorSpace = SRGBColorSpace;
  t.needsUpdate = true;
  return t;
}

/**
 * @param {TextureFace[]} faces one, or six sides of a cube
 * @param {boolean} plain whether to do without smaller images for what is far away, which take long to make on a processor
 * @returns {DataTexture | CubeTexture}
 */
export function texture(faces, plain) {
  const minFilter = plain ? LinearFilter : LinearMipmapLinearFilter;
  if (faces.length === 6) {
    const cube = new CubeTexture(/** @type {any} */ (faces.map(image)));
    cube.colorSpace = SRGBColorSpace;
    cube.generateMipmaps = !plain;
    cube.minFilter = minFilter;
    cube.magFilter = LinearFilter;
    cube.needsUpdate = true;
    return cube;
  }
  const t = image(faces[0]);
  t.wrapS = t.wrapT = RepeatWrapping;
  t.magFilter = LinearFilter;
  t.minFilter = minFilter;
  t.generateMipmaps = !plain;
  t.anisotropy = plain ? 1 : 8;
  return t;
}

/** Number of repetitions on a drawable from which an image would look like noise; its mean replaces it. */
const TILES = 20;

/**
 * Returns the mean of an image that is repeated too often to be seen, sRGB; nothing for other textures.
 * @param {Drawable} d
 * @param {TextureFace[]} faces
 * @returns {[number, number, number] | null}
 */
export function mean(d, faces) {
  if (faces.length !== 1 || Math.max(...d.textureScale) < TILES) return null;
  const { pixels } = faces[0];
  const sum = [0, 0, 0];
  for (let i = 0; i < pixels.length; i += 4) for (let k = 0; k < 3; k++) sum[k] += pixels[i + k];
  return /** @type {[number, number, number]} */ (sum.map((v) => (4 * v) / pixels.length / 255));
}

/** Bodies between the eye and MIMo become transparent. */
const GLASS = /* glsl */ `
  #include <opaque_fragment>
  gl_FragColor.a *= mix(0.1, 1.0, smoothstep(focus - 0.5, focus - 0.22, vViewPosition.z));`;

/** Grazing light on skin is warm: a thin rim, and a soft transition into shade. */
const RIM = /* glsl */ `
  float rim = pow(1.0 - saturate(dot(normalize(vViewPosition), normal)), 3.0);
  outgoingLight += diffuseColor.rgb * rim * rimLight;
  #include <opaque_fragment>`;

/**
 * Creates the material of a group of drawables. Colours come with the instances.
 * @param {Drawable} d
 * @param {DataTexture | CubeTexture | null} map
 * @param {{ rim: { value: Color }, focus: { value: number } }} shared by all materials
 * @param {boolean} glass whether it turns to glass before MIMo
 * @returns {MeshPhongMaterial}
 */
export function material(d, map, shared, glass) {
  const m = new MeshPhongMaterial({ specular: new Color().setScalar(0.1 * d.specular), shininess: Math.max(12, d.exponent) });
  if (glass) m.transparent = true;
  if (d.rgba[3] < 1) Object.assign(m, { transparent: true, opacity: d.rgba[3], depthWrite: false });
  const cube = map instanceof CubeTexture;
  const mapped = Boolean(d.mesh?.texcoord);
  m.onBeforeCompile = (shader) => {
    shader.uniforms.rimLight = shared.rim;
    shader.uniforms.focus = shared.focus;
    let { vertexShader: v, fragmentShader: f } = shader;
    f = f.replace("#include <common>", "#include <common>\nuniform vec3 rimLight;\nuniform float focus;");
    f = f.replace("#include <opaque_fragment>", RIM);
    if (glass) f = f.replace("#include <opaque_fragment>", GLASS);
    if (map) {
      const [x, y, z] = d.textureScale.map((s, i) => s / (d.shape === "capsule" ? d.size[i] : 1));
      shader.uniforms.coat = { value: map };
      shader.uniforms.coatScale = { value: [x, y, z] };
      shader.uniforms.coatOffset = { value: d.textureOffset };
      const varying = "varying vec3 vCoat;";
      v = v.replace("#include <common>", `#include <common>\n${varying} uniform vec3 coatScale; uniform float coatOffset;`);
      v = v.replace("#include <begin_vertex>", "#include <begin_vertex>\nvCoat = COAT_MAPPED ? vec3(uv, 0.0) : position * coatScale + (COAT_CUBE ? 0.0 : coatOffset);".replace("COAT_CUBE", String(cube)).replace("COAT_MAPPED", String(mapped)));
      f = f.replace("#include <common>", `#include <common>\n${varying} uniform ${cube ? "samplerCube" : "sampler2D"} coat;`);
      f = f.replace("#include <map_fragment>", `diffuseColor.rgb *= texture(coat, ${cube ? "normalize(vCoat)" : "vCoat.xy"}).rgb;`);
    }
    shader.vertexShader = v;
    shader.fragmentShader = f;
  };
  m.customProgramCacheKey = () => `${map ? (cube ? "cube" : mapped ? "mapped" : "flat") : "plain"} ${glass}`;
  return m;
}
