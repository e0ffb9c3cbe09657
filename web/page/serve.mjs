// Serves a folder on this machine, compressed, with validators: `node serve.mjs DIR [PORT]`. Any static host works, too; answers are
// smallest from a host that serves FILE.br, which the build leaves beside FILE.
import { createHash } from "node:crypto";
import { readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".json": "application/json", ".webmanifest": "application/manifest+json", ".svg": "image/svg+xml", ".png": "image/png", ".woff2": "font/woff2", ".txt": "text/plain; charset=utf-8" };
/** Types that do not compress. */
const PACKED = new Set([".woff2", ".png"]);
const PACKERS = { br: (bytes) => brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 5 } }), gzip: (bytes) => gzipSync(bytes) };

/**
 * @param {string} folder
 * @param {number} port 0 takes a free one
 * @param {string} [under] path that the folder appears under
 * @param {{ bare?: boolean, seen?: (path: string) => void }} [how] bare: like the plainest hosts, without compression and validators
 * @returns {Promise<{ url: string, close: () => void }>}
 */
export function serve(folder, port = 0, under = "/", { bare = false, seen = () => {} } = {}) {
  const root = resolve(folder);
  const found = files(root, under);
  const server = createServer((request, response) => {
    const file = found(request.url ?? "/");
    if (!file) return response.writeHead(404).end("There is no such file.");
    seen(file.name);
    if (bare) return response.writeHead(200, { "content-type": file.type, "content-length": file.bytes.length }).end(file.bytes);
    const shared = { etag: file.etag, "cache-control": "no-cache", vary: "accept-encoding" };
    if (request.headers["if-none-match"] === file.etag) return response.writeHead(304, shared).end();
    const coding = Object.keys(PACKERS).find((name) => file.shrinks && new RegExp(`\\b${name}\\b`).test(request.headers["accept-encoding"] ?? ""));
    const body = coding ? (file.packed[coding] ??= PACKERS[coding](file.bytes)) : file.bytes;
    response.writeHead(200, { ...shared, "content-type": file.type, "content-length": body.length, ...(coding && { "content-encoding": coding }) });
    return response.end(request.method === "HEAD" ? undefined : body);
  });
  return new Promise((done) => server.listen(port, "127.0.0.1", () => done({ url: `http://127.0.0.1:${server.address().port}${under}`, close: () => void (server.close(), server.closeAllConnections()) })));
}

/**
 * Finds files by address; each is read and packed once, until it changes.
 * @param {string} root
 * @param {string} under
 */
function files(root, under) {
  const known = new Map();
  return (url) => {
    const path = pathOf(url);
    if (!path?.startsWith(under)) return undefined;
    const name = normalize(path.slice(under.length - 1));
    const target = join(root, name.endsWith("/") ? `${name}index.html` : name);
    const stat = target.startsWith(root + sep) ? statSync(target, { throwIfNoEntry: false }) : undefined;
    if (!stat?.isFile()) return undefined;
    const version = `${stat.mtimeMs} ${stat.size}`;
    if (known.get(target)?.version !== version) {
      const bytes = readFileSync(target);
      const etag = `"${createHash("sha256").update(bytes).digest("base64url").slice(0, 22)}"`;
      const beside = statSync(`${target}.br`, { throwIfNoEntry: false });
      const packed = beside && beside.mtimeMs >= stat.mtimeMs ? { br: readFileSync(`${target}.br`) } : {};
      known.set(target, { name, version, bytes, etag, type: TYPES[extname(target)] ?? "application/octet-stream", shrinks: !PACKED.has(extname(target)), packed });
    }
    return known.get(target);
  };
}

/** Reads the path of an address; null if it is invalid. @param {string} url */
function pathOf(url) {
  try {
    const path = decodeURIComponent(new URL(url, "http://x").pathname);
    return path.includes("\0") ? undefined : path;
  } catch {
    return undefined;
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { url } = await serve(process.argv[2] ?? "dist", Number(process.argv[3] ?? 8080));
  console.log(`MIMo waits at ${url}`);
}
