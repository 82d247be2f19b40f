// Time: where it stands, whether it runs, and how fast.

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100];

export class Playback {
  time = 0;
  playing = false;
  speed = 1;
  loop = true;
  /** While a run goes on, time stays at its newest step. */
  tail = false;
  end = 0;

  /** Lets time pass. `ready`: whether the data of the time reached before has come. */
  tick(elapsed: number, ready: boolean): void {
    if (this.tail) {
      this.time = this.end;
      return;
    }
    // Time waits for data: a film that skips what it cannot load shows nothing.
    if (!this.playing || !ready) {
      return;
    }
    this.time += elapsed * this.speed;
    if (this.time >= this.end) {
      if (this.loop && this.end > 0) {
        this.time %= this.end;
      } else {
        this.time = this.end;
        this.playing = false;
      }
    }
  }

  seek(time: number): void {
    this.tail = false;
    this.time = Math.min(Math.max(time, 0), this.end);
  }
}
