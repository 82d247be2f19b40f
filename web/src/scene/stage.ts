// The three-dimensional scene: viewports, camera, planes, and what is written over them.

import {
  Color,
  DataTexture,
  DirectionalLight,
  HemisphereLight,
  LinearFilter,
  RGBAFormat,
  Scene as World,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { DARK, LIGHT, Palette, caseColour, mapBytes } from "../colour";
import { niceStep, seconds, shownUnit, tick, title } from "../format";
import type { Options, Selection } from "../options";
import type { CaseData, CaseFrame } from "../store/case_data";
import { OrbitCamera, Preset } from "./camera";
import { CaseView, Hit, staticBounds } from "./case_view";
import type { LineLook } from "./line_mesh";
import { Overlay, Project, Rect } from "./overlay";
import { Plane } from "./planes";

interface Viewport {
  world: World;
  views: CaseView[];
  sea: Plane;
  seabed: Plane;
  rect: Rect;
}

/** What writing over a view needs to know of it. */
interface Ground {
  project: Project;
  /** Length of a pixel at a place [m]. */
  pixelAt: (place: Vector3) => number;
  bounds: { min: Vector3; max: Vector3 };
  /** Of the grid [m]. */
  spacing: number;
}

export interface StageState {
  time: number;
  range: [number, number];
  unit: string;
  decimals: number;
}

export class Stage {
  readonly camera = new OrbitCamera();
  readonly overlayCanvas = document.createElement("canvas");
  private renderer: WebGLRenderer;
  private viewports: Viewport[] = [];
  private overlay: Overlay;
  private palette: Palette = LIGHT;
  private texture = new DataTexture(mapBytes("viridis"), 256, 1, RGBAFormat);
  private mapKey = "";
  private bytes = mapBytes("viridis");
  private width = 1;
  private height = 1;
  private ratio = 1;
  private bounds = staticBounds([]);
  /** Frames drawn last, per case. */
  private frames = new Map<string, number>();

  constructor(
    readonly canvas: HTMLCanvasElement,
    private container: HTMLElement,
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: false, preserveDrawingBuffer: false });
    this.renderer.autoClear = false;
    this.renderer.setClearAlpha(0);
    this.texture.magFilter = LinearFilter;
    this.texture.minFilter = LinearFilter;
    this.overlayCanvas.className = "overlay";
    this.overlayCanvas.setAttribute("aria-hidden", "true");
    container.append(this.overlayCanvas);
    this.overlay = this.makeOverlay();
  }

  private makeOverlay(): Overlay {
    const context = this.overlayCanvas.getContext("2d");
    if (!context) {
      throw new Error("this browser has no canvas to write on");
    }
    return new Overlay(context, this.palette);
  }

  setTheme(dark: boolean): void {
    this.palette = dark ? DARK : LIGHT;
    this.overlay = this.makeOverlay();
  }

  get view(): CaseView[] {
    return this.viewports.flatMap((viewport) => viewport.views);
  }

  /** Shows these cases. The camera stays unless `frame`. */
  setCases(cases: CaseData[], over: boolean): void {
    this.view.forEach((view) => view.dispose());
    const groups = over ? [cases] : cases.map((data) => [data]);
    this.viewports = groups
      .filter((group) => group.length > 0)
      .map((group) => {
        const world = new World();
        const light = new DirectionalLight(0xffffff, 1.6);
        light.position.set(-0.4, -1, 1.2);
        world.add(new HemisphereLight(0xffffff, 0x8899aa, 1.9), light);
        const views = group.map((data) => new CaseView(data, this.palette));
        views.forEach((view) => world.add(view.group));
        const [sea, seabed] = [new Plane(false), new Plane(true)];
        world.add(seabed.mesh, sea.mesh);
        return { world, views, sea, seabed, rect: { x: 0, y: 0, width: 1, height: 1 } };
      });
    this.bounds = staticBounds(cases);
    this.layout();
  }

  resize(width: number, height: number, ratio: number): void {
    const same = width === this.width && height === this.height;
    if (same && ratio === this.ratio) {
      return;
    }
    [this.width, this.height, this.ratio] = [width, height, ratio];
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    // Writing stays sharp when the scene is drawn coarser to keep up.
    const sharp = Math.min(Math.max(window.devicePixelRatio, 1), 2);
    const [w, h] = [Math.round(width * sharp), Math.round(height * sharp)];
    if (this.overlayCanvas.width !== w || this.overlayCanvas.height !== h) {
      this.overlayCanvas.width = w;
      this.overlayCanvas.height = h;
    }
    this.layout();
  }

  private layout(): void {
    const count = this.viewports.length;
    const wide = this.width / this.height;
    let columns = 1;
    // The number of columns that leaves the picture with the best use of its space.
    let best = 0;
    for (let c = 1; c <= count; c++) {
      const rows = Math.ceil(count / c);
      const [w, h] = [wide / c, 1 / rows];
      const score = Math.min(w, 0.8 * h) - 0.001 * (c * rows - count);
      if (score > best) {
        [best, columns] = [score, c];
      }
    }
    const rows = Math.ceil(count / columns);
    this.viewports.forEach((viewport, index) => {
      const [column, row] = [index % columns, Math.floor(index / columns)];
      const x = Math.round((column * this.width) / columns);
      const y = Math.round((row * this.height) / rows);
      viewport.rect = {
        x,
        y,
        width: Math.round(((column + 1) * this.width) / columns) - x,
        height: Math.round(((row + 1) * this.height) / rows) - y,
      };
    });
  }

  look(preset: Preset, options: Readonly<Options>): void {
    this.camera.look(preset);
    this.fit(options);
  }

  fit(options: Readonly<Options>): void {
    const rect = this.viewports[0]?.rect;
    if (!rect) {
      return;
    }
    const bounds = this.shownBounds(options);
    const small = rect.width < 300;
    const right = this.viewports.length > 1 || this.width < 500 ? 40 : 120;
    this.camera.parallel = options.parallel;
    this.camera.fit(bounds, rect.width, rect.height, [small ? 50 : 90, small ? 30 : right, 56, 40]);
  }

  /** The box of the system as it is drawn. */
  private shownBounds(options: Readonly<Options>) {
    const { stretch } = options;
    return {
      min: this.bounds.min.clone().multiply(new Vector3(stretch, stretch, 1)),
      max: this.bounds.max.clone().multiply(new Vector3(stretch, stretch, 1)),
    };
  }

  /**
   * Takes the frames of all cases at a time; returns false while data of one is on its way, and then
   * changes nothing of it.
   */
  update(time: number, options: Readonly<Options>): boolean {
    let complete = this.viewports.length > 0;
    for (const view of this.view) {
      const frame: CaseFrame | null = view.data.sample(time, options.quantity);
      if (frame) {
        view.update(frame, options);
        view.group.visible = true;
        this.frames.set(view.data.name, frame.time);
      } else {
        complete &&= !view.data.hasFrames;
        view.group.visible = this.frames.has(view.data.name) && view.data.hasFrames;
      }
    }
    return complete;
  }

  draw(state: StageState, options: Readonly<Options>): void {
    this.refreshMap(options);
    const { renderer, palette } = this;
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    const context = this.overlayCanvas.getContext("2d");
    context?.setTransform(this.overlayCanvas.width / this.width, 0, 0, this.overlayCanvas.height / this.height, 0, 0);
    this.overlay.begin(this.width, this.height);
    this.colourBar(state, options);
    const outline = raw(palette.outline);
    const mark = raw(palette.mark);
    this.camera.parallel = options.parallel;
    const bounds = this.shownBounds(options);
    const centre = new Vector3().addVectors(bounds.min, bounds.max).multiplyScalar(0.5);
    const radius = bounds.max.distanceTo(bounds.min) * 0.5;
    for (const [index, viewport] of this.viewports.entries()) {
      const { rect, views } = viewport;
      const camera = this.camera.update(rect.width / rect.height, radius * 3);
      const project = this.projector(rect, radius);
      const depth = views[0].data.scene?.water_depth_m ?? 0;
      const spacing = niceStep(Math.max(2 * radius, 10), 10);
      const shift = new Vector2(views[0].shift.x, views[0].shift.y);
      const middle = new Vector2(centre.x, centre.y);
      const reach = Math.max(2.6 * radius, 10);
      viewport.sea.mesh.visible = options.sea && depth > 0;
      viewport.sea.place(0, middle, reach, spacing, shift);
      viewport.sea.colour(palette.sea, palette.sea, 0.2, 0.4);
      viewport.seabed.mesh.visible = options.seabed && depth > 0;
      viewport.seabed.place(-depth, middle, reach, spacing, shift);
      viewport.seabed.colour(palette.seabed, palette.seabedGrid, 0.55, 0.3);
      const tangent = 2 * Math.tan((28 * Math.PI) / 360);
      const pixelAt = (place: Vector3) => {
        const away = options.parallel
          ? this.camera.distance
          : Math.max(camera.position.distanceTo(place), 1e-3);
        return (away * tangent) / rect.height;
      };
      for (const view of views) {
        const colour = caseColour(options.cases.indexOf(view.data.name));
        const look: LineLook = {
          map: this.texture,
          range: new Vector2(...state.range),
          size: new Vector2(rect.width, rect.height).multiplyScalar(this.ratio),
          least: options.lineWidth,
          plain: options.colourBy === "case" ? raw(colour) : null,
          outline,
          mark,
        };
        view.show(look, options.selection, camera, pixelAt, this.ratio);
      }
      const y = this.height - rect.y - rect.height;
      renderer.setViewport(rect.x, y, rect.width, rect.height);
      renderer.setScissor(rect.x, y, rect.width, rect.height);
      renderer.render(viewport.world, camera);
      this.annotate(viewport, index, state, options, { project, pixelAt, bounds, spacing });
    }
  }

  private annotate(
    viewport: Viewport,
    index: number,
    state: StageState,
    options: Readonly<Options>,
    { project, pixelAt, bounds, spacing }: Ground,
  ): void {
    const { rect, views } = viewport;
    const context = this.overlayCanvas.getContext("2d");
    if (!context) {
      return;
    }
    context.save();
    context.beginPath();
    context.rect(rect.x, rect.y, rect.width, rect.height);
    context.clip();
    if (this.viewports.length > 1 && (rect.x > 0 || rect.y > 0)) {
      context.strokeStyle = this.palette.faint;
      context.globalAlpha = 0.4;
      context.strokeRect(rect.x + 0.5, rect.y + 0.5, rect.width, rect.height);
      context.globalAlpha = 1;
    }
    const heading = views.map((view) => {
      const { name, description } = view.data.description;
      const ended = view.data.hasFrames && state.time > view.data.endTime + 1e-9;
      const end = ended ? ` (ends at ${seconds(view.data.endTime, state.decimals)} s)` : "";
      const text = `${name}${end}${description ? `: ${description}` : ""}`;
      const colour =
        options.colourBy === "case" ? caseColour(options.cases.indexOf(name)) : undefined;
      return { text, colour, weight: 600 };
    });
    if (index === 0) {
      heading.push({ text: `t = ${seconds(state.time, state.decimals)} s`, colour: undefined, weight: 400 });
    }
    this.overlay.heading(rect, heading);
    const direction = this.camera.direction();
    const across = this.camera.right();
    const up = new Vector3().crossVectors(direction, across);
    const depth = views[0].data.scene?.water_depth_m ?? 0;
    // Seen along itself a plane is a line: sea surface and seabed are drawn as such.
    if (Math.abs(this.camera.elevation) < 0.01 && options.parallel && depth > 0) {
      const surface = options.sea ? project(new Vector3(0, 0, 0)) : null;
      const bottom = options.seabed ? project(new Vector3(0, 0, -depth)) : null;
      this.overlay.levels(rect, surface?.y ?? null, bottom?.y ?? null);
    }
    if (rect.height > 170) {
      this.overlay.axes(rect, across, up, direction);
    }
    const centre = new Vector3().addVectors(bounds.min, bounds.max).multiplyScalar(0.5);
    const half = new Vector3().subVectors(bounds.max, bounds.min).multiplyScalar(0.5);
    const size = half.length();
    const reach = Math.abs(across.x) * half.x + Math.abs(across.y) * half.y + 0.06 * size;
    const level = Math.abs(this.camera.elevation) < 1.2;
    if (options.depthScale && level && depth > 0) {
      const foot = centre.clone().addScaledVector(across, -reach - 0.04 * size);
      const shown = depth <= -bounds.min.z * 1.001 ? depth : Math.max(-bounds.min.z, 1);
      this.overlay.depthScale(rect, foot, shown, project);
    }
    if (options.current && rect.width > 240) {
      const foot = centre.clone().addScaledVector(across, reach + 0.02 * size);
      this.overlay.current(rect, foot, this.currentArrows(views[0].data, bounds, state.time), 0.2 * size, project);
    }
    if (options.labels) {
      const order = { vessel: 0, body: 1, lump: 2, line: 3 };
      // Cases that lie over each other have the same names: once is enough.
      const items = views
        .filter((view) => view.group.visible)
        .slice(0, 1)
        .flatMap((view) => view.named)
        .sort((a, b) => order[a.kind] - order[b.kind])
        .flatMap(({ name, kind, place }) => {
          const at = Number.isFinite(place.x) ? project(place) : null;
          const large = kind === "vessel" || kind === "body";
          const shown = views[0].shownSize(name) / pixelAt(place);
          const gap = large ? { x: 3 + 0.55 * shown, y: 3 + 0.4 * shown } : { x: 8, y: 8 };
          const [size, weight] = [kind === "lump" ? 11 : 12, large ? 600 : 400];
          const key = `${index}/${kind}/${name}`;
          return at ? [{ key, name, at, size, weight, gap, cover: large ? 2 : 0.5 }] : [];
        });
      const drawn = views
        .filter((view) => view.group.visible)
        .flatMap((view) => view.footprint(project, pixelAt));
      this.overlay.names(rect, items, drawn);
    }
    if ((options.sea || options.seabed) && depth > 0 && index === this.viewports.length - 1) {
      this.overlay.remark(rect, `Grid ${tick(spacing, spacing)} m`);
    }
    context.restore();
  }

  /** Arrows at even depths through the water that is shown. */
  private currentArrows(data: CaseData, bounds: { min: Vector3 }, time: number) {
    const profile = data.scene?.current ?? [];
    if (profile.length === 0) {
      return [{ depth: 0, velocity: [0, 0] as [number, number] }];
    }
    const factor = factorAt(data.scene?.current_factor ?? [], time);
    const deepest = Math.max(-bounds.min.z, 1);
    return Array.from({ length: 13 }, (_, k) => {
      const depth = (deepest * k) / 12;
      const below = profile.findIndex((point) => point.depth_m > depth);
      const lower = below < 0 ? profile[profile.length - 1] : profile[below];
      const upper = below <= 0 ? lower : profile[below - 1];
      const span = lower.depth_m - upper.depth_m;
      const share = span > 0 ? (depth - upper.depth_m) / span : 0;
      const part = (axis: 0 | 1) =>
        factor * (upper.velocity_m_s[axis] + share * (lower.velocity_m_s[axis] - upper.velocity_m_s[axis]));
      return { depth, velocity: [part(0), part(1)] as [number, number] };
    });
  }

  private colourBar(state: StageState, options: Readonly<Options>): void {
    if (options.colourBy !== "result" || this.viewports.length === 0) {
      return;
    }
    const largest = Math.max(Math.abs(state.range[0]), Math.abs(state.range[1]));
    const { unit, factor } = shownUnit(state.unit, largest);
    const height = Math.min(220, Math.max(90, this.height * 0.42));
    const small = this.width < 500;
    const box = { x: this.width - 70, y: small ? 84 : 56, width: 60, height };
    const label = `${title(options.quantity)}${unit ? ` [${unit}]` : ""}`;
    const words = this.width < 500 ? `${title(options.quantity)}|[${unit}]` : label;
    this.overlay.colourBar(box, this.bytes, [state.range[0] * factor, state.range[1] * factor], words);
  }

  private refreshMap(options: Readonly<Options>): void {
    const key = `${options.colourMap}${options.reversed}`;
    if (key === this.mapKey) {
      return;
    }
    this.mapKey = key;
    this.bytes = mapBytes(options.colourMap);
    if (options.reversed) {
      const pixels = new Uint32Array(this.bytes.buffer);
      pixels.reverse();
    }
    this.texture.image.data?.set(this.bytes);
    this.texture.needsUpdate = true;
  }

  private projector(rect: Rect, radius: number) {
    const camera = this.camera.update(rect.width / rect.height, radius * 3);
    const place = new Vector3();
    const view = camera.matrixWorldInverse;
    return (world: Vector3): { x: number; y: number } | null => {
      place.copy(world).applyMatrix4(view);
      if (!this.camera.parallel && place.z > -camera.near) {
        return null;
      }
      place.applyMatrix4(camera.projectionMatrix);
      return {
        x: rect.x + (0.5 + 0.5 * place.x) * rect.width,
        y: rect.y + (0.5 - 0.5 * place.y) * rect.height,
      };
    };
  }

  /** What is at a point of the picture. */
  pick(x: number, y: number, reach: number): Selection | null {
    const radius = this.bounds.max.distanceTo(this.bounds.min) * 0.5;
    let best: Hit | null = null;
    const at = this.viewAt(x, y);
    for (const { rect, views } of this.viewports) {
      if (rect !== at) {
        continue;
      }
      const project = this.projector(rect, radius);
      for (const view of views) {
        const hit = view.pick(x, y, reach, project);
        if (hit && (!best || hit.distance < (best as Hit).distance)) {
          best = hit;
        }
      }
    }
    return (best as Hit | null)?.selection ?? null;
  }

  /** Where a thing is in the picture of the first case that has it [px]. */
  locate(selection: Selection): { x: number; y: number } | null {
    const radius = this.bounds.max.distanceTo(this.bounds.min) * 0.5;
    for (const { rect, views } of this.viewports) {
      for (const view of views) {
        const place = view.placeOf(selection);
        if (place && Number.isFinite(place.x)) {
          return this.projector(rect, radius)(place);
        }
      }
    }
    return null;
  }

  /** The part of the picture in which a point lies; all have one size. */
  viewAt(x: number, y: number): Rect {
    const inside = ({ rect }: Viewport) =>
      x >= rect.x && y >= rect.y && x < rect.x + rect.width && y < rect.y + rect.height;
    const found = this.viewports.find(inside) ?? this.viewports[0];
    return found?.rect ?? { x: 0, y: 0, width: this.width, height: this.height };
  }

  /** Goes near a thing; returns whether there is one. */
  near(selection: Selection): boolean {
    for (const view of this.view) {
      const place = view.placeOf(selection);
      if (place && Number.isFinite(place.x)) {
        this.camera.approach(place, view.spanOf(selection));
        return true;
      }
    }
    return false;
  }

  get size(): { width: number; height: number } {
    return { width: this.width, height: this.height };
  }

  /** Scene and writing as one picture. Draws both at this scale first. */
  compose(state: StageState, options: Readonly<Options>, scale: number, target: HTMLCanvasElement): void {
    const [width, height, ratio] = [this.width, this.height, this.ratio];
    this.renderer.setPixelRatio(scale);
    this.renderer.setSize(width, height, false);
    this.ratio = scale;
    const [ow, oh] = [this.overlayCanvas.width, this.overlayCanvas.height];
    this.overlayCanvas.width = Math.round(width * scale);
    this.overlayCanvas.height = Math.round(height * scale);
    this.draw(state, options);
    // Video encoders want even sizes.
    const [w, h] = [2 * Math.floor((width * scale) / 2), 2 * Math.floor((height * scale) / 2)];
    if (target.width !== w || target.height !== h) {
      target.width = w;
      target.height = h;
    }
    const context = target.getContext("2d");
    if (context) {
      const gradient = context.createLinearGradient(0, 0, 0, h);
      gradient.addColorStop(0, this.palette.top);
      gradient.addColorStop(1, this.palette.bottom);
      context.fillStyle = gradient;
      context.fillRect(0, 0, w, h);
      context.drawImage(this.canvas, 0, 0);
      context.drawImage(this.overlayCanvas, 0, 0);
    }
    this.overlayCanvas.width = ow;
    this.overlayCanvas.height = oh;
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    void this.container;
  }
}

/** A colour as the shaders write it: in the screen's own space. */
function raw(hex: string): Color {
  return new Color(hex).convertLinearToSRGB();
}

function factorAt(table: [number, number][], time: number): number {
  if (table.length === 0) {
    return 1;
  }
  const after = table.findIndex(([t]) => t > time);
  if (after === 0) {
    return table[0][1];
  }
  if (after < 0) {
    return table[table.length - 1][1];
  }
  const [[t0, f0], [t1, f1]] = [table[after - 1], table[after]];
  return f0 + ((f1 - f0) * (time - t0)) / (t1 - t0);
}
