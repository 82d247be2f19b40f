// The graphs of what is selected: its history, and for a line the range graph at this moment.

import { caseColour, caseDash } from "../colour";
import { number, seconds, shownUnit, title } from "../format";
import type { OptionStore, Selection } from "../options";
import { CaseData, quantityOf } from "../store/case_data";
import type { Envelope } from "../store/types";
import { Chart, Curve } from "./chart";
import { byId, fill, make, themeColour } from "./dom";

/** What the graphs show, for export as numbers. */
export interface GraphData {
  history: Curve[];
  range: Curve[];
  historyUnit: string;
  rangeUnit: string;
}

interface History {
  name: string;
  times: ArrayLike<number>;
  values: ArrayLike<number | null>;
  unit: string;
}

/** Elapsed time between two renewals of graphs that a run keeps changing [ms]. */
const RENEWAL_MS = 3000;
/** Elapsed time between two drawings of the moving curve [ms]. */
const MOVING_MS = 200;

export class Graphs {
  readonly data: GraphData = { history: [], range: [], historyUnit: "", rangeUnit: "" };
  private history = new Chart(byId("history"), (time) => this.onSeek(time));
  private range = new Chart(byId("range"), (arc) => this.pickArc(arc));
  private histories: History[] = [];
  private envelopes = new Map<string, { envelope: Envelope; stamp: string }>();
  private requested = "";
  private requestedAt = 0;
  private drawnAt = 0;
  private drawn = "";
  private channel = "";
  private begun = false;
  private scaledKey = "";
  private scaledCurves: (number | null)[][] = [];

  constructor(
    private options: OptionStore,
    private cases: () => CaseData[],
    private onSeek: (time: number) => void,
    private report: (error: unknown) => void,
  ) {
    byId<HTMLSelectElement>("object").addEventListener("change", (event) => {
      const [kind, ...rest] = (event.target as HTMLSelectElement).value.split(":");
      const name = rest.join(":");
      const selection = kind === "line" ? { kind, name, node: 0 } : { kind, name };
      this.options.set({ selection: selection as Selection });
    });
    byId<HTMLInputElement>("node").addEventListener("input", (event) => {
      const { selection } = this.options.get();
      if (selection?.kind === "line") {
        const node = Number((event.target as HTMLInputElement).value);
        this.options.set({ selection: { ...selection, node } });
      }
    });
    byId<HTMLSelectElement>("channel").addEventListener("change", (event) => {
      this.channel = (event.target as HTMLSelectElement).value;
      this.refresh();
    });
  }

  /** Draws with the colours of a new theme, or numbers that have changed. */
  redraw(): void {
    this.drawHistory();
    this.drawn = "";
  }

  /** Selection, result, cases or stored rows have changed. */
  refresh(drawn = this.begun): void {
    // The history of one node needs every chunk of its array: the first picture goes before.
    this.begun ||= drawn;
    const { selection, quantity } = this.options.get();
    const cases = this.cases().filter((data) => data.hasFrames);
    this.fillObjects(cases);
    if (!selection || cases.length === 0 || !this.begun) {
      return;
    }
    const rows = cases.map((data) => `${data.name}/${data.description.field_rows}/${data.description.status}`);
    const subject = JSON.stringify([selection, quantity, this.channel, cases.map((data) => data.name)]);
    const stamp = `${subject}|${rows.join()}`;
    const now = performance.now();
    const grown = stamp !== this.requested && this.requested.startsWith(`${subject}|`);
    if (stamp === this.requested || (grown && now - this.requestedAt < RENEWAL_MS)) {
      return;
    }
    this.requested = stamp;
    this.requestedAt = now;
    this.load(cases, selection, quantity, stamp).catch((error) => {
      this.requested = "";
      this.report(error);
    });
  }

  private async load(
    cases: CaseData[],
    selection: Selection,
    quantity: string,
    stamp: string,
  ): Promise<void> {
    const channel = this.channel;
    const found = await Promise.all(
      cases.map(async (data): Promise<History | null> => {
        if (channel) {
          const place = data.description.channels.find((c) => c.name === channel);
          const read = place && (await data.history(channel));
          return read ? { name: data.name, unit: place.unit, ...read } : null;
        }
        if (selection.kind !== "line" || !hasQuantity(data, selection.name, quantity)) {
          return null;
        }
        const read = await data.nodeHistory(selection.name, quantity, selection.node);
        return { name: data.name, times: read.times_s, values: read.values, unit: read.unit };
      }),
    );
    if (selection.kind === "line") {
      await Promise.all(cases.map((data) => this.envelope(data, selection.name, quantity)));
    }
    if (this.requested === stamp) {
      this.histories = found.filter((history) => history !== null);
      this.drawHistory();
      this.drawn = "";
    }
  }

  /** The envelope of a result along a line, kept until the run has gone on. */
  async envelope(data: CaseData, line: string, quantity: string): Promise<Envelope | null> {
    if (!hasQuantity(data, line, quantity)) {
      return null;
    }
    const key = JSON.stringify([data.name, line, quantity]);
    const stamp = `${data.description.field_rows}/${data.description.status}`;
    const kept = this.envelopes.get(key);
    if (kept && kept.stamp === stamp) {
      return kept.envelope;
    }
    const envelope = await data.envelope(line, quantity);
    this.envelopes.set(key, { envelope, stamp });
    return envelope;
  }

  /** Forgets everything: the store is another one. */
  clear(): void {
    this.envelopes.clear();
    this.requested = "";
    this.histories = [];
    this.history.clear();
    this.range.clear();
    this.drawn = "";
  }

  private fillObjects(cases: CaseData[]): void {
    const names = (pick: (data: CaseData) => string[]) => [...new Set(cases.flatMap(pick))];
    const group = (label: string, kind: string, all: string[]) => ({
      label,
      entries: all.map((name): [string, string] => [`${kind}:${name}`, name]),
    });
    const groups = [
      group("Lines", "line", names((data) => data.description.lines.map((line) => line.name))),
      group("Bodies", "body", names((data) => data.scene?.bodies.map((body) => body.name) ?? [])),
      group("Vessels", "vessel", names((data) => data.scene?.vessels.map((v) => v.name) ?? [])),
    ].filter(({ entries }) => entries.length > 0);
    const { selection } = this.options.get();
    const chosen = selection ? `${selection.kind}:${selection.name}` : "";
    fill(byId("object"), groups, chosen);
    const isLine = selection?.kind === "line";
    byId("node-row").hidden = !isLine;
    byId("range-part").hidden = !isLine;
    if (!selection) {
      return;
    }
    const own = cases[0]?.description.channels.map((channel) => channel.name) ?? [];
    const channels = own.filter((name) => name.startsWith(`${selection.name}.`));
    const entries = channels.map((name): [string, string] => [
      name,
      channelTitle(name, selection.name),
    ]);
    if (isLine) {
      entries.unshift(["", "Result at the node"]);
    }
    if (!entries.some(([value]) => value === this.channel)) {
      // What most would look at first: how far a body is off, how a vessel heaves.
      const ending = (end: string) => entries.find(([value]) => value.endsWith(end));
      this.channel = (ending(".offset_x") ?? ending(".z") ?? entries[0] ?? [""])[0];
    }
    fill(byId("channel"), [{ label: "", entries }], this.channel);
  }

  private unitOf(values: Iterable<number | null>, unit: string) {
    let largest = 0;
    for (const value of values) {
      if (value !== null && Math.abs(value) > largest) {
        largest = Math.abs(value);
      }
    }
    return shownUnit(unit, largest);
  }

  private drawHistory(): void {
    const { cases, quantity, selection } = this.options.get();
    if (this.histories.length === 0 || !selection) {
      this.history.clear();
      byId("history-text").textContent = "No history is stored for this.";
      return;
    }
    const all = this.histories.flatMap((history) => Array.from(history.values));
    const shown = this.unitOf(all, this.histories[0].unit);
    const curves = this.histories.map(({ name, times, values }) => ({
      label: name,
      colour: caseColour(cases.indexOf(name)),
      dash: caseDash(cases.indexOf(name)),
      x: times,
      y: Array.from(values, (value) => (value === null ? null : value * shown.factor)),
    }));
    this.data.history = curves;
    this.data.historyUnit = shown.unit;
    const what = this.channel
      ? channelTitle(this.channel, selection.name)
      : title(quantity);
    const yLabel = `${what} [${shown.unit}]`;
    this.history.show({ xLabel: "Time [s]", yLabel, curves, bands: [] });
    const several = curves.length > 1 ? curves : [];
    byId("history-legend").replaceChildren(...several.map(({ label, colour, dash }) => legendEntry(label, colour, dash)));
    byId("history-title").textContent = `Time history: ${this.channel || `${selection.name}, ${what.toLowerCase()}`}`;
    byId("history-text").textContent = curves
      .map(({ label, y }) => {
        const known = y.filter((value) => value !== null && Number.isFinite(value)) as number[];
        const low = known.reduce((a, b) => Math.min(a, b), Infinity);
        const high = known.reduce((a, b) => Math.max(a, b), -Infinity);
        const mark = this.histories.length > 1 ? `${label}: ` : "";
        const same = number(low) === number(high);
        return `${mark}${same ? "always " : `${number(low)} to `}${number(high)} ${shown.unit}`;
      })
      .join("; ");
  }

  /** The moment has changed. `values` are those of the frame that is shown. */
  moment(time: number, decimals: number, force: boolean): void {
    this.history.mark(time);
    const now = performance.now();
    if (!force && now - this.drawnAt < MOVING_MS) {
      return;
    }
    const { selection, quantity, cases } = this.options.get();
    if (!selection || (byId("graphs").hidden && !force)) {
      return;
    }
    const key = JSON.stringify([time, selection, quantity, this.requested]);
    if (key === this.drawn) {
      return;
    }
    this.drawnAt = now;
    const complete =
      selection.kind === "line"
        ? this.drawRange(time, decimals, selection, quantity, cases)
        : this.objectReadout(time, decimals, selection);
    // What was drawn without all of its data is drawn again when that has come.
    this.drawn = complete ? key : "";
  }

  private drawRange(
    time: number,
    decimals: number,
    selection: { name: string; node: number },
    quantity: string,
    order: string[],
  ): boolean {
    const shownCases = this.cases().filter((data) => data.hasFrames);
    const active = shownCases[0];
    const arc = active?.arcLengths.get(selection.name);
    if (!active || !arc) {
      return true;
    }
    const place = active.line(selection.name);
    const unit = (place && quantityOf(place, quantity)?.unit) ?? "";
    const key = JSON.stringify([active.name, selection.name, quantity]);
    const envelope = this.envelopes.get(key)?.envelope;
    const current = shownCases.map((data) => valuesAt(data, selection.name, quantity, time));
    const shown = envelope
      ? this.unitOf([extreme(envelope.run_min, Math.min), extreme(envelope.run_max, Math.max)], unit)
      : this.unitOf(current.flatMap((c) => Array.from(c ?? [])), unit);
    const scaled = (values: ArrayLike<number | null>) =>
      Array.from(values, (value) => (value === null ? null : value * shown.factor));
    const faint = themeColour("faint");
    const curves: Curve[] = [];
    if (envelope) {
      const stamp = `${key}${this.envelopes.get(key)?.stamp}${shown.unit}`;
      if (stamp !== this.scaledKey) {
        this.scaledKey = stamp;
        const { run_min, run_max, min, max, mean } = envelope;
        this.scaledCurves = [run_min, run_max, min, max, mean].map(scaled);
      }
      const [runMin, runMax, min, max, mean] = this.scaledCurves;
      curves.push(
        { label: "smallest of the run", colour: faint, width: 1, dash: [4, 3], x: arc, y: runMin },
        { label: "largest of the run", colour: faint, width: 1, dash: [4, 3], x: arc, y: runMax },
        { label: "min", colour: faint, width: 1, x: arc, y: min },
        { label: "max", colour: faint, width: 1, x: arc, y: max },
        { label: "mean", colour: themeColour("ink"), width: 1.5, x: arc, y: mean },
      );
    }
    const bands: [number, number][] = envelope ? [[3, 2]] : [];
    for (const [index, data] of shownCases.entries()) {
      const values = current[index];
      const arcs = data.arcLengths.get(selection.name);
      if (values && arcs) {
        const place = order.indexOf(data.name);
        curves.push({
          label: `now, ${data.name}`,
          colour: caseColour(place),
          dash: caseDash(place),
          width: 2.5,
          x: arcs,
          y: scaled(values),
        });
      }
    }
    this.data.range = curves;
    this.data.rangeUnit = shown.unit;
    const yLabel = `${title(quantity)} [${shown.unit}]`;
    this.range.show({ xLabel: "Distance from end A [m]", yLabel, curves, bands });
    this.range.mark(arc[Math.min(selection.node, arc.length - 1)]);
    byId("range-title").textContent = `Range graph: ${selection.name}, case ${active.name}`;
    byId("range-text").textContent = envelope
      ? `${envelopeWords(envelope)} Bold: now.`
      : "Loading the envelope…";
    this.lineReadout(time, decimals, selection, shown, arc, shownCases, current);
    return current.every((values) => values !== null);
  }

  private lineReadout(
    time: number,
    decimals: number,
    selection: { name: string; node: number },
    shown: { unit: string; factor: number },
    arc: Float64Array,
    cases: CaseData[],
    current: (Float32Array | null)[],
  ): void {
    const slider = byId<HTMLInputElement>("node");
    slider.max = String(arc.length - 1);
    slider.value = String(selection.node);
    const node = Math.min(selection.node, arc.length - 1);
    const end = node === 0 ? ", end A" : node === arc.length - 1 ? ", end B" : "";
    const place = `${number(arc[node], 5)} m from end A (node ${node}${end})`;
    slider.setAttribute("aria-valuetext", place);
    const readout = byId("readout");
    readout.replaceChildren(`${place}, t = ${seconds(time, decimals)} s: `);
    for (const [index, data] of cases.entries()) {
      const value = current[index]?.[node] ?? NaN;
      const bold = document.createElement("b");
      bold.textContent = `${number(value * shown.factor)} ${shown.unit}`;
      bold.dataset.case = data.name;
      bold.dataset.value = String(value);
      bold.title = `${value} ${this.histories[0]?.unit ?? ""}`;
      readout.append(index > 0 ? "; " : "", cases.length > 1 ? `${data.name} ` : "", bold);
    }
  }

  private objectReadout(time: number, decimals: number, selection: Selection): boolean {
    let complete = true;
    const readout = byId("readout");
    readout.replaceChildren(`${selection.name}, t = ${seconds(time, decimals)} s: `);
    for (const [index, data] of this.cases().filter((d) => d.hasFrames).entries()) {
      const position = data.sample(time, "x")?.poses.get(selection.name)?.position;
      complete &&= position !== undefined;
      const bold = document.createElement("b");
      bold.textContent = position ? position.map((v) => number(v)).join(", ") + " m" : "–";
      bold.dataset.case = data.name;
      bold.dataset.value = position?.join(" ") ?? "";
      readout.append(index > 0 ? "; " : "", `${data.name} `, bold);
    }
    return complete;
  }

  private pickArc(arc: number): void {
    const { selection } = this.options.get();
    const arcs = this.cases()[0]?.arcLengths.get(selection?.name ?? "");
    if (selection?.kind === "line" && arcs) {
      let node = 0;
      for (let k = 0; k < arcs.length; k++) {
        if (Math.abs(arcs[k] - arc) < Math.abs(arcs[node] - arc)) {
          node = k;
        }
      }
      this.options.set({ selection: { ...selection, node } });
    }
  }
}

/** What a channel of an object is: `ship.x` of `ship` is `Position x`. */
function channelTitle(channel: string, object: string): string {
  const name = channel.slice(object.length + 1);
  return name.length === 1 ? `Position ${name}` : title(name.replaceAll(".", ", "));
}

/** A stretch of a curve beside its name. */
function legendEntry(name: string, colour: string, dash: number[]): HTMLElement {
  const entry = make("span", "", { class: "entry" });
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("width", "30");
  svg.setAttribute("height", "8");
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
  line.setAttribute("d", "M0 4H30");
  line.setAttribute("stroke", colour);
  line.setAttribute("stroke-width", "2.5");
  line.setAttribute("stroke-dasharray", dash.join(" "));
  svg.append(line);
  entry.append(svg, name);
  return entry;
}

function extreme(values: (number | null)[], pick: (a: number, b: number) => number): number | null {
  return values.reduce((a, b) => (a === null ? b : b === null ? a : pick(a, b)), null);
}

function hasQuantity(data: CaseData, line: string, quantity: string): boolean {
  const place = data.line(line);
  return place !== undefined && quantityOf(place, quantity) !== undefined;
}

/** Values along a line at a time, interpolated between stored rows; null while on their way. */
export function valuesAt(
  data: CaseData,
  line: string,
  quantity: string,
  time: number,
): Float32Array | null {
  const { row, share } = data.locate(Math.min(time, data.endTime));
  const first = data.values(line, quantity, row);
  const second = share > 0 ? data.values(line, quantity, row + 1) : first;
  if (!first || !second) {
    return null;
  }
  return Float32Array.from(first, (value, k) => value + share * (second[k] - value));
}

function envelopeWords(envelope: Envelope): string {
  const { window_s: window } = envelope;
  const span = window ? ` from ${number(window[0])} to ${number(window[1])} s` : "";
  return envelope.every_step
    ? `Band and mean: every step${span}. Dashed: extremes of the whole run.`
    : `Band and mean: stored rows${span}; a peak between two rows is not in them.`;
}
