// Measures how fast the page opens a store and plays it:
// `node measure.mjs DIR [WIDTH HEIGHT [SPEED]]`, with CATENIX_BIN naming the program.
//
// Prints the elapsed time until the first whole picture, pictures per second while it plays, and
// where processor time went, which says more than elapsed time on a machine that others use too.

import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { closeBrowser, openPage, start } from "./tests/bench.mjs";

const [directory, width = "1000", height = "640", speed = "1"] = process.argv.slice(2);
if (!directory) {
  throw new Error("usage: node measure.mjs DIR [WIDTH HEIGHT [SPEED]]");
}
/** Time that is played [ms]. */
const PLAYED_MS = 10000;
const ticks = Number(execFileSync("getconf", ["CLK_TCK"]).toString());

const server = await start("view", directory);
const page = await openPage("about:blank", { viewport: { width: Number(width), height: Number(height) } });
await page.addInitScript(() => {
  new MutationObserver(() => {
    if (document.querySelector("#scene")?.dataset.ready === "true") {
      window.openedAt ??= performance.now();
    }
  }).observe(document, { subtree: true, attributes: true, attributeFilter: ["data-ready"] });
});
const client = await page.context().newCDPSession(page);
await client.send("Profiler.enable");
await client.send("Profiler.setSamplingInterval", { interval: 500 });

// The browser is open already when somebody looks at results.
await page.waitForTimeout(3000);
let before = processorTimes();
await client.send("Profiler.start");
await page.goto(server.url);
await page.waitForFunction(() => window.openedAt !== undefined);
const opened = await page.evaluate(() => window.openedAt);
console.log(`opened after ${(opened / 1000).toFixed(2)} s`);
await tell("to the first picture");
await page.waitForTimeout(4000);
before = await phase("in the four seconds after it");

const box = await (await page.$("#scene")).boundingBox();
await page.selectOption("#speed", speed);
await client.send("Profiler.start");
await page.click("#play");
const frames = await page.evaluate(async (span) => {
  let last = document.querySelector("#scene").dataset.time;
  let drawn = 0;
  const begin = performance.now();
  while (performance.now() < begin + span) {
    await new Promise(requestAnimationFrame);
    const { time } = document.querySelector("#scene").dataset;
    drawn += time === last ? 0 : 1;
    last = time;
  }
  return (1000 * drawn) / (performance.now() - begin);
}, PLAYED_MS);
console.log(`${frames.toFixed(1)} pictures a second, scene of ${box.width} x ${box.height} px, speed x ${speed}`);
await phase("while playing");
await closeBrowser();
await server.stop();

async function tell(what) {
  const { profile } = await client.send("Profiler.stop");
  printProfile(profile, what);
  const now = processorTimes();
  printTimes(before, now, what);
  before = now;
}

async function phase(what) {
  if (what.startsWith("in the")) {
    printTimes(before, processorTimes(), what);
  } else {
    await tell(what);
  }
  return processorTimes();
}

/** Functions of the page in which most processor time was spent. */
function printProfile({ nodes, samples, timeDeltas }, what) {
  const own = new Map();
  const byId = new Map(nodes.map((node) => [node.id, node]));
  samples.forEach((id, k) => {
    const { callFrame } = byId.get(id);
    const name = callFrame.functionName || "(anonymous)";
    own.set(name, (own.get(name) ?? 0) + timeDeltas[k] / 1000);
  });
  const sorted = [...own].filter(([name]) => name !== "(idle)").sort((a, b) => b[1] - a[1]);
  const words = sorted.slice(0, 14).map(([name, ms]) => `${name} ${ms.toFixed(0)}`);
  console.log(`  page, ${what} [ms]: ${words.join(", ")}`);
}

/** Processor time of the server and of the browser's processes so far [s]. */
function processorTimes() {
  const times = new Map();
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = readFileSync(`/proc/${pid}/stat`, "utf8");
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      const command = readFileSync(`/proc/${pid}/cmdline`, "utf8");
      const kind = command.match(/--type=([\w-]+)/)?.[1];
      const own = Number(pid) === server.child.pid || descends(Number(pid));
      if (own) {
        const name = Number(pid) === server.child.pid ? "server" : (kind ?? "browser");
        times.set(name, (times.get(name) ?? 0) + (Number(fields[11]) + Number(fields[12])) / ticks);
      }
    } catch {
      // The process has ended meanwhile.
    }
  }
  return times;
}

function descends(pid) {
  while (pid > 1) {
    if (pid === process.pid) {
      return true;
    }
    const stat = readFileSync(`/proc/${pid}/stat`, "utf8");
    pid = Number(stat.slice(stat.lastIndexOf(")") + 2).split(" ")[1]);
  }
  return false;
}

function printTimes(from, to, what) {
  const words = [...to].map(([name, time]) => `${name} ${(time - (from.get(name) ?? 0)).toFixed(2)}`);
  console.log(`  processor time, ${what} [s]: ${words.join(", ")}`);
}
