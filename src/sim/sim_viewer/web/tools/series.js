// The samples of one line of a plot.

const MOST = 30000; // samples; the oldest go first

export class Series {
  constructor() {
    this.clear();
  }

  clear() {
    this.times = []; // s, rising
    this.values = []; // null where there was no number
  }

  /** Samples are `[time, value]`; time that goes back is a reset simulation. */
  add(samples) {
    for (const [time, value] of samples) {
      if (this.times.length && time < this.times.at(-1) - 1) this.clear();
      this.times.push(time);
      this.values.push(value);
    }
    const extra = this.times.length - MOST;
    if (extra > MOST / 10) {
      this.times.splice(0, extra);
      this.values.splice(0, extra);
    }
  }

  last() {
    return this.values.at(-1);
  }

  /** Index of the first sample that is not before `time`. */
  from(time) {
    let [low, high] = [0, this.times.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The value of the last sample at or before `time`; undefined before the first. */
  at(time) {
    const index = this.from(time);
    return this.times[index] === time ? this.values[index] : this.values[index - 1];
  }
}

/** One row a sample: path, time in s, value. */
export function csv(lines) {
  const rows = ["path,time_s,value"];
  for (const { path, series } of lines) {
    series.times.forEach((time, i) => rows.push(`"${path}",${time},${series.values[i] ?? ""}`));
  }
  return `${rows.join("\n")}\n`;
}
