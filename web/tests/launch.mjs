// Browsers for the tests. CHROMIUM and FIREFOX name others than the system's.
import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

/** The programs; an empty variable says that there is none. */
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";

/** Returns why tests in a browser are skipped, or false if there is one. */
const missing = (/** @type {string} */ program, /** @type {string} */ variable) => !existsSync(program) && (program ? `there is no ${program}` : `${variable} names no browser`);
export const noChromium = missing(CHROMIUM, "CHROMIUM");
export const noFirefox = missing(FIREFOX, "FIREFOX");

/** How often a browser may fall while it starts. */
const TRIES = 3;

/**
 * Starts Chromium, once more where it ends before it answers: on a machine that has little memory left for a moment it may.
 * Start it before a server, which would keep a test that has failed alive.
 * @param {string[]} more arguments
 * @returns {Promise<import("playwright-core").Browser>}
 */
export async function launch(...more) {
  for (let left = TRIES - 1; ; left--) {
    try {
      return await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", ...more] });
    } catch (error) {
      if (left === 0) throw error;
      console.error(`Chromium did not start, ${left} tries are left: ${error instanceof Error ? error.message.slice(0, 2000) : error}`);
    }
  }
}
