/* global uPlot */
/** Tip displacement and contact force over two periods, with one cursor. */
import {element} from "./plot.js";
import {scaled, short} from "./units.js";

export const periodsShown = 2;

/** A colour of the page's theme. */
export function themed(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export class Curves {
  /** @param hover told the time in steps under the cursor */
  constructor(host, hover) {
    this.host = host;
    this.hover = hover;
    this.plots = [];
    new ResizeObserver(() => this.resize()).observe(host);
  }

  show(motion) {
    this.motion = motion;
    for (const plot of this.plots) plot.destroy();
    this.host.replaceChildren();
    const {period, step, bar} = motion;
    const time = scaled(periodsShown * motion.seconds, "s");
    const steps = Array.from({length: periodsShown * period + 1}, (_, n) => n);
    this.toSteps = time.factor / step;
    const times = steps.map((n) => n * step / time.factor);
    const size = Math.max(...motion.tip.map(Math.abs), Math.abs(bar.gap));
    const length = scaled(size, "m");
    const force = scaled(Math.max(...motion.force.map(Math.abs)), "N");
    const tip = steps.map((n) => motion.tip[n % period] / length.factor);
    const pressing = steps.map((n) => 0 - motion.force[n % period] / force.factor);
    this.plots = [
      this.plot(`tip displacement (${length.unit})`, times, tip, `time (${time.unit})`, {wall: bar.gap / length.factor}),
      this.plot(`contact force (${force.unit})`, times, pressing, `time (${time.unit})`, {stepped: true}),
    ];
  }

  plot(label, times, values, timeLabel, {wall, stepped}) {
    const ink = themed("--ink");
    const axis =
        {stroke: ink, grid: {stroke: themed("--grid"), width: 1}, ticks: {stroke: themed("--grid")}, font: "12px system-ui"};
    const options = {
      width: Math.max(this.host.clientWidth, 200),
      height: 170,
      title: "",
      legend: {show: false},
      cursor: {y: false, sync: {key: "time"}, drag: {x: true, y: false}},
      // Of a force that is zero throughout as well.
      scales:
          {x: {time: false}, y: {range: (_, lo, hi) => (lo === hi ? [lo - 1, hi + 1] : uPlot.rangeNum(lo, hi, 0.1, true))}},
      axes: [
        {...axis, label: timeLabel, labelSize: 18, labelFont: "12px system-ui", size: 34},
        {...axis, label, labelSize: 18, labelFont: "12px system-ui", size: 56},
      ],
      series: [
        {},
        {
          label,
          stroke: themed("--accent"),
          width: 2,
          paths: stepped ? uPlot.paths.stepped({align: 1}) : uPlot.paths.linear(),
          points: {show: false},
          value: (_, value) => short(value, 6),
        },
      ],
      hooks: {
        drawClear: [(plot) => this.shade(plot)],
        drawAxes: [(plot) => wall !== undefined && this.drawWall(plot, wall)],
        setCursor: [(plot) => {
          if (plot.cursor.left >= 0 && plot.cursor.event) this.hover(plot.posToVal(plot.cursor.left, "x") * this.toSteps);
        }],
      },
    };
    const host = element("div", {class: "curve", role: "img", "aria-label": label});
    this.host.append(host);
    return new uPlot(options, [times, values], host);
  }

  // Contact phases are shaded, under all else.
  shade(plot) {
    const {ctx, bbox} = plot;
    const {free, period} = this.motion;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = themed("--shade");
    for (let k = 0; k < periodsShown; ++k) {
      const from = plot.valToPos((k * period + free) / this.toSteps, "x", true);
      const to = plot.valToPos((k + 1) * period / this.toSteps, "x", true);
      ctx.fillRect(from, bbox.top, to - from, bbox.height);
    }
    ctx.restore();
  }

  // A line over the grid.
  drawWall(plot, wall) {
    const {ctx, bbox} = plot;
    const at = plot.valToPos(wall, "y", true);
    ctx.save();
    ctx.strokeStyle = themed("--ink");
    ctx.setLineDash([6, 4]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, at);
    ctx.lineTo(bbox.left + bbox.width, at);
    ctx.stroke();
    ctx.restore();
  }

  /** Puts the cursor at a time in steps. */
  mark(steps) {
    for (const plot of this.plots) {
      const left = plot.valToPos(steps / this.toSteps, "x");
      plot.setCursor({left, top: plot.bbox.height / 2 / devicePixelRatio}, false);
    }
  }

  resize() {
    for (const plot of this.plots) plot.setSize({width: Math.max(this.host.clientWidth, 200), height: 170});
  }

  /** Both curves as one picture. */
  picture() {
    const canvases = this.plots.map((plot) => plot.ctx.canvas);
    const canvas = element("canvas");
    canvas.width = canvases[0].width;
    canvas.height = canvases.reduce((sum, {height}) => sum + height, 0);
    const context = canvas.getContext("2d");
    context.fillStyle = themed("--paper");
    context.fillRect(0, 0, canvas.width, canvas.height);
    let top = 0;
    for (const one of canvases) {
      context.drawImage(one, 0, top);
      top += one.height;
    }
    return canvas;
  }
}
