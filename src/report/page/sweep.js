/** The page of a sweep: diagram, one orbit, table. */
import {Animation} from "./animation.js";
import {Curves} from "./curves.js";
import {showDetails} from "./details.js";
import {Diagram} from "./diagram.js";
import {motionCsv, saveCsv, saveDrawing, savePng, saveSvg} from "./download.js";
import {SpaceTime} from "./field.js";
import {Motion} from "./orbit.js";
import {Table} from "./table.js";
import {short, si} from "./units.js";

/** What the program wrote, with patterns and orbits as objects. */
export function reportOf(data) {
  const patternAt = new Map();
  const key = (free, contact) => `${free},${contact}`;
  const column = (fields) => new Map(fields.map((name, i) => [name, i]));
  const patternColumn = column(data.pattern_fields);
  const patterns = data.patterns.map((row) => {
    const get = (name) => row[patternColumn.get(name)];
    const pattern = {
      free: get("free_steps"),
      contact: get("contact_steps"),
      m: get("kernel_dimension"),
      verdict: get("verdict"),
      kind: get("kind"),
      least: get("energy_least"),
      greatest: get("energy_greatest"),
      unbounded: get("energy_unbounded"),
      leastExact: get("energy_min_exact"),
      greatestExact: get("energy_max_exact"),
      proved: get("proved"),
    };
    pattern.ratio = 4 * data.cells / (pattern.free + pattern.contact);
    patternAt.set(key(pattern.free, pattern.contact), pattern);
    return pattern;
  });
  const answerColumn = column(data.answer_fields);
  const rows = data.answers.map((row) => {
    const get = (name) => row[answerColumn.get(name)] ?? null;
    const orbit = get("beta") !== null;
    return {
      get,
      pattern: patternAt.get(key(get("free_steps"), get("contact_steps"))),
      level: get("level"),
      verdict: get("verdict"),
      energy: get("energy"),
      proof: get("proof"),
      proved: get("global"),
      forceless: get("forceless"),
      orbit,
      copy: get("copy"),
    };
  });
  const prices = data.prices.map((one) => ({...one, pattern: patternAt.get(key(one.free_steps, one.contact_steps))}));
  return {
    ...data,
    patterns,
    rows,
    prices,
    orbits: rows.filter(({orbit}) => orbit),
    missing:
        rows.filter(({orbit, level, verdict}) => !orbit && level !== null && (verdict === "below" || verdict === "above")),
  };
}

const columnsOf = ({bar}) =>
    [{title: "r", value: ({pattern}) => pattern.free, text: ({pattern}) => String(pattern.free)},
     {title: "p", value: ({pattern}) => pattern.contact, text: ({pattern}) => String(pattern.contact)},
     {title: "ω/ω₁", value: ({pattern}) => pattern.ratio, text: ({pattern}) => short(pattern.ratio, 5)},
     {
       title: "f",
       value: ({pattern}) => pattern.ratio,
       text: ({pattern}) => si(pattern.ratio * bar.first_frequency, "Hz", 5)
     },
     {title: "m", value: ({pattern}) => pattern.m, text: ({pattern}) => String(pattern.m)},
     {
       title: bar.gap === 0 ? "level (J)" : "level (E/E_g)",
       value: ({level}) => level,
       text: ({level}) => (level === null ? "least energy" : short(level, 6))
     },
     {title: "verdict", value: ({verdict}) => verdict, text: ({verdict}) => (verdict === "admissible" ? "orbit" : verdict)},
     {
       title: "E",
       value: ({energy}) => energy,
       text: ({energy}) => (energy === null ? "" : si(energy * bar.energy_unit, "J", 5))
     },
     {
       title: "peak force",
       value: ({get}) => get("peak_force_n"),
       text: ({get, orbit}) => (orbit ? si(get("peak_force_n"), "N", 4) : "")
     },
     {
       title: "gap",
       value: ({get}) => get("objective_gap"),
       text: ({get}) => (get("objective_gap") === null ? "" : `${short(100 * get("objective_gap"), 2)} %`)
     },
     {title: "proof", value: ({proof}) => proof, text: ({proof}) => proof ?? ""},
     {
       title: "kind",
       value: ({pattern}) => pattern.kind,
       text: ({pattern, forceless}) => `${pattern.kind}${forceless ? ", no force" : ""}`
     },
     {title: "distinct",
      value: ({copy}) => copy,
      text: ({copy, orbit}) =>
          (!orbit   ? "" :
               copy ? "seen above" :
                      "new")},
];

// An orbit worth looking at first: of the pattern with most amplitudes, at a middle energy.
function middle(orbits) {
  const levels = orbits.filter(({level, forceless}) => level !== null && !forceless);
  if (levels.length === 0) return orbits[0];
  const {pattern} = levels.reduce((a, b) => (b.pattern.m > a.pattern.m ? b : a));
  const of = levels.filter((orbit) => orbit.pattern === pattern);
  return of[Math.floor(of.length / 2)];
}

export class SweepPage {
  constructor(data, find) {
    this.report = reportOf(data);
    const {report} = this;
    const show = (time) => this.mark(time);
    this.diagram = new Diagram(find("#diagram"), find("#legend"), report, (orbit) => this.choose(orbit));
    this.curves = new Curves(find("#curves"), (time) => this.hover(time));
    this.field = new SpaceTime(find("#field"), (time) => this.hover(time));
    this.animation = new Animation(
        {
          canvas: find("#bar"),
          play: find("#play"),
          slower: find("#slower"),
          slider: find("#time"),
          output: find("#moment"),
        },
        show);
    this.table = new Table(find("#levels"), columnsOf(report), report.rows, (row) => row.orbit && this.choose(row));
    this.table.counted = (shown, all) => {
      const left = report.left_out > 0 ? `; ${report.left_out} more are in levels.csv only` : "";
      find("#count").textContent = (shown === all ? `${all} rows` : `${shown} of ${all} rows`) + left;
    };
    this.table.arrange();
    this.find = find;
    find("#filter").addEventListener("input", ({target}) => this.table.filter(target.value));
    find("#kind").addEventListener("change", ({target}) => this.field.choose(target.value));
    const units = {
      "#joules": (on) => ({energy: on}),
      "#hertz": (on) => ({hertz: on}),
      "#linear": (on) => ({log: !on}),
    };
    find("#joules").checked = this.diagram.units.energy || report.bar.gap === 0;
    find("#joules").disabled = report.bar.gap === 0;  // without E_g
    find("#hertz").checked = this.diagram.units.hertz;
    for (const [box, of] of Object.entries(units)) {
      find(box).addEventListener("change", ({target}) => this.diagram.show(of(target.checked)));
    }
    find("#zoom-in").addEventListener("click", () => this.diagram.plot.zoom(0.7));
    find("#zoom-out").addEventListener("click", () => this.diagram.plot.zoom(1 / 0.7));
    find("#zoom-reset").addEventListener("click", () => this.diagram.plot.reset());
    find("#diagram").addEventListener("keydown", (event) => this.key(event));
    this.downloads();
    window.addEventListener("hashchange", () => this.follow());
    if (report.orbits.length === 0) {
      find("#orbit-name").textContent = "No orbit was found: the table says why.";
      find("#orbit").replaceChildren(find("#orbit-name"));
      return;
    }
    if (!this.follow()) this.choose(middle(report.orbits), this.find("#message").textContent);
  }

  downloads() {
    const name = (what, ending) => {
      const {pattern, level} = this.orbit;
      return `orbit-${pattern.free}-${pattern.contact}${level === null ? "" : `-${short(level, 6)}`}${what}.${ending}`;
    };
    const actions = {
      "#save-csv": () => saveCsv(name("", "csv"), motionCsv(this.motion)),
      "#save-curves": () => savePng(name("-motion", "png"), this.curves.picture()),
      "#save-field": () => savePng(name(`-${this.field.kind}`, "png"), this.field.canvas),
      "#save-svg": () => saveSvg("diagram.svg", this.diagram.plot.svg),
      "#save-png": () => saveDrawing("diagram.png", this.diagram.plot.svg),
    };
    for (const [button, action] of Object.entries(actions)) this.find(button).addEventListener("click", action);
  }

  /** The orbit that the address names; false where it names none. */
  follow() {
    const said = new URLSearchParams(location.hash.slice(1));
    if (!said.has("r") || !said.has("p")) return false;
    const [free, contact] = [Number(said.get("r")), Number(said.get("p"))];
    const energy = said.get("E");
    const level =
        energy === null ? null : Number.parseFloat(energy) / (energy.endsWith("J") ? this.report.bar.energy_unit : 1);
    const of = this.report.orbits.filter(({pattern}) => pattern.free === free && pattern.contact === contact);
    const found = of.find((orbit) => orbit.level === level) ??
        (level === null ? of[0] : of.find((orbit) => Math.abs(orbit.energy / level - 1) < 1e-6));
    if (!found) {
      this.find("#message").textContent =
          `No orbit of (r = ${free}, p = ${contact})${energy === null ? "" : ` at ${energy}`} is in this report.`;
      return false;
    }
    if (found !== this.orbit) this.choose(found);
    return true;
  }

  /** Shows an orbit; with a message the address stays as it is. */
  choose(orbit, message = "") {
    const {report, find} = this;
    this.orbit = orbit;
    const {pattern, level} = orbit;
    this.motion = new Motion(report.bar, report.cells, pattern.free, pattern.contact, orbit.get("beta"));
    find("#message").textContent = message;
    find("#orbit-name").textContent = `Orbit (r = ${pattern.free}, p = ${pattern.contact}), ` +
        `${si(pattern.ratio * report.bar.first_frequency, "Hz")}, ${si(orbit.energy * report.bar.energy_unit, "J")}`;
    this.curves.show(this.motion);
    this.field.show(this.motion);
    this.animation.show(this.motion);
    showDetails(find("#details"), report, orbit, this.motion);
    this.diagram.select(orbit);
    this.table.select(orbit);
    const hash = `#r=${pattern.free}&p=${pattern.contact}${level === null ? "" : `&E=${level}`}`;
    if (message === "" && location.hash !== hash) history.replaceState(null, "", hash);
  }

  // A cursor over curves or field leads, unless the animation plays.
  hover(time) {
    if (this.animation.playing || this.marking) return;
    this.animation.to(Math.min(time, 2 * this.motion.period));
  }

  mark(time) {
    if (this.marking) return;
    this.marking = true;
    this.curves.mark(time);
    this.field.mark(time);
    this.marking = false;
  }

  /** Left and right along the branch, up and down to the next pattern: by frequency, then by steps of flight. */
  key(event) {
    if (!this.orbit || !["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"].includes(event.key)) return;
    event.preventDefault();
    const {orbit: now, report: {orbits}} = this;
    const sign = event.key === "ArrowRight" || event.key === "ArrowUp" ? 1 : -1;
    const along = event.key === "ArrowLeft" || event.key === "ArrowRight";
    // The place of an orbit among those that the key leads through; its least-energy orbit comes before a level there.
    const place =
        along ? ({energy, level}) => [energy, level === null ? 0 : 1] : ({pattern}) => [pattern.ratio, pattern.free];
    const before = (a, b) => sign * (a[0] - b[0] || a[1] - b[1]) < 0;
    const apart = ({energy}) => Math.abs(Math.log(energy / now.energy));
    let found = null;
    for (const orbit of orbits) {
      if ((along && orbit.pattern !== now.pattern) || !before(place(now), place(orbit))) continue;
      const nearer = found === null || before(place(orbit), place(found));
      if (nearer || (!before(place(found), place(orbit)) && apart(orbit) < apart(found))) found = orbit;
    }
    if (found !== null) this.choose(found);
  }

  /** Colours of canvases follow the theme. */
  redraw() {
    this.diagram.plot.draw();
    if (!this.orbit) return;
    this.curves.show(this.motion);
    this.field.show(this.motion);
    this.animation.to(this.animation.time);
  }
}
