// The export tab: pictures, videos, numbers.

import { VideoHost, VideoPlan, canRecord, frameCount, recordWebm, savePngs, toPng } from "../export/video";
import { number, seconds } from "../format";
import { SPEEDS } from "../playback";
import { byId, fill, save } from "./dom";
import type { GraphData } from "./graphs";

export interface ExportHost {
  /** Stem of file names: study, cases and time. */
  stem(): string;
  picture(target: HTMLCanvasElement, scale: number): Promise<void>;
  frame(time: number, target: HTMLCanvasElement): Promise<void>;
  graphs(): GraphData;
  end(): number;
  /** Time belongs to the export until `done`. */
  begin(): void;
  done(): void;
  failed(error: unknown): void;
}

export class Exports {
  private stop = false;
  private busy = false;
  private touched = false;

  constructor(private host: ExportHost) {
    const entries = SPEEDS.map((speed): [string, string] => [String(speed), `× ${speed}`]);
    fill(byId("video-speed"), [{ label: "", entries }], "10");
    byId("picture").addEventListener("click", () => this.picture());
    byId("csv").addEventListener("click", () => this.csv());
    byId("video-webm").addEventListener("click", () => this.video(recordWebm, "webm"));
    byId("video-zip").addEventListener("click", () => this.video(savePngs, "zip"));
    byId("video-stop").addEventListener("click", () => (this.stop = true));
    for (const id of ["video-from", "video-to", "video-speed", "video-fps"]) {
      byId(id).addEventListener("input", () => {
        this.touched = true;
        this.plan();
      });
    }
    if (!canRecord()) {
      byId<HTMLButtonElement>("video-webm").disabled = true;
      byId("video-note").textContent = "This browser cannot record WebM; save PNG frames instead.";
    }
  }

  /** The stored time has changed. */
  refresh(): void {
    if (!this.touched && !this.busy) {
      byId<HTMLInputElement>("video-from").value = "0";
      byId<HTMLInputElement>("video-to").value = String(Number(this.host.end().toPrecision(6)));
    }
    this.plan();
  }

  private plan(): VideoPlan | null {
    const value = (id: string) => Number(byId<HTMLInputElement>(id).value);
    const end = this.host.end();
    const from = Math.min(Math.max(value("video-from"), 0), end);
    const to = Math.min(value("video-to"), end);
    const plan = { from, to, speed: value("video-speed"), fps: value("video-fps") };
    const valid = plan.to > plan.from && plan.speed > 0;
    const count = valid ? frameCount(plan) : 0;
    byId("video-plan").textContent = valid
      ? `${count} frames, ${number((plan.to - plan.from) / plan.speed)} s of video`
      : "Choose an end after the beginning.";
    byId<HTMLButtonElement>("video-zip").disabled = !valid || this.busy;
    byId<HTMLButtonElement>("video-webm").disabled = !valid || this.busy || !canRecord();
    return valid ? plan : null;
  }

  async picture(): Promise<void> {
    try {
      const canvas = document.createElement("canvas");
      await this.host.picture(canvas, Number(byId<HTMLSelectElement>("picture-scale").value));
      save(await toPng(canvas), `${this.host.stem()}.png`);
    } catch (error) {
      this.host.failed(error);
    }
  }

  private async video(
    make: (plan: VideoPlan, host: VideoHost) => Promise<Blob | null>,
    ending: string,
  ): Promise<void> {
    const plan = this.plan();
    if (!plan || this.busy) {
      return;
    }
    this.busy = true;
    this.stop = false;
    const progress = byId<HTMLProgressElement>("video-progress");
    const note = byId("video-note");
    progress.hidden = false;
    byId("video-stop").hidden = false;
    this.plan();
    this.host.begin();
    note.textContent = "Drawing…";
    try {
      const blob = await make(plan, {
        frame: (time, target) => this.host.frame(time, target),
        progress: (share) => (progress.value = share),
        cancelled: () => this.stop,
      });
      if (blob) {
        save(blob, `${this.host.stem()}.${ending}`);
      }
      note.textContent = blob ? `Saved, ${number(blob.size / 1e6, 3)} MB.` : "Stopped; nothing was saved.";
    } catch (error) {
      note.textContent = `Not saved: ${(error as Error).message}`;
    } finally {
      this.busy = false;
      progress.hidden = true;
      byId("video-stop").hidden = true;
      this.host.done();
      this.plan();
    }
  }

  private csv(): void {
    const { history, range, historyUnit, rangeUnit } = this.host.graphs();
    const part = (name: string, unit: string, curves: GraphData["history"]) =>
      curves.flatMap((curve) =>
        Array.from({ length: Math.min(curve.x.length, curve.y.length) }, (_, k) =>
          [name, quote(curve.label), unit, curve.x[k], curve.y[k] ?? ""].join(","),
        ),
      );
    const rows = [
      "graph,curve,unit,time_s_or_arc_length_m,value",
      ...part("history", historyUnit, history),
      ...part("range", rangeUnit, range),
    ];
    save(new Blob([rows.join("\n"), "\n"], { type: "text/csv" }), `${this.host.stem()}.csv`);
  }
}

function quote(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** A part of a file name. */
export function fileName(...parts: string[]): string {
  return parts.join("-").replace(/[^\p{L}\p{N}._-]+/gu, "_").slice(0, 100);
}

export function timeName(time: number, decimals: number): string {
  return `${seconds(time, decimals).replace(/[^\d.−]/g, "")}s`;
}
