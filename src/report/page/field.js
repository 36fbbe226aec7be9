/** Stress, velocity or displacement over bar and time, on a canvas: time to the right, the wall at the top. */
import {periodsShown, themed} from "./curves.js";
import {scaled, short} from "./units.js";

const kinds = {
  stress: {title: "stress, tension > 0", unit: "Pa"},
  velocity: {title: "velocity, to the wall > 0", unit: "m/s"},
  displacement: {title: "displacement, to the wall > 0", unit: "m"},
};

// Negative blue, nothing white, positive orange; in grey only what is negative grows dark.
const palette = [
  [0, 8, 48, 107],
  [0.25, 63, 136, 197],
  [0.42, 198, 219, 239],
  [0.5, 255, 255, 255],
  [0.58, 253, 230, 200],
  [0.75, 247, 178, 103],
  [1, 232, 137, 43],
];

/** The colour of a share in [-1, 1] of the greatest value. */
export function colourOf(share) {
  const at = (share + 1) / 2;
  const upper = Math.max(1, palette.findIndex(([place]) => place >= at));
  const [a, b] = [palette[upper - 1], palette[upper]];
  const part = (at - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map((i) => Math.round(a[i] + part * (b[i] - a[i])));
}

export class SpaceTime {
  constructor(canvas, hover) {
    this.canvas = canvas;
    this.kind = "stress";
    this.margin = {left: 62, right: 8, top: 22, bottom: 34};
    canvas.addEventListener("pointermove", (event) => {
      if (!this.motion) return;
      const box = canvas.getBoundingClientRect();
      const share = (event.clientX - box.left - this.margin.left) / this.width;
      if (share >= 0 && share <= 1) hover(share * periodsShown * this.motion.period);
    });
    new ResizeObserver(() => this.motion && this.show(this.motion)).observe(canvas.parentElement);
  }

  choose(kind) {
    this.kind = kind;
    if (this.motion) this.show(this.motion);
  }

  show(motion) {
    this.motion = motion;
    const scale = devicePixelRatio;
    const [outer, height] = [this.canvas.parentElement.clientWidth, 240];
    this.canvas.width = outer * scale;
    this.canvas.height = height * scale;
    this.canvas.style.height = `${height}px`;
    const {left, right, top, bottom} = this.margin;
    this.width = Math.max(outer - left - right, 10);
    this.height = height - top - bottom;
    this.paint();
    this.draw(scale);
  }

  // The field itself, at most 128 000 samples, off the places and times at which a front passes.
  paint() {
    const {motion} = this;
    const columns = Math.min(Math.round(this.width), 800);
    const rows = Math.min(Math.round(this.height), 160);
    const values = new Float64Array(columns * rows);
    let largest = 0;
    for (let row = 0; row < rows; ++row) {
      const place = (1 - (row + 0.25) / rows) * motion.cells;
      for (let column = 0; column < columns; ++column) {
        const value = motion[this.kind](place, (column + 0.5) / columns * periodsShown * motion.period);
        values[row * columns + column] = value;
        largest = Math.max(largest, Math.abs(value));
      }
    }
    this.largest = largest;
    const image = new ImageData(columns, rows);
    values.forEach((value, i) => {
      image.data.set([...colourOf(largest > 0 ? value / largest : 0), 255], 4 * i);
    });
    this.image = new OffscreenCanvas(columns, rows);
    this.image.getContext("2d").putImageData(image, 0, 0);
  }

  draw(scale) {
    const {motion, width, height} = this;
    const {left, top} = this.margin;
    const context = this.canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.fillStyle = themed("--paper");
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.image, left, top, width, height);
    context.strokeStyle = context.fillStyle = themed("--ink");
    context.strokeRect(left, top, width, height);
    context.font = "12px system-ui";
    context.textAlign = "left";
    const {title, unit} = kinds[this.kind];
    const shown = scaled(this.largest, unit);
    const limit = short(this.largest / shown.factor, 3);
    context.fillText(`${title}; blue −${limit} to orange ${limit} ${shown.unit}; bar above: contact`, left, 14, width);
    context.textAlign = "right";
    context.fillText("wall", left - 6, top + 10);
    context.fillText("held end", left - 6, top + height);
    const time = scaled(periodsShown * motion.seconds, "s");
    for (let k = 0; k < periodsShown; ++k) {
      const from = left + width * (k * motion.period + motion.free) / (periodsShown * motion.period);
      context.fillRect(from, top - 4, width * motion.contact / (periodsShown * motion.period), 4);
    }
    context.textAlign = "center";
    for (let i = 0; i <= 4; ++i) {
      const text = short(i / 4 * periodsShown * motion.seconds / time.factor, 3);
      context.fillText(
          i === 4 ? `${text} ${time.unit}` : text, left + Math.min(width * i / 4, width - 22), top + height + 16);
    }
  }

  /** A line at a time in steps. */
  mark(steps) {
    if (!this.motion) return;
    const scale = devicePixelRatio;
    this.draw(scale);
    const context = this.canvas.getContext("2d");
    const at = this.margin.left + this.width * steps / (periodsShown * this.motion.period);
    context.beginPath();
    context.moveTo(at, this.margin.top);
    context.lineTo(at, this.margin.top + this.height);
    context.strokeStyle = "#000";
    context.stroke();
  }
}
