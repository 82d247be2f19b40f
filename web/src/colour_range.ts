// The ends of the colour scale: the extremes of the whole run over all that is shown, so that a
// colour means the same at every moment.

import type { CaseData } from "./store/case_data";
import { quantityOf } from "./store/case_data";
import type { Graphs } from "./ui/graphs";

/** Elapsed time between two renewals while a run goes on [ms]. */
const RENEWAL_MS = 3000;

export class ColourRange {
  private ranges = new Map<string, { range: [number, number]; stamp: string; at: number }>();
  private pending = new Set<string>();

  constructor(
    private graphs: Graphs,
    private onChange: () => void,
  ) {}

  clear(): void {
    this.ranges.clear();
    this.pending.clear();
  }

  /** The range for these cases; until the extremes have come, that of the moment. */
  range(cases: CaseData[], quantity: string, time: number): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    const include = (value: number | null) => {
      if (value !== null && Number.isFinite(value)) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    };
    for (const data of cases.filter((found) => found.hasFrames)) {
      for (const place of data.description.lines) {
        if (!quantityOf(place, quantity)) {
          continue;
        }
        const key = JSON.stringify([data.name, place.name, quantity]);
        const stamp = `${data.description.field_rows}/${data.description.status}`;
        const kept = this.ranges.get(key);
        if (kept) {
          kept.range.forEach(include);
        }
        const due = !kept || performance.now() - kept.at > RENEWAL_MS;
        if (kept?.stamp !== stamp && due && !this.pending.has(key)) {
          this.request(data, place.name, quantity, key, stamp);
        }
        if (kept?.stamp !== stamp) {
          const { row } = data.locate(Math.min(time, data.endTime));
          data.values(place.name, quantity, row)?.forEach(include);
        }
      }
    }
    return low <= high ? [low, high] : [0, 1];
  }

  private request(data: CaseData, line: string, quantity: string, key: string, stamp: string): void {
    this.pending.add(key);
    this.graphs
      .envelope(data, line, quantity)
      .then((envelope) => {
        let [low, high] = [Infinity, -Infinity];
        for (const value of [...(envelope?.run_min ?? []), ...(envelope?.run_max ?? [])]) {
          if (value !== null) {
            low = Math.min(low, value);
            high = Math.max(high, value);
          }
        }
        this.ranges.set(key, { range: [low, high], stamp, at: performance.now() });
      })
      // The connection's own messages tell of it; the range of the moment does meanwhile.
      .catch(() => this.ranges.set(key, { range: [NaN, NaN], stamp: "", at: performance.now() }))
      .finally(() => {
        this.pending.delete(key);
        this.onChange();
      });
  }
}
