// Custom rooms: the dropped files, and which of them is the scene.
import { unzip } from "./zip.js";

/** Limits of a room, in bytes and files: the library reads no larger one. */
const [MOST, COUNT] = [64 << 20, 2000];

/** @typedef {Record<string, Uint8Array<ArrayBuffer>>} Files by path */
/** @typedef {{ files: Files, scenes: string[], yaml: string | null }} Room scenes that include MIMo, and the configuration beside them */

/** Files that operating systems leave in folders. @param {string} path */
const hidden = (path) => path.split("/").some((part) => part.startsWith(".") || part === "__MACOSX");

/** A collection of files that throws once they exceed the limits. */
class Basket {
  /** @type {[string, Uint8Array<ArrayBuffer>][]} */
  files = [];
  size = 0;

  /**
   * Whether a file belongs to the room.
   * @param {string} path
   * @param {number} size
   */
  wants(path, size) {
    if (hidden(path) || path.endsWith("/")) return false;
    this.size += size;
    if (this.size > MOST || this.files.length >= COUNT) throw new Error(`That is more than a room may have: ${MOST >> 20} MB in ${COUNT} files. Drop the folder of the room alone.`);
    return true;
  }

  /**
   * @param {string} path
   * @param {File} file
   */
  async add(path, file) {
    if (!this.wants(path, file.size)) return;
    const bytes = new Uint8Array(await file.arrayBuffer());
    if (!/\.zip$/i.test(path)) return void this.files.push([path, bytes]);
    const inside = await unzip(bytes, (name, size) => this.wants(name, size), MOST);
    if (!inside) throw new Error(`${path} is not an archive (.zip).`);
    this.files.push(...inside);
  }
}

/**
 * Collects the files of a folder.
 * @param {FileSystemEntry} entry
 * @param {Basket} basket
 * @returns {Promise<void>}
 */
async function walk(entry, basket) {
  const path = entry.fullPath.replace(/^\//, "");
  if (hidden(path)) return;
  if (entry.isFile) return basket.add(path, await new Promise((done, failed) => /** @type {FileSystemFileEntry} */ (entry).file(done, failed)));
  const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
  for (;;) {
    /** @type {FileSystemEntry[]} */
    const some = await new Promise((done, failed) => reader.readEntries(done, failed));
    if (!some.length) return;
    for (const inner of some) await walk(inner, basket);
  }
}

/**
 * Reads what was dropped or chosen: folders, archives, or single files.
 * @param {(FileSystemEntry | File)[]} things
 * @returns {Promise<Room>}
 */
export async function readRoom(things) {
  const basket = new Basket();
  for (const thing of things) {
    if (thing instanceof File) await basket.add(thing.webkitRelativePath || thing.name, thing);
    else await walk(thing, basket);
  }
  return roomOf(basket.files);
}

/**
 * Finds the scenes among files: documents that include MIMo, directly or through others, and that no other document includes.
 * @param {[string, Uint8Array<ArrayBuffer>][]} list
 * @returns {Room}
 */
export function roomOf(list) {
  while (list.length && list.every(([path]) => path.includes("/") && path.split("/")[0] === list[0][0].split("/")[0])) list = list.map(([path, bytes]) => [path.slice(path.indexOf("/") + 1), bytes]);
  const files = Object.fromEntries(list);
  const depth = (/** @type {string} */ path) => path.split("/").length;
  const paths = Object.keys(files).sort((a, b) => depth(a) - depth(b) || (a < b ? -1 : 1));
  const text = (/** @type {string} */ path) => new TextDecoder().decode(files[path]);
  const last = (/** @type {string} */ path) => path.split("/").at(-1) ?? path;
  const documents = paths.filter((path) => /\.xml$/i.test(path));
  if (!documents.length) throw new Error("There is no room here: none of the files is an MJCF document (.xml).");
  const included = new Map(documents.map((path) => [path, Array.from(text(path).replace(/<!--.*?-->/gs, "").matchAll(/<include\s[^>]*?file\s*=\s*["']([^"']+)["']/g), (m) => last(m[1]))]));
  /** @type {(path: string, seen?: string[]) => boolean} */
  const hasMimo = (path, seen = []) => !seen.includes(path) && (included.get(path) ?? []).some((name) => name === "mimo.xml" || documents.some((other) => last(other) === name && hasMimo(other, [...seen, path])));
  const parts = new Set([...included.values()].flat());
  const scenes = documents.filter((path) => !parts.has(last(path)) && hasMimo(path));
  if (!scenes.length) {
    const named = documents.slice(0, 3).map(last).join(", ");
    throw new Error(`MIMo is in none of these documents: ${named}${documents.length > 3 ? ", ..." : ""}. A room includes mimo_settings.xml, mimo_actuators.xml and, in a body mimo_location, mimo.xml; the tab Setup has one to start from.`);
  }
  const configuration = paths.find((path) => /^[^/]+\.ya?ml$/i.test(path) && scenes.includes(sceneOf(text(path)) ?? ""));
  return { files, scenes, yaml: configuration === undefined ? null : text(configuration) };
}

/**
 * The document that settings name as their scene; nothing for a scene of the library.
 * @param {import("./types").Settings | string} settings
 */
export function sceneOf(settings) {
  const named = typeof settings === "string" ? /^scene:\s*["']?([^"'#\n]+?)["']?\s*(#.*)?$/m.exec(settings)?.[1] : settings.scene;
  return typeof named === "string" && /\.xml$/i.test(named) ? named : null;
}
