// The camera: orbit about a target, with z up, in perspective or parallel projection.

import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";

export type Preset = "3d" | "side" | "front" | "plan";

/** Vertical opening angle [rad]: narrow, so that a hanging line looks like on a drawing. */
const OPENING = (28 * Math.PI) / 180;
const MOST_ELEVATION = Math.PI / 2 - 1e-4;

/** What the camera should frame, in scene coordinates. */
export interface Bounds {
  min: Vector3;
  max: Vector3;
}

export class OrbitCamera {
  readonly target = new Vector3();
  /** From the target to the camera, [rad] and [m]. */
  azimuth = -1;
  elevation = 0.25;
  distance = 1000;
  parallel = false;
  private perspective = new PerspectiveCamera((OPENING * 180) / Math.PI, 1);
  private orthographic = new OrthographicCamera();

  constructor() {
    this.perspective.up.set(0, 0, 1);
    this.orthographic.up.set(0, 0, 1);
  }

  /** The camera for a viewport of this aspect. */
  update(aspect: number, radius: number): PerspectiveCamera | OrthographicCamera {
    const camera = this.parallel ? this.orthographic : this.perspective;
    camera.position.copy(this.target).addScaledVector(this.direction(), this.distance);
    // Straight up and down, the picture's up is where the azimuth says.
    camera.lookAt(this.target);
    camera.near = Math.max(this.distance * 0.01, 0.05);
    camera.far = this.distance + 12 * radius + 100;
    if (camera instanceof PerspectiveCamera) {
      camera.aspect = aspect;
    } else {
      const half = this.distance * Math.tan(OPENING / 2);
      camera.near = -camera.far;
      camera.top = half;
      camera.bottom = -half;
      camera.right = half * aspect;
      camera.left = -half * aspect;
    }
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  /** Unit vector from the target to the camera. */
  direction(): Vector3 {
    const c = Math.cos(this.elevation);
    return new Vector3(
      c * Math.cos(this.azimuth),
      c * Math.sin(this.azimuth),
      Math.sin(this.elevation),
    );
  }

  /** Unit vector to the right of the picture. */
  right(): Vector3 {
    return new Vector3(-Math.sin(this.azimuth), Math.cos(this.azimuth), 0);
  }

  /** World length of a pixel at the target [m]. */
  pixel(height: number): number {
    return (2 * this.distance * Math.tan(OPENING / 2)) / height;
  }

  orbit(dx: number, dy: number): void {
    this.azimuth -= dx;
    this.elevation = Math.min(Math.max(this.elevation + dy, -MOST_ELEVATION), MOST_ELEVATION);
  }

  /** Moves the target by pixels of the picture. */
  pan(dx: number, dy: number, height: number): void {
    const scale = this.pixel(height);
    const right = this.right();
    const up = new Vector3().crossVectors(this.direction(), right);
    this.target.addScaledVector(right, -dx * scale).addScaledVector(up, dy * scale);
  }

  /** Zooms about a point of the picture, `dx` and `dy` from its middle [px]. */
  zoom(factor: number, dx = 0, dy = 0, height = 1): void {
    const before = this.distance;
    this.distance = Math.min(Math.max(before * factor, 0.2), 2e6);
    const left = 1 - this.distance / before;
    const scale = ((2 * before * Math.tan(OPENING / 2)) / height) * left;
    const right = this.right();
    const up = new Vector3().crossVectors(this.direction(), right);
    this.target.addScaledVector(right, dx * scale).addScaledVector(up, -dy * scale);
  }

  /** Looks at a place so that `span` fills a good part of the picture [m]. */
  approach(place: Vector3, span: number): void {
    this.target.copy(place);
    this.distance = (0.9 * span) / Math.tan(OPENING / 2);
  }

  look(preset: Preset): void {
    if (preset === "3d") {
      [this.azimuth, this.elevation] = [-1.05, 0.28];
    } else if (preset === "side") {
      [this.azimuth, this.elevation] = [-Math.PI / 2, 0];
    } else if (preset === "front") {
      [this.azimuth, this.elevation] = [0, 0];
    } else {
      [this.azimuth, this.elevation] = [-Math.PI / 2, MOST_ELEVATION];
    }
  }

  /** Frames a box, leaving margins (left, right, top, bottom) for scales [px]. */
  fit(bounds: Bounds, width: number, height: number, margins: number[]): void {
    const [left, right, top, bottom] = margins;
    const inner = { width: Math.max(width - left - right, 60), height: Math.max(height - top - bottom, 60) };
    const back = this.direction();
    const across = this.right();
    const up = new Vector3().crossVectors(back, across);
    const centre = new Vector3().addVectors(bounds.min, bounds.max).multiplyScalar(0.5);
    const tangent = Math.tan(OPENING / 2);
    const corners: { x: number; y: number; z: number }[] = [];
    for (let k = 0; k < 8; k++) {
      const corner = new Vector3(
        k & 1 ? bounds.max.x : bounds.min.x,
        k & 2 ? bounds.max.y : bounds.min.y,
        k & 4 ? bounds.max.z : bounds.min.z,
      ).sub(centre);
      corners.push({ x: corner.dot(across), y: corner.dot(up), z: corner.dot(back) });
    }
    // The box's outline as seen, not its centre, belongs in the middle.
    const middle = (axis: "x" | "y") => {
      const values = corners.map((corner) => corner[axis]);
      return 0.5 * (Math.max(...values) + Math.min(...values));
    };
    const [mx, my] = [middle("x"), middle("y")];
    let distance = 1;
    for (const { x, y, z } of corners) {
      const vertical = (Math.abs(y - my) * height) / inner.height / tangent;
      const horizontal = (Math.abs(x - mx) * height) / inner.width / tangent;
      distance = Math.max(distance, Math.max(vertical, horizontal) + (this.parallel ? 0 : z));
    }
    this.distance = distance * 1.04;
    const scale = this.pixel(height);
    this.target
      .copy(centre)
      .addScaledVector(across, mx - (0.5 * (left - right)) * scale)
      .addScaledVector(up, my + (0.5 * (top - bottom)) * scale);
  }
}
