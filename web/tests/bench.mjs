// What the tests need: stores, servers, pages, and a reader of stores that shares no code with the
// page.

import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import net from "node:net";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const here = dirname(fileURLToPath(import.meta.url));
const program = process.env.CATENIX_BIN ?? join(here, "../../target/debug/catenix");
export const folder = mkdtempSync(join(tmpdir(), "catenix-viewer-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** Time that a page gets: test machines are busy [ms]. */
export const PATIENCE = 60000;

/** Computes a model and returns the directory of its results. */
export function compute(model, name) {
  const out = join(folder, name);
  const run = spawnSync(program, ["run", model, "--quiet", "--out", out], { encoding: "utf8" });
  if (run.status !== 0) {
    throw new Error(`the run failed: ${run.stderr}`);
  }
  return out;
}

/** Programs that run: a test that fails leaves its own behind, and the file would never end. */
const running = new Set();

/** Starts the program and waits for the viewer's link. */
export async function start(...args) {
  const child = spawn(program, [...args, "--no-open"], { stdio: ["ignore", "ignore", "pipe"] });
  let text = "";
  running.add(child);
  child.on("exit", () => running.delete(child));
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const url = await new Promise((resolve, reject) => {
    child.stderr.on("data", (data) => {
      text += data;
      const found = text.match(/viewer: (http:\S+)/);
      if (found) {
        resolve(found[1]);
      }
    });
    child.on("exit", () => reject(new Error(`no viewer: ${text}`)));
  });
  const stop = async () => {
    child.kill("SIGCONT");
    child.kill("SIGTERM");
    return ended;
  };
  return { url, child, stop, text: () => text };
}

let browser = null;

export async function openPage(url, options = {}) {
  browser ??= await chromium.launch({
    executablePath: process.env.CATENIX_CHROMIUM ?? "/usr/bin/chromium",
    // As a browser draws on a machine without a graphics card: three dimensions by SwiftShader,
    // everything else by itself.
    args: ["--no-sandbox", "--enable-unsafe-swiftshader"],
  });
  const context = await browser.newContext({
    viewport: { width: 1000, height: 640 },
    reducedMotion: "reduce",
    acceptDownloads: true,
    ...options,
  });
  context.setDefaultTimeout(PATIENCE);
  const { CATENIX_ASSETS: assets } = process.env;
  if (assets) {
    // A page that was just built, without building the program around it again.
    const own = (url) => /^\/\w+\/(app\.js|app\.css|index\.html)?$/.test(url.pathname);
    await context.route(own, (route, request) => {
      const name = new URL(request.url()).pathname.split("/").pop() || "index.html";
      return route.fulfill({ path: join(assets, name) });
    });
  }
  const page = await context.newPage();
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  await page.goto(url);
  return page;
}

export async function closeBrowser() {
  await browser?.close();
  browser = null;
  for (const child of running) {
    child.kill("SIGKILL");
  }
}

/** Waits until the scene shows all that it should. */
export async function ready(page) {
  await page.waitForFunction(() => document.querySelector("#scene").dataset.ready === "true");
  // The picture of that moment and the numbers beside it come one frame later at most.
  await page.waitForTimeout(150);
}

/** Puts the slider on a stored step. */
export async function scrub(page, row) {
  await page.$eval(
    "#scrub",
    (slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input"));
    },
    row,
  );
  await ready(page);
}

/** The number in the readout, with all its digits. */
export async function shownValue(page, name) {
  await page.waitForFunction((wanted) => {
    const shown = document.querySelector(`#readout b[data-case="${wanted}"]`);
    return shown && shown.dataset.value !== "NaN";
  }, name);
  return Number(await page.getAttribute(`#readout b[data-case="${name}"]`, "data-value"));
}

/** A proxy in front of a server, to cut and mend its connection, or to lead elsewhere. */
export async function proxy(url) {
  const address = new URL(url);
  let target = Number(address.port);
  let open = true;
  const sockets = new Set();
  const server = net.createServer((client) => {
    if (!open) {
      client.destroy();
      return;
    }
    const upstream = net.connect(target, "127.0.0.1");
    for (const [from, to] of [[client, upstream], [upstream, client]]) {
      sockets.add(from);
      from.on("error", () => to.destroy());
      from.on("close", () => to.destroy());
      from.pipe(to);
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  address.port = String(server.address().port);
  const cut = () => {
    open = false;
    sockets.forEach((socket) => socket.destroy());
    sockets.clear();
  };
  return {
    url: address.href,
    cut,
    mend: () => (open = true),
    lead: (other) => {
      cut();
      target = Number(new URL(other).port);
      open = true;
    },
    close: () => {
      cut();
      server.close();
    },
  };
}

/** Lays the archives of the cases that have ended out as folders, which stores may have as well. */
export function unpack(results) {
  const cases = join(results, "results.zarr", "cases");
  for (const name of readdirSync(cases).filter((name) => name.endsWith(".zip"))) {
    for (const [file, content] of unzipped(readFileSync(join(cases, name)))) {
      const path = join(cases, name.slice(0, -4), ...file.split("/"));
      mkdirSync(dirname(path), { recursive: true });
      writeFileSync(path, content);
    }
    rmSync(join(cases, name));
  }
}

/** The files of an archive, by name: one after another, uncompressed, each behind its header. */
function unzipped(bytes) {
  const files = new Map();
  for (let at = 0; bytes.readUInt32LE(at) === 0x04034b50; ) {
    const [size, length] = [bytes.readUInt32LE(at + 22), bytes.readUInt16LE(at + 26)];
    const start = at + 30 + length;
    files.set(bytes.toString("utf8", at + 30, start), bytes.subarray(start, start + size));
    at = start + size;
  }
  return files;
}

/** An array of a store: shape, and values of a row or of everything. */
export function array(results, path) {
  const [, name, ...inside] = path.split("/");
  const folder = join(results, "results.zarr", "cases", name);
  const archive = `${folder}.zip`;
  const files = existsSync(archive) ? unzipped(readFileSync(archive)) : null;
  const read = (...way) => {
    const whole = [...inside, ...way];
    return files ? files.get(whole.join("/")) : readFileSync(join(folder, ...whole));
  };
  const meta = JSON.parse(read("zarr.json").toString("utf8"));
  const [rows, columns = 1] = meta.shape;
  const chunkRows = meta.chunk_grid.configuration.chunk_shape[0];
  const size = meta.data_type === "float32" ? 4 : 8;
  const at = (row, column = 0) => {
    const chunk = Math.floor(row / chunkRows);
    const tail = meta.shape.length > 1 ? [String(chunk), "0"] : [String(chunk)];
    const bytes = read("c", ...tail);
    const offset = ((row - chunk * chunkRows) * columns + column) * size;
    return size === 4 ? bytes.readFloatLE(offset) : bytes.readDoubleLE(offset);
  };
  return { rows, columns, at };
}
