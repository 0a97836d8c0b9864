// Parts shared by the plots of the plane: samples, obstacles, open-loop predictions, roads and the road's legend.

// The index of the drive's sample nearest to time `t`; null outside the drive.
function sampleAt({series, t_s}, t) {
  const times = series.t;
  if (t === null || t < times[0] - t_s || t > times.at(-1) + t_s) return null;
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return t - times[low] <= times[high] - t ? low : high;
}

const hasPose = ({series}, k) => series.X[k] != null && series.Y[k] != null && series.psi[k] != null;

// The index of the last number of the rising `numbers` that is at most `value`; 0 if all are greater.
function lastUpTo(numbers, value) {
  let low = 0;
  let high = numbers.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= value) low = middle;
    else high = middle;
  }
  return low;
}

const isThere = ({from, to}, k) => k >= from && k <= to;

// What identifies an obstacle among those of several drives.
const obstacleKey = ({id, shape, r_x, r_y, places}) => JSON.stringify([id, shape, r_x, r_y, places.X[0], places.Y[0]]);

// The obstacle with its place at sample `k`, or with its first one if `k` is null.
function placedAt({shape, r_x, r_y, margin, places}, k) {
  const i = k === null ? 0 : lastUpTo(places.k, k);
  return {shape, r_x, r_y, margin, X: places.X[i], Y: places.Y[i], heading: places.heading[i]};
}

// The sample at which the drive is nearest to the obstacle's centre, with the distance; null if it never saw it.
function closest(drive, obstacle) {
  let best = null;
  for (let k = obstacle.from; k <= obstacle.to; ++k) {
    if (!hasPose(drive, k)) continue;
    const {X, Y} = placedAt(obstacle, k);
    const distance = Math.hypot(drive.series.X[k] - X, drive.series.Y[k] - Y);
    if (best === null || distance < best.distance) best = {k, distance};
  }
  return best;
}
const closestSample = (drive, obstacle) => closest(drive, obstacle)?.k ?? null;

// The open-loop prediction of step `k` in the plane, or if there is none that of the last step before it, at most half a
// second ago: {step, X, Y}; null if the report contains none.
function planOf({plans, series}, k) {
  if (!plans || plans.k.length === 0) return null;
  const i = lastUpTo(plans.k, k);
  const step = plans.k[i];
  if (step > k || series.t[k] - series.t[step] > 0.5 || series.X[step] == null || series.Y[step] == null) return null;
  return {step, X: plans.dX[i].map(dX => series.X[step] + dX), Y: plans.dY[i].map(dY => series.Y[step] + dY)};
}

function drawRoad(pen, {reference, left, right}) {
  const edge = {color: color("road"), width: 2};
  pen.line(left.X, left.Y, edge);
  pen.line(right.X, right.Y, edge);
  pen.line(reference.X, reference.Y, {color: color("road"), width: 1, dash: [6, 4]});
}

function drawObstacle(pen, obstacle) {
  pen.obstacle(obstacle, 0, {fill: color("obstacle"), color: color("obstacle-edge"), width: 1});
  pen.obstacle(obstacle, obstacle.margin, {color: color("obstacle-edge"), width: 1, dash: [4, 3]});
}

// Draws the obstacles of several drives at sample `sample(drive, obstacle)`, if they are there then; those that coincide
// are drawn once.
function drawObstacles(pen, drives, sample) {
  const drawn = new Set();
  for (const drive of drives) {
    for (const obstacle of drive.obstacles) {
      const k = sample(drive, obstacle);
      if (k !== null && !isThere(obstacle, k)) continue;
      const placed = placedAt(obstacle, k);
      const key = JSON.stringify(placed);
      if (!drawn.has(key)) drawObstacle(pen, placed);
      drawn.add(key);
    }
  }
}

const roadsOf = (report, drives) => [...new Set(drives.map(drive => drive.road))].map(key => report.roads[key]);

// Two opposite corners of a square around the obstacle and its margin, where `drive` is nearest, as a line for
// boxAbout().
function extentOf(obstacle, drive) {
  const {X, Y, shape, r_x, r_y, margin} = placedAt(obstacle, closestSample(drive, obstacle));
  const radius = (shape === "box" ? Math.hypot(r_x, r_y) : Math.max(r_x, r_y)) + margin;
  return {X: [X - radius, X + radius], Y: [Y - radius, Y + radius]};
}

const obstacleSwatch = ellipse => swatch(ellipse
  ? `<ellipse cx="15" cy="7" rx="8" ry="4" fill="var(--obstacle)" stroke="var(--obstacle-edge)"/>` +
    `<ellipse cx="15" cy="7" rx="12" ry="6.4" fill="none" stroke="var(--obstacle-edge)" stroke-dasharray="3 2"/>`
  : `<rect x="7" y="3" width="16" height="8" fill="var(--obstacle)" stroke="var(--obstacle-edge)"/>` +
    `<rect x="4.5" y="0.5" width="21" height="13" rx="2.5" fill="none" stroke="var(--obstacle-edge)" ` +
    `stroke-dasharray="3 2"/>`);

const roadLegend = drives => [
  {swatch: lineSwatch("road", {width: 2}), label: "road edges"},
  {swatch: lineSwatch("road", {width: 1.2, dash: "6 4"}), label: "reference"},
  ...(drives.some(drive => drive.obstacles.length > 0) ? [{
    swatch: obstacleSwatch(drives.some(drive => drive.obstacles.some(obstacle => obstacle.shape === "ellipse"))),
    label: "obstacle and its margin",
  }] : []),
];
