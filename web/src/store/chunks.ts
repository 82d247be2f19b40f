// Single chunks of the store's arrays, checked, and kept as long as there is room.

import { ConnectionLost, ServerError, getStoreFile, getVectors } from "../api";
import { crc32c } from "./crc32c";
import type { ArrayPlace } from "./types";

export type Values = Float32Array | Float64Array;

/** A chunk that is not what was written. */
export class DamagedChunk extends Error {}

interface Entry {
  values: Values | null;
  error: Error | null;
  /** Rows of the array that were known to be written when the chunk was asked for. */
  rows: number;
  pending: Promise<void> | null;
  /** When a failed chunk may be asked for again. */
  retry_at: number;
}

/** Room for chunks [bytes]. A minute of the largest systems; small studies fit as a whole. */
const BUDGET = 256 * 1024 * 1024;

export class ChunkCache {
  private entries = new Map<string, Entry>();
  private bytes = 0;
  /** Called when a chunk has come, or could not. */
  onChange: () => void = () => {};
  /** Called with chunks that are damaged, once each. */
  onDamage: (path: string, first_row: number, last_row: number) => void = () => {};

  /** The chunk's values if they are here; otherwise null, and they are on their way. */
  peek(array: ArrayPlace, chunk: number, rows: number): Values | null {
    const key = `${array.path}#${chunk}`;
    let entry = this.entries.get(key);
    if (entry) {
      // Most recently used last.
      this.entries.delete(key);
      this.entries.set(key, entry);
    }
    const end = (chunk + 1) * array.chunk_rows;
    const stale = entry ? Math.min(rows, end) > entry.rows : true;
    const failed = entry?.error && !(entry.error instanceof DamagedChunk);
    const due = failed ? performance.now() > (entry?.retry_at ?? 0) : stale;
    if (!entry || (!entry.pending && due)) {
      entry ??= { values: null, error: null, rows: 0, pending: null, retry_at: 0 };
      this.entries.set(key, entry);
      this.load(key, entry, array, chunk, rows);
    }
    // An older version of a growing chunk will not do: its last rows are missing.
    return stale ? null : entry.values;
  }

  /** The chunk's values, waited for. A damaged chunk reads as NaN. */
  async get(array: ArrayPlace, chunk: number, rows: number): Promise<Values> {
    for (;;) {
      const values = this.peek(array, chunk, rows);
      if (values) {
        return values;
      }
      const entry = this.entries.get(`${array.path}#${chunk}`);
      if (entry?.pending) {
        await entry.pending;
      } else if (entry?.error instanceof DamagedChunk && entry.values) {
        return entry.values;
      } else if (entry?.error) {
        throw entry.error;
      }
    }
  }

  /** Forgets everything: the store is another one now. */
  clear(): void {
    this.entries.clear();
    this.bytes = 0;
  }

  private load(key: string, entry: Entry, array: ArrayPlace, chunk: number, rows: number): void {
    const run = async () => {
      try {
        const tail = array.columns === null ? `${chunk}` : `${chunk}/0`;
        const content = await getStoreFile(`${array.path}/c/${tail}`);
        if (content === null && chunk * array.chunk_rows < rows) {
          throw new DamagedChunk(`${array.path}: chunk ${chunk} is missing`);
        }
        const values = decode(content, array);
        this.bytes += values.byteLength - (entry.values?.byteLength ?? 0);
        entry.values = values;
        entry.error = null;
        entry.rows = rows;
      } catch (error) {
        entry.error = error as Error;
        if (error instanceof DamagedChunk) {
          const length = array.chunk_rows * (array.columns ?? 1);
          entry.values = new Float32Array(length).fill(NaN);
          this.bytes += entry.values.byteLength;
          entry.rows = rows;
          const first = chunk * array.chunk_rows;
          this.onDamage(array.path, first, Math.min(first + array.chunk_rows, array.rows) - 1);
        } else {
          entry.retry_at = performance.now() + (error instanceof ConnectionLost ? 1000 : 5000);
        }
      } finally {
        entry.pending = null;
        this.evict(key);
        this.onChange();
      }
    };
    entry.pending = run();
  }

  private evict(keep: string): void {
    for (const [key, entry] of this.entries) {
      if (this.bytes <= BUDGET) {
        return;
      }
      if (key !== keep && !entry.pending) {
        this.bytes -= entry.values?.byteLength ?? 0;
        this.entries.delete(key);
      }
    }
  }
}

/** Checks and decodes a chunk; one that was never written holds NaN. */
function decode(content: ArrayBuffer | null, array: ArrayPlace): Values {
  const length = array.chunk_rows * (array.columns ?? 1);
  const size = array.data_type === "float32" ? 4 : 8;
  if (content === null) {
    return new Float32Array(length).fill(NaN);
  }
  if (content.byteLength !== length * size + 4) {
    throw new DamagedChunk(`${array.path}: the file does not have the size of a chunk`);
  }
  const data = new Uint8Array(content, 0, length * size);
  const stored = new DataView(content).getUint32(length * size, true);
  if (crc32c(data) !== stored) {
    throw new DamagedChunk(`${array.path}: the checksum does not fit the data`);
  }
  return size === 4
    ? new Float32Array(content, 0, length)
    : new Float64Array(content.slice(0, length * size));
}

/** An array with one axis, and how many of its rows are wanted. */
export interface Wanted {
  array: ArrayPlace;
  rows: number;
}

/** Most arrays and most values in one request; the server's own bounds are a little wider. */
const MOST_ARRAYS = 60;
const MOST_VALUES = 4e6;

/**
 * Whole arrays with one axis. They lie on the disk in hundreds of small chunks, so the server joins
 * them; where it cannot, because one is damaged or too long, they are read chunk by chunk.
 */
export async function readVectors(cache: ChunkCache, wanted: Wanted[]): Promise<Float64Array[]> {
  const found: Float64Array[] = [];
  for (let first = 0; first < wanted.length; ) {
    let [last, values] = [first, 0];
    while (last < wanted.length && last - first < MOST_ARRAYS && (last === first || values + length(wanted[last]) <= MOST_VALUES)) {
      values += length(wanted[last++]);
    }
    found.push(...(await readJoined(cache, wanted.slice(first, last))));
    first = last;
  }
  return found;
}

function length({ array, rows }: Wanted): number {
  return Math.min(rows, array.rows);
}

async function readJoined(cache: ChunkCache, wanted: Wanted[]): Promise<Float64Array[]> {
  try {
    const content = await getVectors(wanted.map((entry) => [length(entry), entry.array.path]));
    let first = 0;
    return wanted.map((entry) => {
      const values = new Float64Array(content, 8 * first, length(entry));
      first += values.length;
      return values;
    });
  } catch (error) {
    if (!(error instanceof ServerError)) {
      throw error;
    }
    return Promise.all(wanted.map((entry) => readChunkwise(cache, entry)));
  }
}

async function readChunkwise(cache: ChunkCache, wanted: Wanted): Promise<Float64Array> {
  const { array } = wanted;
  const count = length(wanted);
  const out = new Float64Array(count);
  for (let chunk = 0; chunk * array.chunk_rows < count; chunk++) {
    const values = await cache.get(array, chunk, count);
    const first = chunk * array.chunk_rows;
    out.set(values.subarray(0, Math.min(array.chunk_rows, count - first)), first);
  }
  return out;
}
