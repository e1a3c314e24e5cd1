// Runs taplo's language server on standard input and output, as editors expect it. The server is that of the VS Code extension "Even Better
// TOML". Install it with npm install @taplo/lsp in the folder of this file or a parent folder, or set NODE_PATH.
const fs = require("fs"), path = require("path"), url = require("url");
const { TaploLsp } = require("@taplo/lsp");
function findConfigFile(from) {
  for (const name of [".taplo.toml", "taplo.toml"])
    if (fs.existsSync(path.join(from, name))) return path.join(from, name);
}
const environment = {
  cwd: () => process.cwd(),
  envVar: (name) => process.env[name],
  envVars: () => Object.entries(process.env),
  findConfigFile,
  glob: () => [],
  isAbsolute: (p) => path.isAbsolute(p),
  now: () => new Date(),
  readFile: (p) => fs.promises.readFile(p),
  writeFile: (p, bytes) => fs.promises.writeFile(p, bytes),
  stdErrAtty: () => false,
  stdin: process.stdin,
  stdout: process.stderr,
  stderr: process.stderr,
  urlToFilePath: (u) => (u.startsWith("file:") ? url.fileURLToPath(u) : new URL(u).pathname),
  fetch: { fetch, Headers, Request, Response },
};
const write = (message) => {
  const body = Buffer.from(JSON.stringify(message));
  process.stdout.write(`Content-Length: ${body.length}\r\n\r\n`);
  process.stdout.write(body);
};
(async () => {
  const server = await TaploLsp.initialize(environment, { onMessage: write });
  let buffer = Buffer.alloc(0);
  process.stdin.on("data", (chunk) => {
    buffer = Buffer.concat([buffer, chunk]);
    for (;;) {
      const end = buffer.indexOf("\r\n\r\n");
      if (end < 0) return;
      const length = Number(/content-length: *(\d+)/i.exec(buffer.subarray(0, end).toString())[1]);
      if (buffer.length < end + 4 + length) return;
      const message = JSON.parse(buffer.subarray(end + 4, end + 4 + length).toString());
      buffer = buffer.subarray(end + 4 + length);
      server.send(message);
    }
  });
  process.stdin.on("end", () => process.exit(0));
})();
