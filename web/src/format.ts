// Numbers and units as a person reads them.

/** How a unit is shown: the stored value times `factor`. */
export interface ShownUnit {
  unit: string;
  factor: number;
}

const LARGE: Record<string, [string, string, string]> = {
  N: ["N", "kN", "MN"],
  "N m": ["N m", "kN m", "MN m"],
  Pa: ["Pa", "kPa", "MPa"],
};

/** The prefix that keeps the largest number below ten thousand. */
export function shownUnit(unit: string, largest: number): ShownUnit {
  const names = LARGE[unit];
  if (!names || !(largest >= 1e4)) {
    return { unit, factor: 1 };
  }
  return largest < 1e7 ? { unit: names[1], factor: 1e-3 } : { unit: names[2], factor: 1e-6 };
}

/** A number with four significant digits, thousands parted by thin spaces. */
export function number(value: number, digits = 4): string {
  if (!Number.isFinite(value)) {
    return "–";
  }
  const size = Math.abs(value);
  if (size === 0) {
    return "0";
  }
  if (size < 1e-3 || size >= 1e7) {
    return value.toExponential(digits - 1).replace("-", "−").replace("e−", "e-");
  }
  const whole = Math.floor(Math.log10(size)) + 1;
  const text = value.toFixed(Math.max(0, Math.min(6, digits - whole)));
  return minus(thousands(text));
}

/** A tick of a scale whose steps are `step` apart. */
export function tick(value: number, step: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    return minus(value.toPrecision(3).replace(/\.?0+(e|$)/, "$1"));
  }
  const decimals = Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9)));
  const rounded = value.toFixed(decimals);
  return minus(thousands(Number(rounded) === 0 ? (0).toFixed(decimals) : rounded));
}

/** Time with as many decimals as the stored interval needs. */
export function seconds(time: number, decimals = 1): string {
  return minus(thousands(time.toFixed(decimals)));
}

/** A step of 1, 2 or 5 times a power of ten that cuts a span into at most `count` parts. */
export function niceStep(span: number, count: number): number {
  const raw = Math.max(span, 1e-12) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const part = raw / power;
  return (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10) * power;
}

/** Multiples of a nice step within a range. */
export function ticks(low: number, high: number, count: number): { step: number; at: number[] } {
  const step = niceStep(high - low, count);
  const at = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    at.push(k * step);
  }
  return { step, at };
}

/** `bend_moment` as `Bend moment`. */
export function title(name: string): string {
  const words = name.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

function thousands(text: string): string {
  const [whole, part] = text.split(".");
  const digits = whole.replace("-", "").length;
  const grouped = digits > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  return part === undefined ? grouped : `${grouped}.${part}`;
}

function minus(text: string): string {
  return text.replace("-", "−").replace("e−", "e-");
}
