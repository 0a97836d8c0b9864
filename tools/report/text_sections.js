// Tiles of figures, and tables.

// A verdict is shown by a sign and by colour.
const verdictSign = {good: "✓", bad: "✗"};
const verdictMark = verdict => verdict ? [element("span", {class: "verdict"}, verdictSign[verdict])] : [];

function addFigures(report, {items}, body) {
  const tiles = items.map(({label, value, verdict}) => element("div", {class: `tile ${verdict}`},
    element("dt", {}, label), element("dd", {class: verdict}, ...verdictMark(verdict), element("span", {}, value))));
  body.append(element("dl", {class: "tiles"}, ...tiles));
}

// A numeric cell is a number with an optional unit, a dash, or empty.
const numeral = /^[<>≤≥±]?\s*[-−+]?\d[\d.,\s]*(e[-−+]?\d+)?\s*(%|[a-zA-Zµ°/²³·]{1,6})?$/;
const looksNumeric = text => ["", "–", "—", "-"].includes(text) || numeral.test(text);

// A cell of at most this many characters is kept on one line.
const shortText = 20;

// Runs of consecutive rows with the same first cell.
function groupsOf(rows, textOf) {
  const groups = [];
  for (const row of rows) {
    if (groups.length > 0 && textOf(groups.at(-1)[0][0]) === textOf(row[0])) groups.at(-1).push(row);
    else groups.push([row]);
  }
  return groups;
}

function addTable(report, {columns, rows, note}, body) {
  const textOf = cell => typeof cell === "string" ? cell : cell.text;
  const numeric = columns.map((column, i) => rows.every(row => looksNumeric(textOf(row[i]))));
  const head = element("tr", {}, ...columns.map((column, i) =>
    element("th", {scope: "col", class: numeric[i] ? "number" : ""}, column)));
  const cellOf = (cell, i, more) => {
    const text = textOf(cell);
    const kinds = [numeric[i] ? "number" : "", text.length <= shortText ? "short" : "", cell.verdict ?? ""];
    return element("td", {class: kinds.filter(kind => kind).join(" "), ...more}, ...verdictMark(cell.verdict),
                   numeric[i] ? text.replace(/^-(?=\d)/, "−").replace(/^-$/, "–") : unbroken(text));
  };
  // The first cell of a group spans all its rows.
  const groups = groupsOf(rows, textOf).map(group => element("tbody", {}, ...group.map((row, r) =>
    element("tr", {}, ...row.flatMap((cell, i) =>
      i > 0 ? cellOf(cell, i, {}) : r === 0 ? cellOf(cell, i, {rowspan: group.length}) : [])))));
  const table = element("table", {class: "data"}, element("thead", {}, head), ...groups);
  body.append(element("div", {class: "table-wrap"}, table));
  if (note) body.append(element("p", {class: "note"}, unbroken(note)));
}
