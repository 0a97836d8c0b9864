// Common parts of all plots: the figure, the axes, and the list of plots to resize and redraw.
const plots = [];

// A figure with its caption: {figure, host, title, readout}. `hint` describes what the mouse can do.
function plotFigure(title, hint = "") {
  const readout = element("span", {class: "readout"});
  const name = element("span", {class: "name"}, title);
  if (hint) name.append(element("span", {class: "hint mouse"}, ` – ${hint}`));
  const host = element("div", {class: "plot"});
  return {figure: element("figure", {}, element("figcaption", {}, name, readout), host), host, title, readout};
}

// Creates the uPlot of a figure that is already in the document. `height(width)` is in CSS pixels; `resized` is called
// after every change of size.
function mountPlot({host, title}, options, data, height, resized = () => {}) {
  const width = host.clientWidth;
  const plot = new uPlot({...options, width, height: height(width), legend: {show: false}}, data, host);
  const canvas = plot.root.querySelector("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", title);
  const fit = () => {
    if (host.clientWidth === 0 || host.clientWidth === plot.width) return;
    plot.batch(() => {
      plot.setSize({width: host.clientWidth, height: height(host.clientWidth)});
      resized(plot);
    });
  };
  plots.push({plot, fit});
  // Deferred, because a size that changes within its observer would trigger the observer again.
  new ResizeObserver(() => requestAnimationFrame(fit)).observe(host);
  return plot;
}

// Functions that redraw canvases outside the plots after the colours have changed.
const onThemeChange = [];

const axisFont = font(12);

// Room of the axes in CSS pixels. It is fixed so that stacked plots line up and an aspect ratio can be kept.
const room = {left: {size: 52, labelSize: 20}, bottom: {size: 26, labelSize: 18}, padding: [8, 14, 0, 0]};
const roomAcross = room.left.size + room.left.labelSize + room.padding[1];
const roomDown = room.bottom.size + room.bottom.labelSize + room.padding[0];

function axis(side, label, more = {}) {
  return {
    label,
    ...room[side],
    side: side === "left" ? 3 : 2,
    labelGap: 0,
    labelFont: axisFont,
    font: axisFont,
    gap: 4,
    stroke: () => color("soft"),
    grid: {stroke: () => color("grid"), width: 1},
    ticks: {stroke: () => color("rule"), width: 1, size: 4},
    border: {show: true, stroke: () => color("rule"), width: 1},
    values: (plot, splits, index, space, step) => splits.map(value => number(value, decimalsOf(step))),
    ...more,
  };
}

// The number of decimals of the step between two ticks, at most 9.
function decimalsOf(step) {
  let decimals = 0;
  while (decimals < 9 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) ++decimals;
  return decimals;
}

// A number with a true minus sign, and none if it rounds to zero.
const number = (value, decimals) => value.toFixed(decimals).replace(/^-(?=.*[1-9])/, "−").replace("-", "");
