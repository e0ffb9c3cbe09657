// What the files of the package share of the loaded module.

/** @type {{ memory?: WebAssembly.Memory }} */
export const module = {};
