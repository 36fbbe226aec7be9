/** Files made in the page: tables, drawings, pictures. */
import {themed} from "./curves.js";
import {element, shape} from "./plot.js";

function save(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], {type}));
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** Motion and force of an orbit over one period, every number as it is. */
export function motionCsv(motion) {
  const rows = ["t_s,x_m,force_n"];
  for (let n = 0; n <= motion.period; ++n)
    rows.push(`${n * motion.step},${motion.tip[n]},${motion.force[n % motion.period]}`);
  return `${rows.join("\n")}\n`;
}

export function saveCsv(name, text) {
  save(name, text, "text/csv");
}

// Styles come from the sheet of the page: a drawing of its own must bring them along.
function standalone(svg) {
  const copy = svg.cloneNode(true);
  const kept = [
    "fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-family", "stroke-linecap",
    "fill-opacity"
  ];
  const [from, to] = [svg.querySelectorAll("*"), copy.querySelectorAll("*")];
  from.forEach((one, i) => {
    const style = getComputedStyle(one);
    for (const name of kept) to[i].setAttribute(name, style.getPropertyValue(name));
  });
  const [, , width, height] = svg.getAttribute("viewBox").split(" ");
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  copy.prepend(shape("rect", {width, height, fill: themed("--paper")}));
  return {text: new XMLSerializer().serializeToString(copy), width: Number(width), height: Number(height)};
}

export function saveSvg(name, svg) {
  save(name, standalone(svg).text, "image/svg+xml");
}

export function savePng(name, canvas) {
  canvas.toBlob((blob) => save(name, blob, "image/png"));
}

/** A drawing as a picture of twice its size. */
export function saveDrawing(name, svg) {
  const {text, width, height} = standalone(svg);
  const image = new Image();
  image.addEventListener("load", () => {
    const canvas = element("canvas");
    [canvas.width, canvas.height] = [2 * width, 2 * height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    savePng(name, canvas);
  });
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
}
