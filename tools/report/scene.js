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

// The obstacle moved to its position at time `t`.
const obstacleAt = (obstacle, t) =>
  ({...obstacle, X: obstacle.X + obstacle.velocity_X * t, Y: obstacle.Y + obstacle.velocity_Y * t});

// The obstacle moved to its position at sample `k` of the drive, or at the start if `k` is null.
const placedAt = (obstacle, {series}, k) => obstacleAt(obstacle, k === null ? 0 : series.t[k]);

// The sample at which the drive is nearest to the obstacle's centre; null if it has no pose at all.
function closestSample(drive, obstacle) {
  let best = null;
  let least = Infinity;
  drive.series.t.forEach((t, k) => {
    if (!hasPose(drive, k)) return;
    const {X, Y} = obstacleAt(obstacle, t);
    const distance = Math.hypot(drive.series.X[k] - X, drive.series.Y[k] - Y);
    if (distance < least) [best, least] = [k, distance];
  });
  return best;
}

// The open-loop prediction of step `k` in the plane; null if the report contains none.
function planOf({plans, series}, k) {
  const i = plans ? plans.k.indexOf(k) : -1;
  if (i < 0 || series.X[k] == null || series.Y[k] == null) return null;
  return {X: plans.dX[i].map(dX => series.X[k] + dX), Y: plans.dY[i].map(dY => series.Y[k] + dY)};
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

// Draws the obstacles of several drives at sample `sample(drive, obstacle)`; obstacles that coincide are drawn once.
function drawObstacles(pen, drives, sample) {
  const drawn = new Set();
  for (const drive of drives) {
    for (const obstacle of drive.obstacles) {
      const placed = placedAt(obstacle, drive, sample(drive, obstacle));
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
  const {X, Y, shape, r_x, r_y, margin} = placedAt(obstacle, drive, closestSample(drive, obstacle));
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
