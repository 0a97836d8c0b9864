// Plots of one quantity over time, with the drives of a section overlaid.

// `span`: the least range of the axis, so that rounding does not look like motion. `limits`: the member of the drive's
// limits; `limit`: a fixed limit. `scheduling`: exists only for controllers that schedule a model.
const quantities = [
  {key: "delta", title: "Steering angle", axis: "δ [rad]", decimals: 4, span: 0.02, limits: "delta"},
  {key: "a", title: "Acceleration", axis: "a [m/s²]", decimals: 3, span: 0.2, limits: "a"},
  {key: "upsilon", title: "Speed", axis: "υ [m/s]", decimals: 2, span: 1, reference: "upsilon_ref"},
  {key: "solve_time", title: "Solve time", axis: "time of a step [µs]", decimals: 0, log: true},
  {key: "scheduling_error", title: "Scheduling error", axis: "error [trust radii]", decimals: 3, span: 0.1,
   fromZero: true, limit: 1, scheduling: true},
  {key: "active_rows", title: "Active trust-region rows", axis: "rows [count]", decimals: 0, span: 2, fromZero: true,
   stepped: true, scheduling: true},
  {key: "largest_slack", title: "Largest slack", axis: "slack [trust radii]", decimals: 3, span: 0.1, fromZero: true,
   scheduling: true},
];

const schedules = ({series}) =>
  quantities.some(({key, scheduling}) => scheduling && series[key].some(value => value !== null));

function valueRange({span, fromZero}, min, max) {
  if (min === null) return [0, span];
  if (fromZero) return [0, Math.max(max * 1.08, span)];
  const middle = (min + max) / 2;
  const half = Math.max((max - min) * 1.16, span) / 2;
  return [middle - half, middle + half];
}

// The range from a tick (1, 2 or 5 times a power of ten) at or below the least value to one at or above the greatest.
function logRange(min, max) {
  if (min === null) return [1, 10];
  const steps = logTicks(10 ** Math.floor(Math.log10(min)), 10 ** Math.ceil(Math.log10(max) + 1e-9));
  return [steps.findLast(step => step <= min), steps.find(step => step >= max)];
}

function logTicks(min, max) {
  const ticks = [];
  for (let decade = Math.floor(Math.log10(min) + 1e-9); 10 ** decade <= max * 1.0001; ++decade) {
    for (const digit of [1, 2, 5]) ticks.push(digit * 10 ** decade);
  }
  return ticks.filter(tick => tick >= min * 0.9999 && tick <= max * 1.0001);
}

// Beyond 8 ticks, about two and a half decades, only the powers of ten are labelled.
function logLabels(plot, ticks) {
  const all = ticks.length <= 8;
  const isDecade = tick => tick.toExponential().startsWith("1e");
  return ticks.map(tick => all || isDecade(tick) ? tick.toLocaleString("en").replaceAll(",", " ") : "");
}

// Runs of steps whose problem was not solved: [[from, to], ...] in seconds, a step being t_s long.
function unsolvedRuns({series, t_s}) {
  const runs = [];
  series.solved.forEach((solved, k) => {
    if (solved !== 0) return;
    const from = series.t[k];
    if (runs.length > 0 && from - runs.at(-1)[1] < t_s / 2) runs.at(-1)[1] = from + t_s;
    else runs.push([from, from + t_s]);
  });
  return runs;
}

// Draws each run as a band over the whole height, with a block in the drive's colour at the bottom, one row per drive.
function drawUnsolved(plot, drives) {
  const {ctx} = plot;
  const {left, top, width, height} = plot.bbox;
  const pixels = uPlot.pxRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  drives.forEach((drive, i) => {
    for (const [from, to] of unsolvedRuns(drive)) {
      const start = plot.valToPos(from, "x", true);
      const wide = Math.max(plot.valToPos(to, "x", true) - start, 2 * pixels);
      ctx.fillStyle = color("unsolved");
      ctx.fillRect(start, top, wide, height);
      ctx.fillStyle = color("bad");
      ctx.fillRect(start, top, wide, 3 * pixels);
      ctx.fillStyle = color(driveColor(i));
      ctx.fillRect(start, top + height - (i + 1) * 5 * pixels, wide, 4 * pixels);
    }
  });
  ctx.restore();
}

function drawLimits(plot, levels) {
  const {ctx} = plot;
  const {left, width} = plot.bbox;
  ctx.save();
  ctx.strokeStyle = color("soft");
  ctx.lineWidth = 1.25 * uPlot.pxRatio;
  ctx.setLineDash([6, 4].map(length => length * uPlot.pxRatio));
  for (const level of levels) {
    if (level < plot.scales.y.min || level > plot.scales.y.max) continue;
    const height = plot.valToPos(level, "y", true);
    ctx.beginPath();
    ctx.moveTo(left, height);
    ctx.lineTo(left + width, height);
    ctx.stroke();
  }
  ctx.restore();
}

function showValues(readout, t, drives, {key, decimals}) {
  readout.replaceChildren();
  if (t === null) return;
  readout.append(element("span", {}, `t = ${number(t, 2)} s`));
  drives.forEach((drive, i) => {
    const k = sampleAt(drive, t);
    const value = k === null ? null : drive.series[key][k];
    readout.append(element("span", {}, element("span", {class: "dot", style: `background: var(--${driveColor(i)})`}),
                           value === null ? "–" : number(value, decimals)));
  });
}

// Mounts the plot of `quantity`. `sync` joins the cursors of a section; `moved(t)` is called with the cursor's time, or
// null when the cursor leaves.
function mountTimePlot(frame, quantity, drives, {sync, span, moved}) {
  const {key, reference, log, stepped} = quantity;
  // A logarithmic axis cannot show values that are not positive.
  const values = name => drives.map(({series}) =>
    [series.t, log ? series[name].map(value => value > 0 ? value : null) : series[name]]);
  const tables = values(key).concat(reference ? values(reference) : []);
  const lines = drives.map((drive, i) => ({
    stroke: () => color(driveColor(i)),
    width: driveWidth(i, drives),
    points: {show: false},
    ...(stepped ? {paths: uPlot.paths.stepped({align: 1})} : {}),
  }));
  const references = reference ? lines.map(line => ({...line, width: line.width * 0.8, dash: [2, 4]})) : [];
  const levels = [quantity.limit ?? [], ...drives.map(drive => drive.limits[quantity.limits] ?? [])].flat();
  const yAxis = log
    ? axis("left", quantity.axis, {splits: (plot, index, min, max) => logTicks(min, max),
                                   filter: (plot, splits) => splits, values: logLabels})
    : axis("left", quantity.axis, {space: 34, ...(stepped ? {incrs: [1, 2, 5, 10, 20, 50]} : {})});

  mountPlot(frame, {
    scales: {
      x: {time: false, range: (plot, min, max) => {
        const all = min <= plot.data[0][0] && max >= plot.data[0].at(-1);
        return all ? span : [Math.max(min, span[0]), Math.min(max, span[1])];
      }},
      y: {distr: log ? 3 : 1, range: (plot, min, max) => log ? logRange(min, max) : valueRange(quantity, min, max)},
    },
    series: [{}, ...lines, ...references],
    axes: [axis("bottom", "t [s]", {space: 50}), yAxis],
    padding: room.padding,
    cursor: {
      y: false,
      points: {size: 7},
      drag: {x: true, y: false, dist: 4},
      sync: {key: sync},
    },
    hooks: {
      drawAxes: [plot => drawUnsolved(plot, drives)],
      draw: [plot => drawLimits(plot, levels)],
      setCursor: [plot => {
        const t = plot.cursor.left >= 0 ? plot.posToVal(plot.cursor.left, "x") : null;
        showValues(frame.readout, t, drives, quantity);
        moved(t);
      }],
    },
  }, uPlot.join(tables), () => 220);
}
