// Pointer and keys on the scene, and the keys of the whole page.

import type { Stage } from "../scene/stage";
import type { Preset } from "../scene/camera";
import type { OptionStore } from "../options";
import { byId, make } from "./dom";

export interface Actions {
  playPause(): void;
  step(by: number): void;
  toStart(): void;
  toEnd(): void;
  faster(by: number): void;
  look(preset: Preset): void;
  fit(): void;
  near(): void;
  nextCase(): void;
  nextQuantity(): void;
  nextNode(by: number): void;
  picture(): void;
  help(): void;
  deselect(): void;
  redraw(): void;
  pick(x: number, y: number, reach: number): void;
}

/** Keys and what they do; the help dialog lists them. */
const KEYS: { keys: string[]; shown: string; what: string; run: (a: Actions) => void }[] = [
  { keys: [" "], shown: "Space", what: "Play or pause", run: (a) => a.playPause() },
  { keys: [","], shown: ",", what: "One stored step back", run: (a) => a.step(-1) },
  { keys: ["."], shown: ".", what: "One stored step on", run: (a) => a.step(1) },
  { keys: ["Home"], shown: "Home", what: "To the start", run: (a) => a.toStart() },
  { keys: ["End"], shown: "End", what: "To the last stored step", run: (a) => a.toEnd() },
  { keys: ["["], shown: "[", what: "Slower", run: (a) => a.faster(-1) },
  { keys: ["]"], shown: "]", what: "Faster", run: (a) => a.faster(1) },
  { keys: ["1"], shown: "1", what: "View from an angle", run: (a) => a.look("3d") },
  { keys: ["2"], shown: "2", what: "View along y", run: (a) => a.look("side") },
  { keys: ["3"], shown: "3", what: "View along x", run: (a) => a.look("front") },
  { keys: ["4"], shown: "4", what: "View from above", run: (a) => a.look("plan") },
  { keys: ["f", "F"], shown: "F", what: "Frame the whole system", run: (a) => a.fit() },
  { keys: ["g", "G"], shown: "G", what: "Go near what is selected", run: (a) => a.near() },
  { keys: ["c", "C"], shown: "C", what: "Next load case", run: (a) => a.nextCase() },
  { keys: ["r", "R"], shown: "R", what: "Next result", run: (a) => a.nextQuantity() },
  { keys: ["n", "N"], shown: "N", what: "Next node of the line", run: (a) => a.nextNode(1) },
  { keys: ["b", "B"], shown: "B", what: "Node before", run: (a) => a.nextNode(-1) },
  { keys: ["p", "P"], shown: "P", what: "Save a picture", run: (a) => a.picture() },
  { keys: ["Escape"], shown: "Esc", what: "Select nothing", run: (a) => a.deselect() },
  { keys: ["?"], shown: "?", what: "This help", run: (a) => a.help() },
];

export function bindKeys(options: OptionStore, actions: Actions): void {
  const rows = KEYS.map(({ shown, what }) => row(shown, what));
  rows.push(row("Arrows", "On the scene: turn the view; with Shift: move it"));
  rows.push(row("+ −", "On the scene: zoom"));
  byId("keys").replaceChildren(...rows);
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    const typing = target.matches("input, select, textarea, dialog *");
    const pressing = target.matches("button, a, summary") && event.key === " ";
    const foreign = event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented;
    const onScene = target.closest("#scene") !== null;
    if (typing || pressing || foreign || (!options.get().shortcuts && !onScene)) {
      return;
    }
    const found = KEYS.find(({ keys }) => keys.includes(event.key));
    if (found) {
      event.preventDefault();
      found.run(actions);
    }
  });
}

function row(key: string, what: string): HTMLElement {
  const line = make("tr");
  const head = make("th", "", { scope: "row" });
  head.append(make("kbd", key));
  line.append(head, make("td", what));
  return line;
}

/** Distance from the pointer within which a thing is meant [px]. */
const REACH = { mouse: 12, touch: 24 };

export function bindScene(container: HTMLElement, stage: Stage, actions: Actions): void {
  const { camera } = stage;
  const pointers = new Map<number, { x: number; y: number }>();
  let moved = 0;
  /** Where a point of the window is from the middle of its view [px]. */
  const fromMiddle = ({ x, y }: { x: number; y: number }): [number, number] => {
    const box = container.getBoundingClientRect();
    const view = stage.viewAt(x - box.left, y - box.top);
    return [x - box.left - view.x - view.width / 2, y - box.top - view.y - view.height / 2];
  };
  const heightAt = () => stage.viewAt(0, 0).height;
  container.addEventListener("contextmenu", (event) => event.preventDefault());
  container.addEventListener("pointerdown", (event) => {
    container.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (pointers.size === 1) {
      moved = 0;
    }
  });
  container.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) {
      return;
    }
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    moved += Math.hypot(dx, dy);
    const height = heightAt();
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const before = Math.hypot(last.x - other.x, last.y - other.y);
        const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
        const middle = { x: (event.clientX + other.x) / 2, y: (event.clientY + other.y) / 2 };
        camera.zoom(before / Math.max(after, 1), ...fromMiddle(middle), heightAt());
        camera.pan(dx / 2, dy / 2, height);
      }
    } else if (event.buttons & 2 || event.buttons & 4 || event.shiftKey) {
      camera.pan(dx, dy, height);
    } else {
      camera.orbit(dx * 0.006, dy * 0.006);
    }
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    actions.redraw();
  });
  const release = (event: PointerEvent) => {
    const was = pointers.delete(event.pointerId);
    // A hand is never quite still: a few pixels are still a click.
    if (was && event.type === "pointerup" && pointers.size === 0 && moved < 6 && event.button === 0) {
      const box = container.getBoundingClientRect();
      const reach = event.pointerType === "touch" ? REACH.touch : REACH.mouse;
      actions.pick(event.clientX - box.left, event.clientY - box.top, reach);
    }
  };
  container.addEventListener("pointerup", release);
  container.addEventListener("pointercancel", release);
  container.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 20 : 1;
      const factor = Math.exp(Math.max(-1, Math.min(1, event.deltaY * lines * 0.0015)));
      camera.zoom(factor, ...fromMiddle({ x: event.clientX, y: event.clientY }), heightAt());
      actions.redraw();
    },
    { passive: false },
  );
  container.addEventListener("dblclick", () => actions.near());
  container.addEventListener("keydown", (event) => {
    const turn = 0.07;
    const height = heightAt();
    const moves: Record<string, () => void> = event.shiftKey
      ? {
          ArrowLeft: () => camera.pan(30, 0, height),
          ArrowRight: () => camera.pan(-30, 0, height),
          ArrowUp: () => camera.pan(0, 30, height),
          ArrowDown: () => camera.pan(0, -30, height),
        }
      : {
          ArrowLeft: () => camera.orbit(-turn, 0),
          ArrowRight: () => camera.orbit(turn, 0),
          ArrowUp: () => camera.orbit(0, turn),
          ArrowDown: () => camera.orbit(0, -turn),
        };
    moves["+"] = moves["="] = () => camera.zoom(0.85);
    moves["-"] = () => camera.zoom(1 / 0.85);
    const move = moves[event.key];
    if (move && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      move();
      actions.redraw();
    }
  });
}
