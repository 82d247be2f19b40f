// What the user has chosen, and who wants to know.

import type { MapName } from "./colour";

export type Selection =
  | { kind: "line"; name: string; node: number }
  | { kind: "vessel" | "body"; name: string };

export interface Options {
  /** Cases that are shown, by name, in file order. */
  cases: string[];
  arrangement: "beside" | "over";
  /** Result along the lines. */
  quantity: string;
  selection: Selection | null;
  colourMap: MapName;
  reversed: boolean;
  colourBy: "result" | "case";
  /** Fixed ends of the colour scale in the stored unit; null: of the data. */
  fixedRange: [number, number] | null;
  lineWidth: number;
  exaggeration: number;
  stretch: number;
  /** Vessel or body that stays in the middle; empty: the sea stands still. */
  follow: string;
  parallel: boolean;
  labels: boolean;
  current: boolean;
  depthScale: boolean;
  sea: boolean;
  seabed: boolean;
  theme: "auto" | "light" | "dark";
  shortcuts: boolean;
  adaptive: boolean;
}

export const DEFAULTS: Options = {
  cases: [],
  arrangement: "beside",
  quantity: "effective_tension",
  selection: null,
  colourMap: "viridis",
  reversed: false,
  colourBy: "result",
  fixedRange: null,
  lineWidth: 5,
  exaggeration: 1,
  stretch: 1,
  follow: "",
  parallel: false,
  labels: true,
  current: true,
  depthScale: true,
  sea: true,
  seabed: true,
  theme: "auto",
  shortcuts: true,
  adaptive: true,
};

type Listener = (changed: Set<keyof Options>) => void;

export class OptionStore {
  private values: Options = { ...DEFAULTS };
  private listeners: Listener[] = [];

  get(): Readonly<Options> {
    return this.values;
  }

  set(change: Partial<Options>): void {
    const keys = Object.keys(change) as (keyof Options)[];
    const changed = new Set(keys.filter((key) => this.values[key] !== change[key]));
    if (changed.size > 0) {
      this.values = { ...this.values, ...change };
      this.listeners.forEach((listener) => listener(changed));
    }
  }

  onChange(listener: Listener): void {
    this.listeners.push(listener);
  }
}
