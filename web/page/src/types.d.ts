// The messages between the page and its worker, and the data that both keep.

/** A visible geom or site; `size` scales the unit shape, m. */
export interface Drawable {
  name: string;
  body: number;
  shape: "plane" | "sphere" | "capsule" | "cylinder" | "box" | "mesh";
  /** Triangles of a mesh. */
  mesh: Mesh | null;
  /** Whether bodies bend the mesh: a frame has its vertices. */
  worn?: boolean;
  size: [number, number, number];
  rgba: [number, number, number, number];
  specular: number;
  exponent: number;
  emission: number;
  texture: number | null;
  textureScale: [number, number, number];
  textureOffset: number;
}

/** Triangles in true size; `id` tells meshes apart. */
export interface Mesh {
  id: number;
  position: Float32Array<ArrayBuffer>;
  normal: Float32Array<ArrayBuffer>;
  texcoord: Float32Array<ArrayBuffer> | null;
  index: Uint16Array<ArrayBuffer>;
}

/** One image of a texture: RGBA, rows from the top. */
export interface TextureFace {
  width: number;
  height: number;
  pixels: Uint8Array<ArrayBuffer>;
}

export interface Joint {
  name: string;
  part: string | null;
  qpos: number;
  dof: number;
  low: number;
  high: number;
  locked: boolean;
}

export interface Action {
  name: string;
  part: string | null;
  low: number;
  high: number;
}

/** One entry of the table of configuration keys. */
export interface Key {
  name: string;
  section: string;
  kind: "boolean" | "integer" | "number" | "choice" | "list" | "text";
  options: string[] | null;
  min: number | null;
  max: number | null;
  doc: string;
  default: Setting;
}

export type Setting = string | number | boolean | string[] | null;
export type Settings = Record<string, Setting>;

/** The data about a world that the page gets once. */
export interface Scene {
  /** Every key. */
  settings: Settings;
  /** The keys that differ from their defaults. */
  changed: Settings;
  yaml: string;
  drawables: Drawable[];
  textures: TextureFace[][];
  bodies: { name: string; parent: number; mass: number; invweight: number; movable: boolean }[];
  joints: Joint[];
  actions: Action[];
  cameras: string[];
  skin: { at: Float32Array; of: Uint16Array };
  layout: Layout;
  /** Seconds of a step. */
  timestep: number;
  /** The scene of the MIMo beside him, if there is one; or why there is none. */
  twin?: Scene | null;
  alone?: string | null;
  /** Why the network that moved MIMo cannot go on, if so. */
  misfit: string | null;
}

/** Where the parts of a frame start, in numbers of 4 bytes. */
export interface Layout {
  poses: number;
  bodies: number;
  felt: number;
  worn: number;
  action: number;
  angles: number;
  torques: number;
  balance: number;
  contacts: number;
  length: number;
}

/** The counters of the behavior, for display. */
export interface Score {
  behavior: string;
  value: number | null;
  steps: number;
  /** Whether a task's goal is reached, and what it has earned in this episode. */
  success: boolean | null;
  failure: boolean | null;
  earned: number | null;
  hands: { right: string[]; left: string[]; reachable: number } | null;
  regards: [number, number, number, number] | null;
  /** The same, counted as the kit does. */
  kit: [number, number, number, number] | null;
}

/** What the eyes report: left and right picture, RGBA, width and height of each, and their age, s. */
export interface Glance {
  pixels: Uint8ClampedArray<ArrayBuffer>;
  sizes: [[number, number], [number, number]];
  late: number;
}

/** The data that come with the numbers of a frame. */
export interface Moment {
  time: number;
  steps: number;
  /** Milliseconds of a step, smoothed. */
  cost: number;
  /** Simulated seconds per second. */
  pace: number;
  playing: boolean;
  truncated: boolean;
  /** Whether a task has ended; only its next episode can continue. */
  over: boolean;
  contacts: number;
  score: Score;
  recorded: number | null;
  replay: { done: number; of: number } | null;
  /** The range of reachable moments and the current one, in steps; whether they are those of a recording. */
  line: { from: number; at: number; to: number; recording: boolean };
  memory: number;
  pull: { body: number; at: [number, number, number]; force: number } | null;
}

export type PolicyName = "babbling" | "random" | "sine" | "zero" | "model";

/** The own settings of the MIMo beside the first: age, months, or null for the original; policy; delays, ms. */
export interface Twin {
  age: number | null;
  policy: PolicyName;
  sensory: number;
  motor: number;
}

/** The state of a page, enough to continue with the same bits. */
export interface PageState {
  settings: Settings;
  seed: number;
  policy: PolicyName;
  /** Sliders that are held, by index of the action. */
  held: Record<number, number>;
  /** How strongly babbling and sine move, 0 to 1. */
  vigour: number;
  speed: number;
  /** The MIMo beside the first, if there is one. */
  twin?: Twin | null;
  view?: number[];
  locks: string[];
  /** The network of the policy `model`, in links and in the stored state. */
  network?: { name: string; size: number; url: string | null };
}

/** A request to the worker: a name, an id to answer with, and its arguments. */
export interface Request {
  id: number;
  name: string;
  args: unknown[];
}

/** A recording as `babybench replay` reads it. */
export interface Recording {
  qpos0: Float64Array;
  qvel0: Float64Array;
  activity0: Float64Array;
  actions: Float32Array;
  steps: number;
  yaml: string | null;
  end: Float64Array | null;
}
