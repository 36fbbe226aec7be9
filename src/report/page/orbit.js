/**
 * The motion of an orbit from its amplitudes alone: the bar is a queue of 2N waves. A wave b_n reaches the tip in step n
 * and comes back 2N steps later, turned over by free flight and as it was by contact.
 */

function gcd(a, b) {
  return b === 0 ? a : gcd(b, a % b);
}

/** Signs of the waves, and the amplitude that each class of steps n mod g carries (-1: none). */
function kernelOf(cells, free, period) {
  const classes = gcd(2 * cells, period);
  const shift = (2 * cells) % period;
  const sign = new Int8Array(period);
  const amplitude = new Int32Array(classes).fill(-1);
  let count = 0;
  for (let first = 0; first < classes; ++first) {
    let turned = 1;
    const steps = [];
    let n = first;
    do {
      sign[n] = turned;
      steps.push(n);
      if (n < free) turned = -turned;
      n = (n + shift) % period;
    } while (n !== first);
    if (turned === 1) {
      amplitude[first] = count++;
    } else {
      for (const step of steps) sign[step] = 0;
    }
  }
  return {classes, sign, amplitude};
}

/** One orbit of a bar: everything in SI units, times in steps of `step` seconds. */
export class Motion {
  constructor(bar, cells, free, contact, beta) {
    Object.assign(this, {bar, cells, free, contact});
    this.period = free + contact;
    this.step = bar.travel_time / cells;
    const {classes, sign, amplitude} = kernelOf(cells, free, this.period);
    const unit = bar.displacement_unit;
    const shape = new Float64Array(this.period);  // b_n in units u/dt
    for (let n = 0; n < this.period; ++n) {
      const column = amplitude[n % classes];
      if (column >= 0) shape[n] = sign[n] * beta[column];
    }
    /** b_n [m/s] */
    this.wave = shape.map((b) => b * (unit / this.step));
    let rest = 0;
    for (let n = 0; n < 2 * cells; ++n) rest -= shape[n % this.period];
    /** x_n [m], n = 0..n_T */
    this.tip = new Float64Array(this.period + 1).fill(rest);
    for (let n = 0; n + 1 < free; ++n) this.tip[n + 1] = this.tip[n] + 2 * shape[n];
    this.tip = this.tip.map((x) => x * unit);
    /** Force of the wall [N], < 0 presses; n = 0..n_T-1 */
    this.force = this.wave.map((b, n) => (n < free ? 0 : -2 * bar.impedance * bar.area * b));
    this.sums = new Float64Array(this.period + 1);
    for (let n = 0; n < this.period; ++n) this.sums[n + 1] = this.sums[n] + this.wave[n];
  }

  get seconds() {
    return this.period * this.step;
  }

  waveAt(when) {
    const n = Math.floor(when) % this.period;
    return this.wave[n < 0 ? n + this.period : n];
  }

  // The integral of b up to a time, in steps.
  integral(when) {
    const rounds = Math.floor(when / this.period);
    const rest = when - rounds * this.period;
    const n = Math.min(Math.floor(rest), this.period - 1);
    return rounds * this.sums[this.period] + this.sums[n] + (rest - n) * this.wave[n];
  }

  /** [Pa], tension > 0; `place` in cells from the held end. */
  stress(place, when) {
    return -this.bar.impedance * (this.waveAt(when + this.cells - place) + this.waveAt(when + this.cells + place));
  }

  /** [m/s], to the wall > 0. */
  velocity(place, when) {
    return this.waveAt(when + this.cells - place) - this.waveAt(when + this.cells + place);
  }

  /** [m], to the wall > 0. */
  displacement(place, when) {
    return -this.step * (this.integral(when + this.cells + place) - this.integral(when + this.cells - place));
  }

  /** Tip displacement [m] at a time in steps: straight between two steps. */
  tipAt(when) {
    const phase = when - Math.floor(when / this.period) * this.period;
    const n = Math.min(Math.floor(phase), this.period - 1);
    return this.tip[n] + (phase - n) * (this.tip[n + 1] - this.tip[n]);
  }

  forceAt(when) {
    const n = Math.floor(when) % this.period;
    return this.force[n < 0 ? n + this.period : n];
  }

  /** What each condition leaves, and the steps at which it binds. */
  conditions() {
    const near = 1e-9 * this.bar.displacement_unit;
    const none = 1e-9 * Math.max(...this.force.map(Math.abs), Number.MIN_VALUE);
    const touching = [];
    let clearance = Infinity;
    let closest = 0;
    for (let n = 1; n < this.free; ++n) {
      const left = this.bar.gap - this.tip[n];
      if (left < clearance) [clearance, closest] = [left, n];
      if (left <= near) touching.push(n);
    }
    const silent = [];
    let weakest = Infinity;
    for (let n = this.free; n < this.period; ++n) {
      weakest = Math.min(weakest, -this.force[n]);
      if (-this.force[n] <= none) silent.push(n);
    }
    return {clearance, closest, touching, weakest, silent};
  }
}
