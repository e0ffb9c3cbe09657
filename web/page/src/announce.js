// States of the world that the page announces, in one table: the text, and the actions that it offers.
import { capital, TASKS } from "./names.js";

/** @typedef {import("./app.js").App} App */
/**
 * The current announcement. One that stays does so until it is closed; an alert takes the focus.
 * @typedef {{ text: string, bad?: boolean, stays?: boolean, alert?: boolean, actions?: [string, () => unknown][] }} Notice
 */

/** @type {Record<"stopped" | "lost" | "hung" | "tape" | "replayed" | "episode" | "refused" | "missing" | "misfit" | "alone" | "slow", (app: App, data: any) => Notice>} */
export const STATES = {
  stopped: (app, why) => ({ text: `Time has stopped: ${why}`, bad: true, actions: [["Reset", () => app.reset()]] }),

  lost: (app, why) => ({ text: `The simulation has stopped: ${explain(why)}`, bad: true, alert: true, actions: [["Start again", () => app.revive()]] }),

  hung: (app) => {
    const network = app.state.policy === "model";
    const why = network ? " The network may never finish: started again, MIMo babbles instead." : "";
    const again = () => {
      if (network) app.state.policy = "babbling";
      return app.revive();
    };
    return { text: `The simulation has not answered for 10 seconds, and time has stopped.${why}`, bad: true, alert: true, actions: [["Start again", again], ["Wait", () => {}]] };
  },

  /** @param {App} app @param {{ steps: number, full: boolean }} tape */
  tape: (app, { steps, full }) => ({ text: `The recording ${full ? "is full and has ended" : "has ended"}: ${seconds(app, steps)} are kept in the tab Share.`, stays: true }),

  /** @param {App} app @param {{ steps: number, same: boolean | null }} replay */
  replayed: (app, { steps, same }) => {
    const { recordings } = app;
    const again = () => recordings.last && recordings.replay(recordings.last);
    const verdict = same === null ? "" : same ? " It ends with the same bits." : " It does not end where the recording did: another version or configuration made it.";
    return { text: `The replay is over: ${steps} steps.${verdict} Play continues from here.`, stays: true, actions: [["Replay again", again]] };
  },

  /** @param {App} app @param {import("./types").Score & { time: number, second?: boolean }} s */
  episode: (app, { behavior, success, failure, earned, value, time, second }) => {
    const who = second ? "The second MIMo. " : "";
    const task = TASKS[behavior];
    if (!task) {
      const score = value === null ? "" : ` with a score of ${(100 * value).toFixed(1)} %`;
      return { text: `${who}The episode is complete after ${time.toFixed(1)} s${score}. MIMo continues; Reset starts another episode.` };
    }
    const end = success ? "the goal is reached" : failure ? "the goal is out of reach" : "the time is up";
    return { text: `${who}${task.title}: ${end} after ${time.toFixed(2)} s, with a return of ${(earned ?? 0).toFixed(1)}.`, stays: true, actions: [["Next episode", () => app.nextEpisode()]] };
  },

  /** @param {App} _app @param {{ name: string, size: number }} network */
  missing: (_app, { name, size }) => ({ text: `This run was moved by ${name}${size ? ` (${Math.ceil(size / 1e3)} kB)` : ""}, which the link does not hold. Drop it on the page to continue as before; until then MIMo babbles.`, bad: true }),

  /** @param {App} app @param {string} why */
  misfit: (app, why) => ({ text: `${app.model?.name ?? "The network"} does not fit this configuration, so MIMo babbles: ${why}`, bad: true }),

  /** @param {App} _app @param {string} why */
  alone: (_app, why) => ({ text: `There is no second MIMo: ${why}`, bad: true }),

  /** @param {App} app @param {number} pace */
  slow: (app, pace) => ({ text: `This machine is too slow for two MIMos at ${app.state.speed} ×: a second takes them ${(1 / pace).toFixed(1)} s.`, stays: true, actions: [["End the comparison", () => app.compare(null)]] }),

  /** @param {App} _app @param {string[]} what */
  refused: (_app, what) => ({ text: `The link has settings that do not exist: ${what.join(", ")}. The rest of it is kept.`, bad: true }),
};

/**
 * @param {App} app
 * @param {number} steps
 */
export const seconds = (app, steps) => `${(steps * (app.scene?.timestep ?? 0)).toFixed(1)} s`;

/** @param {string} why */
function explain(why) {
  if (/^ModuleError/.test(why)) return why.replace(/^ModuleError: (the simulation stopped: )?/, "");
  if (/memory|allocation|grow/i.test(why)) return `the browser gave it no more memory (${why}). Close other tabs, or choose a smaller scene.`;
  if (/unreachable|RuntimeError/.test(why)) return `an internal error (${why}). Your settings are kept.`;
  return capital(why);
}
