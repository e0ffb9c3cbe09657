// Recordings of the page: nothing ends one without asking, and what was recorded is kept.

/** @typedef {import("./types").Recording} Recording */

export class Recordings {
  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    /** The last replayed recording. */
    /** @type {Recording | null} */
    this.last = null;
  }

  /**
   * Asks before something ends a running recording. The recording is kept.
   * @param {string} what
   * @returns {Promise<boolean>} whether to continue
   */
  async consent(what) {
    if (this.app.moment?.recorded == null) return true;
    if (!(await this.app.confirm(`${what} ends the running recording.`, "End it and go on", "Keep recording"))) {
      this.app.emit("state"); // controls show the actual state again
      return false;
    }
    await this.end();
    return true;
  }

  /** Ends and keeps the running recording. */
  async end() {
    const recording = await this.app.world.ask("endRecording");
    if (this.app.moment) this.app.moment.recorded = null;
    this.keep(recording, false);
  }

  /**
   * @param {Recording} recording
   * @param {boolean} full whether it ended on its own
   */
  keep(recording, full) {
    this.app.emit("tape", { recording });
    this.app.announce("tape", { steps: recording.steps, full });
  }

  /**
   * Replays a recording, in the world that it was made in.
   * @param {Recording} recording
   * @param {boolean} [play]
   */
  async replay(recording, play = true) {
    if (!(await this.consent("A replay"))) return;
    if (this.app.state.twin) await this.app.compare(null);
    if (recording.yaml !== null && recording.yaml !== this.app.scene?.yaml) await this.app.make({}, null, recording.yaml);
    await this.app.world.ask("replay", recording);
    this.last = recording;
    this.app.emit("over", "replayed");
    this.app.play(play);
  }
}
