// A plot of the plane in metres, with the same scale on both axes at any window size, zoom or paper size.

const xyHint = "drag to zoom, Ctrl + wheel at the pointer, double click for all";

// The bounding box of the points of `lines` ([{X, Y}]), extended by `margin` metres on every side.
function boxAbout(lines, margin) {
  const box = {left: Infinity, right: -Infinity, low: Infinity, high: -Infinity};
  for (const {X, Y} of lines) {
    for (let i = 0; i < X.length; ++i) {
      if (X[i] == null || Y[i] == null) continue;
      box.left = Math.min(box.left, X[i]);
      box.right = Math.max(box.right, X[i]);
      box.low = Math.min(box.low, Y[i]);
      box.high = Math.max(box.high, Y[i]);
    }
  }
  if (box.left > box.right) return {left: -margin, right: margin, low: -margin, high: margin};
  return {left: box.left - margin, right: box.right + margin, low: box.low - margin, high: box.high + margin};
}

// The box, extended in one direction to fill `across` by `down` CSS pixels with one scale.
function filling(box, across, down) {
  const metresPerPixel = Math.max((box.right - box.left) / across, (box.high - box.low) / down);
  const X = (box.left + box.right) / 2;
  const Y = (box.low + box.high) / 2;
  const halfWidth = metresPerPixel * across / 2;
  const halfHeight = metresPerPixel * down / 2;
  return {left: X - halfWidth, right: X + halfWidth, low: Y - halfHeight, high: Y + halfHeight};
}

const isWide = box => box.right - box.left > box.high - box.low;

// The height of a plot as a function of its width [CSS pixels]: that of the box, at least 180 and at most `most`, plus
// the room of the axis.
function heightFor(box, most) {
  const aspect = (box.high - box.low) / (box.right - box.left);
  return width => Math.round(Math.min(most, Math.max(180, (width - roomAcross) * aspect)) + roomDown);
}

// Mounts a plot that shows the box `home`; `draw(pen)` draws its content. `height(width)` is in CSS pixels.
function mountXyPlot(frame, home, height, draw) {
  let box = home;   // the part that must be visible
  let view;         // the visible part: `box` extended to fill the plot
  const fill = width => { view = filling(box, width - roomAcross, height(width) - roomDown); };
  const show = plot => {
    fill(plot.width);
    plot.batch(() => {
      plot.setScale("x", {min: view.left, max: view.right});
      plot.setScale("y", {min: view.low, max: view.high});
    });
  };
  const zoom = (plot, next) => {
    box = next;
    show(plot);
  };

  fill(frame.host.clientWidth);
  const plot = mountPlot(frame, {
    scales: {
      x: {time: false, range: () => [view.left, view.right]},
      y: {range: () => [view.low, view.high]},
    },
    series: [{}, {show: true, points: {show: false}}],
    axes: [axis("bottom", "X [m]", {space: 60}), axis("left", "Y [m]", {space: 36})],
    padding: room.padding,
    cursor: {
      points: {show: false},
      drag: {x: true, y: true, setScale: false},
      bind: {dblclick: shown => () => (zoom(shown, home), null)},
    },
    hooks: {
      draw: [shown => {
        const pen = makePen(shown);
        pen.clipped(() => draw(pen));
      }],
      setCursor: [({cursor, posToVal}) => {
        const inside = cursor.left >= 0;
        frame.readout.textContent = inside
          ? `X = ${number(posToVal(cursor.left, "x"), 2)} m, Y = ${number(posToVal(cursor.top, "y"), 2)} m` : "";
      }],
      setSelect: [shown => {
        const {left, top, width, height: tall} = shown.select;
        if (width < 4 && tall < 4) return;
        zoom(shown, {left: shown.posToVal(left, "x"), right: shown.posToVal(left + width, "x"),
                     low: shown.posToVal(top + tall, "y"), high: shown.posToVal(top, "y")});
        shown.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
      }],
    },
  }, [[view.left, view.right], [null, null]], height, show);

  // The wheel alone scrolls the page; with Ctrl (a pinch on a touch pad) it zooms about the pointer.
  plot.over.addEventListener("wheel", event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const factor = Math.exp(Math.sign(event.deltaY) * 0.2);
    const {left, top} = plot.over.getBoundingClientRect();
    const X = plot.posToVal(event.clientX - left, "x");
    const Y = plot.posToVal(event.clientY - top, "y");
    zoom(plot, {left: X + (view.left - X) * factor, right: X + (view.right - X) * factor,
                low: Y + (view.low - Y) * factor, high: Y + (view.high - Y) * factor});
  }, {passive: false});
  return plot;
}
