// Settings that the browser keeps for the next visit: few, and the page works without them.

/**
 * @param {string} key
 * @param {string} [value] kept from now on
 * @returns {string | null}
 */
export function kept(key, value) {
  try {
    if (value !== undefined) localStorage.setItem(`mimo ${key}`, value);
    return localStorage.getItem(`mimo ${key}`);
  } catch {
    return null; // private windows and frames of other pages may have no storage
  }
}
