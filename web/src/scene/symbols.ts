// Vessels, bodies and lumps in their places. What the model knows of their size is drawn as large as
// it is; what it does not know has the size of such things; and all are large enough to be seen.

import { CylinderGeometry, Group, Mesh, MeshLambertMaterial, Object3D, SphereGeometry } from "three";
import type { Palette } from "../colour";
import type { SceneAttachment, SceneBody, SceneVessel } from "../store/types";
import { VesselKind, vesselShape } from "./shapes";

/** A symbol with the size that it has by itself [m], to tell when it would become too small. */
export interface Symbol3D {
  object: Object3D;
  size: number;
  /** Least size on the screen [px]. */
  least: number;
}

/** What a vessel looks like: as the model says, else by where it is and whether it moves. */
export function vesselKind(vessel: SceneVessel, depth: number): VesselKind {
  if (vessel.shape) {
    return vessel.shape;
  }
  if (!vessel.moves) {
    return "anchor";
  }
  const low = depth > 0 && vessel.position_m[2] < -0.5 * depth;
  return low ? "crawler" : "ship";
}

/** Least lengths on the screen [px]. */
const LEAST = { ship: 64, platform: 44, buoy: 22, crawler: 30, anchor: 16 };

/** `length`: of the whole vessel [m]. */
export function vesselSymbol(kind: VesselKind, length: number, palette: Palette): Symbol3D {
  const shape = vesselShape(kind, palette);
  shape.scale.setScalar(length);
  const object = new Group();
  object.add(shape);
  return { object, size: length, least: LEAST[kind] };
}

const lambert = (colour: string) => new MeshLambertMaterial({ color: colour });

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
