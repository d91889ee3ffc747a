// The dead man's switch: while a control is held it repeats the command, and on release it sends
// one stop. The server stops the robot too, 0.25 s after the last message.

const PERIOD_MS = 100;
const HUNG_MS = 400; // between two periods; the server has stopped the robot long since
const MOST_UNANSWERED = 3; // a connection that hangs must not deliver old commands later
const LATE_MS = 150; // since the last frame; a browser tells of fingers and mice between frames

const clamp = (value) => Math.max(-1, Math.min(1, value));

/** One for a mounted tab. `command(forward, turn)` makes the message of two numbers from -1 to 1. */
export class Handle {
  constructor(link, command, onState) {
    this.link = link;
    this.command = command;
    this.onState = onState; // (state, reason): "idle", "driving" or "stopped"
    this.held = new Map(); // what is held -> [forward, turn]
    this.dropped = new Set(); // what is held still, but counts no more
    this.timer = null;
    this.unanswered = 0;
    this.lastFrame = 0;
    this.lastTick = 0;
  }

  get holding() {
    return this.timer !== null;
  }

  /** Something is held: the keys, or the joystick. */
  hold(source, forward, turn) {
    if (this.dropped.has(source)) return;
    this.held.set(source, [forward, turn]);
    if (this.holding) return;
    this.timer = setInterval(() => this.tick(), PERIOD_MS);
    this.lastTick = performance.now();
    this.watchFrames(this.lastTick);
    this.onState("driving");
    this.send();
  }

  /** It was let go. */
  letGo(source) {
    this.dropped.delete(source);
    if (this.held.delete(source) && this.held.size === 0) this.stop("idle");
  }

  /** Whatever is held does not count any more, until it is let go and held again; with
   * `untilNews` only until something is heard of it. */
  drop(reason, untilNews = false) {
    if (!untilNews) this.held.forEach((_, source) => this.dropped.add(source));
    this.held.clear();
    if (this.holding) this.stop("stopped", reason);
  }

  stop(state, reason) {
    clearInterval(this.timer);
    this.timer = null;
    this.link.tell("drive_release");
    this.onState(state, reason);
  }

  watchFrames(now) {
    this.lastFrame = now;
    if (this.holding) requestAnimationFrame((next) => this.watchFrames(next));
  }

  tick() {
    const now = performance.now();
    const gap = now - this.lastTick;
    this.lastTick = now;
    if (gap > HUNG_MS) {
      this.drop("hung"); // the key may be up since then
    } else if (this.held.has("joystick") && now - this.lastFrame > LATE_MS) {
      this.drop("slow", true); // the finger may be; if it moves, it is not
    } else {
      this.send();
    }
  }

  async send() {
    if (this.unanswered >= MOST_UNANSWERED) return;
    const [forward, turn] = [...this.held.values()].reduce(
      ([x, y], [dx, dy]) => [clamp(x + dx), clamp(y + dy)], [0, 0]);
    this.unanswered += 1;
    try {
      await this.link.call("drive", this.command(forward, turn));
    } catch (error) {
      this.drop(error.message);
    } finally {
      this.unanswered -= 1;
    }
  }
}
