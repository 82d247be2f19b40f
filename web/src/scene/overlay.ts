// What is written over the scene: depth scale, current, names, colour bar, axes, time. Drawn on a
// canvas of its own, so that pictures and videos have it too. No text is drawn over another.

import { Vector3 } from "three";
import type { Palette } from "../colour";
import { number, tick, ticks } from "../format";

export interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

export type Project = (place: Vector3) => { x: number; y: number } | null;

/** A thing that has a name, in the picture. */
export interface NamedPlace {
  /** Of all names in all views. */
  key: string;
  name: string;
  at: { x: number; y: number };
  size: number;
  weight: number;
  /** From the middle of the thing to the beginning of its name, sideways and upwards [px]. */
  gap: { x: number; y: number };
  /** Share of the name that may cover what is drawn; a name that would cover more is left out. */
  cover: number;
}

/** Where a name may stand about its thing, in half widths and heights of the name. */
interface Spot {
  x: number;
  y: number;
}

const SPOTS: Spot[] = [
  { x: 1, y: 0 },
  { x: -1, y: 0 },
  { x: 1, y: -0.9 },
  { x: -1, y: -0.9 },
  { x: 1, y: 0.9 },
  { x: -1, y: 0.9 },
  { x: 0, y: -1 },
  { x: 0, y: 1 },
  { x: 1, y: -2 },
  { x: -1, y: -2 },
  { x: 1, y: 2 },
  { x: -1, y: 2 },
  { x: 0, y: 2 },
];

const FONT = '"Noto Sans", system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

export class Overlay {
  private taken: Rect[] = [];
  private widths = new Map<string, number>();
  /** Where each name stood last. */
  private spots = new Map<string, number>();

  constructor(
    private context: CanvasRenderingContext2D,
    private palette: Palette,
  ) {}

  begin(width: number, height: number): void {
    this.context.clearRect(0, 0, width, height);
    this.taken = [];
  }

  private font(size: number, weight = 400): void {
    this.context.font = `${weight} ${size}px ${FONT}`;
  }

  private measure(text: string): number {
    const key = `${this.context.font}|${text}`;
    let width = this.widths.get(key);
    if (width === undefined) {
      if (this.widths.size > 2000) {
        this.widths.clear();
      }
      width = this.context.measureText(text).width;
      this.widths.set(key, width);
    }
    return width;
  }

  reserve(rect: Rect): void {
    this.taken.push(rect);
  }

  private free(rect: Rect): boolean {
    return this.taken.every(
      (other) =>
        rect.x + rect.width < other.x ||
        other.x + other.width < rect.x ||
        rect.y + rect.height < other.y ||
        other.y + other.height < rect.y,
    );
  }

  /** Text with a halo; returns whether there was room for it. `x`, `y`: of its anchor. */
  private write(
    text: string,
    x: number,
    y: number,
    size: number,
    align: "left" | "right" | "center",
    within: Rect,
    options: { weight?: number; colour?: string; force?: boolean; halo?: boolean } = {},
  ): boolean {
    this.font(size, options.weight);
    const width = this.measure(text);
    const left = align === "left" ? x : align === "right" ? x - width : x - width / 2;
    const rect = { x: left - 2, y: y - size * 0.62, width: width + 4, height: size * 1.24 };
    if (!options.force && (!isWithin(rect, within) || !this.free(rect))) {
      return false;
    }
    this.taken.push(rect);
    const { context } = this;
    context.textAlign = "left";
    context.textBaseline = "middle";
    if (options.halo !== false) {
      context.lineJoin = "round";
      context.lineWidth = 3.5;
      context.strokeStyle = this.palette.halo;
      context.strokeText(text, left, y);
    }
    context.fillStyle = options.colour ?? this.palette.ink;
    context.fillText(text, left, y);
    return true;
  }

  /** Cuts a text to a width. */
  private shorten(text: string, width: number): string {
    if (this.measure(text) <= width) {
      return text;
    }
    let [low, high] = [0, text.length];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.measure(`${text.slice(0, middle)}…`) <= width) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    return low > 0 ? `${text.slice(0, low)}…` : "";
  }

  /** Case name and time in the upper left corner. */
  heading(within: Rect, lines: { text: string; colour?: string; weight?: number }[]): void {
    let y = within.y + 16;
    for (const { text, colour, weight } of lines) {
      this.font(13, weight);
      const right = Math.max(60, within.width - 24);
      const style = { weight, colour, force: true };
      const swatch = colour ? 14 : 0;
      if (colour) {
        this.context.fillStyle = colour;
        this.context.fillRect(within.x + 12, y - 5, 10, 10);
      }
      const shown = this.shorten(text, right - swatch);
      const ink = { ...style, colour: this.palette.ink };
      this.write(shown, within.x + 12 + swatch, y, 13, "left", within, ink);
      y += 18;
    }
  }

  /** Sea surface and seabed, seen along themselves, at these heights in the picture. */
  levels(within: Rect, surface: number | null, bottom: number | null): void {
    const { context, palette } = this;
    const [left, right] = [within.x, within.x + within.width];
    const end = within.y + within.height;
    if (bottom !== null && bottom < end) {
      context.globalAlpha = 0.45;
      context.fillStyle = palette.seabed;
      context.fillRect(left, Math.max(bottom, within.y), within.width, end - Math.max(bottom, within.y));
      context.globalAlpha = 1;
    }
    context.lineWidth = 1.5;
    for (const [y, colour] of [[surface, palette.sea], [bottom, palette.seabedGrid]] as const) {
      if (y !== null) {
        context.strokeStyle = colour;
        context.beginPath();
        context.moveTo(left, y);
        context.lineTo(right, y);
        context.stroke();
      }
    }
  }

  /** A vertical scale of depths, from the surface down. `foot`: where it stands at sea level. */
  depthScale(within: Rect, foot: Vector3, depth: number, project: Project): void {
    const at = (d: number) => project(new Vector3(foot.x, foot.y, -d));
    const [top, bottom] = [at(0), at(depth)];
    if (!top || !bottom || Math.abs(bottom.y - top.y) < 70) {
      return;
    }
    const { context, palette } = this;
    const count = Math.max(2, Math.min(10, Math.abs(bottom.y - top.y) / 44));
    const marks = ticks(0, depth, count);
    context.strokeStyle = palette.faint;
    context.lineWidth = 1.25;
    context.beginPath();
    context.moveTo(top.x, top.y);
    context.lineTo(bottom.x, bottom.y);
    for (const d of marks.at) {
      const p = at(d);
      if (p) {
        context.moveTo(p.x, p.y);
        context.lineTo(p.x - 6, p.y);
      }
    }
    context.stroke();
    for (const d of marks.at) {
      const p = at(d);
      if (p) {
        const text = d === 0 ? "0 m" : tick(d, marks.step);
        this.write(text, p.x - 9, p.y, 11.5, "right", within, { colour: palette.faint });
      }
    }
    // The scale may lean: it keeps its room in pieces.
    for (let k = 0; k < 20; k++) {
      const p = at((depth * (k + 0.5)) / 20);
      if (p) {
        const height = Math.abs(bottom.y - top.y) / 20;
        this.reserve({ x: p.x - 6, y: p.y - height / 2, width: 8, height });
      }
    }
    this.write("Depth", top.x, top.y - 18, 11.5, "center", within, { colour: palette.faint });
  }

  /** Arrows of the current over depth. `velocities`: at depths, already times its factor. */
  current(
    within: Rect,
    foot: Vector3,
    arrows: { depth: number; velocity: [number, number] }[],
    metres: number,
    project: Project,
  ): void {
    const fastest = Math.max(...arrows.map(({ velocity }) => Math.hypot(...velocity)), 0);
    if (!(fastest > 0)) {
      return;
    }
    const { context, palette } = this;
    const tips: { x: number; y: number }[] = [];
    const start = project(new Vector3(foot.x, foot.y, -arrows[0].depth));
    const end = project(new Vector3(foot.x, foot.y, -arrows[arrows.length - 1].depth));
    if (!start || !end) {
      return;
    }
    context.strokeStyle = palette.current;
    context.fillStyle = palette.current;
    context.lineWidth = 1;
    context.globalAlpha = 0.5;
    context.beginPath();
    context.moveTo(start.x, start.y);
    context.lineTo(end.x, end.y);
    context.stroke();
    context.globalAlpha = 1;
    context.lineWidth = 1.6;
    for (const { depth, velocity } of arrows) {
      const scale = metres / fastest;
      const base = project(new Vector3(foot.x, foot.y, -depth));
      const tip = project(
        new Vector3(foot.x + velocity[0] * scale, foot.y + velocity[1] * scale, -depth),
      );
      if (!base || !tip) {
        continue;
      }
      tips.push(tip);
      const [dx, dy] = [tip.x - base.x, tip.y - base.y];
      const length = Math.hypot(dx, dy);
      if (length < 2) {
        context.beginPath();
        context.arc(base.x, base.y, 1.5, 0, 2 * Math.PI);
        context.fill();
        continue;
      }
      const head = Math.min(7, 0.5 * length);
      const [ux, uy] = [dx / length, dy / length];
      context.beginPath();
      context.moveTo(base.x, base.y);
      context.lineTo(tip.x - ux * head * 0.8, tip.y - uy * head * 0.8);
      context.stroke();
      context.beginPath();
      context.moveTo(tip.x, tip.y);
      context.lineTo(tip.x - ux * head - uy * head * 0.5, tip.y - uy * head + ux * head * 0.5);
      context.lineTo(tip.x - ux * head + uy * head * 0.5, tip.y - uy * head - ux * head * 0.5);
      context.fill();
    }
    const xs = [start.x, end.x, ...tips.map((tip) => tip.x)];
    const left = Math.min(...xs);
    const top = Math.min(start.y, end.y);
    this.reserve({ x: left - 3, y: top - 3, width: Math.max(...xs) - left + 6, height: Math.abs(end.y - start.y) + 6 });
    const middle = 0.5 * (left + Math.max(...xs));
    const label = `Current ${number(fastest, 3)} m/s`;
    const [above, below] = [[-16, -30], [Math.abs(end.y - start.y) + 16]];
    for (const dy of within.width < 500 ? [...below, ...above] : [...above, ...below]) {
      for (const align of ["center", "right", "left"] as const) {
        const x = align === "center" ? middle : align === "right" ? Math.max(...xs) : left;
        if (this.write(label, x, top + dy, 11.5, align, within, { colour: palette.current })) {
          return;
        }
      }
    }
  }

  /**
   * Names beside their things, the important ones first. A name stands where it covers least of what
   * is drawn (`drawn`), stays there while the scene moves, and is left out where it would cover
   * another.
   */
  names(within: Rect, items: NamedPlace[], drawn: Rect[]): void {
    for (const { key, name, at, size, weight, gap, cover } of items) {
      this.font(size, weight);
      const half = this.measure(name) / 2 + 2;
      const height = 1.24 * size;
      const standing = (spot: Spot) => ({
        x: at.x + spot.x * (gap.x + half),
        y: at.y + spot.y * (gap.y + height / 2),
      });
      const cost = (spot: Spot): number => {
        const { x, y } = standing(spot);
        const rect = { x: x - half, y: y - height / 2, width: 2 * half, height };
        if (!isWithin(rect, within) || !this.free(rect)) {
          return Infinity;
        }
        // A name that is nearer to another thing would be taken for that one's.
        const own = distance(at, rect);
        if (items.some((other) => other.key !== key && distance(other.at, rect) < own + 4)) {
          return Infinity;
        }
        const covered = drawn.reduce((sum, other) => sum + overlap(rect, other), 0);
        const share = covered / (2 * half * height);
        const far = Math.abs(spot.y) > 1.5 ? 0.2 : 0;
        return share > cover ? Infinity : share + far;
      };
      let best = -1;
      let least = Infinity;
      SPOTS.forEach((spot, index) => {
        // The place it had before is given up only for one that is clearly better.
        const found = cost(spot) + 0.01 * index - (this.spots.get(key) === index ? 0.25 : 0);
        if (found < least) {
          [least, best] = [found, index];
        }
      });
      if (best < 0) {
        this.spots.delete(key);
        continue;
      }
      this.spots.set(key, best);
      const place = standing(SPOTS[best]);
      this.write(name, place.x, place.y, size, "center", within, { weight });
    }
  }

  /** Axes in the lower left corner. `across`, `up`: of the picture, in global axes. */
  axes(within: Rect, across: Vector3, up: Vector3, back: Vector3): void {
    const { context, palette } = this;
    const length = 26;
    const [cx, cy] = [within.x + 44, within.y + within.height - 44];
    this.reserve({ x: cx - 40, y: cy - 40, width: 80, height: 80 });
    const names = ["x", "y", "z"] as const;
    const shown = names
      .map((name) => ({ name, dx: across[name] * length, dy: -up[name] * length, depth: back[name] }))
      .sort((a, b) => a.depth - b.depth);
    for (const { name, dx, dy } of shown) {
      context.strokeStyle = palette.ink;
      context.lineWidth = 1.75;
      context.beginPath();
      context.moveTo(cx, cy);
      context.lineTo(cx + dx, cy + dy);
      context.stroke();
      const size = Math.hypot(dx, dy);
      if (size > 9) {
        const [ux, uy] = [dx / size, dy / size];
        context.fillStyle = palette.ink;
        context.beginPath();
        context.moveTo(cx + dx + 4 * ux, cy + dy + 4 * uy);
        context.lineTo(cx + dx - 3 * ux - 3 * uy, cy + dy - 3 * uy + 3 * ux);
        context.lineTo(cx + dx - 3 * ux + 3 * uy, cy + dy - 3 * uy - 3 * ux);
        context.fill();
        const [tx, ty] = [cx + dx + 11 * ux, cy + dy + 11 * uy];
        this.write(name, tx, ty, 12, "center", within, { weight: 600, force: true });
      }
    }
  }

  /** A remark in the lower right corner. */
  remark(within: Rect, text: string): void {
    const [x, y] = [within.x + within.width - 10, within.y + within.height - 12];
    this.write(text, x, y, 11.5, "right", within, { colour: this.palette.faint });
  }

  /** The colour bar, upright at the right edge; takes its room before names are written. */
  colourBar(
    box: Rect,
    bytes: Uint8Array,
    range: [number, number],
    label: string,
  ): void {
    const { context, palette } = this;
    const bar = { x: box.x, y: box.y, width: 14, height: box.height };
    const rows = 64;
    for (let k = 0; k < rows; k++) {
      const share = 1 - (k + 0.5) / rows;
      const i = 4 * Math.round(share * 255);
      context.fillStyle = `rgb(${bytes[i]},${bytes[i + 1]},${bytes[i + 2]})`;
      context.fillRect(bar.x, bar.y + (k / rows) * bar.height, bar.width, bar.height / rows + 0.6);
    }
    context.strokeStyle = palette.faint;
    context.lineWidth = 1;
    context.strokeRect(bar.x, bar.y, bar.width, bar.height);
    const all = { x: 0, y: 0, width: 1e5, height: 1e5 };
    this.reserve({ x: bar.x - 4, y: bar.y - 4, width: 22, height: bar.height + 8 });
    const [low, high] = range;
    if (high > low) {
      const marks = ticks(low, high, Math.max(2, bar.height / 34));
      for (const value of marks.at) {
        const y = bar.y + bar.height * (1 - (value - low) / (high - low));
        context.beginPath();
        context.moveTo(bar.x + bar.width, y);
        context.lineTo(bar.x + bar.width + 4, y);
        context.stroke();
        this.write(tick(value, marks.step), bar.x + bar.width + 8, y, 11.5, "left", all, { halo: false });
      }
    } else if (Number.isFinite(low)) {
      this.write(number(low), bar.x + bar.width + 7, bar.y + bar.height / 2, 11.5, "left", all);
    }
    this.font(12, 600);
    const words = label.split("|");
    words.forEach((word, k) => {
      const y = bar.y - 14 - 15 * (words.length - 1 - k);
      this.write(word, box.x + box.width, y, 12, "right", all, { weight: 600, force: true });
    });
  }
}

function isWithin(rect: Rect, outer: Rect): boolean {
  return (
    rect.x >= outer.x &&
    rect.x + rect.width <= outer.x + outer.width &&
    rect.y >= outer.y &&
    rect.y + rect.height <= outer.y + outer.height
  );
}

/** From a point to a rectangle. */
function distance(point: { x: number; y: number }, rect: Rect): number {
  const dx = Math.max(rect.x - point.x, 0, point.x - rect.x - rect.width);
  const dy = Math.max(rect.y - point.y, 0, point.y - rect.y - rect.height);
  return Math.hypot(dx, dy);
}

/** Area that two rectangles share. */
function overlap(a: Rect, b: Rect): number {
  const width = Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x);
  const height = Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y);
  return width > 0 && height > 0 ? width * height : 0;
}
