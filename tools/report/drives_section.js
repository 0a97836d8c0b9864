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

// The obstacles that a drive came near to, the nearest six, in the order of the data: {id, seen, distance} each, where
// `seen` holds the obstacle as each drive saw it, as {drive, obstacle}.
function obstaclesMet(drives) {
  const all = new Map();
  for (const drive of drives) {
    for (const obstacle of drive.obstacles) {
      const key = obstacleKey(obstacle);
      const met = all.get(key) ?? {id: obstacle.id, seen: [], distance: Infinity};
      met.seen.push({drive, obstacle});
      met.distance = Math.min(met.distance, closest(drive, obstacle)?.distance ?? 0);
      all.set(key, met);
    }
  }
  const met = [...all.values()].filter(({distance}) => distance < nearObstacle);
  const nearest = [...met].sort((a, b) => a.distance - b.distance).slice(0, 6);
  return met.filter(obstacle => nearest.includes(obstacle));
}

// The part of the plane shown around an obstacle: it and the drives near it.
function boxAtObstacle({seen}) {
  const paths = seen.map(({drive, obstacle}) => {
    const {X, Y} = placedAt(obstacle, closestSample(drive, obstacle));
    const near = (x, k) => Math.hypot(x - X, drive.series.Y[k] - Y) < nearObstacle;
    return {X: drive.series.X.map((x, k) => near(x, k) ? x : null), Y: drive.series.Y};
  });
  return boxAbout([...paths, ...extentsOf(seen)], 1.5);
}

const nearObstacle = 14;   // [m], a swerve at city speed
const extentsOf = seen => seen.map(({drive, obstacle}) => extentOf(obstacle, drive));

// The planes of a section, {title, hint, box} each: first that of the whole drives, then one for each obstacle.
function planesOf(drives) {
  const met = obstaclesMet(drives);
  const extents = met.flatMap(({seen}) => extentsOf(seen));
  return [
    {title: "Driven paths", hint: xyHint, box: boxAbout([...drives.map(drive => drive.series), ...extents], 6)},
    ...met.map(obstacle => ({title: `At obstacle ${obstacle.id}`, hint: "", box: boxAtObstacle(obstacle)})),
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
  const deciding = drives.filter(({decisions}) => decisions.length > 0).map(drive => {
    const name = drives.length > 1 ? `: ${drive.name}` : "";
    return {drive, frame: plotFigure(`Course over time${name}`), list: decisionList(drive)};
  });
  body.append(drivesLegend(drives), whole.figure,
              element("div", {class: "panels"}, ...near.map(frame => frame.figure)),
              ...deciding.flatMap(({drive, frame, list}) => [
                courseLegend(drive), element("div", {class: "course"}, frame.figure, list.root)]),
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
      for (const redraw of courses) redraw(time);
    });
  };
  const times = drives.flatMap(({series, t_s}) => [series.t[0], series.t.at(-1) + t_s]);
  const span = [Math.min(...times), Math.max(...times)];
  const sync = `section-${index}`;
  const courses = deciding.map(({drive, frame, list}) => {
    const own = driveColor(drives.indexOf(drive));
    const redraw = mountCourse(frame, report.roads[drive.road], drive, own, {sync, span, moved});
    return t => { redraw(t); list.mark(t); };
  });
  shown.forEach((quantity, i) => mountTimePlot(frames[i], quantity, drives, {sync, span, moved}));
}
