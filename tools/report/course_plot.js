// A plot of the course over time: where along it the vehicle was, and when each object covered which part of it; beside
// it the list of the decisions that the controller took.

const noDecision = -1;

// The index of the decision that holds at time `t`.
function decisionAt({decisions}, t) {
  if (t === null || decisions.length === 0 || t < decisions[0].t) return noDecision;
  return lastUpTo(decisions.map(decision => decision.t), t);
}

// {root, mark(t)}: the list of a drive's decisions, and a function that marks the one at the cursor's time.
function decisionList({decisions, ...drive}) {
  const rows = decisions.map(({t, decision, reason}, i) => element("tr", {},
    element("td", {class: "number"}, String(i + 1)), element("td", {class: "number"}, number(t, 2)),
    element("td", {}, unbroken(decision)), element("td", {}, unbroken(reason))));
  const head = ["", "t [s]", "decision", "reason"].map((text, i) =>
    element("th", {scope: "col", class: i < 2 ? "number" : ""}, text));
  const table = element("table", {class: "data"}, element("thead", {}, element("tr", {}, ...head)),
                        element("tbody", {}, ...rows));
  const root = element("div", {class: "decisions table-wrap", tabindex: "0"}, table);
  let marked = noDecision;
  const mark = t => {
    const now = decisionAt({decisions, ...drive}, t);
    if (now === marked) return;
    rows[marked]?.classList.remove("now");
    rows[now]?.classList.add("now");
    marked = now;
    // The list alone is scrolled, not the page.
    if (now !== noDecision) root.scrollTop = rows[now].offsetTop - root.clientHeight / 2;
  };
  return {root, mark};
}

const courseLegend = drive => legend([
  {swatch: swatch(`<path d="M0 13L30 4V1L0 10Z" fill="var(--drive-0)" opacity="0.35"/>` +
                  `<path d="M0 11.5L30 2.5" stroke="var(--drive-0)" stroke-width="2"/>`),
   label: "vehicle from rear to front"},
  ...(drive.obstacles.some(({places}) => places.s.some(s => s.length > 0)) ? [{
    swatch: swatch(`<path d="M0 9L30 5V1L0 5Z" fill="var(--obstacle)" stroke="var(--obstacle-edge)"/>`),
    label: "part of the road covered by an object, with its id"}] : []),
  ...(drive.series.stop.some(s => s !== null) ? [{
    swatch: swatch(`<path d="M0 7H30" stroke="var(--bad)" stroke-width="2" stroke-dasharray="2 2"/>`),
    label: "line before which it is to stop"}] : []),
  ...(drive.plans?.k.length > 0 ? [{
    swatch: swatch(`<path d="M3 7H27" stroke="var(--soft)"/>` + [5, 15, 25].map(x =>
      `<circle cx="${x}" cy="7" r="2.75" fill="var(--paper)" stroke="var(--soft)" stroke-width="1.25"/>`).join("")),
    label: "plan at the cursor"}] : []),
  {swatch: swatch(`<circle cx="15" cy="7" r="6.5" fill="var(--paper)" stroke="var(--ink)"/>` +
                  `<text x="15" y="10" font-size="9" text-anchor="middle" fill="var(--ink)">1</text>`),
   label: "decision, as listed"},
]);

// The arc length of the road's reference line beside each point, searched from `from` on.
function arcLengths({X, Y}, points, from) {
  const lengths = [0];
  for (let i = 1; i < X.length; ++i) lengths.push(lengths[i - 1] + Math.hypot(X[i] - X[i - 1], Y[i] - Y[i - 1]));
  let i = Math.min(lastUpTo(lengths, from), X.length - 2);
  const along = (j, x, y) => {
    const [dX, dY] = [X[j + 1] - X[j], Y[j + 1] - Y[j]];
    return ((x - X[j]) * dX + (y - Y[j]) * dY) / (dX * dX + dY * dY);
  };
  return points.X.map((x, p) => {
    const y = points.Y[p];
    while (i + 2 < X.length && along(i, x, y) > 1) ++i;
    while (i > 0 && along(i, x, y) < 0) --i;
    return lengths[i] + along(i, x, y) * (lengths[i + 1] - lengths[i]);
  });
}

// The places of an object on the course as bands over time: [{from: [t, s], to: [t, s], half}, ...].
function bandsOf({places, to}, {series, t_s}) {
  const {k, s, half_length: half} = places;
  const bands = [];
  k.forEach((step, i) => {
    const next = i + 1 < k.length ? k[i + 1] : to;
    const [start, end] = [series.t[step], next > step ? series.t[next] : series.t[step] + t_s];
    for (const place of s[i]) {
      // It moves steadily to its next place if that is near; otherwise it stays until it is seen elsewhere.
      const after = (s[i + 1] ?? []).find(other => Math.abs(other - place) < 60 * (end - start) + 0.1);
      bands.push({from: [start, place], to: [end, after ?? place], half: half[i]});
    }
  });
  return bands;
}

function drawBands(pen, drive) {
  for (const obstacle of drive.obstacles) {
    const bands = bandsOf(obstacle, drive);
    if (bands.length === 0) continue;
    pen.areas(bands.map(({from: [t, s], to: [then, there], half}) =>
      [[t, s - half], [then, there - half], [then, there + half], [t, s + half]]), {fill: color("obstacle")});
    for (const side of [-1, 1]) {
      pen.line(bands.flatMap(({from, to}) => [from[0], to[0], null]),
               bands.flatMap(({from, to, half}) => [from[1] + side * half, to[1] + side * half, null]),
               {color: color("obstacle-edge"), width: 0.75});
    }
  }
}

// The id of each object where its band begins or enters the picture, unless another one is there.
function drawIds(pen, drive, plot) {
  const {x, y} = plot.scales;
  const taken = [];
  for (const obstacle of drive.obstacles) {
    const seen = bandsOf(obstacle, drive).find(({from: [t, s], to: [then]}) =>
      then > x.min && t < x.max && s > y.min && s < y.max);
    if (!seen) continue;
    const [t, s] = [Math.max(seen.from[0], x.min), seen.from[1]];
    const place = [plot.valToPos(t, "x"), plot.valToPos(s, "y")];
    if (taken.some(([left, top]) => Math.abs(place[0] - left) < 18 && Math.abs(place[1] - top) < 12)) continue;
    taken.push(place);
    pen.text(t, s, String(obstacle.id), {color: color("ink"), shift: [4, 0]});
  }
}

// The line before which the vehicle is to stop. It is interrupted where it jumps.
function drawStopLine(pen, {series: {t, stop}}) {
  const jump = 5;   // [m]
  let from = 0;
  for (let k = 1; k <= t.length; ++k) {
    if (k < t.length && Math.abs(stop[k] - stop[k - 1]) < jump + 60 * (t[k] - t[k - 1])) continue;
    pen.line(t.slice(from, k), stop.slice(from, k), {color: color("bad"), width: 1.5, dash: [2, 2]});
    from = k;
  }
}

function drawDecisions(pen, {decisions, series}) {
  const numbered = decisions.length <= 40;
  decisions.forEach(({t}, i) => {
    const s = series.s[lastUpTo(series.t, t)];
    if (s === null) return;
    pen.dots([t], [s], numbered ? 7 : 2.5, {color: color("ink"), width: 1, fill: color("paper")});
    if (numbered) pen.text(t, s, String(i + 1), {color: color("ink"), align: "center", size: 9});
  });
}

// Mounts the plot. Returns the function that draws it for a time of the cursor, or without one for null.
function mountCourse(frame, road, drive, own, {sync, span, moved}) {
  const {series, outline} = drive;
  let time = null;
  const driven = series.s.filter(s => s !== null);
  const [least, greatest] = driven.length > 0 ? [Math.min(...driven), Math.max(...driven)] : [0, 0];
  const rim = 0.04 * (greatest - least) + 5;
  const extent = {low: least - rim, high: greatest + rim};
  const plot = mountPlot(frame, {
    scales: {
      x: {time: false, range: (shown, min, max) => {
        const all = min <= shown.data[0][0] && max >= shown.data[0].at(-1);
        return all ? span : [Math.max(min, span[0]), Math.min(max, span[1])];
      }},
      y: {range: (shown, min, max) => min === null ? [extent.low, extent.high]
        : [Math.max(min - rim, extent.low), Math.min(max + rim, extent.high)]},
    },
    series: [{}, {stroke: () => color(own), width: 2, points: {show: false}}],
    axes: [axis("bottom", "t [s]", {space: 50}), axis("left", "s [m]", {space: 36})],
    padding: room.padding,
    cursor: {y: false, points: {size: 7}, drag: {x: true, y: false, dist: 4}, sync: {key: sync}},
    hooks: {
      drawAxes: [shown => {
        const pen = makePen(shown);
        pen.clipped(() => {
          drawBands(pen, drive);
          const ends = [series.s.map(s => s === null ? null : s - outline.rear),
                        series.s.map(s => s === null ? null : s + outline.front)];
          pen.areas([[...series.t.map((t, k) => [t, ends[0][k]]), ...series.t.map((t, k) => [t, ends[1][k]]).reverse()]],
                    {fill: color(own), alpha: 0.3});
          drawStopLine(pen, drive);
        });
      }],
      draw: [shown => {
        const pen = makePen(shown);
        pen.clipped(() => {
          drawIds(pen, drive, shown);
          drawDecisions(pen, drive);
          const k = sampleAt(drive, time);
          const plan = k === null ? null : planOf(drive, k);
          if (!plan) return;
          drawPlan(pen, {X: plan.X.map((x, i) => series.t[plan.step] + i * drive.t_s),
                         Y: arcLengths(road.reference, plan, series.s[plan.step])}, color(own), color("paper"));
        });
      }],
      setCursor: [shown => {
        const t = shown.cursor.left >= 0 ? shown.posToVal(shown.cursor.left, "x") : null;
        const now = drive.decisions[decisionAt(drive, t)];
        frame.readout.textContent = now ? now.decision : "";
        moved(t);
      }],
    },
  }, [series.t, series.s], () => 380);
  return t => {
    time = t;
    plot.redraw(false, false);
  };
}
