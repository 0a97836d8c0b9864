// Draws in metres on a plot whose scales are x and y. `style`: {color, width, dash, fill, alpha}, widths in CSS pixels.
function makePen(plot) {
  const {ctx} = plot;
  const at = (X, Y) => [plot.valToPos(X, "x", true), plot.valToPos(Y, "y", true)];
  const pixelsPerMetre = plot.bbox.width / (plot.scales.x.max - plot.scales.x.min);

  function finish(path, {color: stroke, width = 1.5, dash = [], fill, alpha = 1}) {
    ctx.save();
    ctx.lineJoin = "round";
    ctx.globalAlpha = alpha;
    if (fill) {
      ctx.fillStyle = fill;
      ctx.fill(path);
    }
    if (stroke) {
      ctx.strokeStyle = stroke;
      ctx.lineWidth = width * uPlot.pxRatio;
      ctx.setLineDash(dash.map(length => length * uPlot.pxRatio));
      ctx.stroke(path);
    }
    ctx.restore();
  }

  return {
    // Clips everything that `draw` draws to the plotting area.
    clipped(draw) {
      const {left, top, width, height} = plot.bbox;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      draw();
      ctx.restore();
    },

    // A null sample leaves a gap in the line.
    line(X, Y, style) {
      const path = new Path2D();
      let down = false;
      for (let i = 0; i < X.length; ++i) {
        if (X[i] == null || Y[i] == null) down = false;
        else if (down) path.lineTo(...at(X[i], Y[i]));
        else down = (path.moveTo(...at(X[i], Y[i])), true);
      }
      finish(path, style);
    },

    // Closed areas, each a list of corners [X, Y], filled as one.
    areas(areas, style) {
      const path = new Path2D();
      for (const corners of areas) {
        corners.forEach(([x, y], i) => i === 0 ? path.moveTo(...at(x, y)) : path.lineTo(...at(x, y)));
        path.closePath();
      }
      finish(path, style);
    },

    // `shift`: across and down, `size`: of the font, in CSS pixels.
    text(X, Y, text, {color: ink, align = "left", size = 11, shift = [0, 0]}) {
      const [left, top] = at(X, Y);
      ctx.save();
      ctx.font = font(size * uPlot.pxRatio, 600);
      ctx.textAlign = align;
      ctx.textBaseline = "middle";
      ctx.fillStyle = ink;
      ctx.fillText(text, left + shift[0] * uPlot.pxRatio, top + shift[1] * uPlot.pxRatio);
      ctx.restore();
    },

    dots(X, Y, radius, style) {
      const path = new Path2D();
      X.forEach((x, i) => {
        const [left, top] = at(x, Y[i]);
        path.moveTo(left + radius * uPlot.pxRatio, top);
        path.arc(left, top, radius * uPlot.pxRatio, 0, 2 * Math.PI);
      });
      finish(path, style);
    },

    crosses(X, Y, radius, style) {
      const path = new Path2D();
      const r = radius * uPlot.pxRatio;
      X.forEach((x, i) => {
        const [left, top] = at(x, Y[i]);
        path.moveTo(left - r, top - r);
        path.lineTo(left + r, top + r);
        path.moveTo(left - r, top + r);
        path.lineTo(left + r, top - r);
      });
      finish(path, style);
    },

    // The obstacle enlarged by `margin` [m]: an ellipse with longer semi-axes, a box with arcs about its corners.
    obstacle({X, Y, shape, r_x, r_y, heading}, margin, style) {
      const path = new Path2D();
      if (shape === "box") {
        [[1, 1], [-1, 1], [-1, -1], [1, -1]].forEach(([ahead, left], quarter) => {
          const corner = at(X + ahead * r_x * Math.cos(heading) - left * r_y * Math.sin(heading),
                            Y + ahead * r_x * Math.sin(heading) + left * r_y * Math.cos(heading));
          const from = -heading - quarter * Math.PI / 2;
          path.arc(...corner, margin * pixelsPerMetre, from, from - Math.PI / 2, true);
        });
        path.closePath();
      } else {
        path.ellipse(...at(X, Y), (r_x + margin) * pixelsPerMetre, (r_y + margin) * pixelsPerMetre, -heading, 0,
                     2 * Math.PI);
      }
      finish(path, style);
    },

    // The vehicle's rectangle about (X, Y) with a wedge that points ahead; a dot if these would be too small to see.
    vehicle(X, Y, psi, {front, rear, width}, style) {
      if ((front + rear) * pixelsPerMetre < 9 * uPlot.pxRatio) {
        this.dots([X], [Y], 4, {...style, color: color("paper"), fill: style.color});
        return;
      }
      const corner = (ahead, left) => at(X + ahead * Math.cos(psi) - left * Math.sin(psi),
                                         Y + ahead * Math.sin(psi) + left * Math.cos(psi));
      const path = new Path2D();
      path.moveTo(...corner(front, width / 2));
      path.lineTo(...corner(-rear, width / 2));
      path.lineTo(...corner(-rear, -width / 2));
      path.lineTo(...corner(front, -width / 2));
      path.closePath();
      path.moveTo(...corner(0, width / 2));
      path.lineTo(...corner(front, 0));
      path.lineTo(...corner(0, -width / 2));
      finish(path, style);
    },
  };
}
