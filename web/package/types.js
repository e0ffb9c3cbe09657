// The types of arguments and results.

/** @typedef {Record<string, string | number | boolean | string[] | null | undefined>} Settings values of a configuration by key; null for none */
/** @typedef {Record<string, string | Uint8Array>} Assets files by path, as `rooms/mine.xml`; a text is UTF-8 */
/** @typedef {Record<string, string | number | boolean | string[] | null>} Config every value of a configuration by key */

/**
 * One key of a configuration.
 * @typedef {object} ConfigKey
 * @property {string} name
 * @property {string} section
 * @property {"boolean" | "integer" | "number" | "choice" | "list" | "text"} kind
 * @property {string[] | null} options of a choice, or what a list may hold
 * @property {number | null} min
 * @property {number | null} max
 * @property {string} expected the allowed values, in words
 * @property {string | number | boolean | string[] | null} default
 * @property {string} doc what it means
 */

/**
 * What MIMo senses. Views on the module's memory: they change with the next step; copy what you keep.
 * @typedef {object} Observation
 * @property {Float64Array} proprioception Gymnasium's key `observation`
 * @property {Float32Array | null} touch what the skin feels, N
 * @property {Float64Array | null} touch_pooled with `touch_pooled`, five for each body with skin: sum of the normal forces, N, number of sensors that feel something, sum of the forces in the frame of the body, N
 * @property {Float32Array | null} pain of each touch sensor, with `pain_active`
 * @property {Uint8Array | null} eye_left rows from the top; red, green, blue
 * @property {Uint8Array | null} eye_right
 * @property {Uint8Array | null} eye_left_gray brightness, where `vision_outputs` has `gray`
 * @property {Uint8Array | null} eye_right_gray
 * @property {Float32Array | null} eye_left_depth distance from the camera's plane, m, where it has `depth`
 * @property {Float32Array | null} eye_right_depth
 * @property {Int32Array | null} eye_left_segmentation ids of geoms, -1 for none, where it has `segmentation`
 * @property {Int32Array | null} eye_right_segmentation
 * @property {Float64Array | null} vestibular acceleration, m/s^2, and angular velocity, rad/s, of the head
 * @property {Float64Array | null} reflexes how strongly each reflex acts, 0 to 1, in the order of the keys of `Info.reflexes`, with `reflex_observed`
 * @property {Float64Array | null} achieved_goal of a task with goals
 * @property {Float64Array | null} desired_goal
 */

/**
 * One entry of the observation.
 * @typedef {object} ObservationSpace
 * @property {Exclude<keyof Observation, number>} name the property of an observation
 * @property {string} key the same, but `observation` for `proprioception`
 * @property {number[]} shape
 * @property {"float64" | "float32" | "uint8" | "int32"} dtype
 * @property {number} low of every number
 * @property {number} high of every number
 */

/**
 * @template T
 * @typedef {{ right_hand: T, left_hand: T }} PerHand
 */

/**
 * What a step reports.
 * @typedef {object} Info
 * @property {number} steps of the episode
 * @property {"none" | "self_touch" | "hand_regard" | "reach" | "standup" | "selfbody" | "catch" | "roll_over" | "mobile" | "play"} behavior
 * @property {PerHand<number[]> | null} touches geoms that each palm has touched
 * @property {PerHand<string[]> | null} touched_parts their names
 * @property {number[] | null} regards steps in which each eye saw each hand: right eye with right and left hand, left eye
 * @property {number[] | null} page_regards the same, within 15 degrees of the axis of the eye's camera, as BabyBench's page describes it
 * @property {number[] | null} kit_regards the same, within 15 degrees of the -z axis of the eye's body, as the Python kit computes it
 * @property {number[] | null} gaze_angles between the axis of each eye and each hand, rad
 * @property {number | null} age the age with which the episode began, months, where `age` is a schedule
 * @property {Record<string, number> | null} reflexes share of the episode's physics steps in which each reflex acted, by name
 * @property {number | null} score that the episode would have alone
 * @property {boolean | null} is_success whether a task's goal is reached
 * @property {boolean | null} is_failure whether it is out of reach
 * @property {number | null} return sum of a task's rewards in this episode
 * @property {number[] | null} reward_terms the values besides goals that its reward depends on
 * @property {Record<string, number> | null} measures what a task measures besides, by name; empty for most
 */

/**
 * The result of a step, in Gymnasium's words.
 * @typedef {object} Step
 * @property {Observation} observation
 * @property {number} reward of a task; 0 for behaviors
 * @property {boolean} terminated whether a task has succeeded or failed
 * @property {boolean} truncated whether the episode has reached `max_episode_steps`
 * @property {Info} info
 */

/**
 * A camera anywhere, as MuJoCo's `mjvCamera`.
 * @typedef {object} FreeCamera
 * @property {[number, number, number]} lookat the point in the middle of the picture, m
 * @property {number} distance from it, m
 * @property {number} azimuth degrees, about the vertical
 * @property {number} elevation degrees, negative from above
 */

/**
 * The drawn data of a moment; views on the module's memory.
 * @typedef {object} Frame
 * @property {Float32Array} poses 12 for each drawable: position, m, and rotation matrix, row by row, its columns as long as the thing has grown since it was compiled
 * @property {Float32Array} bodies 7 for each body: position, m, and quaternion, w first
 * @property {Float32Array} felt size of the force at each touch sensor, N
 * @property {Float32Array} contacts 8 for each contact: point, m, force on the second body, N, the two bodies
 * @property {Float32Array} worn for each drawable that is worn, in their order, 6 for each vertex of its mesh: positions of all, m, then their unit normals, in the world
 */

/**
 * @typedef {object} Joint
 * @property {string} name
 * @property {number} body
 * @property {"free" | "slide" | "hinge"} type
 * @property {number} qposadr
 * @property {number} dofadr
 * @property {[number, number] | null} range
 * @property {string | null} part of MIMo, as in the keys `lock_*`
 */

/**
 * The compiled scene.
 * @typedef {object} Model
 * @property {{ name: string, parent: number, mass: number, subtreemass: number, invweight0: [number, number] }[]} bodies
 * @property {Joint[]} joints
 * @property {{ name: string, body: number }[]} geoms
 * @property {{ name: string, body: number, fovy: number }[]} cameras
 * @property {{ name: string, actuator: number, joint: number, part: string | null, low: number, high: number }[]} actions
 * @property {number} timestep of the physics, s
 * @property {number} frame_skip
 * @property {number} nq
 * @property {number} nv
 * @property {number} nu
 */

/**
 * @typedef {object} Drawable
 * @property {string} name
 * @property {number | null} geom
 * @property {number} body
 * @property {"plane" | "sphere" | "capsule" | "cylinder" | "box" | "mesh"} shape
 * @property {{ id: number, position: Float32Array, normal: Float32Array, texcoord: Float32Array | null, index: Uint16Array } | null} mesh triangles of a mesh, in true size
 * @property {boolean} worn whether it is a skin, which bodies bend: its mesh is as the scene has it, that of a moment is in `worn` of a frame
 * @property {[number, number, number]} size half sizes, m; a capsule's are radius, radius, half length of its cylinder
 * @property {[number, number, number, number]} rgba
 * @property {number} emission
 * @property {number} specular
 * @property {number} exponent of highlights
 * @property {number | null} texture
 * @property {[number, number, number]} texture_scale
 * @property {number} texture_offset
 */

/**
 * The look of the scene.
 * @typedef {object} Look
 * @property {Drawable[]} drawables
 * @property {{ width: number, height: number }[][]} textures one image, or the six sides of a cube
 * @property {number | null} sky
 * @property {{ body: number, pos: [number, number, number] | null, dir: [number, number, number], ambient: [number, number, number], diffuse: [number, number, number], specular: [number, number, number] }[]} lights
 * @property {{ ambient: [number, number, number], diffuse: [number, number, number], specular: [number, number, number] } | null} headlight
 * @property {number} near
 * @property {number} far
 */

/**
 * The joints that a lock changed, by name.
 * @typedef {object} LockReport
 * @property {string[]} changed
 * @property {string[]} held by another constraint of the scene
 * @property {string[]} beyond_limits
 */

export {};
