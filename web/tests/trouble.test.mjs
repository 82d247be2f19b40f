// What the page says and does when something is wrong: the server, the store, the run.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { array, closeBrowser, compute, folder, here, openPage, proxy, ready, scrub, shownValue, start, unpack } from "./bench.mjs";

const model = join(here, "model.toml");
let results;

before(() => {
  results = compute(model, "trouble");
});
after(closeBrowser);

/** A copy of the results that a test may spoil. */
function copy(name) {
  const path = join(folder, name);
  cpSync(results, path, { recursive: true });
  unpack(path);
  return path;
}

const bannerOf = (page, key) => page.waitForSelector(`.banner[data-key="${key}"]`);
const noBanner = (page, key) => page.waitForSelector(`.banner[data-key="${key}"]`, { state: "detached" });

test("the server goes, the page says so, and goes on when it is back", async () => {
  const server = await start("view", results);
  const way = await proxy(server.url);
  const page = await openPage(way.url);
  await ready(page);
  way.cut();
  await bannerOf(page, "connection");
  assert.equal(await page.getAttribute("#banners", "aria-live"), "assertive");
  // What was loaded can still be looked at.
  await scrub(page, 10);
  const tension = array(results, "cases/calm/lines/pipe/effective_tension");
  assert.equal(await shownValue(page, "calm"), tension.at(10, 0));
  // What was not loaded comes when the server is back.
  await page.selectOption("#quantity", "bend_moment");
  await page.waitForTimeout(500);
  way.mend();
  await noBanner(page, "connection");
  assert.equal(await page.textContent("#live"), "The connection is back.");
  const moment = array(results, "cases/calm/lines/pipe/bend_moment");
  await page.waitForFunction((v) => Number(document.querySelector("#readout b")?.dataset.value) === v, moment.at(10, 0));

  // A server that hangs is lost too.
  server.child.kill("SIGSTOP");
  await bannerOf(page, "connection");
  server.child.kill("SIGCONT");
  await noBanner(page, "connection");

  // A server that was started anew has another link.
  const other = await start("view", results);
  way.lead(other.url);
  const banner = await bannerOf(page, "study");
  assert.match(await banner.textContent(), /no longer valid/);
  way.lead(server.url);
  await noBanner(page, "study");
  assert.deepEqual(page.faults, []);
  way.close();
  await other.stop();
  assert.equal(await server.stop(), 0, "the viewer ends in order");
});

test("a damaged chunk is told and shown as missing", async () => {
  const spoiled = copy("damaged");
  const chunk = join(spoiled, "results.zarr/cases/calm/lines/pipe/bend_moment/c/0/0");
  const bytes = readFileSync(chunk);
  bytes[100] ^= 4;
  writeFileSync(chunk, bytes);
  const server = await start("view", spoiled);
  const page = await openPage(server.url);
  await ready(page);
  await page.selectOption("#quantity", "bend_moment");
  const banner = await bannerOf(page, "damage cases/calm/lines/pipe/bend_moment");
  assert.match(await banner.textContent(), /damaged.*bend_moment.*rows 0 to 40/);
  await page.selectOption("#quantity", "effective_tension");
  await ready(page);
  const tension = array(results, "cases/calm/lines/pipe/effective_tension");
  await page.waitForFunction((v) => Number(document.querySelector("#readout b")?.dataset.value) === v, tension.at(0, 0));
  assert.deepEqual(page.faults, []);
  await server.stop();
});

test("damaged times and shapes are told, and the rest is shown", async () => {
  const spoiled = copy("shapes");
  const chunk = join(spoiled, "results.zarr/cases/calm/lines/pipe/static_x/c/0");
  const bytes = readFileSync(chunk);
  bytes[5] ^= 1;
  writeFileSync(chunk, bytes);
  const server = await start("view", spoiled);
  const page = await openPage(server.url);
  await ready(page);
  await bannerOf(page, "damage cases/calm/lines/pipe/static_x");
  await scrub(page, 4);
  assert.equal(await shownValue(page, "calm"), array(results, "cases/calm/lines/pipe/effective_tension").at(4, 0));
  assert.deepEqual(page.faults, []);
  await server.stop();
});

test("a root that becomes newer, damaged or empty is told, and the page recovers", async () => {
  const changed = copy("root");
  const root = join(changed, "results.zarr/zarr.json");
  const text = readFileSync(root, "utf8");
  const server = await start("view", changed);
  const page = await openPage(server.url);
  await ready(page);
  const newer = text.replace('"catenix_store_format":2', '"catenix_store_format":7');
  assert.notEqual(newer, text);
  for (const [content, words] of [[newer, /store format 7/], [text.slice(0, 200), /damaged/]]) {
    writeFileSync(root, content);
    await page.waitForFunction((wanted) => new RegExp(wanted).test(document.querySelector('.banner[data-key="study"]')?.textContent), words.source);
  }
  const empty = text.replace('"case_names":["calm","rough"]', '"case_names":[]');
  assert.notEqual(empty, text);
  writeFileSync(root, empty);
  await page.waitForFunction(() => /no load case/.test(document.querySelector("#empty:not([hidden])")?.textContent));
  await noBanner(page, "study");
  writeFileSync(root, text);
  await page.waitForSelector("#empty", { state: "hidden" });
  await ready(page);
  await scrub(page, 6);
  assert.equal(await shownValue(page, "calm"), array(results, "cases/calm/lines/pipe/effective_tension").at(6, 0));
  assert.deepEqual(page.faults, []);
  await server.stop();
});

test("a case that has not begun, and results that vanish and come again", async () => {
  const changed = copy("changed");
  const path = join(changed, "results.zarr/cases/calm");
  const calm = join(copy("unchanged"), "results.zarr/cases/calm");
  const text = readFileSync(join(path, "zarr.json"), "utf8");
  const node = JSON.parse(text);
  for (const key of ["history_rows", "field_rows", "summary_json"]) {
    delete node.attributes[key];
  }
  node.attributes.status = "pending";
  rmSync(path, { recursive: true });
  cpSync(join(calm, "zarr.json"), join(path, "zarr.json"));
  writeFileSync(join(path, "zarr.json"), JSON.stringify(node));
  const server = await start("view", changed);
  const page = await openPage(server.url);
  await ready(page);
  // The page begins with the first case that has something to show.
  assert.ok(await page.isChecked('input[name="case"][value="rough"]'));
  await page.keyboard.press("c");
  await page.waitForFunction(() => document.querySelector("#empty").textContent.includes("has not begun"));
  assert.ok(await page.isDisabled("#play"));
  cpSync(calm, path, { recursive: true });
  await page.waitForFunction(() => document.querySelector("#empty").hidden);
  await ready(page);

  rmSync(join(changed, "results.zarr"), { recursive: true });
  const banner = await bannerOf(page, "study");
  assert.match(await banner.textContent(), /gone from the disk/);
  cpSync(join(results, "results.zarr"), join(changed, "results.zarr"), { recursive: true });
  await noBanner(page, "study");
  assert.deepEqual(page.faults, []);
  await server.stop();
});

test("a run is followed while it goes on", async () => {
  const text = readFileSync(model, "utf8").replace('duration = "20 s"', 'duration = "4000 s"').replace('step = "0.1 s"', 'step = "0.02 s"');
  const long = join(folder, "long.toml");
  writeFileSync(long, text);
  const out = join(folder, "live");
  const run = await start("run", long, "--case", "calm", "--quiet", "--live", "--out", out);
  const page = await openPage(run.url);
  await page.waitForFunction(() => document.querySelector("#status").textContent === "Running");
  await page.waitForFunction(() => Number(document.querySelector("#scene").dataset.time) > 0);
  await ready(page);
  const end = () => page.textContent("#clock").then((clock) => Number(clock.split("/")[1].replace(/[^\d.]/g, "")));
  const before_ = await end();
  await page.waitForFunction(
    (seen) => Number(document.querySelector("#clock").textContent.split("/")[1].replace(/[^\d.]/g, "")) > seen,
    before_,
  );
  assert.ok(await page.isChecked("#tail"), "the newest step is followed");
  const share = await page.$eval("#canvas", (canvas) => canvas.width / canvas.clientWidth);
  assert.ok(share > 0.99, `steps that come slowly are no reason to draw coarsely: ${share}`);
  await scrub(page, 3);
  assert.ok(!(await page.isChecked("#tail")));
  const tension = array(out, "cases/calm/lines/pipe/effective_tension");
  assert.equal(await shownValue(page, "calm"), tension.at(3, 0));
  run.child.kill("SIGINT");
  await page.waitForFunction(() =>
    ["Interrupted", "Complete"].includes(document.querySelector("#status").textContent) ||
    document.querySelector('.banner[data-key="connection"]') !== null,
  );
  assert.deepEqual(page.faults, []);
  await run.stop();
});

test("the command line tells what it cannot show", () => {
  const view = (...args) => spawnSync(process.env.CATENIX_BIN ?? join(here, "../../target/debug/catenix"), ["view", ...args, "--no-open"], { encoding: "utf8" });
  const missing = view(join(folder, "nothing"));
  assert.equal(missing.status, 4);
  assert.match(missing.stderr, /no Catenix result store/);
  const newer = copy("newer");
  const root = join(newer, "results.zarr/zarr.json");
  writeFileSync(root, readFileSync(root, "utf8").replace('"catenix_store_format":2', '"catenix_store_format":7'));
  const refused = view(newer);
  assert.equal(refused.status, 4);
  assert.match(refused.stderr, /store format 7/);
});
