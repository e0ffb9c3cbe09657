// The layout of a frame: one buffer of 32-bit numbers that the worker fills and the page reads.

/** Numbers of a contact: position, force in the world, both bodies. */
export const CONTACT = 8;
/** Contacts that fit into a frame. */
export const CONTACTS = 96;

/**
 * @param {{ drawables: number, bodies: number, sensors: number, worn: number, actions: number, joints: number }} count
 * @returns {import("./types").Layout}
 */
export function layoutOf(count) {
  const poses = 0;
  const bodies = poses + 12 * count.drawables;
  const felt = bodies + 7 * count.bodies;
  const worn = felt + count.sensors;
  const action = worn + count.worn;
  const angles = action + count.actions;
  const torques = angles + count.joints;
  const balance = torques + count.joints;
  const contacts = balance + 6;
  return { poses, bodies, felt, worn, action, angles, torques, balance, contacts, length: contacts + CONTACT * CONTACTS };
}
