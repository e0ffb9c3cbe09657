// Serves a folder on this machine: `node serve.mjs DIR [PORT]`. Any static host does as well.
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".json": "application/json", ".woff2": "font/woff2", ".txt": "text/plain; charset=utf-8" };

/**
 * @param {string} folder
 * @param {number} port 0 takes a free one
 * @param {string} [under] path that the folder appears under
 * @returns {Promise<{ url: string, close: () => void }>}
 */
export function serve(folder, port = 0, under = "/") {
  const root = resolve(folder);
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url ?? "/", "http://x").pathname));
    const file = join(root, path.startsWith(under) ? path.slice(under.length - 1) : "/none");
    const target = file.endsWith("/") ? join(file, "index.html") : file;
    const stat = target.startsWith(root) ? statSync(target, { throwIfNoEntry: false }) : undefined;
    if (!stat?.isFile()) return response.writeHead(404).end("There is no such file.");
    response.writeHead(200, { "content-type": TYPES[extname(target)] ?? "application/octet-stream", "content-length": stat.size });
    return createReadStream(target).pipe(response);
  });
  return new Promise((done) => server.listen(port, "127.0.0.1", () => done({ url: `http://127.0.0.1:${server.address().port}${under}`, close: () => void (server.close(), server.closeAllConnections()) })));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { url } = await serve(process.argv[2] ?? "dist", Number(process.argv[3] ?? 8080));
  console.log(`MIMo waits at ${url}`);
}
