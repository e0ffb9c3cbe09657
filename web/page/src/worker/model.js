// A trained network as a policy. Its module is large and is loaded on first use.

/** @typedef {import("./env.js").PageEnv} PageEnv */

/** @type {Promise<typeof import("babybench/onnx.js")> | null} */
let loading = null;

/** Loads the module once. */
async function onnx() {
  loading ??= import("babybench/onnx.js").then(async (module) => {
    await module.default();
    return module;
  });
  try {
    return await loading;
  } catch (e) {
    loading = null;
    throw e;
  }
}

export class Model {
  /**
   * @param {import("babybench/onnx.js").OnnxPolicy} policy
   * @param {PageEnv} env that it moves
   */
  constructor(policy, env) {
    this.policy = policy;
    this.about = `It decides ${env.actions.length} numbers in every step.`;
    this.sees = env.settings.vision_active === true;
  }

  /**
   * @param {Uint8Array} bytes of the ONNX file
   * @param {PageEnv} env that it moves
   */
  static async load(bytes, env) {
    const { OnnxPolicy } = await onnx();
    return new Model(new OnnxPolicy(bytes, env.env), env);
  }

  /**
   * @param {PageEnv} env
   * @param {Float32Array} action
   */
  act(env, action) {
    if (this.sees) env.env.drawEyes();
    action.set(this.policy.act(env.env));
  }

  free() {
    this.policy.free();
  }
}
