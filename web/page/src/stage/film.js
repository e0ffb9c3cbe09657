// Pictures and short videos of the scene.

/** Longest video, ms. */
const LONGEST = 20_000;
const TYPES = ["video/mp4;codecs=avc1.42E01E", "video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];

/**
 * Draws again at double resolution and returns the picture. A canvas does not keep what it shows.
 * @param {import("./stage.js").Stage} stage
 * @returns {Promise<Blob>}
 */
export function picture(stage) {
  const { sharpness } = stage;
  stage.sharpness = 2;
  stage.resize();
  stage.draw();
  const blob = new Promise((resolve, reject) => {
    stage.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The browser could not make the picture."))), "image/png");
  });
  stage.sharpness = sharpness;
  stage.resize();
  return blob;
}

export class Film {
  static possible() {
    return typeof MediaRecorder === "function" && TYPES.some((t) => MediaRecorder.isTypeSupported(t));
  }

  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** @type {MediaRecorder | null} */
    this.recorder = null;
    /** @type {Blob[]} */
    this.parts = [];
  }

  get running() {
    return this.recorder !== null;
  }

  /** @param {() => void} full called when it is long enough */
  start(full) {
    const mimeType = TYPES.find((t) => MediaRecorder.isTypeSupported(t));
    this.parts = [];
    this.recorder = new MediaRecorder(this.canvas.captureStream(30), { mimeType, videoBitsPerSecond: 8_000_000 });
    this.recorder.ondataavailable = (e) => this.parts.push(e.data);
    this.recorder.start(500);
    this.timer = setTimeout(full, LONGEST);
  }

  /** @returns {Promise<Blob>} */
  stop() {
    clearTimeout(this.timer);
    const { recorder } = this;
    this.recorder = null;
    return new Promise((resolve, reject) => {
      if (!recorder) return reject(new Error("No video is being recorded."));
      recorder.onstop = () => resolve(new Blob(this.parts, { type: recorder.mimeType }));
      recorder.stop();
      for (const track of recorder.stream.getTracks()) track.stop();
    });
  }
}
