// Builds the page from the report, and redraws it when the system's colour scheme changes and for printing.
const sectionBuilders = {
  text() {}, figures: addFigures, table: addTable, drives: addDrives, fans: addFans, map: addMap,
};

function addSection(report, section, index, parent = document.querySelector("main")) {
  if (section.type === "fold") return addFold(report, section, index, parent);
  const heading = section.title === "" ? [] : [element("h2", {}, section.title)];
  const paragraphs = section.paragraphs.map(text => element("p", {}, unbroken(text)));
  const body = element("section", section.title === "" ? {class: "untitled"} : {}, ...heading, ...paragraphs);
  parent.append(body);
  sectionBuilders[section.type](report, section, body, index);
}

// Sections that are shown, and drawn, only once the reader asks for them.
function addFold(report, {title, verdict, paragraphs, sections}, index, parent) {
  const summary = element("summary", {class: verdict}, ...verdictMark(verdict), element("h2", {}, title));
  const fold = element("details", {class: "fold"}, summary,
                       ...paragraphs.map(text => element("p", {}, unbroken(text))));
  fold.addEventListener("toggle", () => {
    sections.forEach((section, i) => addSection(report, section, `${index}-${i}`, fold));
  }, {once: true});
  parent.append(fold);
}

function redrawAll() {
  for (const {plot} of plots) plot.redraw(false, false);
  for (const redraw of onThemeChange) redraw();
}

function setPrinting(printing) {
  document.documentElement.toggleAttribute("data-print", printing);
  for (const {fit} of plots) fit();
  redrawAll();
}

function buildPage() {
  // Also catches errors in later drawing. The browser logs them.
  window.addEventListener("error", event => showFault(`The report could not be drawn: ${event.message}`));
  const report = JSON.parse(document.getElementById("report-data").textContent);
  const faults = checkReport(report);
  if (faults.length > 0) {
    const text = `The data of this report is not what it must be:\n${faults.join("\n")}`;
    showFault(text);
    console.error(text);
    return;
  }
  document.querySelector("main").append(element("header", {}, element("h1", {}, report.title),
    ...(report.subtitle ? [element("p", {class: "subtitle"}, report.subtitle)] : [])));
  report.sections.forEach((section, index) => addSection(report, section, String(index)));

  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);
  window.addEventListener("beforeprint", () => setPrinting(true));
  window.addEventListener("afterprint", () => setPrinting(false));
  // Plots are drawn in microtasks, so all are drawn when the next task runs.
  setTimeout(() => {
    document.documentElement.dataset.plots = plots.length;
    if (!document.querySelector(".fault")) document.documentElement.dataset.ready = "1";
  });
}

buildPage();
