// Serves the repository to browsers, and takes what their pages report.
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
/** @type {Record<string, string>} */
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".yml": "text/plain", ".onnx": "application/octet-stream" };

/** @returns {Promise<{ page: string, reported: Promise<string>, close: () => void }>} */
export async function serve() {
  let tell = (/** @type {string} */ _) => {};
  /** @type {Promise<string>} */
  const reported = new Promise((done) => (tell = done));
  const server = createServer(async (request, response) => {
    if (request.method === "POST") {
      let body = "";
      for await (const chunk of request) body += chunk;
      tell(body);
      return response.end();
    }
    const file = join(root, normalize(decodeURIComponent(new URL(request.url ?? "/", "http://x").pathname)));
    const type = TYPES[extname(file)];
    if (!type || !statSync(file, { throwIfNoEntry: false })?.isFile()) return response.writeHead(404).end();
    response.writeHead(200, { "content-type": type });
    return createReadStream(file).pipe(response);
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", () => done(undefined)));
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  return { page: `http://127.0.0.1:${port}/web/tests/package/page.html`, reported, close: () => server.close() };
}
