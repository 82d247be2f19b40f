// The tabs, and the settings in them.

import { caseColour } from "../colour";
import type { MapName } from "../colour";
import { shownUnit, title } from "../format";
import type { Options, OptionStore } from "../options";
import type { CaseData } from "../store/case_data";
import type { StudyReport } from "../store/types";
import { byId, fill, make } from "./dom";

/** Arrow keys move between tabs, as screen-reader users expect of a tab list. */
export function bindTabs(onOpen: () => void): void {
  const tabs = [...document.querySelectorAll<HTMLButtonElement>('[role="tab"]')];
  const open = (tab: HTMLButtonElement) => {
    for (const other of tabs) {
      const chosen = other === tab;
      other.setAttribute("aria-selected", String(chosen));
      other.tabIndex = chosen ? 0 : -1;
      byId(other.getAttribute("aria-controls") ?? "").hidden = !chosen;
    }
    onOpen();
  };
  for (const [index, tab] of tabs.entries()) {
    tab.addEventListener("click", () => open(tab));
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      const next = event.key === "Home" ? 0 : event.key === "End" ? tabs.length - 1 : index + (step ?? 0);
      if (step !== undefined || event.key === "Home" || event.key === "End") {
        event.preventDefault();
        event.stopPropagation();
        const target = tabs[(next + tabs.length) % tabs.length];
        target.focus();
        open(target);
      }
    });
  }
}

/** From 0 to 100 on the slider to 0.1 to 1000 in steps of a fine scale; 10 is 1. */
function exaggerationOf(position: number): number {
  const value = position <= 10 ? position / 10 : 10 ** ((position - 10) / 30);
  return value < 10 ? Math.round(value * 10) / 10 : Math.round(value);
}

const CHECKS = ["parallel", "labels", "current", "depthScale", "sea", "seabed", "adaptive", "reversed", "shortcuts"] as const;

export class Panels {
  /** Unit and range of the result that is shown, for the inputs of a fixed range. */
  private unit = "";
  private factor = 1;
  private range: [number, number] = [0, 1];
  private listKey = "";

  constructor(private options: OptionStore) {
    for (const key of CHECKS) {
      const input = byId<HTMLInputElement>(key);
      input.checked = options.get()[key];
      input.addEventListener("change", () => options.set({ [key]: input.checked }));
    }
    this.bind("colour-by", (value) => ({ colourBy: value as Options["colourBy"] }));
    this.bind("map", (value) => ({ colourMap: value as MapName }));
    this.bind("follow", (value) => ({ follow: value }));
    this.slide("width", (value) => ({ lineWidth: value }), (value) => String(value));
    this.slide("exaggeration", (value) => ({ exaggeration: exaggerationOf(value) }), (value) => String(exaggerationOf(value)));
    this.slide("stretch", (value) => ({ stretch: value }), (value) => String(value));
    for (const radio of document.querySelectorAll<HTMLInputElement>('input[name="arrangement"]')) {
      radio.addEventListener("change", () => {
        const arrangement = radio.value as Options["arrangement"];
        // Overlaid cases are told apart by colour.
        const colourBy = arrangement === "over" ? "case" : "result";
        byId<HTMLSelectElement>("colour-by").value = colourBy;
        options.set({ arrangement, colourBy });
      });
    }
    const fixed = byId<HTMLInputElement>("fixed");
    const ends = ["low", "high"].map((id) => byId<HTMLInputElement>(id));
    const apply = () => {
      ends.forEach((input) => (input.disabled = !fixed.checked));
      const [low, high] = ends.map((input) => input.valueAsNumber / this.factor);
      const valid = Number.isFinite(low) && Number.isFinite(high) && high > low;
      ends.forEach((input) => input.setCustomValidity(fixed.checked && !valid ? "The lowest must be below the highest." : ""));
      if (fixed.checked && !valid) {
        ends[1].reportValidity();
        return;
      }
      options.set({ fixedRange: fixed.checked ? [low, high] : null });
    };
    fixed.addEventListener("change", () => {
      this.fillRange();
      apply();
    });
    ends.forEach((input) => input.addEventListener("change", apply));
  }

  private bind(id: string, change: (value: string) => Partial<Options>): void {
    const select = byId<HTMLSelectElement>(id);
    select.addEventListener("change", () => this.options.set(change(select.value)));
  }

  private slide(id: string, change: (value: number) => Partial<Options>, text: (value: number) => string): void {
    const input = byId<HTMLInputElement>(id);
    input.addEventListener("input", () => {
      byId(`${id}-value`).textContent = text(input.valueAsNumber);
      input.setAttribute("aria-valuetext", text(input.valueAsNumber));
      this.options.set(change(input.valueAsNumber));
    });
  }

  /** The range of the colours, for the inputs. */
  setRange(range: [number, number], unit: string): void {
    this.range = range;
    const shown = shownUnit(unit, Math.max(Math.abs(range[0]), Math.abs(range[1])));
    if (shown.unit !== this.unit || !byId<HTMLInputElement>("fixed").checked) {
      this.unit = shown.unit;
      this.factor = shown.factor;
      byId("low-label").textContent = `Lowest [${shown.unit}]`;
      byId("high-label").textContent = `Highest [${shown.unit}]`;
      this.fillRange();
    }
  }

  private fillRange(): void {
    const [low, high] = this.options.get().fixedRange ?? this.range;
    byId<HTMLInputElement>("low").value = String(Number((low * this.factor).toPrecision(4)));
    byId<HTMLInputElement>("high").value = String(Number((high * this.factor).toPrecision(4)));
  }

  /** A result of another kind has another range. */
  releaseRange(): void {
    const fixed = byId<HTMLInputElement>("fixed");
    if (fixed.checked) {
      fixed.checked = false;
      fixed.dispatchEvent(new Event("change"));
    }
  }

  /** The list of cases with their states, and what can be kept in the middle. */
  refresh(study: StudyReport, cases: CaseData[]): void {
    const options = this.options.get();
    const key = JSON.stringify([study.cases, options.cases, caseColour(0)]);
    if (key !== this.listKey) {
      this.listKey = key;
      this.caseList(study);
    }
    byId("study-note").textContent = study.note;
    const names = (pick: (data: CaseData) => string[]) => [...new Set(cases.flatMap(pick))];
    const movers = names((data) => [
      ...(data.scene?.vessels.filter((vessel) => vessel.moves).map((vessel) => vessel.name) ?? []),
      ...(data.scene?.bodies.map((body) => body.name) ?? []),
    ]);
    const entries = movers.map((name): [string, string] => [name, name]);
    entries.unshift(["", "Nothing: the sea stands still"]);
    fill(byId("follow"), [{ label: "", entries }], options.follow);
  }

  private caseList(study: StudyReport): void {
    const options = this.options.get();
    const list = byId("case-list");
    const focused = (document.activeElement as HTMLInputElement | null)?.value;
    list.replaceChildren(
      ...study.cases.map((found) => {
        const chosen = options.cases.includes(found.name);
        const label = make("label", "", { class: "case" });
        const input = make("input", "", { type: "checkbox", name: "case", value: found.name });
        input.checked = chosen;
        // One case is always shown.
        input.disabled = chosen && options.cases.length === 1;
        input.addEventListener("change", () => this.toggle(study, found.name, input.checked));
        const text = make("span");
        text.append(make("b", found.name), ` ${found.description}`);
        text.append(make("small", progressWords(found)));
        const swatch = make("span", "", { class: "swatch" });
        const index = options.cases.indexOf(found.name);
        swatch.style.background = index < 0 ? "transparent" : caseColour(index);
        label.append(input, text, swatch);
        return label;
      }),
    );
    if (focused) {
      list.querySelector<HTMLInputElement>(`input[value="${CSS.escape(focused)}"]`)?.focus();
    }
  }

  private toggle(study: StudyReport, name: string, on: boolean): void {
    const { cases } = this.options.get();
    const wanted = on ? [...cases, name] : cases.filter((other) => other !== name);
    const order = study.cases.map((found) => found.name);
    this.options.set({ cases: order.filter((found) => wanted.includes(found)) });
  }
}

function progressWords(found: StudyReport["cases"][number]): string {
  const end = found.duration_s === null ? "statics" : `${found.duration_s} s`;
  const words = {
    pending: "has not begun",
    running: `being computed, ${found.field_rows} steps stored of ${end}`,
    complete: `complete, ${end}`,
    interrupted: `interrupted, ${found.field_rows} steps stored of ${end}`,
    failed: `the solver gave up: ${found.error?.message ?? "no reason is stored"}`,
  };
  return words[found.status];
}

/** Fills the list of results along lines, positions last; returns the one that is chosen. */
export function fillQuantities(cases: CaseData[], wanted: string): string | null {
  const lines = cases.flatMap((data) => data.description.lines);
  const names = [...new Set(lines.flatMap((line) => line.quantities.map((q) => q.name)))];
  if (names.length === 0) {
    return null;
  }
  const rank = (name: string) => (["x", "y", "z"].includes(name) ? 1 : 0);
  names.sort((a, b) => rank(a) - rank(b));
  const entries = names.map((name): [string, string] => {
    return [name, name.length === 1 ? `Position ${name}` : title(name)];
  });
  const chosen = names.includes(wanted) ? wanted : names[0];
  fill(byId("quantity"), [{ label: "", entries }], chosen);
  return chosen;
}
