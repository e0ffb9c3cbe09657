// Leaves out of three.js headsets, environment maps and materials that the page does not use. esbuild reads
// three.js from its sources, where these are separate files.
import { readFileSync, realpathSync } from "node:fs";
import { join } from "node:path";

/** Files replaced by the parts that the renderer uses. */
const STUBS = {
  "renderers/webxr/WebXRManager.js": `export class WebXRManager {
    enabled = false; isPresenting = false; cameraAutoUpdate = true;
    addEventListener() {} removeEventListener() {} dispose() {} setAnimationLoop() {}
    getCamera() {} getDepthSensingMesh() {} hasDepthSensing() { return false; } getEnvironmentBlendMode() {}
  }`,
  "extras/PMREMGenerator.js": `export class PMREMGenerator { constructor() { throw new Error("The page has no environment maps."); } }`,
};
const UNUSED_SHADERS = ["meshtoon", "meshmatcap", "meshphysical", "meshnormal", "sprite", "points", "linedashed", "equirect", "cube", "backgroundCube", "vsm"];

/** Parts of shaders for features that no material of the page uses: bones, bump and reflection maps, clipping planes. */
const UNUSED_PARTS = /ShaderChunk[\\/](aomap|lightmap|envmap|bumpmap|displacementmap|emissivemap|metalnessmap|roughnessmap|gradientmap|normalmap|morph|skin|batching|clearcoat|iridescence|clipping_planes|alphahash|logdepthbuf|map_particle|dithering)\w*\.glsl\.js$/;
const UNUSED_CHUNKS = ["lights_physical_pars_fragment", "lights_physical_fragment", "transmission_pars_fragment", "transmission_fragment", "iridescence_fragment", "cube_uv_reflection_fragment", "lights_toon_pars_fragment", "lights_toon_fragment"];

/** @param {string} folder of three.js */
export function lean(folder) {
  const src = join(realpathSync(folder), "src");
  const unix = (path) => path.slice(src.length + 1).replaceAll("\\", "/");
  return {
    name: "lean three.js",
    setup(build) {
      build.onResolve({ filter: /^three$/ }, () => ({ path: join(src, "Three.js"), sideEffects: false }));
      build.onLoad({ filter: /three[\\/]src[\\/].*\.js$/ }, ({ path }) => {
        const stub = STUBS[unix(path)];
        if (stub) return { contents: stub, loader: "js" };
        if (!path.endsWith(".glsl.js")) return undefined;
        const name = path.match(/ShaderLib[\\/](\w+)\.glsl\.js$/)?.[1];
        if (UNUSED_PARTS.test(path) || UNUSED_CHUNKS.some((c) => path.endsWith(`${c}.glsl.js`))) return { contents: 'export default "";', loader: "js" };
        if (name && UNUSED_SHADERS.includes(name)) return { contents: 'export const vertex = "", fragment = "";', loader: "js" };
        return { contents: bare(readFileSync(path, "utf8")), loader: "js" };
      });
    },
  };
}

/**
 * Removes comments, indentation and empty lines from a shader. Line breaks remain, because directives need them.
 * @param {string} text
 */
function bare(text) {
  return text.replace(/`[^`]*`/gs, (shader) => shader.replace(/\/\*.*?\*\//gs, "").replace(/\/\/[^\n]*/g, "").replace(/[ \t]+/g, " ").replace(/ ?\n ?/g, "\n").replace(/\n{2,}/g, "\n"));
}
