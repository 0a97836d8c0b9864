"""Checks a report's page in a headless Chromium: everything is drawn, and nothing is complained of or asked for.

usage: report_page_check.py REPORT.html --plots N [--png FILE]
"""

import argparse

import browser

READ_PLOTS = """
return [...document.querySelectorAll("figure")].map(figure => {
  const canvas = figure.querySelector("canvas");
  const copy = document.createElement("canvas");  // to be read again and again, which the page's own is not
  copy.width = canvas.width;
  copy.height = canvas.height;
  const ctx = copy.getContext("2d", {willReadFrequently: true});
  ctx.drawImage(canvas, 0, 0);
  const pixels = ctx.getImageData(0, 0, copy.width, copy.height).data;
  let drawn = 0, coloured = 0, sum = 0, hash = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] < 128) continue;
    ++drawn;
    const [r, g, b] = [pixels[i], pixels[i + 1], pixels[i + 2]];
    hash = (hash * 31 + i + r + 3 * g + 7 * b) | 0;
    if (Math.max(r, g, b) - Math.min(r, g, b) < 60) continue;
    ++coloured;
    sum += r + g + b;
  }
  return {title: figure.querySelector(".name").textContent, label: canvas.getAttribute("aria-label"), drawn, coloured,
          lightness: coloured ? sum / coloured / 3 : 0, hash};
});
"""
# Axes and grid are grey; the curves of drives are coloured. Number of pixels.
LEAST_COLOURED = 200


def read_plots(chromium):
    return chromium.run(READ_PLOTS)


def complaints(chromium):
    return [entry for entry in chromium.log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def check_page(chromium, path, plots):
    """Loads the page; raises AssertionError if it is not whole."""
    chromium.log("browser")
    chromium.requests()
    chromium.go(path)
    chromium.wait_for("return document.documentElement.dataset.ready === '1' ||"
                      "document.querySelector('.fault') !== null", "the page to be drawn")
    faults = chromium.run("return [...document.querySelectorAll('.fault')].map(fault => fault.textContent)")
    assert not faults, f"the page reports a fault: {faults}"
    reported = int(chromium.run("return document.documentElement.dataset.plots"))
    seen = read_plots(chromium)
    assert reported == plots and len(seen) == plots, f"{reported} plots reported and {len(seen)} seen, not {plots}"
    for plot in seen:
        assert plot["title"] and plot["label"], f"a plot has no name: {plot}"
        assert plot["coloured"] >= LEAST_COLOURED, f"nothing is drawn in {plot}"
    assert not (reported := complaints(chromium)), f"the browser complains: {reported}"
    asked = chromium.requests()
    asked += chromium.run("return performance.getEntriesByType('resource').map(entry => entry.name)")
    foreign = [address for address in asked if not address.startswith(("file:", "data:"))]
    assert asked and not foreign, f"the page asks for {foreign}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report")
    parser.add_argument("--plots", type=int, required=True)
    parser.add_argument("--png", help="a picture of the whole page")
    options = parser.parse_args()
    with browser.Browser() as chromium:
        check_page(chromium, options.report, options.plots)
        if options.png:
            with open(options.png, "wb") as file:
                file.write(chromium.screenshot())


if __name__ == "__main__":
    main()
