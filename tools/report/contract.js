// Checks the report's data (tools/report/report_page.hpp) before anything is drawn. Returns the faults, one line each.
const seriesNames = ["X", "Y", "psi", "s", "stop", "upsilon", "upsilon_ref", "delta", "a", "solve_time", "scheduling_error",
                     "active_rows", "largest_slack", "solved"];
const obstacleNames = ["r_x", "r_y", "margin"];
const placeNames = ["X", "Y", "heading", "s", "half_length"];
const sectionMembers = {
  text: {paragraphs: Array.isArray},
  figures: {paragraphs: Array.isArray, items: Array.isArray},
  table: {paragraphs: Array.isArray, columns: Array.isArray, rows: Array.isArray},
  drives: {paragraphs: Array.isArray, drives: Array.isArray},
  fans: {paragraphs: Array.isArray, fans: Array.isArray},
  map: {paragraphs: Array.isArray, speeds: Array.isArray, shifts: Array.isArray, panels: Array.isArray,
        marks: Array.isArray},
  fold: {paragraphs: Array.isArray, verdict: value => ["good", "bad", ""].includes(value), sections: Array.isArray},
};
const isText = value => typeof value === "string";
const isShape = value => value === "ellipse" || value === "box";
const isObject = value => typeof value === "object" && value !== null && !Array.isArray(value);
const isRange = value => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);

function checkReport(report) {
  const faults = [];
  const expect = (condition, fault) => condition || faults.push(fault);
  const members = (object, where, kinds) => {
    if (!isObject(object)) return expect(false, `${where} is missing or no object`);
    for (const [key, kind] of Object.entries(kinds)) {
      expect(kind(object[key]), `${where}.${key} is ${key in object ? "of another kind than it must be" : "missing"}`);
    }
  };
  const line = (object, where) => {
    members(object, where, {X: Array.isArray, Y: Array.isArray});
    if (object?.X?.length !== object?.Y?.length) expect(false, `${where}.X and .Y differ in length`);
  };

  members(report, "report", {title: isText, subtitle: isText, roads: isObject, drives: isObject,
                             sections: Array.isArray});
  if (faults.length > 0) return faults;
  for (const [key, road] of Object.entries(report.roads)) {
    for (const part of ["reference", "left", "right"]) line(road[part], `roads.${key}.${part}`);
  }
  for (const [key, drive] of Object.entries(report.drives)) {
    checkDrive(drive, `drives.${key}`, report, {expect, members, line});
  }
  report.sections.forEach((section, i) => checkSection(section, `sections[${i}]`, report, {expect, members}));
  return faults;
}

function checkSection(section, where, report, {expect, members}) {
  members(section, where, {title: isText});
  const kinds = sectionMembers[section.type];
  if (!kinds) return expect(false, `${where}.type is ${JSON.stringify(section.type)}`);
  members(section, where, kinds);
  for (const key of section.drives ?? section.fans?.map(fan => fan.drive) ?? []) {
    expect(key in report.drives, `${where} shows drive ${JSON.stringify(key)}, which is not there`);
  }
  section.rows?.forEach((row, r) => {
    expect(row.length === section.columns?.length, `${where}.rows[${r}] has ${row.length} cells`);
  });
  section.sections?.forEach((inner, i) => checkSection(inner, `${where}.sections[${i}]`, report, {expect, members}));
  if (section.type === "map") checkMap(section, where, expect);
}

function checkDrive(drive, where, report, {expect, members, line}) {
  members(drive, where, {name: isText, controller: isText, horizon: Number.isInteger, t_s: Number.isFinite,
                         obstacles: Array.isArray, decisions: Array.isArray, outline: isObject, limits: isObject,
                         series: isObject});
  expect(drive.road in report.roads, `${where}.road is ${JSON.stringify(drive.road)}, which is not there`);
  members(drive.outline, `${where}.outline`, {front: Number.isFinite, rear: Number.isFinite, width: Number.isFinite});
  members(drive.limits, `${where}.limits`, {delta: isRange, a: isRange});
  drive.decisions?.forEach((decision, i) => {
    members(decision, `${where}.decisions[${i}]`, {t: Number.isFinite, decision: isText, reason: isText});
  });
  const t = drive.series?.t;
  if (!Array.isArray(t) || t.length === 0 || !t.every(Number.isFinite)) {
    return expect(false, `${where}.series.t is missing, empty or has gaps`);
  }
  expect(t.every((value, i) => i === 0 || value > t[i - 1]), `${where}.series.t does not rise`);
  for (const name of seriesNames) {
    const series = drive.series[name];
    const whole = Array.isArray(series) && series.length === t.length;
    expect(whole, `${where}.series.${name} is ${Array.isArray(series) ? "not as long as t" : "missing"}`);
  }
  drive.obstacles?.forEach((obstacle, i) => checkObstacle(obstacle, `${where}.obstacles[${i}]`, t, {expect, members}));
  if (!("plans" in drive)) return;
  const {k, dX, dY} = drive.plans;
  const whole = Array.isArray(k) && k.length === dX?.length && k.length === dY?.length;
  expect(whole, `${where}.plans: k, dX and dY differ in length`);
  k?.forEach((step, i) => {
    expect(step in t, `${where}.plans.k[${i}] is no index of the series`);
    line({X: dX?.[i], Y: dY?.[i]}, `${where}.plans[${i}]`);
  });
}

function checkObstacle(obstacle, where, t, {expect, members}) {
  const isIndex = value => value in t;
  members(obstacle, where, {
    shape: isShape, from: isIndex, to: isIndex, places: isObject,
    ...Object.fromEntries(obstacleNames.map(key => [key, Number.isFinite])),
  });
  const {k} = obstacle.places ?? {};
  const rises = Array.isArray(k) && k.every((step, i) => isIndex(step) && (i === 0 || step > k[i - 1]));
  if (!rises || k[0] !== obstacle.from) return expect(false, `${where}.places.k does not rise from .from on`);
  for (const name of placeNames) {
    expect(obstacle.places[name]?.length === k.length, `${where}.places.${name} is not as long as k`);
  }
}

function checkMap(section, where, expect) {
  section.panels?.forEach((panel, p) => {
    const whole = panel.cells?.length === section.shifts.length &&
      panel.cells.every(row => row.length === section.speeds.length && row.every(outcome => outcome in outcomes));
    expect(whole, `${where}.panels[${p}].cells is no outcome for each shift and speed`);
  });
}
