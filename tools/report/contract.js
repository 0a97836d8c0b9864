// Checks the report's data (tools/report/report_page.hpp) before anything is drawn. Returns the faults, one line each.
const seriesNames = ["X", "Y", "psi", "upsilon", "upsilon_ref", "delta", "a", "solve_time", "scheduling_error",
                     "active_rows", "largest_slack", "solved"];
const obstacleNames = ["X", "Y", "r_x", "r_y", "heading", "margin", "velocity_X", "velocity_Y"];
const sectionMembers = {
  text: {paragraphs: Array.isArray},
  figures: {paragraphs: Array.isArray, items: Array.isArray},
  table: {paragraphs: Array.isArray, columns: Array.isArray, rows: Array.isArray},
  drives: {paragraphs: Array.isArray, drives: Array.isArray},
  fans: {paragraphs: Array.isArray, fans: Array.isArray},
  map: {paragraphs: Array.isArray, speeds: Array.isArray, shifts: Array.isArray, panels: Array.isArray,
        marks: Array.isArray},
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
  report.sections.forEach((section, i) => {
    const where = `sections[${i}]`;
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
    if (section.type === "map") checkMap(section, where, expect);
  });
  return faults;
}

function checkDrive(drive, where, report, {expect, members, line}) {
  members(drive, where, {name: isText, controller: isText, horizon: Number.isInteger, t_s: Number.isFinite,
                         obstacles: Array.isArray, outline: isObject, limits: isObject, series: isObject});
  expect(drive.road in report.roads, `${where}.road is ${JSON.stringify(drive.road)}, which is not there`);
  members(drive.outline, `${where}.outline`, {front: Number.isFinite, rear: Number.isFinite, width: Number.isFinite});
  members(drive.limits, `${where}.limits`, {delta: isRange, a: isRange});
  drive.obstacles?.forEach((obstacle, i) => {
    members(obstacle, `${where}.obstacles[${i}]`, {
      shape: isShape, ...Object.fromEntries(obstacleNames.map(key => [key, Number.isFinite])),
    });
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
  if (!("plans" in drive)) return;
  const {k, dX, dY} = drive.plans;
  const whole = Array.isArray(k) && k.length === dX?.length && k.length === dY?.length;
  expect(whole, `${where}.plans: k, dX and dY differ in length`);
  k?.forEach((step, i) => {
    expect(step in t, `${where}.plans.k[${i}] is no index of the series`);
    line({X: dX?.[i], Y: dY?.[i]}, `${where}.plans[${i}]`);
  });
}

function checkMap(section, where, expect) {
  section.panels?.forEach((panel, p) => {
    const whole = panel.cells?.length === section.shifts.length &&
      panel.cells.every(row => row.length === section.speeds.length && row.every(outcome => outcome in outcomes));
    expect(whole, `${where}.panels[${p}].cells is no outcome for each shift and speed`);
  });
}
