// Videos: every frame drawn for its own time, recorded as WebM or saved as pictures.

import { MOST_BYTES, Zip } from "./zip";

export interface VideoPlan {
  from: number;
  to: number;
  /** Simulated seconds per second of the video. */
  speed: number;
  fps: number;
}

export interface VideoHost {
  /** Draws a time into the canvas; resolves when its data was there. */
  frame(time: number, target: HTMLCanvasElement): Promise<void>;
  progress(share: number): void;
  cancelled(): boolean;
}

export function frameCount(plan: VideoPlan): number {
  return Math.max(1, Math.floor(((plan.to - plan.from) / plan.speed) * plan.fps + 1e-9) + 1);
}

function timeOf(plan: VideoPlan, frame: number): number {
  return Math.min(plan.from + (frame * plan.speed) / plan.fps, plan.to);
}

export function canRecord(): boolean {
  return typeof MediaRecorder !== "undefined" && mimeType() !== undefined;
}

function mimeType(): string | undefined {
  const types = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
  return types.find((type) => MediaRecorder.isTypeSupported(type));
}

/** Records in the time that the video lasts, or longer where drawing is slower. */
export async function recordWebm(plan: VideoPlan, host: VideoHost): Promise<Blob | null> {
  const canvas = document.createElement("canvas");
  await host.frame(plan.from, canvas);
  const stream = canvas.captureStream(0);
  const track = stream.getVideoTracks()[0] as CanvasCaptureMediaStreamTrack;
  const recorder = new MediaRecorder(stream, { mimeType: mimeType(), videoBitsPerSecond: 12e6 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
  const ended = new Promise<void>((resolve) => recorder.addEventListener("stop", () => resolve()));
  recorder.start(500);
  const count = frameCount(plan);
  let due = performance.now();
  for (let frame = 0; frame < count && !host.cancelled(); frame++) {
    await host.frame(timeOf(plan, frame), canvas);
    track.requestFrame();
    host.progress((frame + 1) / count);
    due += 1000 / plan.fps;
    const wait = due - performance.now();
    // The recorder keeps the clock: frames are given to it at their own pace.
    await new Promise((resolve) => setTimeout(resolve, Math.max(wait, 0)));
    if (wait < 0) {
      due = performance.now();
    }
  }
  recorder.stop();
  await ended;
  track.stop();
  return host.cancelled() ? null : new Blob(parts, { type: "video/webm" });
}

/** Saves every frame as a PNG in one archive. */
export async function savePngs(plan: VideoPlan, host: VideoHost): Promise<Blob | null> {
  const canvas = document.createElement("canvas");
  const zip = new Zip();
  const count = frameCount(plan);
  for (let frame = 0; frame < count && !host.cancelled(); frame++) {
    await host.frame(timeOf(plan, frame), canvas);
    const picture = await toPng(canvas);
    if (zip.size + picture.size > MOST_BYTES - 1e6) {
      throw new Error("the frames are larger than an archive may be (4 GB); choose a shorter time");
    }
    await zip.add(`frame-${String(frame).padStart(5, "0")}.png`, picture);
    host.progress((frame + 1) / count);
  }
  return host.cancelled() ? null : zip.finish();
}

export function toPng(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the picture is too large"))), "image/png"),
  );
}
