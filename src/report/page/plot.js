/** Axes in SVG with layers of marks: zoomed by wheel, drag, buttons and keys; nearest mark under the pointer. */

const svgNamespace = "http://www.w3.org/2000/svg";

/** An element of HTML with attributes, text and children. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) {
      made.addEventListener(key.slice(2), value);
    } else if (value !== false && value !== null) {
      made.setAttribute(key, value === true ? "" : value);
    }
  }
  made.append(...children);
  return made;
}

export function shape(name, attributes = {}, text = "") {
  const made = document.createElementNS(svgNamespace, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== "") made.textContent = text;
  return made;
}

/** A box that shows a layer of a plot or hides it, with what stands for it: a mark, or a line. */
export function legendEntry(plot, {name, title, mark, size, line}) {
  const box = element("input", {type: "checkbox", checked: true, onchange: ({target}) => plot.toggle(name, target.checked)});
  const swatch = shape("svg", {viewBox: "0 0 26 14", class: "swatch", "aria-hidden": "true"});
  swatch.append(shape("path", {d: line ? "M1 7H25" : marks[mark](13, 7, size ?? 4), class: `layer ${name}`}));
  return element("label", {}, box, swatch, title);
}

/** The path of a mark of some radius about a point. */
export const marks = {
  circle: (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${- 2 * r} 0`,
  square: (x, y, r) => `M${x - r} ${y - r}h${2 * r}v${2 * r}h${- 2 * r}z`,
  diamond: (x, y, r) => `M${x} ${y - r}l${r} ${r}l${- r} ${r}l${- r} ${- r}z`,
  triangle: (x, y, r) => `M${x} ${y - r}l${r} ${1.7 * r}h${- 2 * r}z`,
  down: (x, y, r) => `M${x} ${y + r}l${r} ${- 1.7 * r}h${- 2 * r}z`,
  cross: (x, y, r) => `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${- 2 * r}l${- 2 * r} ${2 * r}`,
  plus: (x, y, r) => `M${x - r} ${y}h${2 * r}M${x} ${y - r}v${2 * r}`,
  dot: (x, y) => `M${x} ${y}h0`,
  bar: (x, y, r) => `M${x} ${y - r}v${2 * r}`,
};

function linearTicks(lo, hi, wanted) {
  const rough = (hi - lo) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const ticks = [];
  for (let k = Math.ceil(lo / step); k * step <= hi; ++k) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

function logTicks(lo, hi) {
  const decades = Math.log10(hi / lo);
  if (decades < 0.7) return linearTicks(lo, hi, 5);
  const factors = decades < 2.5 ? [1, 2, 5] : [1];
  const every = Math.max(1, Math.ceil(decades / 7));
  const ticks = [];
  for (let power = Math.floor(Math.log10(lo)); power <= Math.log10(hi); ++power) {
    if (power % every !== 0) continue;
    for (const factor of factors) {
      const tick = Number((factor * 10 ** power).toPrecision(12));
      if (tick >= lo && tick <= hi) ticks.push(tick);
    }
  }
  return ticks;
}

export class Plot {
  /**
   * @param host element that the plot fills
   * @param options x, y: {label, log, lo, hi, text(value)}; layers: [{name, title, mark, points, path(plot)}] from bottom
   *   to top, drawn as one path each; pick(point) when a mark is clicked; hint(point) for the line under the pointer
   */
  constructor(host, options) {
    this.host = host;
    this.options = options;
    this.hidden = new Set();
    this.margin = {left: 62, right: 14, top: 12, bottom: 46};
    this.svg = shape("svg", {role: "application", tabindex: "0", "aria-label": options.name});
    this.hint = element("output", {class: "hint", "aria-live": "off", hidden: true});
    host.replaceChildren(this.svg, this.hint);
    this.reset();
    this.listen();
    new ResizeObserver(() => this.draw()).observe(host);
  }

  reset() {
    const {x, y} = this.options;
    this.view = {x: [x.lo, x.hi], y: [y.lo, y.hi]};
    this.draw();
  }

  set(options) {
    Object.assign(this.options, options);
    this.reset();
  }

  /** Shows a layer or hides it. */
  toggle(name, shown) {
    if (shown)
      this.hidden.delete(name);
    else
      this.hidden.add(name);
    this.draw();
  }

  fraction(axis, value) {
    const [lo, hi] = this.view[axis];
    return this.options[axis].log ? Math.log(value / lo) / Math.log(hi / lo) : (value - lo) / (hi - lo);
  }

  valueAt(axis, fraction) {
    const [lo, hi] = this.view[axis];
    return this.options[axis].log ? lo * (hi / lo) ** fraction : lo + fraction * (hi - lo);
  }

  /** Pixels of a point. */
  x(value) {
    return this.margin.left + this.fraction("x", value) * this.inner.width;
  }
  y(value) {
    return this.margin.top + (1 - this.fraction("y", value)) * this.inner.height;
  }

  zoom(factor, place = {x: 0.5, y: 0.5}) {
    for (const axis of ["x", "y"]) {
      this.look(axis, place[axis] - place[axis] * factor, place[axis] + (1 - place[axis]) * factor);
    }
    this.draw();
  }

  // Shows what lies between two shares of the axis: never more than the whole, nor less than can be told apart.
  look(axis, from, to) {
    const {lo, hi, log} = this.options[axis];
    const [least, greatest] = [from, to].map((share) => this.valueAt(axis, share));
    const span = log ? Math.log(greatest / least) : greatest - least;
    const whole = log ? Math.log(hi / lo) : hi - lo;
    if (!(span > 1e-9 * whole)) return;
    this.view[axis] = span < whole ? [least, greatest] : [lo, hi];
  }

  get isWhole() {
    return ["x", "y"].every(
        (axis) => this.view[axis][0] === this.options[axis].lo && this.view[axis][1] === this.options[axis].hi);
  }

  draw() {
    const width = this.host.clientWidth || 640;
    const height = this.host.clientHeight || 400;
    const {left, right, top, bottom} = this.margin;
    this.inner = {width: Math.max(width - left - right, 10), height: Math.max(height - top - bottom, 10)};
    this.svg.replaceChildren();
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.drawAxes(width, height);
    const clip = `clip-${this.options.id}`;
    const definitions = shape("clipPath", {id: clip});
    definitions.append(shape("rect", {x: left, y: top, width: this.inner.width, height: this.inner.height}));
    this.svg.append(definitions);
    const body = shape("g", {"clip-path": `url(#${clip})`});
    this.svg.append(body);
    for (const layer of this.options.layers) {
      if (this.hidden.has(layer.name)) continue;
      const path = layer.path ? layer.path(this) : this.markPath(layer);
      if (path !== "") body.append(shape("path", {d: path, class: `layer ${layer.name}`}));
      for (const {x, y, text, anchor, below} of layer.labels ?? []) {
        const place = {x: this.x(x), y: this.y(y) + (below ? 14 : -5), class: "note", "text-anchor": anchor ?? "start"};
        body.append(shape("text", place, text));
      }
    }
    if (this.options.selected) {
      const {x, y} = this.options.selected;
      body.append(shape("path", {d: marks.circle(this.x(x), this.y(y), 9), class: "selected"}));
    }
    this.box = shape("rect", {class: "drag", width: 0, height: 0});
    this.svg.append(this.box);
  }

  markPath(layer) {
    const mark = marks[layer.mark];
    let path = "";
    for (const point of layer.points) {
      const x = Math.round(10 * this.x(point.x)) / 10;
      const y = Math.round(10 * this.y(point.y)) / 10;
      if (x > -20 && x < 4000 && y > -20 && y < 4000) path += mark(x, y, layer.size ?? 4);
    }
    return path;
  }

  drawAxes(width, height) {
    const {left, top} = this.margin;
    const {x, y} = this.options;
    const end = top + this.inner.height;
    const ticks = (axis, wanted) => {
      const [lo, hi] = this.view[axis];
      return this.options[axis].log ? logTicks(lo, hi) : linearTicks(lo, hi, wanted);
    };
    const grid = shape("g", {class: "axis"});
    for (const value of ticks("x", Math.max(3, this.inner.width / 90))) {
      const at = this.x(value);
      grid.append(shape("line", {x1: at, x2: at, y1: top, y2: end}));
      grid.append(shape("text", {x: at, y: end + 17, "text-anchor": "middle"}, x.text(value)));
    }
    for (const value of ticks("y", Math.max(3, this.inner.height / 50))) {
      const at = this.y(value);
      grid.append(shape("line", {x1: left, x2: left + this.inner.width, y1: at, y2: at}));
      grid.append(shape("text", {x: left - 7, y: at + 4, "text-anchor": "end"}, y.text(value)));
    }
    const middle = top + this.inner.height / 2;
    grid.append(shape("text", {x: left + this.inner.width / 2, y: height - 8, "text-anchor": "middle"}, x.label));
    const turned = {x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})`};
    grid.append(shape("text", turned, y.label));
    grid.append(shape("path", {d: `M${left} ${top}V${end}H${left + this.inner.width}`, class: "frame"}));
    this.svg.append(grid);
  }

  /** The marks at the one nearest to a place in pixels, of the layers that are shown; the uppermost first. */
  nearest(px, py, reach = 18) {
    const shown = this.options.layers.filter((layer) => layer.points && !this.hidden.has(layer.name));
    const points = shown.reverse().flatMap((layer) => layer.points);
    const apart = (point, x, y) => (this.x(point.x) - x) ** 2 + (this.y(point.y) - y) ** 2;
    let best = null;
    for (const point of points) {
      if (apart(point, px, py) <= (best === null ? reach ** 2 : apart(best, px, py) - 1e-9)) best = point;
    }
    if (best === null) return [];
    const [x, y] = [this.x(best.x), this.y(best.y)];
    return points.filter((point) => apart(point, x, y) < 1);
  }

  place(event) {
    const box = this.svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  fractions([px, py]) {
    return {x: (px - this.margin.left) / this.inner.width, y: 1 - (py - this.margin.top) / this.inner.height};
  }

  showHint(points, px, py) {
    this.hint.hidden = points.length === 0;
    if (points.length === 0) return;
    const more = points.length > 1 ? ` (1 of ${points.length} here; click again for the next)` : "";
    this.hint.textContent = this.options.hint(points[0]) + more;
    const right = px > this.host.clientWidth / 2;
    this.hint.style.left = right ? "" : `${px + 14}px`;
    this.hint.style.right = right ? `${this.host.clientWidth - px + 14}px` : "";
    this.hint.style.top = `${Math.max(py - 12, 0)}px`;
  }

  listen() {
    let from = null;
    const forget = () => {
      from = null;
      for (const size of ["width", "height"]) this.box.setAttribute(size, 0);
    };
    this.svg.addEventListener("wheel", (event) => {
      const factor = Math.exp(0.002 * Math.max(-200, Math.min(200, event.deltaY)));
      if (factor > 1 && this.isWhole) return;  // the page scrolls
      event.preventDefault();
      this.zoom(factor, this.fractions(this.place(event)));
    }, {passive: false});
    this.svg.addEventListener("pointerdown", (event) => {
      this.dragged = false;
      if (event.button === 0 && event.pointerType !== "touch") from = this.place(event);
    });
    this.svg.addEventListener("pointermove", (event) => {
      const [px, py] = this.place(event);
      if (from !== null) {
        const box = {x: Math.min(px, from[0]), y: Math.min(py, from[1])};
        const size = {width: Math.abs(px - from[0]), height: Math.abs(py - from[1])};
        for (const [key, value] of Object.entries({...box, ...size})) this.box.setAttribute(key, value);
      }
      this.showHint(this.nearest(px, py), px, py);
    });
    this.svg.addEventListener("pointerleave", () => this.showHint([]));
    window.addEventListener("pointercancel", forget);
    window.addEventListener("pointerup", (event) => {
      const start = from;
      forget();
      if (start === null) return;
      const end = this.place(event);
      const wide = [0, 1].map((i) => Math.abs(end[i] - start[i]) >= 6);
      if (!wide[0] && !wide[1]) return;
      this.dragged = true;  // the click that follows picks nothing
      const [a, b] = [this.fractions(start), this.fractions(end)];
      ["x", "y"].forEach((axis, i) => {
        if (wide[i]) this.look(axis, Math.min(a[axis], b[axis]), Math.max(a[axis], b[axis]));
      });
      this.draw();
    });
    this.svg.addEventListener("click", (event) => {
      if (this.dragged || !this.options.pick) return;
      const points = this.nearest(...this.place(event));
      if (points.length > 0) this.options.pick(points);
    });
    this.svg.addEventListener("dblclick", () => this.reset());
    this.svg.addEventListener("keydown", (event) => {
      const known = {"+": () => this.zoom(0.8), "-": () => this.zoom(1.25), 0: () => this.reset()};
      if (!(event.key in known)) return;
      known[event.key]();
      event.preventDefault();
    });
  }
}
