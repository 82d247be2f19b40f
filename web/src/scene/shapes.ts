// Shapes of ships, platforms, crawlers and buoys, made of plates and boxes. Lengths are shares of the
// whole length, x forward, z up, the origin where the vessel's own is: in the waterline.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  Mesh,
  MeshLambertMaterial,
  Object3D,
} from "three";
import type { Palette } from "../colour";

export type VesselKind = "ship" | "platform" | "buoy" | "crawler" | "anchor";

/** A vessel of length 1. */
export function vesselShape(kind: VesselKind, palette: Palette): Object3D {
  const parts = { ship, platform, buoy, crawler, anchor }[kind](palette);
  return joined(parts);
}

/** All parts as one: drawn one by one, the bars of a derrick would take longer than all lines. */
function joined(parts: Part[]): Mesh {
  const pieces = parts.map((part) => {
    part.updateMatrix();
    const flat = part.geometry.index ? part.geometry.toNonIndexed() : part.geometry;
    return { geometry: flat.applyMatrix4(part.matrix), colour: part.material.color };
  });
  const count = pieces.reduce((sum, { geometry }) => sum + geometry.attributes.position.count, 0);
  const [position, normal, colour] = [0, 1, 2].map(() => new Float32Array(3 * count));
  let at = 0;
  for (const { geometry, colour: paint } of pieces) {
    position.set(geometry.attributes.position.array, at);
    normal.set(geometry.attributes.normal.array, at);
    for (const end = at + geometry.attributes.position.array.length; at < end; at += 3) {
      paint.toArray(colour, at);
    }
    geometry.dispose();
  }
  const whole = new BufferGeometry();
  whole.setAttribute("position", new BufferAttribute(position, 3));
  whole.setAttribute("normal", new BufferAttribute(normal, 3));
  whole.setAttribute("color", new BufferAttribute(colour, 3));
  return new Mesh(whole, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
}

function ship(palette: Palette): Part[] {
  const white = paint(palette.house);
  const dark = paint(palette.weight);
  const crane = paint(palette.body);
  const parts: Part[] = [
    hull(0.0, 1, paint(palette.topside)),
    hull(1, 2, paint(palette.hull)),
    deck(paint(palette.deck)),
    // Deck house forward, with bridge, windows and helideck; a working deck behind it.
    block([0.16, 0.145, 0.045], [0.285, 0, 0.067], white),
    block([0.12, 0.13, 0.03], [0.28, 0, 0.104], white),
    block([0.085, 0.15, 0.028], [0.29, 0, 0.133], white),
    block([0.003, 0.14, 0.012], [0.3335, 0, 0.136], dark),
    block([0.06, 0.05, 0.012], [0.275, 0, 0.152], dark),
    rod([0.275, 0, 0.158], [0.275, 0, 0.225], 0.004, dark),
    disc(0.07, 0.008, [0.4, 0, 0.115], paint(palette.deck)),
    rod([0.4, 0, 0.055], [0.4, 0, 0.112], 0.01, dark),
    // Two funnels aft of the house, and the crane on the side of the working deck.
    block([0.03, 0.025, 0.05], [0.185, 0.055, 0.075], paint(palette.hull)),
    block([0.03, 0.025, 0.05], [0.185, -0.055, 0.075], paint(palette.hull)),
    rod([-0.25, 0.065, 0.045], [-0.25, 0.065, 0.13], 0.014, crane),
    rod([-0.25, 0.065, 0.13], [-0.09, 0.02, 0.2], 0.009, crane),
  ];
  return [...parts, ...derrick(0.05, 0.05, 0.27, palette)];
}

/** A lattice tower over the origin, where pipes hang. */
function derrick(foot: number, base: number, top: number, palette: Palette): Part[] {
  const steel = paint(palette.derrick);
  const half = (z: number) => foot - (foot - 0.014) * ((z - base) / (top - base));
  const corner = (k: number, z: number): Point => {
    const [sx, sy] = [
      [1, 1],
      [-1, 1],
      [-1, -1],
      [1, -1],
    ][k % 4];
    return [sx * half(z), sy * half(z), z];
  };
  const parts: Part[] = [block([0.045, 0.045, 0.012], [0, 0, top], steel)];
  const levels = [0, 0.3, 0.55, 0.77, 1].map((share) => base + share * (top - base));
  for (let k = 0; k < 4; k++) {
    parts.push(rod(corner(k, base), corner(k, top), 0.0055, steel));
    for (let i = 0; i + 1 < levels.length; i++) {
      const flip = (i + k) % 2;
      parts.push(rod(corner(k + flip, levels[i]), corner(k + 1 - flip, levels[i + 1]), 0.0035, steel));
    }
  }
  return parts;
}

function platform(palette: Palette): Part[] {
  const hull = paint(palette.hull);
  const topside = paint(palette.topside);
  const parts: Part[] = [
    block([0.9, 0.9, 0.1], [0, 0, 0.31], paint(palette.deck)),
    block([0.28, 0.7, 0.14], [0.28, 0, 0.43], paint(palette.house)),
    rod([-0.3, 0.3, 0.36], [-0.3, 0.3, 0.55], 0.03, paint(palette.body)),
    rod([-0.3, 0.3, 0.55], [0.1, 0.42, 0.7], 0.018, paint(palette.body)),
  ];
  for (const y of [-0.34, 0.34]) {
    parts.push(block([1, 0.2, 0.14], [0, y, -0.25], hull));
    for (const x of [-0.32, 0.32]) {
      parts.push(rod([x, y, -0.2], [x, y, 0], 0.09, hull), rod([x, y, 0], [x, y, 0.27], 0.09, topside));
    }
  }
  return [...parts, ...derrick(0.13, 0.36, 0.95, palette)];
}

function buoy(palette: Palette): Part[] {
  const float = paint(palette.float);
  const parts: Part[] = [disc(0.5, 0.3, [0, 0, 0], float), disc(0.34, 0.1, [0, 0, 0.2], paint(palette.house))];
  for (const [x, y] of [[0.2, 0], [-0.1, 0.173], [-0.1, -0.173]]) {
    parts.push(rod([x, y, 0.2], [0, 0, 0.85], 0.025, paint(palette.weight)));
  }
  parts.push(disc(0.09, 0.1, [0, 0, 0.85], paint(palette.body)));
  return parts;
}

function crawler(palette: Palette): Part[] {
  const track = paint(palette.weight);
  const body = paint(palette.body);
  const parts: Part[] = [
    block([0.8, 0.4, 0.12], [-0.02, 0, 0.12], paint(palette.topside)),
    block([0.46, 0.44, 0.16], [-0.14, 0, 0.26], body),
    block([0.2, 0.4, 0.1], [0.24, 0, 0.23], paint(palette.house)),
    // The collector in front, and the mast to which the hose is led.
    block([0.16, 0.84, 0.1], [0.5, 0, -0.03], paint(palette.hull)),
    rod([0.5, 0, 0.02], [0.3, 0, 0.18], 0.04, paint(palette.hull)),
    rod([-0.14, 0, 0.34], [-0.14, 0, 0.56], 0.035, track),
  ];
  for (const y of [-0.31, 0.31]) {
    parts.push(block([0.68, 0.2, 0.22], [0, y, -0.03], track));
    for (const x of [-0.34, 0.34]) {
      parts.push(rod([x, y - 0.1, -0.03], [x, y + 0.1, -0.03], 0.11, track));
    }
  }
  return parts;
}

/** A pile in the ground with its head above it. */
function anchor(palette: Palette): Part[] {
  const steel = paint(palette.weight);
  return [
    rod([0, 0, -0.7], [0, 0, 0.05], 0.2, steel),
    disc(0.34, 0.1, [0, 0, 0.05], paint(palette.hull)),
    rod([0, 0, 0.1], [0, 0, 0.3], 0.07, steel),
  ];
}

type Point = [number, number, number];
type Part = Mesh<BufferGeometry, MeshLambertMaterial>;

const paint = (colour: string) => new MeshLambertMaterial({ color: colour });

function block(size: Point, at: Point, material: MeshLambertMaterial): Part {
  const mesh = new Mesh(new BoxGeometry(...size), material);
  mesh.position.set(...at);
  return mesh;
}

/** An upright drum: radius, height, middle. */
function disc(radius: number, height: number, at: Point, material: MeshLambertMaterial): Part {
  const mesh = new Mesh(new CylinderGeometry(radius, radius, height, 24), material);
  mesh.rotation.x = Math.PI / 2;
  mesh.position.set(...at);
  return mesh;
}

/** A bar from one point to another. */
function rod(from: Point, to: Point, radius: number, material: MeshLambertMaterial): Part {
  const [dx, dy, dz] = to.map((value, k) => value - from[k]);
  const length = Math.hypot(dx, dy, dz);
  const mesh = new Mesh(new CylinderGeometry(radius, radius, length, radius > 0.03 ? 20 : 6), material);
  mesh.position.set(from[0] + dx / 2, from[1] + dy / 2, from[2] + dz / 2);
  // A cylinder's axis is y.
  mesh.quaternion.setFromUnitVectors(mesh.up.set(0, 1, 0), mesh.position.clone().set(dx, dy, dz).normalize());
  return mesh;
}

/**
 * Stations of the hull from stern to bow: x; half-breadths of deck, waterline and bottom; height of
 * the deck. The stem leans forward and the stern is cut off.
 */
const STATIONS = [
  [-0.5, 0.078, 0.07, 0.03, 0.044],
  [-0.42, 0.088, 0.086, 0.066, 0.044],
  [-0.2, 0.09, 0.09, 0.08, 0.044],
  [0.18, 0.09, 0.09, 0.08, 0.044],
  [0.3, 0.087, 0.08, 0.06, 0.05],
  [0.4, 0.07, 0.05, 0.026, 0.058],
  [0.47, 0.036, 0.018, 0.006, 0.066],
  [0.5, 0.003, 0.001, 0.001, 0.07],
];
const DRAUGHT = -0.046;
/** How far waterline and bottom stay behind the deck at the stem. */
const RAKE = [0, 0.018, 0.034];

/** Half-breadth and height at a level of a station: 0 deck, 1 waterline, 2 bottom. */
function hullPoint(station: number, level: number, side: number): Point {
  const [x, ...rest] = STATIONS[station];
  const forward = Math.max(0, (x - 0.3) / 0.2);
  return [x - forward * RAKE[level], side * rest[level], [rest[3], 0, DRAUGHT][level]];
}

/** Both sides of the hull between two levels, with bow and stern, and the bottom below. */
function hull(upper: number, lower: number, material: MeshLambertMaterial): Part {
  const triangles: Point[] = [];
  const last = STATIONS.length - 1;
  for (const side of [-1, 1]) {
    for (let k = 0; k < last; k++) {
      quad(triangles, hullPoint(k, upper, side), hullPoint(k + 1, upper, side), hullPoint(k + 1, lower, side), hullPoint(k, lower, side));
    }
  }
  for (const k of [0, last]) {
    quad(triangles, hullPoint(k, upper, -1), hullPoint(k, upper, 1), hullPoint(k, lower, 1), hullPoint(k, lower, -1));
  }
  if (lower === 2) {
    plate(triangles, 2);
  }
  return plates(triangles, material);
}

function deck(material: MeshLambertMaterial): Part {
  const triangles: Point[] = [];
  plate(triangles, 0);
  return plates(triangles, material);
}

/** A level of the hull, from side to side. */
function plate(triangles: Point[], level: number): void {
  for (let k = 0; k + 1 < STATIONS.length; k++) {
    quad(triangles, hullPoint(k, level, -1), hullPoint(k + 1, level, -1), hullPoint(k + 1, level, 1), hullPoint(k, level, 1));
  }
}

function quad(triangles: Point[], a: Point, b: Point, c: Point, d: Point): void {
  triangles.push(a, b, c, a, c, d);
}

/** Flat plates. */
function plates(triangles: Point[], material: MeshLambertMaterial): Part {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(triangles.flat()), 3));
  geometry.computeVertexNormals();
  return new Mesh(geometry, material);
}
