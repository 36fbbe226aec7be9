/** What is known of one orbit, in words and numbers. */
import {element} from "./plot.js";
import {ranges, short, si} from "./units.js";

function table(caption, head, rows) {
  const made = element("table", {}, element("caption", {}, caption));
  if (head.length > 0) {
    made.append(element("thead", {}, element("tr", {}, ...head.map((text) => element("th", {scope: "col"}, text)))));
  }
  const body = element("tbody");
  for (const [first, ...rest] of rows) {
    body.append(element("tr", {}, element("th", {scope: "row"}, first), ...rest.map((text) => element("td", {}, text))));
  }
  made.append(body);
  return made;
}

function numbers(report, orbit) {
  const {bar} = report;
  const {pattern} = orbit;
  const frequency = pattern.ratio * bar.first_frequency;
  const energy = si(orbit.energy * bar.energy_unit, "J");
  const same = orbit.get("same_free_steps");
  return table("Numbers", [], [
    ["pattern", `r = ${pattern.free} free steps, p = ${pattern.contact} contact steps, m = ${pattern.m} amplitudes`],
    ["frequency", `${si(frequency, "Hz", 6)} = ${short(pattern.ratio, 6)} ω₁/2π, T = ${si(1 / frequency, "s", 6)}`],
    ["energy", bar.gap === 0 ? energy : `${energy} = ${short(orbit.energy, 8)} E_g`],
    ["peak force", si(orbit.get("peak_force_n"), "N")],
    ["impact speed", si(orbit.get("impact_speed_m_s"), "m/s")],
    ["peak stress", si(orbit.get("peak_stress_pa"), "Pa")],
    ["least tip displacement", si(orbit.get("tip_min_m"), "m")],
    [
      `objective ${report.objective}`,
      si(orbit.get("objective_value") * report.objective_unit[0], report.objective_unit[1], 6)
    ],
    ["found by", orbit.get("method")],
    ["smallest period", `${orbit.get("minimal_period_steps")} steps`],
    ...(same ? [["same motion as", `(r = ${same}, p = ${orbit.get("same_contact_steps")})`]] : []),
    ...(orbit.get("reason") ? [["remark", orbit.get("reason")]] : []),
  ]);
}

function conditions(motion, orbit) {
  const left = motion.conditions();
  const row = (name, text, steps, what) =>
      [name,
       text,
       steps.length > 0 ? `● binds: ${what} ${ranges(steps)}` : "○ does not bind",
       short(orbit.get(`violation_${name.split(",")[0].toLowerCase()}`), 2),
  ];
  return table("Conditions", ["condition", "what it leaves", "binding", "replayed violation"], [
    row("COND1, no penetration in flight",
        motion.free > 1 ?
            `at least ${si(left.clearance, "m", 4, motion.bar.displacement_unit)} from the wall, in step ${left.closest}` :
            "one step of flight",
        left.touching, "touches in step"),
    row("COND2, contact at the wall", `x = ${si(motion.tip[motion.period], "m", 6, motion.bar.displacement_unit)}`,
        [motion.free], "from step"),
    row("COND3, no tension in contact",
        `presses with at least ${si(left.weakest, "N", 4, Math.max(...motion.force.map(Math.abs)))}`, left.silent,
        "no force in step"),
  ]);
}

function proof(report, orbit) {
  const {pattern} = orbit;
  const unit = report.bar.gap === 0 ? "J" : "E_g";
  const end = (value, exact) =>
      (exact ? `${exact} ${unit} exactly` :
           value === null ? "open" :
                            `${short(value, 8)} ${unit}`);
  const gap = orbit.get("objective_gap");
  return table("Proof", [], [
    ["best orbit of its pattern here", orbit.proof || "–"],
    ...(gap === null ? [] : [["gap to the bound", `${short(100 * gap, 3)} %`]]),
    ["least energy of the pattern", end(pattern.least, pattern.leastExact)],
    ["greatest energy", pattern.unbounded ? "none" : end(pattern.greatest, pattern.greatestExact)],
    ["verdict", `${pattern.verdict}, ${pattern.kind}${pattern.proved ? ", proved in integers" : ", not proved"}`],
  ]);
}

function solvers(orbit) {
  const runs = orbit.get("solvers");
  if (runs.length === 0) return table("Solvers", [], [["none", "known in closed form: no solver was asked"]]);
  return table(
      "Solvers", ["solver", "start", "status", "objective", "iterations"],
      runs.map(
          (run) =>
              [run.name,
               run.start < 0 ? "level before" : String(run.start),
               run.status,
               short(run.objective, 8),
               String(run.iterations),
  ]));
}

function prices(report, orbit) {
  const found = report.prices.find(({pattern, level}) => pattern === orbit.pattern && level === orbit.level);
  if (!found) return [];
  if (found.refusal) return [table("Shadow prices", [], [["none", found.refusal]])];
  return [table(
      `Shadow prices: change of ${found.objective} by unit of the condition`,
      ["condition", "binding", "price"],
      found.prices.map(
          ({name, unit, active, below, above}) =>
              [name,
               active ? "●" : "○",
               above === below ? `${short(above, 5)} ${found.unit} per ${unit}` :
                                 `${short(below, 5)} falling, ${short(above, 5)} rising, ${found.unit} per ${unit}`,
  ]),
      )];
}

/** Fills an element with all of it. */
export function showDetails(host, report, orbit, motion) {
  host.replaceChildren(
      numbers(report, orbit), conditions(motion, orbit), proof(report, orbit), ...prices(report, orbit), solvers(orbit));
}
