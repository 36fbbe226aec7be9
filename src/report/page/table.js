/** A table of any length of which only the rows in sight are drawn; sorted by a click on a head, filtered by words. */
import {element} from "./plot.js";

const rowHeight = 26;
const printed = 500;

export class Table {
  /** @param columns [{name, title, value(row), text(row)}]; @param pick told the row that was chosen */
  constructor(host, columns, rows, pick) {
    Object.assign(this, {host, columns, rows, pick});
    this.words = [];
    this.order = {column: null, rising: true};
    this.head = element(
        "tr", {role: "row"},
        ...columns.map(
            (column) => element(
                "th", {scope: "col", role: "columnheader"},
                element("button", {type: "button", onclick: () => this.sort(column)}, column.title))));
    this.body = element("tbody");
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row?.dataset.place) this.choose(Number(row.dataset.place));
    });
    this.table = element(
        "table", {role: "grid", "aria-label": "energy levels", "aria-rowcount": String(rows.length)},
        element("thead", {}, this.head), this.body);
    host.replaceChildren(this.table);
    host.tabIndex = 0;
    host.addEventListener("scroll", () => this.draw());
    host.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(host);
    window.addEventListener("beforeprint", () => this.draw(true));
    window.addEventListener("afterprint", () => this.draw());
    this.arrange();
  }

  sort(column) {
    this.order = {column, rising: this.order.column === column ? !this.order.rising : true};
    this.columns.forEach((one, i) => {
      const state = one === column ? (this.order.rising ? "ascending" : "descending") : "none";
      this.head.children[i].setAttribute("aria-sort", state);
    });
    this.arrange();
  }

  filter(text) {
    this.words = text.toLowerCase().split(/\s+/).filter((word) => word !== "");
    this.host.scrollTop = 0;
    this.arrange();
  }

  arrange() {
    const matches = (row) => {
      const text = this.columns.map((column) => column.text(row)).join(" ").toLowerCase();
      return this.words.every((word) => text.includes(word));
    };
    this.shown = this.words.length === 0 ? [...this.rows] : this.rows.filter(matches);
    this.table.setAttribute("aria-rowcount", String(this.shown.length + 1));
    const {column, rising} = this.order;
    if (column !== null) {
      const compare = (a, b) => {
        const [p, q] = [column.value(a), column.value(b)];
        if (p === q) return 0;
        if (p === null || q === null) return p === null ? 1 : -1;  // what has no value comes last
        return (p < q ? -1 : 1) * (rising ? 1 : -1);
      };
      this.shown.sort(compare);
    }
    this.place = this.shown.indexOf(this.chosen);
    this.draw();
    if (this.counted) this.counted(this.shown.length, this.rows.length);
  }

  draw(print = false) {
    const inSight = Math.min(Math.floor(this.host.scrollTop / rowHeight), this.shown.length - 1);
    const first = print ? 0 : Math.max(0, inSight - 5);
    const last = Math.min(this.shown.length, print ? printed : first + Math.ceil(this.host.clientHeight / rowHeight) + 12);
    const space = (rows) => element("tr", {"aria-hidden": "true", style: `height:${rows * rowHeight}px`});
    const made = [];
    for (let place = first; place < last; ++place) {
      const row = this.shown[place];
      made.push(element(
          "tr", {
            role: "row",
            id: `row-${place}`,
            "data-place": String(place),
            "aria-rowindex": String(place + 2),
            "aria-selected": String(row === this.chosen),
          },
          ...this.columns.map(({text}) => element("td", {role: "gridcell"}, text(row)))));
    }
    const left = this.shown.length - last;
    if (print && left > 0)
      made.push(element("tr", {}, element("td", {colspan: String(this.columns.length)}, `and ${left} more`)));
    this.body.replaceChildren(...(first > 0 ? [space(first)] : []), ...made, ...(!print && left > 0 ? [space(left)] : []));
  }

  choose(place) {
    if (place < 0 || place >= this.shown.length) return;
    this.select(this.shown[place]);
    this.pick(this.chosen);
  }

  /** Marks a row and brings it into sight. */
  select(row) {
    this.chosen = row;
    this.place = this.shown.indexOf(row);
    if (this.place >= 0) {
      this.host.setAttribute("aria-activedescendant", `row-${this.place}`);
      const top = this.place * rowHeight;
      const seen = this.host.clientHeight - 2 * rowHeight;
      if (top < this.host.scrollTop) this.host.scrollTop = top;
      if (top > this.host.scrollTop + seen) this.host.scrollTop = top - seen;
    }
    this.draw();
  }

  key(event) {
    const page = Math.max(1, Math.floor(this.host.clientHeight / rowHeight) - 2);
    const to = {
      ArrowDown: this.place + 1,
      ArrowUp: this.place - 1,
      PageDown: this.place + page,
      PageUp: this.place - page,
      Home: 0,
      End: this.shown.length - 1,
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    this.choose(Math.min(Math.max(to, 0), this.shown.length - 1));
  }
}
