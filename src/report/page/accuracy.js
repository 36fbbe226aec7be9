/** The page of an accuracy study: speed against error, and maps of where each method fails. */
import {element, legendEntry, Plot} from "./plot.js";

import {short, si} from "./units.js";

const markNames = ["circle", "square", "diamond", "triangle", "down", "cross", "plus", "bar"];
const leastError = 1e-16;
const mostError = 60;  // and what has none
const maps = {
  level: "energy level from E_min to E_max",
  start: "distance of the start",
  units: "bad units",
  rows: "redundant rows",
};

/** What most of the runs of a cell came to, apart from success. */
function causeOf(outcomes, names) {
  let worst = -1;
  for (let i = 1; i < outcomes.length; ++i) {
    if (outcomes[i] > 0 && (worst < 0 || outcomes[i] > outcomes[worst])) worst = i;
  }
  return worst < 0 ? "" : names[worst];
}

function speedChart(host, data, pageTools) {
  const {programs} = data;
  const methods = [...new Set(programs.map(({method}) => method))];
  const sizes = [...new Set(programs.map(({size}) => size))];
  const pointsOf = (size, method) =>
      programs.filter((one) => one.size === size && one.method === method)
          .map(
              (one) => ({x: one.seconds, y: Math.min(Math.max(one.error ?? Infinity, leastError), mostError), record: one}));
  const layersOf = (size) => methods.map((method, i) => ({
                                           name: `method-${i}`,
                                           title: method,
                                           mark: markNames[i % markNames.length],
                                           size: 5,
                                           points: pointsOf(size, method),
                                         }));
  const all = programs.map(({seconds}) => seconds).filter((time) => time > 0);
  const select = element(
      "select", {id: "size", "aria-label": "number of amplitudes"},
      ...sizes.map((size) => element("option", {value: String(size)}, `m = ${size}`)));
  const chart = element("div", {class: "plot", id: "speed"});
  const legend = element("fieldset", {class: "legend"}, element("legend", {}, "methods"));
  host.append(
      element("h2", {}, "Speed against error"),
      element(
          "p", {}, "One orbit at a given energy. Lower left is better. ",
          "The error is the larger of the replayed violation and the distance from the best objective."),
      select, chart, legend);
  const plot = new Plot(chart, {
    id: "speed",
    name: "CPU time against error",
    x: {
      label: "CPU time of a run (s)",
      log: true,
      lo: Math.min(...all) / 2,
      hi: 2 * Math.max(...all),
      text: (value) => value.toExponential(0)
    },
    y: {label: "largest error", log: true, lo: leastError / 3, hi: 100, text: (value) => value.toExponential(0)},
    layers: layersOf(sizes[0]),
    hint: ({record}) => `${record.method}${record.setting ? `, ${record.setting}` : ""}: error ${short(record.error, 2)}, ` +
        `${si(record.seconds, "s", 3)}, ${record.certified} of ${record.runs} certified`,
  });
  select.addEventListener("change", () => plot.set({layers: layersOf(Number(select.value))}));
  for (const layer of plot.options.layers) legend.append(legendEntry(plot, layer));
  pageTools.plots.push(plot);
}

function stabilityMap(data, name) {
  const cells = data.stability.filter(({map}) => map === name);
  const methods = [...new Set(cells.map(({method}) => method))];
  const columns =
      [...new Map(cells.map(({column, difficulty}) => [column, difficulty])).entries()].sort((a, b) => a[0] - b[0]);
  const head = element(
      "tr", {}, element("th", {scope: "col"}, "method"),
      ...columns.map(([, difficulty]) => element("th", {scope: "col"}, difficulty)));
  const rows = methods.map(
      (method) => element("tr", {}, element("th", {scope: "row"}, method), ...columns.map(([column]) => {
        const here = cells.filter((one) => one.method === method && one.column === column);
        const runs = here.reduce((sum, one) => sum + one.runs, 0);
        if (runs === 0) return element("td", {class: "none"}, "");
        const outcomes = data.outcomes.map((_, i) => here.reduce((sum, one) => sum + one.outcomes[i], 0));
        const share = outcomes[0] / runs;
        const cause = causeOf(outcomes, data.outcomes);
        const spent =
            outcomes.map((count, i) => (count > 0 ? `${data.outcomes[i]} ${count}` : "")).filter((part) => part !== "");
        return element(
            "td", {
              class: share === 1 ? "good" :
                  share >= 0.5   ? "fair" :
                                   "bad",
              title: `${method}, ${columns.find(([at]) => at === column)[1]}: ${spent.join(", ")} of ${runs}`,
            },
            share === 1 ? "✓" : `${Math.round(100 * share)} % ✓, ${cause}`);
      })));
  return element(
      "section", {}, element("h3", {}, maps[name] ?? name),
      element(
          "div", {class: "scroll"},
          element(
              "table", {class: "map", "aria-label": `success by method and ${maps[name] ?? name}`},
              element("thead", {}, head), element("tbody", {}, ...rows))));
}

export class AccuracyPage {
  constructor(data, host) {
    this.plots = [];
    host.replaceChildren();
    speedChart(host, data, this);
    host.append(
        element("h2", {}, "Where each method fails"),
        element(
            "p", {}, "Share of runs that succeed, and what most of the others came to: ",
            data.outcomes.slice(1).map((name, i) => `${name}: ${data.meanings[i + 1]}`).join("; "), "."));
    for (const name of new Set(data.stability.map(({map}) => map))) host.append(stabilityMap(data, name));
  }

  redraw() {
    for (const plot of this.plots) plot.draw();
  }
}
