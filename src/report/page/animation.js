/** The bar against the wall, its displacements drawn larger: played, paused, or put at a time. */
import {themed} from "./curves.js";
import {colourOf} from "./field.js";
import {short, si} from "./units.js";

const stations = 60;

export class Animation {
  /** @param controls {canvas, play, slower (select), slider, output}; @param moved told the time in steps */
  constructor(controls, moved) {
    Object.assign(this, controls);
    this.moved = moved;
    this.time = 0;
    this.playing = false;
    this.play.addEventListener("click", () => this.run(!this.playing));
    this.slider.addEventListener("input", () => {
      this.run(false);
      this.to(Number(this.slider.value));
    });
    new ResizeObserver(() => this.motion && this.draw()).observe(this.canvas.parentElement);
  }

  show(motion) {
    this.motion = motion;
    this.slider.max = String(2 * motion.period);
    let [low, high, stress] = [motion.bar.gap, motion.bar.gap, 0];
    for (const x of motion.tip) [low, high] = [Math.min(low, x), Math.max(high, x)];
    for (const b of motion.wave) stress = Math.max(stress, 2 * motion.bar.impedance * Math.abs(b));
    Object.assign(this, {low: Math.min(low, 0), high: Math.max(high, 0), stress});
    this.to(0);
  }

  run(playing) {
    if (playing === this.playing) return;
    this.playing = playing;
    this.play.textContent = playing ? "Pause" : "Play";
    let before = null;
    const frame = (now) => {
      if (!this.playing) return;
      const seconds = before === null ? 0 : (now - before) / 1000;
      before = now;
      const rate = this.motion.period / Number(this.slower.value);
      this.to((this.time + seconds * rate) % (2 * this.motion.period));
      requestAnimationFrame(frame);
    };
    if (playing) requestAnimationFrame(frame);
  }

  /** Draws the bar at a time in steps. */
  to(time) {
    this.time = time;
    this.slider.value = String(time);
    const {motion} = this;
    const share = time / motion.period;
    this.output.textContent = `t = ${si(time * motion.step, "s", 4)} = ${short(share, 3)} T, ` +
        `tip at ${si(motion.tipAt(time), "m", 4, motion.bar.displacement_unit)}, force ${
                                  si(-motion.forceAt(time), "N", 4, motion.bar.impedance * motion.bar.area)}`;
    this.draw();
    this.moved(time);
  }

  draw() {
    const {motion, canvas} = this;
    const scale = devicePixelRatio;
    const [width, height] = [canvas.parentElement.clientWidth, 130];
    canvas.width = width * scale;
    canvas.height = height * scale;
    canvas.style.height = `${height}px`;
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    const [left, right, top, bottom] = [24, width - 70, 34, 92];
    // Displacements take a fifth of the width, and less where the bar would fold over itself.
    const strain = this.stress * motion.bar.travel_time / (motion.bar.impedance * motion.bar.length);
    const most = 0.6 * (right - left) / (motion.bar.length * Math.max(strain, Number.MIN_VALUE));
    const enlarge = Math.min(0.2 * (right - left) / Math.max(this.high - this.low, Number.MIN_VALUE), most);
    const rest = right - this.high * enlarge;
    const place = (cells) => left + (rest - left) * cells / motion.cells + enlarge * motion.displacement(cells, this.time);
    context.fillStyle = themed("--paper");
    context.fillRect(0, 0, width, height);
    context.fillStyle = themed("--shade");
    context.fillRect(6, top - 14, left - 6, bottom - top + 28);
    const wall = rest + enlarge * motion.bar.gap;
    context.fillRect(wall, top - 14, 40, bottom - top + 28);
    let from = place(0);
    for (let i = 1; i <= stations; ++i) {
      const to = place(motion.cells * i / stations);
      const stress = motion.stress(motion.cells * (i - 0.5) / stations, this.time);
      context.fillStyle = `rgb(${colourOf(this.stress > 0 ? stress / this.stress : 0).join(" ")})`;
      context.fillRect(from, top, Math.max(to - from, 0.5) + 0.5, bottom - top);
      from = to;
    }
    context.strokeStyle = "#333";  // on colours that no theme changes
    context.strokeRect(left, top, from - left, bottom - top);
    context.beginPath();
    for (let i = 1; i < stations; i += 6) {
      const at = place(motion.cells * i / stations);
      context.moveTo(at, top);
      context.lineTo(at, bottom);
    }
    context.stroke();
    context.fillStyle = themed("--ink");
    context.font = "12px system-ui";
    context.fillText("held end", 6, top - 20);
    context.fillText("wall", wall + 6, top - 20);
    context.fillText(
        `displacements × ${short(enlarge * motion.bar.length / (rest - left), 3)}; colour: stress`, left, bottom + 30);
    // What a reader of the page, or a test of it, can ask for.
    canvas.dataset.time = String(this.time);
    canvas.dataset.tip = String(motion.displacement(motion.cells, this.time));
  }
}
