// A section of type "fans": the open-loop predictions of consecutive steps, side by side, or stacked if they are wide.

function addFans(report, section, body) {
  const ramp = element("span", {class: "ramp"});
  body.append(legend([
    {swatch: ramp, label: "open-loop predictions, first to last step"},
    {swatch: lineSwatch("ink", {width: 1.5}), label: "driven path"},
    ...roadLegend(section.fans.map(fan => report.drives[fan.drive])),
  ]));
  const frames = section.fans.map(({title}) => plotFigure(title));
  body.append(element("div", {class: "panels"}, ...frames.map(frame => frame.figure)));
  section.fans.forEach((fan, i) => mountFan(frames[i], report, fan));
}

function mountFan(frame, report, {drive: key, from, to}) {
  const drive = report.drives[key];
  const steps = (drive.plans?.k ?? []).filter(k => k >= from && k <= to);
  const plans = steps.map(k => planOf(drive, k)).filter(plan => plan !== null);
  const name = frame.figure.querySelector(".name");
  const {t} = drive.series;
  const hint = plans.length === 0 ? "no predictions here"
    : `${t[steps[0]].toFixed(2)} to ${t[steps.at(-1)].toFixed(2)} s`;
  name.append(element("span", {class: "hint"}, ` – ${hint}`));

  const inView = {X: drive.series.X.slice(from, to + 1), Y: drive.series.Y.slice(from, to + 1)};
  const home = boxAbout([...plans, inView], 0.6);
  if (isWide(home)) frame.figure.classList.add("wide");
  mountXyPlot(frame, home, heightFor(home, 680), pen => {
    drawRoad(pen, report.roads[drive.road]);
    drawObstacles(pen, [drive], closestSample);
    pen.line(drive.series.X, drive.series.Y, {color: color("ink"), width: 1.5});
    plans.forEach((plan, i) => {
      const own = rampColor(plans.length === 1 ? 1 : i / (plans.length - 1));
      pen.line(plan.X, plan.Y, {color: own, width: 1.25});
      pen.dots(plan.X, plan.Y, 2, {fill: own});
    });
  });
}
