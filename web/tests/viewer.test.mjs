// The page as a person uses it: play, scrub, pick, switch cases and results, export. Every number
// that is checked comes from the files of the store.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { array, closeBrowser, compute, here, openPage, ready, scrub, shownValue, start } from "./bench.mjs";

let results;
let server;

before(() => {
  results = compute(join(here, "model.toml"), "viewer");
});
before(async () => {
  server = await start("view", results);
});
after(async () => {
  await closeBrowser();
  await server.stop();
});

async function open(options) {
  const page = await openPage(server.url, options);
  await ready(page);
  return page;
}

test("the study is shown, plays and pauses", async () => {
  const page = await open();
  assert.equal(await page.textContent("#title"), "Viewer test: pipe, buffer and hose");
  assert.equal(await page.textContent("#status"), "Complete");
  assert.equal(await page.textContent("#clock"), "0.0 / 20.0 s");
  await page.click("#play");
  assert.equal(await page.getAttribute("#play", "aria-label"), "Pause");
  await page.waitForFunction(() => Number(document.querySelector("#scene").dataset.time) > 0.6);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => document.querySelector("#play").ariaLabel === "Play");
  const time = await page.getAttribute("#scene", "data-time");
  await page.waitForTimeout(400);
  assert.equal(await page.getAttribute("#scene", "data-time"), time, "paused is paused");
  await page.selectOption("#speed", "100");
  await page.click("#play");
  await page.waitForFunction(() => document.querySelector("#clock").textContent.startsWith("20.0"));
  await page.waitForFunction(() => document.querySelector("#play").ariaLabel === "Play");
  assert.deepEqual(page.faults, []);
});

test("numbers are those of the store, at every step, node and result", async () => {
  const page = await open();
  const tension = array(results, "cases/calm/lines/pipe/effective_tension");
  assert.equal(tension.rows, 41);
  for (const [row, node] of [[0, 0], [17, 3], [40, 15], [5, 8]]) {
    await scrub(page, row);
    await page.$eval("#node", (slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input"));
    }, node);
    await page.waitForTimeout(200);
    assert.equal(await shownValue(page, "calm"), tension.at(row, node), `row ${row}, node ${node}`);
    assert.equal(Number(await page.getAttribute("#scene", "data-time")), 0.5 * row);
  }
  const text = await page.textContent("#readout b");
  const shown = Number(text.replace(/[^\d.]/g, ""));
  assert.ok(text.endsWith(" kN"), text);
  assert.ok(Math.abs(shown * 1000 - tension.at(5, 8)) <= 1e-3 * tension.at(5, 8), text);

  await page.keyboard.press(".");
  await page.waitForTimeout(200);
  assert.equal(await shownValue(page, "calm"), tension.at(6, 8));
  for (const quantity of ["bend_moment", "declination", "von_mises_stress", "x", "z"]) {
    await page.selectOption("#quantity", quantity);
    await ready(page);
    const field = array(results, `cases/calm/lines/pipe/${quantity}`);
    await page.waitForFunction(
      (value) => Number(document.querySelector("#readout b")?.dataset.value) === value,
      field.at(6, 8),
    );
  }
  await page.click("#tab-values");
  await page.waitForSelector("#node-table tbody tr");
  const rows = await page.$$eval("#node-table tbody tr", (found) =>
    found.map((row) => Object.fromEntries([...row.querySelectorAll("td[data-quantity]")].map((cell) => [cell.dataset.quantity, Number(cell.dataset.value)]))),
  );
  assert.equal(rows.length, 16);
  for (const quantity of ["x", "z", "effective_tension", "shear_force", "curvature"]) {
    const field = array(results, `cases/calm/lines/pipe/${quantity}`);
    rows.forEach((row, node) => assert.equal(row[quantity], field.at(6, node), `${quantity} ${node}`));
  }
  assert.deepEqual(page.faults, []);
});

test("between two steps positions and values lie on the straight line", async () => {
  const page = await open();
  await page.click("#play");
  await page.waitForFunction(() => Number(document.querySelector("#scene").dataset.time) > 1.2);
  await page.click("#play");
  await ready(page);
  await page.waitForTimeout(300);
  const time = Number(await page.getAttribute("#scene", "data-time"));
  const field = array(results, "cases/calm/lines/pipe/effective_tension");
  const [row, share] = [Math.floor(time / 0.5), (time / 0.5) % 1];
  const expected = field.at(row) + share * (field.at(row + 1) - field.at(row));
  // Single precision of the page: 1e-7 of the value, with room for two roundings.
  assert.ok(Math.abs((await shownValue(page, "calm")) - expected) < 3e-7 * expected);
});

test("a click picks a line at its node, and a body", async () => {
  const page = await open();
  const place = (what) => page.evaluate((selection) => window.catenix.locate(selection), what);
  const box = await (await page.$("#scene")).boundingBox();
  const node = await place({ kind: "line", name: "pipe", node: 7 });
  await page.mouse.click(box.x + node.x, box.y + node.y);
  assert.equal(await page.inputValue("#object"), "line:pipe");
  assert.equal(await page.inputValue("#node"), "7");
  const field = array(results, "cases/calm/lines/pipe/effective_tension");
  await page.waitForFunction((v) => Number(document.querySelector("#readout b")?.dataset.value) === v, field.at(0, 7));
  const body = await place({ kind: "body", name: "buffer" });
  await page.mouse.click(box.x + body.x, box.y + body.y);
  assert.equal(await page.inputValue("#object"), "body:buffer");
  await scrub(page, 12);
  const expected = ["x", "y", "z"].map((axis) => {
    const history = array(results, `cases/calm/buffer.${axis}`);
    const times = array(results, "cases/calm/time");
    const index = Array.from({ length: times.rows }, (_, k) => k).find((k) => Math.abs(times.at(k) - 6) < 1e-9);
    return history.at(index);
  });
  await page.waitForFunction(
    (wanted) => {
      const shown = document.querySelector("#readout b")?.dataset.value?.split(" ").map(Number);
      return shown?.length === 3 && shown.every((value, k) => Math.abs(value - wanted[k]) < 1e-6);
    },
    expected,
  );
  // A drag turns the view and selects nothing.
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 380, box.y + 230, { steps: 4 });
  await page.mouse.up();
  const turned = await place({ kind: "line", name: "pipe", node: 7 });
  assert.ok(Math.hypot(turned.x - node.x, turned.y - node.y) > 2);
  assert.equal(await page.inputValue("#object"), "body:buffer");
  await page.keyboard.press("Escape");
  assert.deepEqual(page.faults, []);
});

test("the wheel zooms towards the pointer, and what is selected can be gone near to", async () => {
  const page = await open();
  const place = (what) => page.evaluate((selection) => window.catenix.locate(selection), what);
  const box = await (await page.$("#scene")).boundingBox();
  const node = { kind: "line", name: "pipe", node: 3 };
  const [other, before] = [await place({ ...node, node: 12 }), await place(node)];
  await page.mouse.move(box.x + before.x, box.y + before.y);
  await page.mouse.wheel(0, -400);
  await ready(page);
  const [farther, after] = [await place({ ...node, node: 12 }), await place(node)];
  const length = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);
  assert.ok(length(farther, after) > 1.4 * length(other, before), "it is larger");
  // In perspective only what is as far as the middle of the view stays exactly in its place.
  assert.ok(length(after, before) < 30, `${length(after, before)} px away`);

  await page.selectOption("#object", "vessel:ship");
  await page.click("#near");
  await ready(page);
  const ship = await place({ kind: "vessel", name: "ship" });
  assert.ok(Math.abs(ship.x - box.width / 2) < 2 && Math.abs(ship.y - box.height / 2) < 2, "in the middle");
  await page.click("#fit");
  await ready(page);
  const fitted = await place({ ...node, node: 12 });
  assert.ok(length(fitted, other) < 2, "the whole system again");
  assert.deepEqual(page.faults, []);
});

test("vessels have the shape and length of the model", async () => {
  const page = await open();
  const { vessels } = await page.evaluate(async () => (await (await fetch("api/case?case=calm")).json()).scene);
  assert.deepEqual(vessels.map(({ name, shape, length_m }) => [name, shape, length_m]), [["ship", "platform", 60], ["tower", "anchor", null]]);
  assert.deepEqual(page.faults, []);
});

test("whole arrays come in one answer, not chunk by chunk", async () => {
  const page = await openPage(server.url);
  // Else what the first load still asks for would count too.
  await ready(page);
  const asked = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  await page.reload();
  await ready(page);
  assert.equal(asked.filter((path) => path.endsWith("api/vectors")).length, 1);
  for (const name of ["field_time", "arc_length", "static_x", "time/c"]) {
    assert.deepEqual(asked.filter((path) => path.includes(name)), [], name);
  }
});

test("cases stand side by side and lie over each other", async () => {
  const page = await open();
  await page.click("#tab-cases");
  await page.check('input[name="case"][value="rough"]');
  await ready(page);
  await scrub(page, 20);
  await page.click("#tab-graphs");
  for (const name of ["calm", "rough"]) {
    const field = array(results, `cases/${name}/lines/pipe/effective_tension`);
    assert.equal(await shownValue(page, name), field.at(20, 0), name);
  }
  // The shorter case stays at its end.
  await page.focus("#scene");
  await page.keyboard.press("End");
  await ready(page);
  await page.waitForTimeout(300);
  const rough = array(results, "cases/rough/lines/pipe/effective_tension");
  assert.equal(await shownValue(page, "rough"), rough.at(rough.rows - 1, 0));
  await page.click("#tab-cases");
  await page.check('input[value="over"]');
  await ready(page);
  assert.equal(await page.inputValue("#colour-by"), "case");
  await page.uncheck('input[name="case"][value="calm"]');
  await ready(page);
  await page.click("#tab-graphs");
  assert.equal(await page.$('#readout b[data-case="calm"]'), null);
  await page.keyboard.press("c");
  await ready(page);
  await page.waitForSelector('#readout b[data-case="calm"]');
  assert.deepEqual(page.faults, []);
});

test("graphs are of the store: envelope, history, and their numbers as CSV", async () => {
  const page = await open();
  await page.click("#tab-export");
  await page.waitForTimeout(500);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#csv")]);
  const lines = readFileSync(await download.path(), "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  const curve = (graph, label) => lines.filter((line) => line[0] === graph && line[1].replaceAll('"', "") === label);
  const tension = array(results, "cases/calm/lines/pipe/effective_tension");
  const history = curve("history", "calm");
  assert.equal(history.length, 41);
  history.forEach((line, row) => assert.ok(Math.abs(Number(line[4]) * 1000 - tension.at(row, 0)) < 1e-9 * tension.at(row, 0)));
  for (const [label, name] of [["min", "min"], ["max", "max"], ["mean", "mean"], ["largest of the run", "run_max"]]) {
    const stored = array(results, `cases/calm/lines/pipe/effective_tension_${name}`);
    const found = curve("range", label);
    assert.equal(found.length, 16, label);
    found.forEach((line, node) => assert.ok(Math.abs(Number(line[4]) * 1000 - stored.at(node)) < 1e-9 * stored.at(node), label));
  }
  assert.deepEqual(page.faults, []);
});

test("pictures and videos are what is on the screen", async () => {
  const page = await open();
  await page.click("#tab-export");
  await page.selectOption("#picture-scale", "1");
  const node = { kind: "line", name: "pipe", node: 4 };
  // Chosen elsewhere: the mark of the chosen node is not to be in the way.
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#picture")]);
  assert.match(download.suggestedFilename(), /^catenix-calm-0\.0s\.png$/);
  const png = readFileSync(await download.path());
  const pixel = await page.evaluate(async ({ data, selection }) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { x, y } = window.catenix.locate(selection);
    const scene = document.querySelector("#scene");
    return {
      size: [image.width - scene.clientWidth, image.height - scene.clientHeight],
      at: [...context.getImageData(Math.round(x), Math.round(y), 1, 1).data],
      beside: [...context.getImageData(Math.round(x) + 60, Math.round(y), 1, 1).data],
    };
  }, { data: png.toString("base64"), selection: node });
  assert.ok(pixel.size.every((difference) => Math.abs(difference) <= 1), "the picture has the scene's size");
  // The upper pipe carries nearly the largest tension: the yellow or green end of viridis.
  const [r, g, b] = pixel.at;
  assert.ok(g > 1.3 * b && g > 90, `the pipe is ${r} ${g} ${b}`);
  assert.ok(pixel.beside[2] > 150 && pixel.beside[0] > 150, "beside it there is pale water");

  await page.fill("#video-to", "1");
  await page.selectOption("#video-speed", "1");
  await page.selectOption("#video-fps", "12");
  assert.match(await page.textContent("#video-plan"), /^13 frames/);
  const [archive] = await Promise.all([page.waitForEvent("download"), page.click("#video-zip")]);
  const zip = readFileSync(await archive.path());
  assert.equal(zip.readUInt32LE(0), 0x04034b50);
  assert.equal(zip.readUInt16LE(zip.length - 22 + 10), 13, "frames in the archive");
  assert.equal(zip.subarray(30, 45).toString(), "frame-00000.png");
  assert.equal(zip.subarray(46, 49).toString(), "PNG");
  const [film] = await Promise.all([page.waitForEvent("download"), page.click("#video-webm")]);
  const webm = readFileSync(await film.path());
  assert.equal(webm.readUInt32BE(0), 0x1a45dfa3, "a Matroska file");
  assert.ok(webm.length > 5000, `${webm.length} bytes`);
  const played = await page.evaluate(async (data) => {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    const video = document.createElement("video");
    const event = (name) => new Promise((resolve, reject) => {
      video.addEventListener(name, resolve, { once: true });
      video.addEventListener("error", () => reject(new Error(video.error.message)), { once: true });
    });
    video.muted = true;
    video.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
    await Promise.all([event("ended"), video.play()]);
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
    const context = canvas.getContext("2d");
    context.drawImage(video, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const scene = document.querySelector("#scene");
    return {
      size: [canvas.width - scene.clientWidth, canvas.height - scene.clientHeight],
      colours: new Set(new Uint32Array(pixels.buffer)).size,
      length: video.currentTime,
    };
  }, webm.toString("base64"));
  assert.ok(played.size.every((difference) => Math.abs(difference) <= 1), "the film has the scene's size");
  assert.ok(played.colours > 500, `${played.colours} colours in its last picture`);
  // 13 frames at 12 a second; a busy machine records more slowly.
  assert.ok(played.length > 0.8, `it lasts ${played.length} s`);
  assert.deepEqual(page.faults, []);
});
