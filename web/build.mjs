// Builds the page into the viewer crate. Run as `npm ci --ignore-scripts && npm run build`.
//
// The built files are committed, so that `cargo build` needs no node. Beside them stands a hash of
// everything they are made from; `cargo xtask tidy` compares it with the sources.

import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join, relative, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "../crates/viewer/assets");
mkdirSync(out, { recursive: true });

const result = await build({
  absWorkingDir: here,
  entryPoints: { app: "src/main.ts" },
  outdir: out,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "none",
  write: false,
  logLevel: "warning",
});
for (const file of result.outputFiles) {
  writeFileSync(file.path, file.contents);
}
for (const name of ["index.html", "icon.svg"]) {
  writeFileSync(join(out, name), readFileSync(join(here, name)));
}
const notices = ["three", "uplot"].map((name) => {
  const folder = join(here, "node_modules", name);
  const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  return `${name} ${version}\n\n${readFileSync(join(folder, "LICENSE"), "utf8").trim()}\n`;
});
writeFileSync(join(out, "licenses.txt"), notices.join("\n----\n\n"));
writeFileSync(join(out, "sources.sha256"), `${sourceHash()}\n`);

/** SHA-256 over the names and contents of the sources, in order of name. */
function sourceHash() {
  const files = ["build.mjs", "icon.svg", "index.html", "package-lock.json", "package.json", "tsconfig.json"];
  const walk = (folder) => {
    for (const entry of readdirSync(folder, { withFileTypes: true })) {
      const path = join(folder, entry.name);
      if (entry.isDirectory()) {
        walk(path);
      } else {
        files.push(relative(here, path).split(sep).join("/"));
      }
    }
  };
  walk(join(here, "src"));
  const hash = createHash("sha256");
  for (const file of files.sort()) {
    const text = readFileSync(join(here, file), "utf8").replaceAll("\r\n", "\n");
    hash.update(`${file}\n${Buffer.byteLength(text)}\n${text}`);
  }
  return hash.digest("hex");
}
