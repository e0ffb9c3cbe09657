// The pace of a world: as many steps as the elapsed time requires, however long frames take.

/** Longest run of steps between checks for messages, ms. */
export const BUDGET = 24;
/** Milliseconds between checks of the time. */
const BEAT = 8;
/** Seconds over which the shown pace is averaged. */
const MEMORY = 0.5;

export class Clock {
  /**
   * @param {() => void} step one step of the world
   * @param {() => number} seconds simulated seconds of a step
   * @param {(stepped: number) => void} show
   * @param {() => boolean} ready whether another frame may be made
   * @param {(error: unknown) => void} fail
   */
  constructor(step, seconds, show, ready, fail) {
    this.step = step;
    this.seconds = seconds;
    this.show = show;
    this.ready = ready;
    this.fail = fail;
    this.playing = false;
    this.speed = 1;
    this.debt = 0;
    this.last = 0;
    /** Milliseconds of a step and simulated seconds per second, smoothed. */
    this.cost = 0;
    this.pace = 0;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.timer = undefined;
  }

  /** @param {boolean} on */
  play(on) {
    if (on === this.playing) return;
    this.playing = on;
    clearTimeout(this.timer);
    this.debt = this.pace = 0;
    this.last = performance.now();
    if (on) this.timer = setTimeout(() => this.beat(), 0);
  }

  beat() {
    this.timer = setTimeout(() => this.beat(), BEAT);
    const now = performance.now();
    const passed = (now - this.last) / 1000;
    this.last = now;
    this.debt = Math.min(this.debt + passed * this.speed, 0.25 * this.speed + this.seconds());
    let done = 0;
    try {
      while (this.playing && this.debt >= this.seconds() && performance.now() - now < BUDGET) {
        this.debt -= this.seconds();
        this.step();
        done++;
      }
      // beats without a step count, too, because steps may be longer than beats
      const share = 1 - Math.exp(-passed / MEMORY);
      if (passed > 0) this.pace += share * ((done * this.seconds()) / passed - this.pace);
      if (!done) return;
      this.cost += 0.1 * ((performance.now() - now) / done - this.cost);
      // the last frame is shown in any case
      if (this.ready() || !this.playing) this.show(done);
    } catch (e) {
      this.play(false);
      this.fail(e);
    }
  }
}
