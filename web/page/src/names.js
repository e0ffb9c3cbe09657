// Readable names for what the model calls `act:right_shoulder_ad_ab` or `robot:left_hand2`.

/** @type {Record<string, string>} */
const WORDS = {
  ad_ab: "abduction",
  abduction: "abduction",
  hand1: "wrist rotation",
  hand2: "wrist flexion",
  hand3: "wrist side to side",
  foot1: "ankle flexion",
  foot2: "ankle inversion",
  foot3: "ankle rotation",
  hip1: "hip flexion",
  hip2: "hip abduction",
  hip3: "hip rotation",
  hip_lean1: "lower back lean",
  hip_rot1: "lower back twist",
  hip_bend1: "lower back bend",
  hip_lean2: "upper back lean",
  hip_rot2: "upper back twist",
  hip_bend2: "upper back bend",
  hip_bend: "trunk bend",
  hip_twist: "trunk twist",
  hip_lean: "trunk lean",
  hip_flex: "hip flexion",
  head_swivel: "head turn",
  head_tilt: "head nod",
  head_tilt_side: "head tilt",
  eye_horizontal: "eye left and right",
  eye_vertical: "eye up and down",
  eye_torsional: "eye roll",
  wrist_ulnar: "wrist side to side",
  shoulder_horizontal: "shoulder forward",
  shoulder_ad_ab: "shoulder raise",
  shoulder_abduction: "shoulder raise",
  shoulder_rotation: "shoulder rotation",
  shoulder_internal: "shoulder rotation",
  foot_flexion: "ankle flexion",
  foot_inversion: "ankle inversion",
  foot_rotation: "ankle rotation",
  ff: "index finger",
  mf: "middle finger",
  rf: "ring finger",
  lf: "little finger",
  th: "thumb",
};

/**
 * MIMo's tasks: each has its own scene and body.
 * @type {Record<string, { title: string, goal: string }>}
 */
export const TASKS = {
  reach: { title: "Reach", goal: "Knock the hovering ball, which his eyes follow, from its place with the right hand." },
  standup: { title: "Stand up", goal: "Rise from a crouch by the railing, until the head is half a metre above the ground." },
  selfbody: { title: "Touch a part", goal: "Touch one part of his own body, another in each episode, with the right hand." },
  catch: { title: "Catch", goal: "Hold the ball that falls into the right hand for a hundred steps; every effort costs." },
  roll_over: { title: "Roll over", goal: "Roll from the back to the belly, with as little effort as it takes." },
  mobile: { title: "Mobile", goal: "Move a limb more often while the mobile is tied to it by a ribbon than before." },
  play: { title: "Play", goal: "Touch every toy of the play room." },
};
/** The behaviors of BabyBench. @type {Record<string, string>} */
export const BEHAVIORS = { self_touch: "Self-touch", hand_regard: "Hand regard", none: "None" };

/** The parts of the body from head to feet, with their names. */
export const PARTS = /** @type {const} */ ({
  head: "Head",
  eyes: "Eyes",
  body: "Trunk",
  arms: "Arms",
  hands: "Wrists",
  fingers: "Fingers",
  legs: "Legs",
  feet: "Feet",
});

/**
 * @param {string} text
 * @returns {string}
 */
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/**
 * Splits a name of the model into a side and words.
 * @param {string} name
 * @returns {{ side: "" | "right" | "left", what: string }}
 */
export function split(name) {
  const bare = name.replace(/^[a-z]+:/, "");
  const match = /^(right|left)_(.*)$/.exec(bare);
  const side = /** @type {"" | "right" | "left"} */ (match?.[1] ?? "");
  return { side, what: words(match?.[2] ?? bare) };
}

/**
 * @param {string} bare
 * @returns {string}
 */
function words(bare) {
  if (WORDS[bare]) return WORDS[bare];
  const finger = /^(ff|mf|rf|lf|th)_?(.*)$/.exec(bare);
  if (finger) return `${WORDS[finger[1]]} ${finger[2].replace(/_/g, " ").trim()}`.trim();
  return bare.replace(/_/g, " ").replace(/([a-z])(\d)/g, "$1 $2");
}

/**
 * Returns a name to read: "right shoulder raise".
 * @param {string} name
 * @returns {string}
 */
export function readable(name) {
  const { side, what } = split(name);
  return capital(side ? `${side} ${what}` : what);
}
