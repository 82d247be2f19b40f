// For everybody: keyboard, screen reader, phone, light and dark.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, compute, here, openPage, ready, start } from "./bench.mjs";

let server;

before(async () => {
  server = await start("view", compute(join(here, "model.toml"), "access"));
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

/** What axe-core has against the page as it is, one line per fault. */
async function faults(page) {
  const source = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
  // The page's own policy forbids foreign scripts, so it is run beside the page's.
  await page.evaluate(readFileSync(source, "utf8"));
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations.flatMap(({ id, help, nodes }) => nodes.map((node) => `${id}: ${help}: ${node.html.slice(0, 160)}`));
}

test("axe-core finds nothing, on any tab, in both themes, on a desk and a phone", async () => {
  for (const [colorScheme, width, height] of [["light", 1280, 720], ["dark", 1280, 720], ["light", 390, 844]]) {
    const page = await open({ colorScheme, viewport: { width, height } });
    for (const tab of ["graphs", "cases", "values", "display", "export"]) {
      await page.click(`#tab-${tab}`);
      await ready(page);
      assert.deepEqual(await faults(page), [], `${tab}, ${colorScheme}, ${width} x ${height}`);
    }
    await page.click("#help");
    assert.deepEqual(await faults(page), [], `help, ${colorScheme}, ${width} x ${height}`);
    await page.context().close();
  }
});

test("every control has a name, and every place can be reached with the keyboard", async () => {
  const page = await open();
  const nameless = await page.$$eval("button, input, select, progress, [role=img], [role=tabpanel], [role=region]", (all) =>
    all
      .filter((element) => {
        const labels = element.labels ? [...element.labels].map((label) => label.textContent.trim()) : [];
        const by = (element.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "");
        return !(element.getAttribute("aria-label") || labels.some(Boolean) || by.some(Boolean) || element.textContent.trim());
      })
      .map((element) => element.outerHTML),
  );
  assert.deepEqual(nameless, []);
  const seen = new Set();
  for (let k = 0; k < 60; k++) {
    await page.keyboard.press("Tab");
    seen.add(await page.evaluate(() => document.activeElement.id || document.activeElement.textContent));
  }
  for (const id of ["quantity", "fit", "scene", "play", "scrub", "speed", "tab-graphs", "object", "node", "help"]) {
    assert.ok(seen.has(id), `${id} is reached`);
  }
  await page.focus("#tab-graphs");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.getAttribute("#tab-cases", "aria-selected"), "true");
  assert.ok(await page.isVisible("#cases"));
  await page.keyboard.press("End");
  assert.ok(await page.isVisible("#export"));
});

test("keys work, are listed, and can be kept to the scene", async () => {
  const page = await open();
  await page.focus("#scene");
  const at = () => page.evaluate(() => window.catenix.locate({ kind: "line", name: "pipe", node: 15 }));
  const first = await at();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await ready(page);
  const turned = await at();
  assert.ok(Math.hypot(turned.x - first.x, turned.y - first.y) > 1, "arrow keys turn the view");
  await page.keyboard.press("n");
  await page.waitForFunction(() => document.querySelector("#node").value === "1");
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("#help-dialog"));
  assert.ok((await page.$$("#keys tr")).length > 15);
  await page.uncheck("#shortcuts");
  await page.keyboard.press("Escape");
  assert.ok(!(await page.isVisible("#help-dialog")));
  await page.focus("#tab-graphs");
  await page.keyboard.press("n");
  await page.waitForTimeout(100);
  assert.equal(await page.inputValue("#node"), "1", "off the scene the key does nothing now");
  await page.focus("#scene");
  await page.keyboard.press("n");
  await page.waitForFunction(() => document.querySelector("#node").value === "2");
});

test("it fits a phone and a laptop, and nothing is cut off", async () => {
  for (const [width, height] of [[390, 844], [1366, 768], [844, 390]]) {
    const page = await open({ viewport: { width, height } });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${wide} of ${width} px`);
    const clipped = await page.$$eval("button, select", (all) =>
      all.filter((e) => e.offsetParent && e.tagName === "BUTTON" && e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent),
    );
    assert.deepEqual(clipped, [], `${width} x ${height}`);
    await page.context().close();
  }
});

test("text has the contrast of WCAG AA in both themes", async () => {
  const page = await open({ colorScheme: "dark" });
  assert.ok(await page.evaluate(() => document.documentElement.hasAttribute("data-dark")), "as the system");
  for (const theme of ["light", "dark"]) {
    while ((await page.textContent("#theme")).toLowerCase() !== theme) {
      await page.click("#theme");
    }
    const low = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      const light = (name) => {
        const hex = style.getPropertyValue(`--${name}`).trim().slice(1);
        const parts = [0, 2, 4].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
        const [r, g, b] = parts.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const pairs = [
        ["ink", "page"], ["ink", "card"], ["faint", "card"], ["accent", "card"], ["on-accent", "accent"],
        ["bad", "bad-page"], ["warn", "warn-page"],
      ];
      return pairs.flatMap(([a, b]) => {
        const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
        const ratio = (high + 0.05) / (low + 0.05);
        return ratio < 4.5 ? [`${a} on ${b}: ${ratio.toFixed(2)}`] : [];
      });
    });
    assert.deepEqual(low, [], theme);
  }
});
