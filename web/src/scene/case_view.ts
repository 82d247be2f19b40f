// One load case in three dimensions: lines, vessels, bodies and lumps at a moment.

import { Camera, Group, Matrix4, Quaternion, Vector3 } from "three";
import type { Palette } from "../colour";
import type { Options, Selection } from "../options";
import type { CaseData, CaseFrame } from "../store/case_data";
import { LineLook, LineMesh } from "./line_mesh";
import {
  Symbol3D,
  attachmentSymbol,
  bodySymbol,
  markSymbol,
  vesselKind,
  vesselSymbol,
} from "./symbols";
import type { Bounds } from "./camera";
import type { Project, Rect } from "./overlay";
import type { SceneVessel } from "../store/types";

/** Something with a name and a place. */
export interface Named {
  name: string;
  kind: "vessel" | "body" | "lump" | "line";
  place: Vector3;
}

export interface Hit {
  selection: Selection;
  /** From the pointer [px]. */
  distance: number;
}

/** Pieces of a line whose places are kept clear of names. */
const STRETCHES = 40;

export class CaseView {
  readonly group = new Group();
  readonly named: Named[] = [];
  /** Horizontal way of the followed object since the start, global [m]. */
  readonly shift = new Vector3();
  private lines: LineMesh[] = [];
  private objects = new Map<string, Symbol3D>();
  private lumps: { line: number; arc: number; symbol: Symbol3D; named: Named }[] = [];
  private mark: Symbol3D;
  private places = new Map<string, Vector3>();

  constructor(
    readonly data: CaseData,
    palette: Palette,
  ) {
    const scene = data.scene;
    const box = staticBounds([data]);
    const size = Math.max(box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z, 1);
    for (const place of data.description.lines) {
      const arc = data.arcLengths.get(place.name) ?? new Float64Array(2);
      const sections = scene?.lines.find((line) => line.name === place.name)?.sections ?? [];
      const diameters = new Float32Array(Math.max(arc.length - 1, 1));
      for (let k = 0; k < diameters.length; k++) {
        const middle = 0.5 * (arc[k] + arc[k + 1]);
        const section = sections.find((s) => middle < s.end_m) ?? sections[sections.length - 1];
        diameters[k] = section?.outer_diameter_m ?? 0.2;
      }
      const mesh = new LineMesh(arc.length, diameters);
      this.lines.push(mesh);
      this.group.add(mesh.group);
      this.addNamed(place.name, "line");
    }
    for (const vessel of scene?.vessels ?? []) {
      const kind = vesselKind(vessel, scene?.water_depth_m ?? 0);
      this.addObject(vessel.name, vesselSymbol(kind, vesselLength(data, vessel, size), palette));
      this.addNamed(vessel.name, "vessel");
    }
    for (const body of scene?.bodies ?? []) {
      this.addObject(body.name, bodySymbol(body, palette));
      this.addNamed(body.name, "body");
    }
    for (const [index, place] of data.description.lines.entries()) {
      const line = scene?.lines.find((candidate) => candidate.name === place.name);
      for (const lump of line?.attachments ?? []) {
        const symbol = attachmentSymbol(lump, palette);
        this.group.add(symbol.object);
        const named = this.addNamed(lump.name, "lump");
        this.lumps.push({ line: index, arc: lump.arc_length_m, symbol, named });
      }
    }
    this.mark = markSymbol(palette);
    this.mark.object.visible = false;
    this.group.add(this.mark.object);
  }

  private addNamed(name: string, kind: Named["kind"]): Named {
    const named = { name, kind, place: new Vector3(NaN, NaN, NaN) };
    this.named.push(named);
    this.places.set(`${kind}:${name}`, named.place);
    return named;
  }

  private addObject(name: string, symbol: Symbol3D): void {
    this.objects.set(name, symbol);
    this.group.add(symbol.object);
  }

  /** Lays everything out for a frame. */
  update(frame: CaseFrame, options: Readonly<Options>): void {
    const rest = this.data.restPoses();
    const { exaggeration, stretch } = options;
    this.shift.set(0, 0, 0);
    const way = (name: string, out: Vector3) => {
      const now = frame.poses.get(name)?.position;
      const then = rest?.get(name)?.position;
      if (now && then) {
        out.set(now[0] - then[0], now[1] - then[1], 0);
      }
    };
    if (options.follow) {
      way(options.follow, this.shift);
    }
    // Displacements are exaggerated beside the way that the whole system is towed.
    const towed = new Vector3();
    const mover = this.data.scene?.vessels.find((vessel) => vessel.moves)?.name;
    if (mover) {
      way(mover, towed);
    }
    const { x: sx, y: sy } = this.shift;
    const enlarge = (value: number, base: number) => base + exaggeration * (value - base);
    for (const [index, { place, nodes }] of frame.lines.entries()) {
      const out = this.lines[index]?.nodes;
      if (!out) {
        // The case has begun since this view was made; the view with its lines is on the way.
        continue;
      }
      const statics = this.data.statics.get(place.name);
      for (let k = 0, s = 0; k < nodes.length; k += 4, s += 3) {
        let [x, y, z] = [nodes[k], nodes[k + 1], nodes[k + 2]];
        if (exaggeration !== 1 && statics) {
          x = enlarge(x, statics[s] + towed.x);
          y = enlarge(y, statics[s + 1] + towed.y);
          z = enlarge(z, statics[s + 2]);
        }
        out[k] = (x - sx) * stretch;
        out[k + 1] = (y - sy) * stretch;
        out[k + 2] = z;
        out[k + 3] = nodes[k + 3];
      }
      const middle = 4 * Math.floor(nodes.length / 8);
      this.places.get(`line:${place.name}`)?.set(out[middle], out[middle + 1], out[middle + 2]);
    }
    for (const [name, symbol] of this.objects) {
      const pose = frame.poses.get(name);
      symbol.object.visible = pose !== undefined;
      if (!pose) {
        continue;
      }
      let [x, y, z] = pose.position;
      const base = rest?.get(name)?.position;
      if (exaggeration !== 1 && base) {
        x = enlarge(x, base[0] + towed.x);
        y = enlarge(y, base[1] + towed.y);
        z = enlarge(z, base[2]);
      }
      symbol.object.position.set((x - sx) * stretch, (y - sy) * stretch, z);
      symbol.object.quaternion.copy(new Quaternion(...pose.turn));
      const place = this.places.get(`vessel:${name}`) ?? this.places.get(`body:${name}`);
      place?.copy(symbol.object.position);
    }
    for (const lump of this.lumps) {
      const place = this.pointAt(lump.line, lump.arc);
      lump.symbol.object.position.copy(place);
      lump.named.place.copy(place);
    }
    const { selection } = options;
    this.mark.object.visible = false;
    if (selection) {
      const place = this.placeOf(selection);
      if (place && selection.kind === "line") {
        this.mark.object.visible = true;
        this.mark.object.position.copy(place);
      }
    }
  }

  /** Where the selected thing is, in scene coordinates. */
  placeOf(selection: Selection): Vector3 | null {
    if (selection.kind !== "line") {
      return this.places.get(`${selection.kind}:${selection.name}`) ?? null;
    }
    const index = this.data.description.lines.findIndex((line) => line.name === selection.name);
    const nodes = this.lines[index]?.nodes;
    if (!nodes) {
      return null;
    }
    const k = 4 * Math.min(selection.node, nodes.length / 4 - 1);
    return new Vector3(nodes[k], nodes[k + 1], nodes[k + 2]);
  }

  /** How much of the scene belongs to the selected thing: to go near it [m]. */
  spanOf(selection: Selection): number {
    if (selection.kind !== "line") {
      return 1.1 * (this.objects.get(selection.name)?.size ?? 10);
    }
    const place = this.data.line(selection.name);
    const arcs = this.data.arcLengths.get(selection.name);
    return place && arcs ? 0.04 * arcs[arcs.length - 1] : 10;
  }

  /** Length of a vessel or body as it is drawn [m]. */
  shownSize(name: string): number {
    const symbol = this.objects.get(name);
    return symbol ? symbol.size * symbol.object.scale.x : 0;
  }

  /** Where something is drawn, as rectangles of the picture, for names to keep clear of. */
  footprint(project: Project, pixelAt: (place: Vector3) => number): Rect[] {
    const covered: Rect[] = [];
    const cover = (at: { x: number; y: number } | null, half: number) => {
      if (at) {
        covered.push({ x: at.x - half, y: at.y - half, width: 2 * half, height: 2 * half });
      }
    };
    const symbols = [...this.objects.values(), ...this.lumps.map((lump) => lump.symbol)];
    for (const { object, size, least } of symbols) {
      cover(project(object.position), 0.3 * Math.max(least, size / pixelAt(object.position)));
    }
    const place = new Vector3();
    for (const { nodes } of this.lines) {
      const count = nodes.length / 4;
      let before: { x: number; y: number } | null = null;
      for (let k = 0; k <= STRETCHES; k++) {
        const node = Math.round((k * (count - 1)) / STRETCHES);
        place.fromArray(nodes, 4 * node);
        const at = Number.isFinite(place.x) ? project(place) : null;
        if (at && before) {
          const [x, y] = [Math.min(at.x, before.x), Math.min(at.y, before.y)];
          const [width, height] = [Math.abs(at.x - before.x), Math.abs(at.y - before.y)];
          covered.push({ x: x - 3, y: y - 3, width: width + 6, height: height + 6 });
        }
        before = at;
      }
    }
    return covered;
  }

  private pointAt(line: number, arc: number): Vector3 {
    const arcs = this.data.arcLengths.get(this.data.description.lines[line].name);
    const nodes = this.lines[line]?.nodes;
    if (!arcs || !nodes) {
      return new Vector3();
    }
    let k = 0;
    while (k + 2 < arcs.length && arcs[k + 1] < arc) {
      k++;
    }
    const share = (arc - arcs[k]) / (arcs[k + 1] - arcs[k] || 1);
    const at = (c: number) => nodes[4 * k + c] + share * (nodes[4 * k + 4 + c] - nodes[4 * k + c]);
    return new Vector3(at(0), at(1), at(2));
  }

  /** Widths, colours and least sizes for a camera. */
  show(
    look: LineLook,
    selection: Selection | null,
    camera: Camera,
    pixelAt: (place: Vector3) => number,
    pixelRatio: number,
  ): void {
    const matrix = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    for (const [index, line] of this.lines.entries()) {
      const { name } = this.data.description.lines[index];
      // Where colours tell the cases apart, the mark at the node is enough.
      const selected = !look.plain && selection?.kind === "line" && selection.name === name;
      line.show(look, selected, pixelRatio, matrix);
    }
    const symbols = [...this.objects.values(), ...this.lumps.map((lump) => lump.symbol), this.mark];
    for (const { object, size, least } of symbols) {
      const shown = size / pixelAt(object.position);
      const scale = Math.max(1, least / shown);
      object.scale.setScalar(object === this.mark.object ? least * pixelAt(object.position) : scale);
    }
  }

  /** The nearest thing to a point of the picture. `project` gives pixels, or null behind. */
  pick(
    x: number,
    y: number,
    reach: number,
    project: (place: Vector3) => { x: number; y: number } | null,
  ): Hit | null {
    let best: Hit | null = null;
    const offer = (selection: Selection, distance: number) => {
      if (distance <= reach && (!best || distance < best.distance)) {
        best = { selection, distance };
      }
    };
    for (const [name, symbol] of this.objects) {
      const at = project(symbol.object.position);
      if (at && symbol.object.visible) {
        const kind = this.places.has(`vessel:${name}`) ? "vessel" : "body";
        // A symbol is wide: its middle counts as nearer than it is.
        offer({ kind, name }, Math.max(0, Math.hypot(at.x - x, at.y - y) - 0.4 * symbol.least));
      }
    }
    const place = new Vector3();
    for (const [index, line] of this.lines.entries()) {
      const { name } = this.data.description.lines[index];
      const { nodes } = line;
      let before: { x: number; y: number } | null = null;
      for (let node = 0; node < nodes.length / 4; node++) {
        place.set(nodes[4 * node], nodes[4 * node + 1], nodes[4 * node + 2]);
        const at: { x: number; y: number } | null = Number.isFinite(place.x) ? project(place) : null;
        if (at && before) {
          const [dx, dy] = [at.x - before.x, at.y - before.y];
          const square = dx * dx + dy * dy;
          const along = square > 0 ? ((x - before.x) * dx + (y - before.y) * dy) / square : 0;
          const s = Math.min(Math.max(along, 0), 1);
          const distance = Math.hypot(before.x + s * dx - x, before.y + s * dy - y);
          offer({ kind: "line", name, node: s < 0.5 ? node - 1 : node }, distance + 2);
        }
        before = at;
      }
    }
    return best;
  }

  dispose(): void {
    this.lines.forEach((line) => line.dispose());
  }
}

/** Length of a vessel [m]; where the model gives none, one that suits a system of this size. */
export function vesselLength(data: CaseData, vessel: SceneVessel, size: number): number {
  if (vessel.length_m) {
    return vessel.length_m;
  }
  const kind = vesselKind(vessel, data.scene?.water_depth_m ?? 0);
  const ends = (data.scene?.lines ?? []).flatMap((line) => line.ends);
  const points = ends.flatMap((end) => (end?.to === vessel.name ? [end.point_m] : []));
  // It reaches a little beyond the points where lines are fastened to it.
  const reach = Math.max(0, ...points.map(([x, y]) => Math.hypot(x, y)));
  const share = { ship: 0.11, platform: 0.08, buoy: 0.02, crawler: 0.02, anchor: 0.01 }[kind];
  const most = { ship: 150, platform: 90, buoy: 12, crawler: 15, anchor: 8 }[kind];
  return Math.max(kind === "anchor" ? 0 : 2.4 * reach, Math.min(share * size, most), 0.5);
}

/** The box around the static shapes and the vessels, sea surface included where it is near. */
export function staticBounds(cases: CaseData[]): Bounds {
  const min = new Vector3(Infinity, Infinity, Infinity);
  const max = new Vector3(-Infinity, -Infinity, -Infinity);
  const place = new Vector3();
  for (const data of cases) {
    for (const positions of data.statics.values()) {
      for (let k = 0; k + 2 < positions.length; k += 3) {
        if (Number.isFinite(positions[k])) {
          place.fromArray(positions, k);
          min.min(place);
          max.max(place);
        }
      }
    }
    for (const vessel of data.scene?.vessels ?? []) {
      place.set(...vessel.position_m);
      min.min(place);
      max.max(place);
    }
  }
  if (!Number.isFinite(min.x)) {
    return { min: new Vector3(-50, -50, -100), max: new Vector3(50, 50, 0) };
  }
  const extent = Math.max(max.x - min.x, max.y - min.y, max.z - min.z, 1);
  for (const data of cases) {
    for (const vessel of data.scene?.vessels ?? []) {
      const half = 0.5 * vesselLength(data, vessel, extent);
      const [x, y, z] = vessel.position_m;
      min.min(place.set(x - half, y - half, z));
      max.max(place.set(x + half, y + half, z + 0.4 * half));
    }
  }
  const height = max.z - min.z;
  const size = Math.max(max.x - min.x, max.y - min.y, height, 1);
  const wet = cases.some((data) => (data.scene?.water_depth_m ?? 0) > 0);
  if (wet && max.z < 0 && -max.z < size) {
    max.z = 0;
  }
  for (const data of cases) {
    const depth = data.scene?.water_depth_m ?? 0;
    if (depth > 0 && depth < -min.z + 0.8 * size) {
      min.z = Math.min(min.z, -depth);
    }
  }
  return { min, max };
}
