// A section of type "drives": the plane at the top, again at each obstacle, and the quantities over time below, with
// one cursor for all.

// Draws the vehicles at the cursor's time `t`, each with its open-loop prediction; without a cursor, where each drive
// is nearest to each obstacle.
function drawVehicles(pen, drives, t) {
  drives.forEach((drive, i) => {
    const own = color(driveColor(i));
    const steps = t === null ? drive.obstacles.map(obstacle => closestSample(drive, obstacle)) : [sampleAt(drive, t)];
    for (const k of new Set(steps)) {
      if (k === null || !hasPose(drive, k)) continue;
      const {X, Y, psi} = drive.series;
      pen.vehicle(X[k], Y[k], psi[k], drive.outline, {color: own, width: 0.75 * driveWidth(i, drives)});
      const plan = t === null ? null : planOf(drive, k);
      if (plan) drawPlan(pen, plan, own, color("paper"));
    }
  });
}

function drawPlan(pen, plan, own, inside) {
  pen.line(plan.X, plan.Y, {color: own, width: 1});
  pen.dots(plan.X, plan.Y, 2.5, {color: own, width: 1.25, fill: inside});
}

function drawDrives(pen, report, drives, t) {
  for (const road of roadsOf(report, drives)) drawRoad(pen, road);
  drawObstacles(pen, drives, t === null ? closestSample : drive => sampleAt(drive, t));
  drives.forEach(({series}, i) => {
    pen.line(series.X, series.Y, {color: color(driveColor(i)), width: driveWidth(i, drives)});
  });
  for (const drive of drives) {
    const {X, Y, solved} = drive.series;
    const failed = solved.flatMap((value, k) => value === 0 && hasPose(drive, k) ? [k] : []);
    pen.crosses(failed.map(k => X[k]), failed.map(k => Y[k]), 3, {color: color("bad"), width: 1.5});
  }
  drawVehicles(pen, drives, t);
}

function drivesLegend(drives) {
  const items = drives.map((drive, i) => {
    const solved = drive.series.solved.filter(value => value !== null);
    const failed = solved.filter(value => value === 0).length;
    return {
      swatch: lineSwatch(driveColor(i), {width: driveWidth(i, drives)}),
      label: drive.name,
      detail: `N = ${drive.horizon}, ${failed} steps unsolved`,
    };
  });
  const vehicle = swatch(
    `<path d="M3 2H27V12H3ZM17 2L27 7L17 12" fill="none" stroke="var(--soft)" stroke-width="1.25"/>`);
  const plan = swatch(`<path d="M3 7H27" stroke="var(--soft)"/>` + [5, 15, 25].map(x =>
    `<circle cx="${x}" cy="7" r="2.75" fill="var(--paper)" stroke="var(--soft)" stroke-width="1.25"/>`).join(""));
  const unsolved = swatch(`<rect width="14" height="14" x="1" fill="var(--unsolved)"/>` +
    `<rect width="14" height="2.5" x="1" fill="var(--bad)"/>` +
    `<path d="M20 3.5L27 10.5M20 10.5L27 3.5" stroke="var(--bad)" stroke-width="1.75"/>`);
  const planned = drives.some(drive => drive.plans?.k.length > 0);
  const obstacles = drives.some(drive => drive.obstacles.length > 0);
  const failed = drives.some(drive => drive.series.solved.includes(0));
  return legend([
    ...items,
    ...roadLegend(drives),
    {swatch: vehicle, label: `vehicle at the cursor${obstacles ? ", or nearest to an obstacle" : ""}`},
    ...(planned ? [{swatch: plan, label: "open-loop prediction at the cursor"}] : []),
    ...(failed ? [{swatch: unsolved, label: "unsolved step"}] : []),
  ]);
}

// The part of the plane shown around an obstacle: it and the drives within 14 m of it, a swerve at city speed.
function boxAtObstacle(obstacle, drives) {
  const paths = drives.map(drive => {
    const {X, Y} = placedAt(obstacle, drive, closestSample(drive, obstacle));
    const near = (x, k) => Math.hypot(x - X, drive.series.Y[k] - Y) < 14;
    return {X: drive.series.X.map((x, k) => near(x, k) ? x : null), Y: drive.series.Y};
  });
  return boxAbout([...paths, ...drives.map(drive => extentOf(obstacle, drive))], 1.5);
}

// The planes of a section, {title, hint, box} each: first that of the whole drives, then one for each obstacle.
function planesOf(drives) {
  const obstacles = drives.flatMap(drive => drive.obstacles.map(obstacle => [JSON.stringify(obstacle), obstacle]));
  const extents = drives.flatMap(drive => drive.obstacles.map(obstacle => extentOf(obstacle, drive)));
  return [
    {title: "Driven paths", hint: xyHint, box: boxAbout([...drives.map(drive => drive.series), ...extents], 6)},
    ...[...new Map(obstacles).values()].map(obstacle =>
      ({title: `At obstacle ${obstacle.id}`, hint: "", box: boxAtObstacle(obstacle, drives)})),
  ];
}

function addDrives(report, section, body, index) {
  const drives = section.drives.map(key => report.drives[key]);
  const planes = planesOf(drives);
  const [whole, ...near] = planes.map(({title, hint}) => plotFigure(title, hint));
  const shown = quantities.filter(({scheduling}) => !scheduling || drives.some(schedules));
  const frames = shown.map(({title, reference, scheduling}) => {
    const frame = plotFigure(title + (reference ? ", reference dotted" : ""));
    if (scheduling) frame.figure.classList.add("third");
    return frame;
  });
  body.append(drivesLegend(drives), whole.figure,
              element("div", {class: "panels"}, ...near.map(frame => frame.figure)),
              element("div", {class: "plots"}, ...frames.map(frame => frame.figure)));

  let time = null;
  const mounted = [whole, ...near].map((frame, i) => {
    const {box} = planes[i];
    return mountXyPlot(frame, box, heightFor(box, 560), pen => drawDrives(pen, report, drives, time));
  });

  // Every time plot of the section reports the cursor's time; the planes are redrawn at most once per frame.
  let due = false;
  const moved = t => {
    if (t === time) return;
    time = t;
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      for (const plane of mounted) plane.redraw(false, false);
      whole.readout.textContent = time === null ? "" : `t = ${number(time, 2)} s`;
    });
  };
  const times = drives.flatMap(({series, t_s}) => [series.t[0], series.t.at(-1) + t_s]);
  const span = [Math.min(...times), Math.max(...times)];
  shown.forEach((quantity, i) => mountTimePlot(frames[i], quantity, drives, {sync: `section-${index}`, span, moved}));
}
