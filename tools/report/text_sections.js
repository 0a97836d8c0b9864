// Tiles of figures, and tables.

// Whether it is good is said by sign and colour.
const verdictSign = {good: "✓", bad: "✗"};
const verdictMark = verdict => verdict ? [element("span", {class: "verdict"}, verdictSign[verdict])] : [];

function addFigures(report, {items}, body) {
  const tiles = items.map(({label, value, verdict}) => element("div", {class: `tile ${verdict}`},
    element("dt", {}, label), element("dd", {class: verdict}, ...verdictMark(verdict), value)));
  body.append(element("dl", {class: "tiles"}, ...tiles));
}

// Numbers with a unit, and dashes that stand where there is none.
const numeral = /^[<>≤≥±]?\s*[-−+]?\d[\d.,\s]*(e[-−+]?\d+)?\s*(%|[a-zA-Zµ°/²³·]{1,6})?$/;
const looksNumeric = text => ["", "–", "—", "-"].includes(text) || numeral.test(text);

function addTable(report, {columns, rows, note}, body) {
  const textOf = cell => typeof cell === "string" ? cell : cell.text;
  const numeric = columns.map((column, i) => rows.every(row => looksNumeric(textOf(row[i]))));
  const kind = (i, verdict = "") => ({class: `${numeric[i] ? "number" : ""} ${verdict}`.trim()});
  const head = element("tr", {}, ...columns.map((column, i) => element("th", {scope: "col", ...kind(i)}, column)));
  const lines = rows.map(row => element("tr", {}, ...row.map((cell, i) =>
    element("td", kind(i, cell.verdict), ...verdictMark(cell.verdict), textOf(cell)))));
  const table = element("table", {class: "data"}, element("thead", {}, head), element("tbody", {}, ...lines));
  body.append(element("div", {class: "table-wrap"}, table));
  if (note) body.append(element("p", {class: "note"}, note));
}
