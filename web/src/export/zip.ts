// A ZIP archive of files that are compressed already: stored, with their checksums.
// Format: PKWARE APPNOTE 6.3.10, sections 4.3.7, 4.3.12 and 4.3.16.

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; bit++) {
    crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  return crc >>> 0;
});

function crc32(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc = TABLE[(crc ^ byte) & 255] ^ (crc >>> 8);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/** Largest archive without the 64-bit extension [bytes]. */
export const MOST_BYTES = 0xffffffff;

export class Zip {
  private parts: BlobPart[] = [];
  private directory: Uint8Array<ArrayBuffer>[] = [];
  private offset = 0;

  get size(): number {
    return this.offset;
  }

  async add(name: string, file: Blob): Promise<void> {
    const bytes = new Uint8Array(await file.arrayBuffer());
    const title = new TextEncoder().encode(name);
    const crc = crc32(bytes);
    const local = header(0x04034b50, 30, title, (view) => common(view, 4, crc, bytes.length, title.length));
    const central = header(0x02014b50, 46, title, (view) => {
      view.setUint16(4, 20, true);
      common(view, 6, crc, bytes.length, title.length);
      view.setUint32(42, this.offset, true);
    });
    this.directory.push(central);
    this.parts.push(local, file);
    this.offset += local.length + bytes.length;
  }

  finish(): Blob {
    const size = this.directory.reduce((sum, entry) => sum + entry.length, 0);
    const end = header(0x06054b50, 22, new Uint8Array(0), (view) => {
      view.setUint16(8, this.directory.length, true);
      view.setUint16(10, this.directory.length, true);
      view.setUint32(12, size, true);
      view.setUint32(16, this.offset, true);
    });
    return new Blob([...this.parts, ...this.directory, end], { type: "application/zip" });
  }
}

function header(
  mark: number,
  length: number,
  name: Uint8Array,
  fill: (view: DataView) => void,
): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(length + name.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, mark, true);
  fill(view);
  bytes.set(name, length);
  return bytes;
}

/** The fields that the local and the central header share, from `at` on. */
function common(view: DataView, at: number, crc: number, size: number, name: number): void {
  view.setUint16(at, 20, true);
  // Names are UTF-8.
  view.setUint16(at + 2, 0x0800, true);
  // 1 January 1980: a picture of a computation has no better date.
  view.setUint16(at + 8, 0x21, true);
  view.setUint32(at + 10, crc, true);
  view.setUint32(at + 14, size, true);
  view.setUint32(at + 18, size, true);
  view.setUint16(at + 22, name, true);
}
