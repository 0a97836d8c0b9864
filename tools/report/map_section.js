// A section of type "map": the outcome of each drive over speed and sideways shift, one grid for each panel.

// The outcomes from best to worst: the fill darkens (in the dark theme it brightens), and each but clear and none
// has a sign, so that they can be distinguished without colour.
const outcomes = {
  clear: {label: "clear", sign: null},
  marginal: {label: "short by less than a centimetre", sign: "slash"},
  touch: {label: "feasible, obstacle touched", sign: "ring"},
  infeasible: {label: "infeasible", sign: "cross"},
  "off-road": {label: "off the road", sign: "bar"},
  none: {label: "not driven", sign: null},
};

function drawOutcome(ctx, outcome, left, top, width, height) {
  const unit = Math.min(width, height);
  const gap = Math.max(1, unit * 0.04);
  ctx.save();
  if (outcome === "none") {
    ctx.strokeStyle = color("rule");
    ctx.lineWidth = gap;
    ctx.strokeRect(left + 1.5 * gap, top + 1.5 * gap, width - 3 * gap, height - 3 * gap);
  } else {
    ctx.fillStyle = color(outcome);
    ctx.fillRect(left + gap, top + gap, width - 2 * gap, height - 2 * gap);
    drawSign(ctx, outcomes[outcome].sign, color(`on-${outcome}`), left + width / 2, top + height / 2, unit * 0.22);
  }
  ctx.restore();
}

function drawSign(ctx, sign, ink, x, y, r) {
  const path = new Path2D();
  if (sign === "ring") path.arc(x, y, r, 0, 2 * Math.PI);
  const stroke = (...ends) => {
    path.moveTo(x + ends[0] * r, y + ends[1] * r);
    path.lineTo(x + ends[2] * r, y + ends[3] * r);
  };
  if (sign === "slash") stroke(-1, 1, 1, -1);
  if (sign === "cross") stroke(-1, -1, 1, 1), stroke(-1, 1, 1, -1);
  if (sign === "bar") stroke(-1, 0, 1, 0);
  ctx.strokeStyle = ink;
  ctx.lineWidth = r * 0.45;
  ctx.stroke(path);
}

// The place of a mark's speed or shift on the grid, interpolated between cells.
function placeOf(value, grid) {
  const next = grid.findIndex(step => step >= value);
  if (next <= 0) return next < 0 ? grid.length - 1 : 0;
  return next - (grid[next] - value) / (grid[next] - grid[next - 1]);
}

function drawMark(ctx, label, x, y) {
  const pixels = uPlot.pxRatio;
  ctx.save();
  ctx.font = font(11 * pixels, 600);
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  const width = ctx.measureText(label).width + 8 * pixels;
  ctx.beginPath();
  ctx.roundRect(x - width / 2, y - 8 * pixels, width, 16 * pixels, 4 * pixels);
  ctx.fillStyle = color("paper");
  ctx.fill();
  ctx.strokeStyle = color("ink");
  ctx.lineWidth = pixels;
  ctx.stroke();
  ctx.fillStyle = color("ink");
  ctx.fillText(label, x, y + 0.5 * pixels);
  ctx.restore();
}

function outcomeSwatch(outcome) {
  const canvas = element("canvas", {width: 40, height: 40, style: "width: 20px; height: 20px", "aria-hidden": "true"});
  const redraw = () => {
    const ctx = canvas.getContext("2d");
    ctx.clearRect(0, 0, 40, 40);
    drawOutcome(ctx, outcome, 0, 0, 40, 40);
  };
  redraw();
  onThemeChange.push(redraw);
  return canvas;
}

function addMap(report, section, body) {
  const present = new Set(section.panels.flatMap(panel => panel.cells.flat()));
  const items = Object.keys(outcomes).filter(outcome => present.has(outcome))
    .map(outcome => ({swatch: outcomeSwatch(outcome), label: outcomes[outcome].label}));
  const frames = section.panels.map(({title}) => plotFigure(title));
  body.append(legend(items), element("div", {class: "panels"}, ...frames.map(frame => frame.figure)));
  section.panels.forEach((panel, i) => {
    mountMap(frames[i], section, panel, section.marks.filter(mark => mark.panel === null || mark.panel === i));
  });
}

function mountMap(frame, {speeds, shifts}, {cells}, marks) {
  const decimals = Math.max(...shifts.map(decimalsOf));
  const ticks = (label, side, steps, text) => axis(side, label, {
    splits: (plot, index, min, max) => steps.map((step, i) => i),
    // Labels as many steps as fit, at equal distances.
    values: (plot, places) => {
      const each = side === "left" ? 16 : 30;
      const pixels = (side === "left" ? plot.bbox.height : plot.bbox.width) / uPlot.pxRatio;
      const nth = Math.max(1, Math.ceil(steps.length * each / pixels));
      return places.map(i => i % nth === 0 ? text(steps[i]) : "");
    },
    grid: {show: false},
    ticks: {show: false},
    border: {show: false},
  });
  const height = width => {
    const cell = Math.min(30, Math.max(18, (width - roomAcross) / speeds.length));
    return Math.round(cell * shifts.length + roomDown);
  };
  mountPlot(frame, {
    scales: {
      x: {time: false, range: () => [-0.5, speeds.length - 0.5]},
      y: {range: () => [-0.5, shifts.length - 0.5]},
    },
    series: [{}, {points: {show: false}}],
    axes: [ticks("speed [m/s]", "bottom", speeds, String),
           ticks("shift [m]", "left", shifts, shift => number(shift, decimals))],
    padding: room.padding,
    cursor: {x: false, y: false, points: {show: false}, drag: {x: false, y: false, setScale: false}},
    hooks: {
      draw: [plot => {
        const at = (i, j) => [plot.valToPos(i, "x", true), plot.valToPos(j, "y", true)];
        cells.forEach((row, j) => row.forEach((outcome, i) => {
          const [left, top] = at(i - 0.5, j + 0.5).map(Math.round);
          const [right, bottom] = at(i + 0.5, j - 0.5).map(Math.round);
          drawOutcome(plot.ctx, outcome, left, top, right - left, bottom - top);
        }));
        for (const {speed, shift, label} of marks) {
          drawMark(plot.ctx, label, ...at(placeOf(speed, speeds), placeOf(shift, shifts)));
        }
      }],
      setCursor: [({cursor, posToVal}) => {
        const i = Math.round(posToVal(cursor.left, "x"));
        const j = Math.round(posToVal(cursor.top, "y"));
        const outcome = cursor.left < 0 ? undefined : cells[j]?.[i];
        frame.readout.textContent = outcome === undefined ? ""
          : `${speeds[i]} m/s, ${number(shifts[j], decimals)} m: ${outcomes[outcome].label}`;
      }],
    },
  }, [[0, 1], [null, null]], height);
}
