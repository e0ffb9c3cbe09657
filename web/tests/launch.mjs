// Chromium for the tests. CHROMIUM names another than the system's.
import { chromium } from "playwright-core";

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
      return await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", ...more] });
    } catch (error) {
      if (left === 0) throw error;
      console.error(`Chromium did not start, ${left} tries are left: ${error instanceof Error ? error.message.slice(0, 2000) : error}`);
    }
  }
}
