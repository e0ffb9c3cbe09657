// Episodes and their checksums, in whatever runs JavaScript; and how fast they go.
import init, { Env } from "../../dist/babybench/babybench.js";

/** Lengths of the episodes, as in `examples/checksum`. */
const STEPS = [0, 10, 100, 1000];
const NAMES = { self_touch: "config_selftouch", hand_regard: "config_handregard", test_installation: "config_test_installation", infant: "config_infant" };

/**
 * Returns what `cargo run --release --example checksum` prints.
 * @param {(file: string) => Promise<string>} read a file of `configs/`
 * @param {number} most steps of an episode
 */
export async function sums(read, most = Infinity) {
  await init();
  let text = "";
  for (const [name, file] of Object.entries(NAMES)) {
    const config = await read(`${file}.yml`);
    const env = new Env(config, name);
    for (const steps of STEPS.filter((n) => n <= most)) {
      env.reset(0);
      for (let k = 0; k < steps; k++) env.step(env.sampleAction());
      text += `${name} ${steps} ${env.checksum()}\n`;
    }
    env.free();
  }
  return text;
}

/** Milliseconds before the first round. */
const WARM = 2000;

/**
 * Returns the milliseconds of a piece of work: the least of some rounds.
 * @param {string} name of the work, as `examples/pace` knows it
 */
export async function pace(name) {
  await init();
  const [config, work] = WORK[name];
  const env = new Env(config);
  env.reset(0);
  // engines compile what runs often once more, in the background
  for (const started = performance.now(); performance.now() - started < WARM; ) work(env);
  let least = Infinity;
  for (let round = 0; round < 5; round++) {
    const n = name === "picture" ? 4 : 200;
    const started = performance.now();
    for (let k = 0; k < n; k++) work(env);
    least = Math.min(least, (performance.now() - started) / n);
  }
  env.free();
  return least;
}

const quiet = { touch_active: false, vision_active: false };
/** @type {Record<string, [import("../../dist/babybench/types.js").Settings, (env: Env) => unknown]>} */
const WORK = {
  physics: [{ ...quiet, behavior: "self_touch", scene: "crib" }, (env) => env.step(env.sampleAction())],
  eyes: [{ behavior: "hand_regard", scene: "cubes", touch_active: false }, (env) => env.step(env.sampleAction())],
  picture: [{ ...quiet, behavior: "self_touch", scene: "crib" }, (env) => env.draw("corner", 480, 480)],
};
