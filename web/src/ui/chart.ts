// Curves: time histories, and range graphs along a line.

import uPlot from "uplot";
import { number } from "../format";
import { make, themeColour } from "./dom";

export interface Curve {
  label: string;
  colour: string;
  width?: number;
  dash?: number[];
  x: ArrayLike<number>;
  y: ArrayLike<number | null>;
}

export interface ChartContent {
  xLabel: string;
  yLabel: string;
  curves: Curve[];
  /** Pairs of curves with a filled band between them. */
  bands: [number, number][];
}

/** Most points of a curve that are drawn; more could not be told apart. */
const MOST_POINTS = 600;

export class Chart {
  private plot: uPlot | null = null;
  private shape = "";
  private now: HTMLElement | null = null;
  private nowAt: number | null = null;

  constructor(
    private host: HTMLElement,
    private onPick: (x: number) => void,
  ) {
    new ResizeObserver(() => this.resize()).observe(host);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (this.plot && width > 0 && (this.plot.width !== width || this.plot.height !== height)) {
      this.plot.setSize({ width, height });
      this.placeNow();
    }
  }

  /** Draws anew when what is drawn has changed in kind, else only the numbers. */
  show(content: ChartContent): void {
    const kind = content.curves.map(({ label, colour, width, dash }) => [label, colour, width, dash]);
    const ink = themeColour("ink");
    const shape = JSON.stringify([content.xLabel, content.yLabel, kind, content.bands, ink]);
    const data = align(content.curves);
    if (this.plot && shape === this.shape) {
      this.plot.setData(data);
      this.placeNow();
      return;
    }
    this.shape = shape;
    this.plot?.destroy();
    const axis = (label: string, size: number): uPlot.Axis => ({
      label,
      labelSize: 18,
      labelGap: 0,
      size,
      font: "11px system-ui, sans-serif",
      labelFont: "12px system-ui, sans-serif",
      stroke: themeColour("faint"),
      grid: { stroke: themeColour("line"), width: 0.6 },
      ticks: { stroke: themeColour("line"), width: 0.6, size: 5 },
      values: (_, values) => values.map((value) => (value === null ? "" : plain(value))),
    });
    this.plot = new uPlot(
      {
        width: Math.max(this.host.clientWidth, 100),
        height: Math.max(this.host.clientHeight, 100),
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { size: 6 } },
        scales: { x: { time: false } },
        axes: [axis(content.xLabel, 30), axis(content.yLabel, 54)],
        series: [
          {},
          ...content.curves.map(({ label, colour, width, dash }) => ({
            label,
            stroke: colour,
            width: width ?? 1.5,
            dash,
            spanGaps: false,
            points: { show: false },
          })),
        ],
        bands: content.bands.map(([a, b]) => ({
          series: [a + 1, b + 1] as [number, number],
          fill: themeColour("band"),
        })),
      },
      data,
      this.host,
    );
    this.now = make("div", "", { class: "now" });
    this.plot.over.append(this.now);
    this.plot.over.addEventListener("click", (event) => {
      const box = this.plot?.over.getBoundingClientRect();
      if (box && this.plot) {
        this.onPick(this.plot.posToVal(event.clientX - box.left, "x"));
      }
    });
    this.placeNow();
  }

  /** Puts the upright mark at a place on the x axis. */
  mark(x: number | null): void {
    this.nowAt = x;
    this.placeNow();
  }

  private placeNow(): void {
    if (!this.plot || !this.now) {
      return;
    }
    const { nowAt } = this;
    const { min, max } = this.plot.scales.x;
    const inside = nowAt !== null && min != null && max != null && nowAt >= min && nowAt <= max;
    this.now.hidden = !inside;
    if (inside) {
      this.now.style.transform = `translateX(${this.plot.valToPos(nowAt, "x")}px)`;
    }
  }

  clear(): void {
    this.plot?.destroy();
    this.plot = null;
    this.shape = "";
    this.host.replaceChildren();
  }
}

function plain(value: number): string {
  const text = Math.abs(value) >= 1e6 || (value !== 0 && Math.abs(value) < 1e-3) ? number(value, 2) : String(Number(value.toPrecision(6)));
  return text.replace("-", "−");
}

/** One x axis for all curves, each thinned out to its extremes. */
function align(curves: Curve[]): uPlot.AlignedData {
  const tables = curves.map(({ x, y }) => thinned(x, y));
  if (tables.length === 0) {
    return [[], []];
  }
  const first = tables[0][0];
  const same = tables.every(
    ([x]) => x.length === first.length && x.every((value, k) => value === first[k]),
  );
  if (same) {
    return [first, ...tables.map(([, y]) => y)];
  }
  return uPlot.join(tables);
}

/** Curves that were thinned before: most stay the same while one moves. */
const known = new WeakMap<object, [number[], (number | null)[]]>();

function thinned(x: ArrayLike<number>, y: ArrayLike<number | null>): [number[], (number | null)[]] {
  let found = known.get(y);
  if (!found) {
    found = thin(x, y);
    known.set(y, found);
  }
  return found;
}

/** Keeps the least and the largest of each stretch, in order. */
function thin(x: ArrayLike<number>, y: ArrayLike<number | null>): [number[], (number | null)[]] {
  const count = Math.min(x.length, y.length);
  const value = (k: number) => {
    const found = y[k];
    return found === null || !Number.isFinite(found) ? null : found;
  };
  const keep: number[] = [];
  if (count <= MOST_POINTS) {
    for (let k = 0; k < count; k++) {
      keep.push(k);
    }
  } else {
    const stretches = MOST_POINTS / 2;
    for (let s = 0; s < stretches; s++) {
      const [from, to] = [Math.floor((s * count) / stretches), Math.floor(((s + 1) * count) / stretches)];
      let [low, high] = [from, from];
      for (let k = from; k < to; k++) {
        const v = value(k);
        if (v !== null && v < (value(low) ?? Infinity)) {
          low = k;
        }
        if (v !== null && v > (value(high) ?? -Infinity)) {
          high = k;
        }
      }
      keep.push(Math.min(low, high));
      if (low !== high) {
        keep.push(Math.max(low, high));
      }
    }
  }
  return [keep.map((k) => x[k]), keep.map(value)];
}
