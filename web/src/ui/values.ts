// The numbers of this moment as tables, for reading without the picture.

import { number, seconds, shownUnit, title } from "../format";
import type { CaseData } from "../store/case_data";
import { byId, fill, make } from "./dom";
import { valuesAt } from "./graphs";

/** Nodes in a table at a time: more would make the page slow to read and to draw. */
const PAGE = 100;

export class Values {
  private first = 0;
  private drawn = "";
  private drawnAt = 0;

  constructor(
    private cases: () => CaseData[],
    private changed: () => void,
  ) {
    const turn = (by: number) => () => {
      this.first = Math.max(0, this.first + by);
      this.drawn = "";
      changed();
    };
    byId("values-back").addEventListener("click", turn(-PAGE));
    byId("values-on").addEventListener("click", turn(PAGE));
    for (const id of ["values-case", "values-line"]) {
      byId(id).addEventListener("change", () => {
        this.first = 0;
        this.drawn = "";
        this.changed();
      });
    }
  }

  /** Fills the tables for a moment, at most twice a second while time runs. */
  moment(time: number, decimals: number, force: boolean): void {
    if (byId("values").hidden) {
      return;
    }
    const cases = this.cases().filter((data) => data.hasFrames);
    const caseSelect = byId<HTMLSelectElement>("values-case");
    const lineSelect = byId<HTMLSelectElement>("values-line");
    const data = cases.find(({ name }) => name === caseSelect.value) ?? cases[0];
    if (!data) {
      return;
    }
    const caseEntries = cases.map(({ name }): [string, string] => [name, name]);
    fill(caseSelect, [{ label: "", entries: caseEntries }], data.name);
    const lines = data.description.lines;
    const line = lines.find(({ name }) => name === lineSelect.value) ?? lines[0];
    fill(lineSelect, [{ label: "", entries: lines.map((l): [string, string] => [l.name, l.name]) }], line.name);
    const now = performance.now();
    const rows = data.description.field_rows;
    const key = JSON.stringify([time, data.name, line.name, this.first, rows]);
    if (key === this.drawn || (!force && now - this.drawnAt < 500)) {
      return;
    }
    const arc = data.arcLengths.get(line.name) ?? new Float64Array(0);
    this.first = Math.min(this.first, Math.floor(Math.max(arc.length - 1, 0) / PAGE) * PAGE);
    const columns = line.quantities.map((quantity) => ({
      quantity,
      values: valuesAt(data, line.name, quantity.name, time),
    }));
    if (columns.some(({ values }) => values === null)) {
      // On its way; the next moment asks again.
      setTimeout(this.changed, 100);
      return;
    }
    this.drawn = key;
    this.drawnAt = now;
    const last = Math.min(this.first + PAGE, arc.length);
    const table = byId<HTMLTableElement>("node-table");
    const caption = `${line.name}, case ${data.name}, t = ${seconds(time, decimals)} s: nodes ${this.first} to ${last - 1} of ${arc.length}`;
    const units = columns.map(({ quantity, values }) => {
      const largest = Array.from(values ?? []).reduce((a: number, b: number) => Math.max(a, Math.abs(b) || 0), 0);
      return shownUnit(quantity.unit, largest);
    });
    const head = make("tr");
    head.append(make("th", "Node", { scope: "col" }), make("th", "s [m]", { scope: "col" }));
    columns.forEach(({ quantity }, k) =>
      head.append(make("th", `${quantity.name.length === 1 ? quantity.name : title(quantity.name)} [${units[k].unit}]`, { scope: "col" })),
    );
    const body = make("tbody");
    for (let node = this.first; node < last; node++) {
      const row = make("tr");
      row.append(make("th", String(node), { scope: "row" }), make("td", number(arc[node], 5)));
      columns.forEach(({ values, quantity }, k) => {
        const value = values?.[node] ?? NaN;
        const cell = make("td", number(value * units[k].factor));
        cell.dataset.quantity = quantity.name;
        cell.dataset.value = String(value);
        row.append(cell);
      });
      body.append(row);
    }
    const thead = make("thead");
    thead.append(head);
    table.replaceChildren(make("caption", caption), thead, body);
    byId<HTMLButtonElement>("values-back").disabled = this.first === 0;
    byId<HTMLButtonElement>("values-on").disabled = last >= arc.length;
    this.objects(data, time, decimals);
  }

  private objects(data: CaseData, time: number, decimals: number): void {
    const poses = data.sample(time, "x")?.poses ?? new Map();
    const head = make("tr");
    for (const name of ["Object", "x [m]", "y [m]", "z [m]"]) {
      head.append(make("th", name, { scope: "col" }));
    }
    const body = make("tbody");
    for (const [name, pose] of poses) {
      const row = make("tr");
      row.append(make("th", name, { scope: "row" }));
      for (const value of pose.position) {
        row.append(make("td", number(value, 6)));
      }
      body.append(row);
    }
    const thead = make("thead");
    thead.append(head);
    const caption = `Vessels and bodies, case ${data.name}, t = ${seconds(time, decimals)} s`;
    byId("object-table").replaceChildren(make("caption", caption), thead, body);
  }
}
