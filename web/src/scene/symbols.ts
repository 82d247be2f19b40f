// Vessels, bodies and lumps. The model knows points and lengths, not shapes: what is drawn are
// symbols, large enough to be seen.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshLambertMaterial,
  Object3D,
  SphereGeometry,
} from "three";
import type { Palette } from "../colour";
import type { SceneAttachment, SceneBody, SceneVessel } from "../store/types";

/** A symbol with the size that it has by itself [m], to tell when it would become too small. */
export interface Symbol3D {
  object: Object3D;
  size: number;
  /** Least size on the screen [px]. */
  least: number;
}

export type VesselKind = "ship" | "buoy" | "crawler" | "anchor";

/** Which symbol a vessel gets: by where it is, whether it moves, and what it is called. */
export function vesselKind(vessel: SceneVessel, depth: number): VesselKind {
  const z = vessel.position_m[2];
  if (!vessel.moves) {
    return "anchor";
  }
  if (/buoy|float/i.test(vessel.name)) {
    return "buoy";
  }
  return depth > 0 && z < -0.5 * depth ? "crawler" : "ship";
}

const lambert = (colour: string) => new MeshLambertMaterial({ color: colour });

/** `length`: of the whole symbol [m]. */
export function vesselSymbol(kind: VesselKind, length: number, palette: Palette): Symbol3D {
  const object = new Group();
  if (kind === "ship") {
    object.add(new Mesh(hull(length), lambert(palette.hull)));
    const house = box(0.16, 0.13, 0.12, -0.33, 0.105, length, palette.float);
    const mast = box(0.03, 0.03, 0.2, -0.33, 0.25, length, palette.weight);
    const tower = new Mesh(
      new CylinderGeometry(0.012 * length, 0.055 * length, 0.26 * length, 4),
      lambert(palette.weight),
    );
    tower.rotation.x = Math.PI / 2;
    tower.position.set(0, 0, 0.175 * length);
    object.add(house, mast, tower);
  } else if (kind === "buoy") {
    const tank = new Mesh(new CylinderGeometry(0.5 * length, 0.5 * length, 0.4 * length, 24), lambert(palette.float));
    tank.rotation.x = Math.PI / 2;
    const mast = box(0.06, 0.06, 0.5, 0, 0.4, length, palette.weight);
    object.add(tank, mast);
  } else if (kind === "crawler") {
    for (const side of [-0.27, 0.27]) {
      const track = box(1, 0.18, 0.24, 0, 0, length, palette.weight);
      track.position.y = side * length;
      object.add(track);
    }
    object.add(box(0.8, 0.46, 0.26, 0, 0.16, length, palette.body));
    object.add(box(0.3, 0.3, 0.14, -0.15, 0.34, length, palette.hull));
  } else {
    const cone = new Mesh(new ConeGeometry(0.5 * length, 0.8 * length, 4), lambert(palette.weight));
    cone.rotation.x = Math.PI / 2;
    cone.position.z = -0.4 * length;
    object.add(cone);
  }
  return { object, size: length, least: kind === "anchor" ? 14 : kind === "ship" ? 30 : 20 };
}

/** A body: a cylinder about its z axis, as long as the model says. */
export function bodySymbol(body: SceneBody, palette: Palette): Symbol3D {
  const volume = Math.max(body.volume_m3, body.mass_kg / 7850, 1e-6);
  const length = body.length_m > 0 ? body.length_m : 1.5 * Math.cbrt(volume);
  const radius = Math.max(Math.sqrt(volume / (Math.PI * length)), 0.15 * length);
  const cylinder = new Mesh(new CylinderGeometry(radius, radius, length, 24), lambert(palette.body));
  cylinder.rotation.x = Math.PI / 2;
  const band = new Mesh(
    new CylinderGeometry(1.06 * radius, 1.06 * radius, 0.14 * length, 24),
    lambert(palette.hull),
  );
  band.rotation.x = Math.PI / 2;
  band.position.z = 0.3 * length;
  const object = new Group();
  object.add(cylinder, band);
  return { object, size: Math.max(length, 2 * radius), least: 22 };
}

/** A float or a weight on a line. */
export function attachmentSymbol(lump: SceneAttachment, palette: Palette): Symbol3D {
  const radius = Math.cbrt((0.75 * Math.max(lump.volume_m3, 1e-3)) / Math.PI);
  const colour = lump.wet_weight_n < 0 ? palette.float : palette.weight;
  const object = new Mesh(new SphereGeometry(radius, 20, 14), lambert(colour));
  return { object, size: 2 * radius, least: 11 };
}

/** The mark at the chosen node. */
export function markSymbol(palette: Palette): Symbol3D {
  const material = lambert(palette.mark);
  material.emissive.set(palette.mark);
  material.emissiveIntensity = 0.4;
  material.depthTest = false;
  const object = new Mesh(new SphereGeometry(0.5, 20, 14), material);
  object.renderOrder = 30;
  return { object, size: 1e-9, least: 10 };
}

function box(
  l: number,
  w: number,
  h: number,
  x: number,
  z: number,
  length: number,
  colour: string,
): Mesh {
  const mesh = new Mesh(new BoxGeometry(l * length, w * length, h * length), lambert(colour));
  mesh.position.set(x * length, 0, z * length);
  return mesh;
}

/** A hull along x with its origin in the waterline: stations of deck and keel half-breadths. */
function hull(length: number): BufferGeometry {
  // x, half-breadth of the deck, half-breadth of the keel, height of the deck (shares of length)
  const stations = [
    [-0.5, 0.075, 0.045, 0.05],
    [-0.3, 0.09, 0.07, 0.048],
    [0.2, 0.09, 0.07, 0.048],
    [0.38, 0.06, 0.03, 0.055],
    [0.5, 0.004, 0.002, 0.065],
  ];
  const rings = stations.map(([x, deck, keel, top]) => [
    [x, deck, top],
    [x, deck, 0.0],
    [x - 0.03 * (x > 0.3 ? 1 : 0), keel, -0.05],
    [x - 0.03 * (x > 0.3 ? 1 : 0), -keel, -0.05],
    [x, -deck, 0.0],
    [x, -deck, top],
  ]);
  const points: number[] = [];
  const quad = (a: number[], b: number[], c: number[], d: number[]) => {
    for (const p of [a, b, c, a, c, d]) {
      points.push(...p.map((value) => value * length));
    }
  };
  for (let k = 0; k + 1 < rings.length; k++) {
    for (let i = 0; i < 6; i++) {
      const j = (i + 1) % 6;
      quad(rings[k][i], rings[k + 1][i], rings[k + 1][j], rings[k][j]);
    }
  }
  const stern = rings[0];
  quad(stern[0], stern[1], stern[4], stern[5]);
  quad(stern[1], stern[2], stern[3], stern[4]);
  const geometry = new BufferGeometry();
  // Flat shading needs no shared corners; both sides are drawn by turning each face outwards.
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(outward(points)), 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Turns triangles so that they face away from the x axis (or backwards at the stern). */
function outward(points: number[]): number[] {
  for (let k = 0; k < points.length; k += 9) {
    const p = (i: number) => points.slice(k + 3 * i, k + 3 * i + 3);
    const [a, b, c] = [p(0), p(1), p(2)];
    const u = b.map((value, i) => value - a[i]);
    const v = c.map((value, i) => value - a[i]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const middle = a.map((value, i) => (value + b[i] + c[i]) / 3);
    const flat = Math.abs(n[1]) + Math.abs(n[2]) < 1e-9 * Math.abs(n[0]);
    const side = flat ? -n[0] : n[1] * middle[1] + n[2] * middle[2];
    if (side < 0) {
      points.splice(k + 3, 6, ...c, ...b);
    }
  }
  return points;
}
