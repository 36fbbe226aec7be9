/** Reads what the program wrote into the page and starts its parts. */
import {AccuracyPage} from "./accuracy.js";
import {element} from "./plot.js";
import {SweepPage} from "./sweep.js";

const find = (selector) => document.querySelector(selector);
const data = JSON.parse(find("#data").textContent);

// The theme of the system, until another is chosen.
const root = document.documentElement;
const system = matchMedia("(prefers-color-scheme: dark)");
let chosen = null;
const paint = () => {
  root.dataset.theme = chosen ?? (system.matches ? "dark" : "light");
};
paint();

document.title = `${data.title} – nsma`;
find("#title").textContent = data.title;
find("#derived").textContent = data.derived;
find("#program").textContent = data.program;
find("#scene").textContent = data.scene;
find("#summary").textContent = data.summary;

const pages = [];
if (data.sweep)
  pages.push(new SweepPage(data.sweep, find));
else
  find("#sweep").remove();
if (data.accuracy)
  pages.push(new AccuracyPage(data.accuracy, find("#accuracy")));
else
  find("#accuracy").remove();

const redraw = () => {
  for (const page of pages) page.redraw();
};
find("#theme").addEventListener("click", () => {
  chosen = root.dataset.theme === "dark" ? "light" : "dark";
  paint();
  redraw();
});
system.addEventListener("change", () => {
  paint();
  redraw();
});
// Paper is white.
window.addEventListener("beforeprint", () => {
  root.dataset.theme = "light";
  redraw();
});
window.addEventListener("afterprint", () => {
  paint();
  redraw();
});

if (data.sweep && data.accuracy) {
  find("#title").after(
      element("nav", {}, element("a", {href: "#sweep"}, "orbits"), " ", element("a", {href: "#accuracy"}, "accuracy")));
}

/** For scripts on the page: what is shown. */
window.nsma = {
  data,
  pages,
  sweep: pages.find((page) => page instanceof SweepPage)
};
