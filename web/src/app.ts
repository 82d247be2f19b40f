// The page at work: what is shown, at which time, and what the server says meanwhile.

import { ServerError, getJson, onConnection } from "./api";
import { ColourRange } from "./colour_range";
import { seconds, title } from "./format";
import { FrameRate } from "./frame_rate";
import { OptionStore } from "./options";
import type { Options, Selection } from "./options";
import { Playback, SPEEDS } from "./playback";
import type { Preset } from "./scene/camera";
import { Stage } from "./scene/stage";
import { CaseData, quantityOf } from "./store/case_data";
import { ChunkCache } from "./store/chunks";
import type { StudyReport } from "./store/types";
import { banner, clearBanner, say } from "./ui/banners";
import { bindKeys, bindScene } from "./ui/controls";
import { byId, fill } from "./ui/dom";
import { Exports, fileName, timeName } from "./ui/exports";
import { Graphs } from "./ui/graphs";
import { bindTabs, fillQuantities, Panels } from "./ui/panels";
import { describeScene, report, tellConnection, tellEmpty, tellStudy } from "./ui/status";
import { Values } from "./ui/values";

/** Elapsed time between two questions about the run [ms]: while it goes on, and otherwise. */
const ASK_RUNNING_MS = 700;
const ASK_MS = 2500;
/** Longest wait for the answer to such a question [ms]. */
const ASK_PATIENCE_MS = 4000;

export class App {
  private options = new OptionStore();
  private playback = new Playback();
  private cache = new ChunkCache();
  private stage = new Stage(byId("canvas"), byId("scene"));
  private study: StudyReport | null = null;
  private loaded = new Map<string, CaseData>();
  private loading = new Set<string>();
  private panels = new Panels(this.options);
  private graphs = new Graphs(
    this.options,
    () => this.shown(),
    (time) => this.seek(time),
    report,
  );
  private values = new Values(() => this.shown(), () => this.wake());
  private colours = new ColourRange(this.graphs, () => this.wake());
  private exports: Exports;
  private exporting = false;
  private dirty = true;
  private forced = true;
  /** Whether something else than data has changed since the scene was drawn. */
  private touched = true;
  private ready = true;
  private lastTick = 0;
  private decimals = 1;
  private rate = new FrameRate(() => this.wake());
  private framed = false;
  /** Whether the results were not there when the server looked last. */
  private gone = false;
  private asking: ReturnType<typeof setTimeout> | undefined;
  private scheduled = false;

  constructor() {
    this.exports = new Exports({
      stem: () => fileName("catenix", ...this.options.get().cases, timeName(this.playback.time, this.decimals)),
      picture: (target, scale) => this.compose(this.playback.time, target, scale),
      frame: (time, target) => this.compose(time, target, 1),
      graphs: () => this.graphs.data,
      end: () => this.playback.end,
      begin: () => {
        this.exporting = true;
        this.setPlaying(false);
      },
      done: () => {
        this.exporting = false;
        this.wake(true);
      },
      failed: report,
    });
  }

  start(): void {
    // For tests, and for the curious at the console: where a thing is in the picture.
    Object.assign(window, { catenix: { locate: (what: Selection) => this.stage.locate(what) } });
    this.bind();
    this.applyTheme();
    this.ask();
    const tick = (now: number) => {
      this.scheduled = false;
      this.tick(now);
    };
    this.schedule = () => {
      if (!this.scheduled) {
        this.scheduled = true;
        requestAnimationFrame(tick);
      }
    };
    this.schedule();
  }

  private schedule: () => void = () => {};

  /** Something has changed: draw soon. */
  private wake(forced = false): void {
    this.touched = true;
    this.dataCame(forced);
  }

  /** Data that was asked for is here: draw soon, if it is all there now. */
  private dataCame(forced: boolean): void {
    this.dirty = true;
    this.forced ||= forced;
    this.schedule();
  }

  /** The cases that are shown and have come. */
  private shown(): CaseData[] {
    const { cases } = this.options.get();
    return cases.flatMap((name) => this.loaded.get(name) ?? []);
  }

  // ---- The server ------------------------------------------------------------------------------

  private async ask(): Promise<void> {
    clearTimeout(this.asking);
    try {
      const study = await getJson<StudyReport>("api/study", {}, ASK_PATIENCE_MS);
      clearBanner("study");
      await this.takeStudy(study);
    } catch (error) {
      this.gone ||= error instanceof ServerError && error.code !== "viewer::token";
      report(error);
    }
    const running = this.study?.cases.some(({ status }) => status === "running" || status === "pending");
    const again = running && this.study?.status === "running" ? ASK_RUNNING_MS : ASK_MS;
    this.asking = setTimeout(() => this.ask(), again);
  }

  private async takeStudy(study: StudyReport): Promise<void> {
    const before = this.study;
    const names = study.cases.map(({ name }) => name);
    const shrunk = before?.cases.some((old) => {
      const now = study.cases.find(({ name }) => name === old.name);
      return !now || now.field_rows < old.field_rows;
    });
    const changed = shrunk || this.gone || before?.model_sha256 !== study.model_sha256;
    const other = before !== null && changed;
    this.gone = false;
    this.study = study;
    if (other) {
      this.startAnew();
      say("The results were computed anew; the page shows the new ones.");
    }
    tellStudy(study, this.options.get().cases);
    const chosen = this.options.get().cases.filter((name) => names.includes(name));
    if (chosen.length === 0) {
      const first = study.cases.find(({ field_rows }) => field_rows > 0) ?? study.cases[0];
      this.options.set({ cases: first ? [first.name] : [] });
    }
    let grown = false;
    for (const progress of study.cases) {
      const data = this.loaded.get(progress.name);
      const had = data?.hasFrames;
      if (data && (await data.advance(progress))) {
        grown = true;
        if (data.hasFrames && !had) {
          this.setCases();
        }
      }
    }
    this.panels.refresh(study, this.shown());
    if (grown) {
      this.afterData();
    }
    this.load();
  }

  private startAnew(): void {
    this.cache.clear();
    this.loaded.clear();
    this.graphs.clear();
    this.colours.clear();
    this.framed = false;
    this.playback.time = 0;
  }

  /** Fetches the cases that are wanted and not here yet. */
  private load(): void {
    for (const name of this.options.get().cases) {
      if (this.loaded.has(name) || this.loading.has(name)) {
        continue;
      }
      this.loading.add(name);
      CaseData.load(this.cache, name)
        .then((data) => {
          this.loaded.set(name, data);
          this.setCases();
        })
        .catch(report)
        .finally(() => this.loading.delete(name));
    }
  }

  // ---- What is shown ---------------------------------------------------------------------------

  private setCases(): void {
    const cases = this.shown();
    const { arrangement, selection } = this.options.get();
    this.stage.setCases(cases, arrangement === "over");
    const drawable = cases.filter((data) => data.hasFrames);
    if (drawable.length > 0) {
      const movers = drawable[0].scene?.vessels.filter((vessel) => vessel.moves) ?? [];
      if (!this.framed) {
        const names = drawable[0].description.lines;
        const known = selection && drawable.some((data) => data.line(selection.name));
        this.options.set({
          follow: movers[0]?.name ?? "",
          selection: known || !names[0] ? selection : { kind: "line", name: names[0].name, node: 0 },
        });
        this.stage.look("3d", this.options.get());
        this.framed = true;
      }
    }
    this.afterData();
  }

  /** Cases have come or gone, or have more rows. */
  private afterData(): void {
    const cases = this.shown();
    const { playback } = this;
    playback.end = Math.max(0, ...cases.map((data) => data.endTime));
    if (playback.time > playback.end) {
      playback.time = playback.end;
    }
    const times = cases.find((data) => data.fieldTimes.length > 1)?.fieldTimes;
    const interval = times ? times[1] - times[0] : 1;
    this.decimals = Math.max(1, Math.min(4, -Math.floor(Math.log10(interval) + 1e-9)));
    for (const id of ["first", "back", "play", "forward", "scrub"]) {
      byId<HTMLButtonElement>(id).disabled = !cases.some((data) => data.hasFrames);
    }
    const scrub = byId<HTMLInputElement>("scrub");
    scrub.max = String(this.master()?.fieldTimes.length ? this.master()!.fieldTimes.length - 1 : 0);
    const running = this.study?.status === "running";
    const label = byId("tail-label");
    if (running && label.hidden) {
      playback.tail = byId<HTMLInputElement>("tail").checked;
    }
    if (!running) {
      playback.tail = false;
    }
    label.hidden = !running;
    const chosen = fillQuantities(cases, this.options.get().quantity);
    if (chosen) {
      this.options.set({ quantity: chosen });
    }
    if (this.study) {
      this.panels.refresh(this.study, cases);
    }
    this.graphs.refresh();
    this.exports.refresh();
    tellEmpty(cases, this.study);
    this.wake(true);
  }

  /** The case with the most rows: its stored steps are those of the slider. */
  private master(): CaseData | undefined {
    return this.shown().reduce<CaseData | undefined>(
      (best, data) => (!best || data.endTime > best.endTime ? data : best),
      undefined,
    );
  }

  private unitOf(quantity: string): string {
    const places = this.shown().flatMap((data) => data.description.lines);
    return places.map((place) => quantityOf(place, quantity)?.unit).find((unit) => unit) ?? "";
  }

  // ---- Time ------------------------------------------------------------------------------------

  private tick(now: number): void {
    const elapsed = Math.min((now - this.lastTick) / 1000, 0.25);
    this.lastTick = now;
    const { playback } = this;
    if (!this.exporting) {
      const was = playback.playing;
      playback.tick(elapsed, this.ready);
      if (was !== playback.playing) {
        this.showPlaying();
      }
      const moving = playback.playing || playback.tail;
      if (this.dirty || playback.playing) {
        this.dirty = false;
        const begin = performance.now();
        this.draw(this.forced || !moving);
        this.forced = false;
        const spent = performance.now() - begin;
        // Pictures of a run that is followed come as it stores steps, however fast they are drawn.
        if (playback.playing) {
          this.rate.moved(now, spent, this.options.get().adaptive);
          byId("scene").dataset.fps = String(this.rate.fps);
        } else {
          this.rate.rested(() => playback.playing);
        }
      }
    }
    if (playback.playing || this.dirty) {
      this.schedule();
    }
  }

  private draw(forced: boolean): void {
    const options = this.options.get();
    const container = byId("scene");
    const { clientWidth: width, clientHeight: height } = container;
    if (width === 0 || height === 0) {
      return;
    }
    const before = this.stage.size;
    const sharp = Math.min(Math.max(window.devicePixelRatio, 1), 2);
    this.stage.resize(width, height, sharp * this.rate.scale);
    if (before.width !== width || before.height !== height) {
      this.stage.fit(options);
    }
    const { time } = this.playback;
    this.ready = this.stage.update(time, options);
    if (this.playback.playing) {
      for (const data of this.shown()) {
        data.prefetch(time, this.playback.speed, options.quantity);
      }
    }
    byId("loading").hidden = this.ready;
    // While data is on its way, each piece that comes is no reason to draw the same again.
    if (this.ready || this.touched) {
      this.touched = false;
      this.stage.draw(this.stageState(), options);
    }
    this.clock();
    this.graphs.refresh(this.ready);
    this.graphs.moment(time, this.decimals, forced && this.ready);
    this.values.moment(time, this.decimals, forced);
  }

  private stageState() {
    const { quantity, fixedRange } = this.options.get();
    const unit = this.unitOf(quantity);
    const range = fixedRange ?? this.colours.range(this.shown(), quantity, this.playback.time);
    this.panels.setRange(range, unit);
    return { time: this.playback.time, range, unit, decimals: this.decimals };
  }

  private clock(): void {
    const { time, end } = this.playback;
    const text = `${seconds(time, this.decimals)} / ${seconds(end, this.decimals)} s`;
    const clock = byId("clock");
    if (clock.textContent !== text) {
      clock.textContent = text;
    }
    const scrub = byId<HTMLInputElement>("scrub");
    const row = this.master()?.locate(time).row ?? 0;
    if (scrub.value !== String(row)) {
      scrub.value = String(row);
    }
    scrub.setAttribute("aria-valuetext", `${seconds(time, this.decimals)} seconds`);
    const scene = byId("scene");
    scene.dataset.time = String(time);
    scene.dataset.ready = String(this.ready);
    if (!this.playback.playing) {
      describeScene(this.shown(), this.options.get().quantity, seconds(time, this.decimals));
    }
  }

  private seek(time: number): void {
    this.playback.seek(time);
    byId<HTMLInputElement>("tail").checked = false;
    this.wake(true);
  }

  private step(by: number): void {
    const data = this.master();
    if (data?.hasFrames) {
      this.setPlaying(false);
      const { row, share } = data.locate(this.playback.time);
      const target = by < 0 && share > 0 ? row : row + by;
      this.seek(data.fieldTimes[Math.min(Math.max(target, 0), data.fieldTimes.length - 1)]);
    }
  }

  private setPlaying(playing: boolean): void {
    this.playback.playing = playing && this.playback.end > 0;
    if (playing && this.playback.time >= this.playback.end && !this.playback.loop) {
      this.playback.time = 0;
    }
    if (playing) {
      this.playback.tail = false;
      byId<HTMLInputElement>("tail").checked = false;
    }
    this.lastTick = performance.now();
    this.showPlaying();
    this.wake(true);
  }

  private showPlaying(): void {
    const { playing } = this.playback;
    const button = byId("play");
    const shape = playing ? "M3 2h3.5v12H3zM9.5 2H13v12H9.5z" : "M3 1.5v13L14 8z";
    button.querySelector("path")?.setAttribute("d", shape);
    button.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.wake(true);
  }

  // ---- Pictures --------------------------------------------------------------------------------

  /** Waits for the data of a time and draws it into a canvas. */
  private async compose(time: number, target: HTMLCanvasElement, scale: number): Promise<void> {
    const options = this.options.get();
    const patience = performance.now() + 20000;
    while (!this.stage.update(time, options)) {
      if (performance.now() > patience) {
        throw new Error("the data did not come");
      }
      await new Promise((resolve) => setTimeout(resolve, 15));
    }
    const state = { ...this.stageState(), time };
    this.stage.compose(state, options, scale * Math.max(window.devicePixelRatio, 1), target);
    this.wake();
  }

  // ---- Controls --------------------------------------------------------------------------------

  private bind(): void {
    const { options, playback } = this;
    this.cache.onChange = () => this.dataCame(true);
    this.cache.onDamage = (path, first, last) =>
      banner(`damage ${path}`, `Part of the store is damaged and shown as missing: ${path}, stored rows ${first} to ${last}. Run the model again.`, true);
    onConnection((connected) => {
      tellConnection(connected);
      if (connected) {
        this.wake(true);
      }
    });
    const reduced = window.matchMedia("(prefers-reduced-motion: reduce)");
    playback.loop = !reduced.matches;
    byId<HTMLInputElement>("loop").checked = playback.loop;
    const speed = byId<HTMLSelectElement>("speed");
    fill(speed, [{ label: "", entries: SPEEDS.map((s): [string, string] => [String(s), `× ${s}`]) }], "1");
    speed.addEventListener("change", () => (playback.speed = Number(speed.value)));
    byId("loop").addEventListener("change", (event) => (playback.loop = (event.target as HTMLInputElement).checked));
    byId("tail").addEventListener("change", (event) => {
      playback.tail = (event.target as HTMLInputElement).checked;
      this.setPlaying(false);
    });
    byId("play").addEventListener("click", () => this.setPlaying(!playback.playing));
    byId("first").addEventListener("click", () => this.seek(0));
    byId("back").addEventListener("click", () => this.step(-1));
    byId("forward").addEventListener("click", () => this.step(1));
    byId<HTMLInputElement>("scrub").addEventListener("input", (event) => {
      const data = this.master();
      if (data) {
        this.seek(data.fieldTimes[Number((event.target as HTMLInputElement).value)] ?? 0);
      }
    });
    byId<HTMLSelectElement>("quantity").addEventListener("change", (event) =>
      options.set({ quantity: (event.target as HTMLSelectElement).value }),
    );
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-preset]")) {
      button.addEventListener("click", () => this.look(button.dataset.preset as Preset));
    }
    byId("fit").addEventListener("click", () => this.fit());
    byId("near").addEventListener("click", () => this.near());
    const dialog = byId<HTMLDialogElement>("help-dialog");
    byId("help").addEventListener("click", () => dialog.showModal());
    const themes = ["auto", "light", "dark"] as const;
    byId("theme").addEventListener("click", () => {
      const next = themes[(themes.indexOf(options.get().theme) + 1) % themes.length];
      options.set({ theme: next });
    });
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.applyTheme());
    new ResizeObserver(() => this.wake(true)).observe(byId("scene"));
    byId("canvas").addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      banner("webgl", "The graphics driver gave up; the scene comes back when it does.", true, false);
    });
    byId("canvas").addEventListener("webglcontextrestored", () => {
      clearBanner("webgl");
      this.setCases();
    });
    bindTabs(() => this.wake(true));
    const actions = {
      playPause: () => this.setPlaying(!playback.playing),
      step: (by: number) => this.step(by),
      toStart: () => this.seek(0),
      toEnd: () => this.seek(playback.end),
      faster: (by: number) => {
        const at = SPEEDS.indexOf(playback.speed) + by;
        playback.speed = SPEEDS[Math.min(Math.max(at, 0), SPEEDS.length - 1)];
        speed.value = String(playback.speed);
      },
      look: (preset: Preset) => this.look(preset),
      fit: () => this.fit(),
      near: () => this.near(),
      nextCase: () => {
        const names = this.study?.cases.map(({ name }) => name) ?? [];
        const at = names.indexOf(options.get().cases[0] ?? "");
        options.set({ cases: [names[(at + 1) % names.length]] });
        say(`Case ${options.get().cases[0]}`);
      },
      nextQuantity: () => {
        const select = byId<HTMLSelectElement>("quantity");
        select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
        options.set({ quantity: select.value });
        say(title(select.value));
      },
      nextNode: (by: number) => {
        const { selection } = options.get();
        const arcs = this.shown()[0]?.arcLengths.get(selection?.name ?? "");
        if (selection?.kind === "line" && arcs) {
          const node = Math.min(Math.max(selection.node + by, 0), arcs.length - 1);
          options.set({ selection: { ...selection, node } });
        }
      },
      picture: () => void this.exports.picture(),
      help: () => dialog.showModal(),
      deselect: () => options.set({ selection: null }),
      redraw: () => this.wake(),
      pick: (x: number, y: number, reach: number) => {
        const found = this.stage.pick(x, y, reach);
        if (found) {
          options.set({ selection: found });
        }
      },
    };
    bindScene(byId("scene"), this.stage, actions);
    bindKeys(options, actions);
    options.onChange((changed) => this.changed(changed));
  }

  private changed(changed: Set<keyof Options>): void {
    if (changed.has("cases")) {
      this.load();
      this.setCases();
    } else if (changed.has("arrangement")) {
      this.setCases();
      this.fit();
    }
    if (changed.has("cases") && this.framed) {
      this.fit();
    }
    if (changed.has("quantity")) {
      this.panels.releaseRange();
    }
    if (changed.has("theme")) {
      this.applyTheme();
    }
    if (changed.has("stretch") || changed.has("parallel")) {
      this.fit();
    }
    if (changed.has("selection") || changed.has("quantity")) {
      this.graphs.refresh();
    }
    this.wake(true);
  }

  private look(preset: Preset): void {
    // Along an axis the picture is a drawing: without perspective, lengths can be compared.
    const parallel = preset !== "3d";
    byId<HTMLInputElement>("parallel").checked = parallel;
    this.options.set({ parallel });
    this.stage.look(preset, this.options.get());
    this.wake(true);
  }

  private fit(): void {
    this.stage.fit(this.options.get());
    this.wake(true);
  }

  private near(): void {
    const { selection } = this.options.get();
    if (!selection || !this.stage.near(selection)) {
      say("Nothing is selected");
    }
    this.wake(true);
  }

  private applyTheme(): void {
    const { theme } = this.options.get();
    const dark = theme === "dark" || (theme === "auto" && window.matchMedia("(prefers-color-scheme: dark)").matches);
    document.documentElement.toggleAttribute("data-dark", dark);
    const word = title(theme);
    byId("theme").textContent = word;
    byId("theme").setAttribute("aria-label", `${word} theme: change between automatic, light and dark`);
    this.stage.setTheme(dark);
    if (this.framed) {
      this.setCases();
    }
    this.graphs.redraw();
    this.wake(true);
  }
}
