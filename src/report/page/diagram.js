/** The frequency-energy diagram of a sweep. */
import {legendEntry, Plot} from "./plot.js";

import {short, si} from "./units.js";

const mostModes = 30;
const grazing = (n) => (n * Math.PI) ** 2 / 8;  // E/E_g at which the tip of linear mode n reaches the wall

/** What stands for a layer in the legend, and how it is drawn. */
const looks = [
  {name: "linear", title: "linear modes", line: true},
  {name: "modes", title: "exact modes k", line: true},
  {name: "intervals", title: "energy intervals", line: true},
  {name: "absent", title: "level without orbit", mark: "dot"},
  {name: "least", title: "least energy", mark: "diamond", size: 4.5},
  {name: "forceless", title: "without force (free patterns)", mark: "bar", size: 5},
  {name: "solved", title: "orbit, proved the best", mark: "circle", size: 5},
  {name: "unproved", title: "orbit, not proved the best", mark: "square", size: 5},
];

export class Diagram {
  constructor(host, legend, report, pick) {
    this.report = report;
    this.pick = pick;
    const physical = !report.bar.without_units;
    this.units = {energy: physical, hertz: physical, log: true};
    this.collect();
    this.plot =
        new Plot(host, {...this.options(), id: "diagram", name: "frequency-energy diagram; arrows move along the branch"});
    for (const layer of this.plot.options.layers) {
      if (!layer.empty) legend.append(legendEntry(this.plot, layer));
    }
  }

  /** Shows energies in joules, frequencies in hertz, energies on a linear axis, or not. */
  show(units) {
    Object.assign(this.units, units);
    this.plot.set(this.options());
  }

  select(orbit) {
    this.plot.options.selected = orbit === null ? null : this.pointOf(orbit);
    this.plot.draw();
  }

  // Where several orbits have one place a click takes the next one.
  pickOf(points) {
    const orbits = points.map(({orbit}) => orbit).filter((orbit) => orbit);
    if (orbits.length === 0) return;
    const now = orbits.indexOf(this.plot.options.selected ? this.plot.options.selected.orbit : null);
    this.pick(orbits[(now + 1) % orbits.length]);
  }

  energy(ratio) {
    return this.units.energy ? ratio * this.report.bar.energy_unit : ratio;
  }
  frequency(ratio) {
    return this.units.hertz ? ratio * this.report.bar.first_frequency : ratio;
  }

  pointOf(orbit) {
    return {x: this.energy(orbit.energy), y: this.frequency(orbit.pattern.ratio), orbit};
  }

  // Ends of the axes: every orbit, every start of an interval, every level; ends of intervals within a decade of them.
  collect() {
    const {patterns, orbits, levels} = this.report;
    const energies =
        [...orbits.map(({energy}) => energy), ...patterns.map(({least}) => least), ...levels].filter((energy) => energy > 0);
    const ends = patterns.map(({greatest}) => greatest).filter((energy) => energy > 0);
    const most = (values, start) => values.reduce((a, b) => Math.max(a, b), start);
    const least = (values, start) => values.reduce((a, b) => Math.min(a, b), start);
    const hi = energies.length > 0 ? most(energies, 0) : 1;
    this.energies = [
      (energies.length > 0 ? least(energies, Infinity) : 1) / 1.5,
      1.5 * Math.max(hi, Math.min(most(ends, 0), 10 * hi)),
    ];
    const ratios = patterns.map(({ratio}) => ratio);
    const [lo, top] = ratios.length > 0 ? [least(ratios, Infinity), most(ratios, 0)] : [1, 1];
    const spread = top - lo;
    const margin = Math.max(0.04, 0.08 * spread);
    this.frequencies = [Math.max(0, lo - margin), top + 1.5 * margin];
  }

  options() {
    const {units, report} = this;
    const joules = units.energy || report.bar.gap === 0;
    const [least, greatest] = this.energies;
    return {
      x: {
        label: joules ? "energy E (J)" : "energy E/E_g",
        log: units.log,
        lo: this.energy(units.log ? least : 0),
        hi: this.energy(greatest),
        text: (value) => short(value, 3),
      },
      y: {
        label: units.hertz ? "frequency (Hz)" : "frequency ω/ω₁",
        lo: this.frequency(this.frequencies[0]),
        hi: this.frequency(this.frequencies[1]),
        text: (value) => short(value, 4),
      },
      layers: this.layers(),
      selected: this.plot?.options.selected ? this.pointOf(this.plot.options.selected.orbit) : null,
      pick: (points) => this.pickOf(points),
      hint: (point) => this.describe(point),
    };
  }

  describe({orbit, pattern, level}) {
    const {bar} = this.report;
    const of = orbit?.pattern ?? pattern;
    const name =
        `(r = ${of.free}, p = ${of.contact}), ω/ω₁ = ${short(of.ratio, 5)}, ${si(of.ratio * bar.first_frequency, "Hz")}`;
    if (level !== undefined)
      return `${name}: no orbit at ${bar.gap === 0 ? "" : `E/E_g = ${short(level, 6)}, `}${
          si(level * bar.energy_unit, "J")}`;
    if (!orbit) return name;
    const ratio = bar.gap === 0 ? "" : `E/E_g = ${short(orbit.energy, 6)}, `;
    return `${name}: ${ratio}${si(orbit.energy * bar.energy_unit, "J")}${orbit.proof ? `, ${orbit.proof}` : ""}`;
  }

  // Lines through points in the units shown.
  line(points) {
    return (plot) => points
                         .map(
                             (part) => part.map(([energy, frequency], i) => {
                                             const x = plot.x(this.energy(energy));
                                             return `${i === 0 ? "M" : "L"}${x.toFixed(1)} ${
                                                 plot.y(this.frequency(frequency)).toFixed(1)}`;
                                           })
                                           .join(""))
                         .join("");
  }

  modes() {
    const sign = this.report.bar.gap_sign;
    const [least, greatest] = this.energies;
    const parts = [];
    const labels = [];
    for (let k = 1; k <= mostModes; ++k) {
      const part = [];
      for (let i = 0; i <= 200; ++i) {
        const energy = least * (greatest / least) ** (i / 200);
        const period = (2 * k + 1 + sign / Math.sqrt(energy)) / (k * k);
        const inside = sign === 0 || (sign > 0 ? period <= 4 / (2 * k - 1) : period >= 2 / k);
        const frequency = 4 / period;
        if (inside && frequency >= this.frequencies[0] && frequency <= this.frequencies[1]) part.push([energy, frequency]);
      }
      if (part.length < 2) continue;
      parts.push(part);
      const [energy, frequency] = part[Math.floor(part.length / 3)];
      labels.push({x: this.energy(energy), y: this.frequency(frequency), text: `k = ${k}`, anchor: "end"});
    }
    return {parts, labels};
  }

  linear() {
    const sign = this.report.bar.gap_sign;
    const [least, greatest] = this.energies;
    const parts = [];
    const labels = [];
    for (let n = Math.max(1, Math.ceil(this.frequencies[0])); n <= this.frequencies[1]; ++n) {
      const end = n % 2 === 1 && sign > 0 ? Math.min(grazing(n), greatest) : greatest;
      if (end <= least) continue;
      parts.push([[least, n], [end, n]]);
      const text = `${n === 1 ? "" : n}ω₁, ${n % 2 === 1 ? "free end" : "end held"}`;
      labels.push({x: this.energy(least) * 1.05, y: this.frequency(n), text, below: true});
    }
    return {parts, labels};
  }

  layers() {
    const {patterns, orbits, missing} = this.report;
    const modes = this.modes();
    const linear = this.linear();
    const intervals =
        patterns.filter(({kind, least, greatest, unbounded}) => kind === "contact" && (unbounded || greatest > least))
            .map(
                (pattern) => [
                    [Math.max(pattern.least, this.energies[0]), pattern.ratio],
                    [pattern.unbounded ? this.energies[1] : Math.min(pattern.greatest, this.energies[1]), pattern.ratio],
    ]);
    const points = {absent: [], least: [], forceless: [], solved: [], unproved: []};
    for (const {pattern, level} of missing)
      points.absent.push({x: this.energy(level), y: this.frequency(pattern.ratio), pattern, level});
    for (const orbit of orbits) {
      const kind = orbit.forceless ? "forceless" : orbit.level === null ? "least" : orbit.proved ? "solved" : "unproved";
      points[kind].push(this.pointOf(orbit));
    }
    const made = {
      linear: {path: this.line(linear.parts), labels: linear.labels, empty: linear.parts.length === 0},
      modes: {path: this.line(modes.parts), labels: modes.labels, empty: modes.parts.length === 0},
      intervals: {path: this.line(intervals), empty: intervals.length === 0},
    };
    return looks.map((look) => ({
                       ...look,
                       ...(made[look.name] ?? {points: points[look.name], empty: points[look.name].length === 0}),
                     }));
  }
}
