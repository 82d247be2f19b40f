// One load case: where its data is, how far it has come, and frames of it at any time.

import { getJson } from "../api";
import { ChunkCache, Wanted, readVectors } from "./chunks";
import type {
  ArrayPlace,
  CaseDescription,
  CaseProgress,
  Envelope,
  LinePlace,
  NodeHistory,
  QuantityPlace,
  Scene,
} from "./types";

/** Position and orientation of a vessel or body: global [m], quaternion x y z w. */
export interface Pose {
  position: [number, number, number];
  turn: [number, number, number, number];
}

/** What a line looks like at a time. */
export interface LineFrame {
  place: LinePlace;
  /** x, y, z and the chosen result of each node (4 x nodes). */
  nodes: Float32Array;
}

/** What a case looks like at a time. */
export interface CaseFrame {
  /** Time that is shown [s]; the case may have ended before the one asked for. */
  time: number;
  /** Stored row at or before that time. */
  row: number;
  lines: LineFrame[];
  poses: Map<string, Pose>;
}

/** How long before it is shown data is asked for, and pictures that are drawn in a second. */
const LEAD_S = 1.5;
const PICTURES_PER_S = 30;

const AXES = ["x", "y", "z"] as const;
const POSE_CHANNELS = ["x", "y", "z", "roll", "pitch", "heading"] as const;

export class CaseData {
  /** Times of the stored fields [s]. */
  fieldTimes: Float64Array = new Float64Array(0);
  /** Times of the stored histories [s]. */
  historyTimes: Float64Array = new Float64Array(0);
  /** Static positions per line, x y z of each node (3 x nodes). */
  statics = new Map<string, Float32Array>();
  arcLengths = new Map<string, Float64Array>();
  private frame: CaseFrame = { time: 0, row: 0, lines: [], poses: new Map() };
  private channels = new Map<string, ArrayPlace>();
  private rest: Map<string, Pose> | null = null;

  private constructor(
    private cache: ChunkCache,
    public description: CaseDescription,
  ) {}

  static async load(cache: ChunkCache, name: string): Promise<CaseData> {
    const description = await getJson<CaseDescription>("api/case", { case: name });
    const data = new CaseData(cache, description);
    await data.prepare();
    return data;
  }

  get name(): string {
    return this.description.name;
  }

  get scene(): Scene | null {
    return this.description.scene;
  }

  /** Whether there is anything to draw. */
  get hasFrames(): boolean {
    return this.fieldTimes.length > 0 && this.description.lines.length > 0;
  }

  /** Last stored time [s]. */
  get endTime(): number {
    return this.fieldTimes[this.fieldTimes.length - 1] ?? 0;
  }

  /** Takes over how far the run has come; reads the description again when that has changed. */
  async advance(progress: CaseProgress): Promise<boolean> {
    const old = this.description;
    const same =
      progress.field_rows === old.field_rows &&
      progress.history_rows === old.history_rows &&
      progress.status === old.status;
    if (same) {
      return false;
    }
    const planned = old.lines[0]?.field_time.rows ?? 0;
    if (progress.status !== old.status || progress.field_rows > planned || planned === 0) {
      this.description = await getJson<CaseDescription>("api/case", { case: this.name });
    } else {
      this.description = { ...old, ...progress };
    }
    await this.prepare();
    return true;
  }

  private async prepare(): Promise<void> {
    const { lines, time, field_rows, history_rows } = this.description;
    this.channels = new Map(this.description.channels.map((c) => [c.name, c.array]));
    if (lines.length === 0 || time === null) {
      return;
    }
    // Everything in one request: arc lengths and static positions only of lines that are new.
    const fresh = lines.filter((line) => !this.arcLengths.has(line.name));
    const wanted: Wanted[] = [
      { array: lines[0].field_time, rows: field_rows },
      { array: time, rows: history_rows },
    ];
    const places = fresh.map((line) => {
      const arc = wanted.push(whole(line.arc_length)) - 1;
      const axes = AXES.map((axis) => {
        const array = quantityOf(line, axis)?.static_state;
        return array ? wanted.push(whole(array)) - 1 : null;
      });
      return { line, arc, axes };
    });
    const read = await readVectors(this.cache, wanted);
    [this.fieldTimes, this.historyTimes] = read;
    for (const { line, arc, axes } of places) {
      this.arcLengths.set(line.name, read[arc]);
      const statics = new Float32Array(3 * read[arc].length).fill(NaN);
      axes.forEach((index, axis) => {
        const values = index === null ? [] : read[index];
        values.forEach((value, node) => (statics[3 * node + axis] = value));
      });
      this.statics.set(line.name, statics);
    }
  }

  /** Stored row at or before a time, and how far the time is on the way to the next. */
  locate(time: number): { row: number; share: number } {
    return locate(this.fieldTimes, time);
  }

  /**
   * The case at a time, with a result along its lines. Null while data is on its way. The frame is
   * used again by the next call.
   */
  sample(time: number, quantity: string): CaseFrame | null {
    if (!this.hasFrames) {
      return null;
    }
    const { row, share } = this.locate(Math.min(time, this.endTime));
    const next = share > 0 ? row + 1 : row;
    const rows = this.description.field_rows;
    let complete = true;
    const { lines } = this.description;
    if (this.frame.lines.length !== lines.length) {
      this.frame.lines = lines.map((place) => ({
        place,
        nodes: new Float32Array(4 * place.arc_length.rows),
      }));
    }
    for (const [index, place] of lines.entries()) {
      const { nodes } = this.frame.lines[index];
      this.frame.lines[index].place = place;
      const names = ["x", "y", "z", quantity];
      for (const [component, name] of names.entries()) {
        const array = quantityOf(place, name)?.field;
        if (!array) {
          for (let k = component; k < nodes.length; k += 4) {
            nodes[k] = NaN;
          }
          continue;
        }
        const from = this.row(array, row, rows);
        const to = next === row ? from : this.row(array, next, rows);
        if (!from || !to) {
          complete = false;
          continue;
        }
        blend(nodes, component, from, to, share);
      }
    }
    const first = this.poses(this.fieldTimes[row]);
    const second = next === row ? first : this.poses(this.fieldTimes[next]);
    if (!first || !second || !complete || !this.restPoses()) {
      return null;
    }
    this.frame.poses.clear();
    for (const [name, pose] of first) {
      this.frame.poses.set(name, mix(pose, second.get(name) ?? pose, share));
    }
    this.frame.row = row;
    this.frame.time =
      this.fieldTimes[row] + share * ((this.fieldTimes[next] ?? 0) - this.fieldTimes[row]);
    return this.frame;
  }

  /** Poses at the start, once they are here. */
  restPoses(): Map<string, Pose> | null {
    this.rest ??= this.fieldTimes.length > 0 ? this.poses(this.fieldTimes[0]) : null;
    return this.rest;
  }

  /** Asks for the data that will be shown soon, `speed` seconds per second from a time on. */
  prefetch(time: number, speed: number, quantity: string): void {
    const ahead = time + LEAD_S * speed;
    if (!this.hasFrames || ahead > this.endTime) {
      return;
    }
    const { row } = this.locate(ahead);
    const passed = (row - this.locate(time).row) / (LEAD_S * PICTURES_PER_S);
    // Where pictures leap over whole chunks, nobody knows which ones will be needed.
    if (passed > this.description.lines[0].quantities[0]?.field.chunk_rows) {
      return;
    }
    for (const place of this.description.lines) {
      for (const name of ["x", "y", "z", quantity]) {
        const array = quantityOf(place, name)?.field;
        if (array) {
          this.row(array, row, this.description.field_rows);
        }
      }
    }
  }

  /** Values of one quantity along a line at a stored row; null while on their way. */
  values(line: string, quantity: string, row: number): Float32Array | Float64Array | null {
    const place = this.line(line);
    const array = place && quantityOf(place, quantity)?.field;
    return array ? this.row(array, row, this.description.field_rows) : null;
  }

  line(name: string): LinePlace | undefined {
    return this.description.lines.find((line) => line.name === name);
  }

  /** A whole time history. */
  async history(channel: string): Promise<{ times: Float64Array; values: Float64Array } | null> {
    const array = this.channels.get(channel);
    if (!array) {
      return null;
    }
    const rows = this.description.history_rows;
    const [values] = await readVectors(this.cache, [{ array, rows }]);
    return { times: this.historyTimes.subarray(0, values.length), values };
  }

  /** The history of a quantity at one node of a line. */
  nodeHistory(line: string, quantity: string, node: number): Promise<NodeHistory> {
    return getJson<NodeHistory>("api/node", { case: this.name, line, quantity, node }, 30000);
  }

  /** What a quantity along a line keeps within. */
  envelope(line: string, quantity: string): Promise<Envelope> {
    return getJson<Envelope>("api/envelope", { case: this.name, line, quantity }, 30000);
  }

  private row(array: ArrayPlace, row: number, rows: number) {
    const chunk = Math.floor(row / array.chunk_rows);
    const values = this.cache.peek(array, chunk, rows);
    if (!values) {
      return null;
    }
    const columns = array.columns ?? 1;
    const start = (row - chunk * array.chunk_rows) * columns;
    return values.subarray(start, start + columns);
  }

  /** Poses of all vessels and bodies at a time; null while on their way. */
  private poses(time: number): Map<string, Pose> | null {
    const scene = this.scene;
    const poses = new Map<string, Pose>();
    if (!scene) {
      return poses;
    }
    let complete = true;
    const { row, share } = locate(this.historyTimes, time);
    const next = Math.min(row + 1, this.historyTimes.length - 1);
    for (const object of [...scene.vessels, ...scene.bodies]) {
      const at = (index: number): Pose | null => {
        const numbers = POSE_CHANNELS.map((channel) => {
          const array = this.channels.get(`${object.name}.${channel}`);
          const found = array && this.row(array, index, this.description.history_rows);
          if (array && !found) {
            complete = false;
          }
          return found ? found[0] : 0;
        });
        return {
          position: [numbers[0], numbers[1], numbers[2]],
          turn: quaternion(numbers[3], numbers[4], numbers[5]),
        };
      };
      const first = at(row);
      const second = share > 0 ? at(next) : first;
      if (first && second) {
        poses.set(object.name, mix(first, second, share));
      }
    }
    return complete ? poses : null;
  }
}

export function quantityOf(line: LinePlace, name: string): QuantityPlace | undefined {
  return line.quantities.find((quantity) => quantity.name === name);
}

/** Entry at or before a time, and the share of the way to the next. */
export function locate(times: Float64Array, time: number): { row: number; share: number } {
  let [low, high] = [0, times.length - 1];
  if (high < 0 || !(time > times[0])) {
    return { row: 0, share: 0 };
  }
  if (time >= times[high]) {
    return { row: high, share: 0 };
  }
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) {
      low = middle;
    } else {
      high = middle;
    }
  }
  const share = (time - times[low]) / (times[high] - times[low]);
  // Stored times are sums of intervals: a millionth off is on the row.
  if (share < 1e-6) {
    return { row: low, share: 0 };
  }
  return share > 1 - 1e-6 ? { row: high, share: 0 } : { row: low, share };
}

function whole(array: ArrayPlace): Wanted {
  return { array, rows: array.rows };
}

function blend(
  nodes: Float32Array,
  component: number,
  from: Float32Array | Float64Array,
  to: Float32Array | Float64Array,
  share: number,
): void {
  for (let node = 0, k = component; node < from.length; node++, k += 4) {
    nodes[k] = from[node] + share * (to[node] - from[node]);
  }
}

/** Quaternion of R = Rz(heading) Ry(pitch) Rx(roll), angles in degrees. */
function quaternion(roll: number, pitch: number, heading: number): Pose["turn"] {
  const half = Math.PI / 360;
  const [cr, sr] = [Math.cos(roll * half), Math.sin(roll * half)];
  const [cp, sp] = [Math.cos(pitch * half), Math.sin(pitch * half)];
  const [ch, sh] = [Math.cos(heading * half), Math.sin(heading * half)];
  return [
    sr * cp * ch - cr * sp * sh,
    cr * sp * ch + sr * cp * sh,
    cr * cp * sh - sr * sp * ch,
    cr * cp * ch + sr * sp * sh,
  ];
}

function mix(a: Pose, b: Pose, share: number): Pose {
  if (share === 0) {
    return a;
  }
  const line = (k: number) => a.position[k] + share * (b.position[k] - a.position[k]);
  // Between two rows the turn is small: the normalised straight way is as good as the arc.
  const sign = a.turn.reduce((sum, value, k) => sum + value * b.turn[k], 0) < 0 ? -1 : 1;
  const turn = a.turn.map((value, k) => value + share * (sign * b.turn[k] - value));
  const length = Math.hypot(...turn) || 1;
  return {
    position: [line(0), line(1), line(2)],
    turn: turn.map((value) => value / length) as Pose["turn"],
  };
}
