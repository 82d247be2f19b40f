// Keeps motion fluid: draws coarser while moving when frames take too long, sharp again at rest.

/** Time that a frame may take at thirty a second, with a little room [ms]. */
const PATIENCE_MS = 31;
/** Coarsest drawing, as a share of the screen's own pixels. */
const COARSEST = 0.4;
/** Rest after which the picture is drawn sharp again [ms]. */
const REST_MS = 250;

export class FrameRate {
  /** Share of the screen's pixels that is drawn, along each axis. */
  scale = 1;
  /** Frames in the last second of motion. */
  fps = 0;
  private times: number[] = [];
  private average = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private onSharp: () => void) {}

  /** A frame of a motion was drawn at `now`, in `spent` milliseconds. */
  moved(now: number, spent: number, adaptive: boolean): void {
    clearTimeout(this.timer);
    const last = this.times[this.times.length - 1];
    this.times.push(now);
    while (this.times[0] < now - 1000) {
      this.times.shift();
    }
    this.fps = this.times.length;
    const span = last === undefined ? spent : Math.max(now - last, spent);
    this.average = 0.85 * this.average + 0.15 * Math.min(span, 200);
    if (adaptive && this.average > PATIENCE_MS && this.scale > COARSEST) {
      this.scale = Math.max(COARSEST, this.scale * 0.8);
      // Time to see what it helps before the next step.
      this.average = 0.6 * PATIENCE_MS;
    }
  }

  /** A frame was drawn at rest. */
  rested(stillMoving: () => boolean): void {
    this.times = [];
    this.average = 0;
    if (this.scale < 1) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => {
        if (!stillMoving()) {
          this.scale = 1;
          this.onSharp();
        }
      }, REST_MS);
    }
  }
}
