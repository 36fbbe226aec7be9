/** How numbers are shown: with the SI prefix that suits them, and as many digits as a reader wants. */

const prefixes = [
  [1e12, "T"],
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
];

/** A number of so many digits without needless zeros. */
export function short(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e6 || size < 1e-4)) return value.toExponential(digits - 1).replace(/\.?0+e/, "e");
  return String(Number(value.toPrecision(digits)));
}

/** The prefix that suits a value: its factor and the unit's name with it. */
export function scaled(value, unit) {
  const size = Math.abs(value);
  const found = prefixes.find(([factor]) => size >= 0.9995 * factor) ?? [1, ""];
  return size === 0 ? {factor: 1, unit} : {factor: found[0], unit: found[1] + unit};
}

/** "98.2 µs"; what is nothing but rounding beside `scale` is zero. */
export function si(value, unit, digits = 5, scale = 0) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 1e-12 * scale) return `0 ${unit}`;
  const shown = scaled(value, unit);
  return `${short(value / shown.factor, digits)} ${shown.unit}`;
}

/** Steps as ranges: "3–7, 12". */
export function ranges(steps) {
  const parts = [];
  for (let i = 0; i < steps.length; ++i) {
    let last = i;
    while (last + 1 < steps.length && steps[last + 1] === steps[last] + 1) ++last;
    parts.push(last > i ? `${steps[i]}–${steps[last]}` : `${steps[i]}`);
    i = last;
  }
  return parts.length > 12 ? `${parts.slice(0, 12).join(", ")}, …` : parts.join(", ");
}
