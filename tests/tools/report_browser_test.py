"""The page of a report in a headless Chromium.

usage: report_browser_test.py RENDER_REPORT
"""

import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import browser
import report_fixture
from report_page_check import LEAST_COLOURED, check_page, complaints, read_plots

RENDER_REPORT = ""
# Parts of the page's script are not reachable from outside; this one needs no other but uPlot, which is global.
PEN = (pathlib.Path(__file__).parents[2] / "tools/report/pen.js").read_text(encoding="utf-8")
TITLE = "A bend & <two> controllers"
# The first section with drives, its plane and its plots over time.
DRIVES = "section:nth-of-type(4)"
PLANE = f"{DRIVES} > figure .u-over"
PLANE_READOUT = f"return document.querySelector('{DRIVES} > figure .readout').textContent"


def time_plot(i):
    return f"{DRIVES} .plots figure:nth-child({i}) .u-over"


def emptied(report):
    """The same report with nothing in it that has a colour: axes, roads and obstacles alone."""
    for drive in report["drives"].values():
        steps = len(drive["series"]["t"])
        drive["series"] = {name: drive["series"]["t"] if name == "t" else [None] * steps for name in drive["series"]}
        # A scheduling series keeps its plot if it has a value: a zero at one step, which makes no line.
        drive["series"]["active_rows"] = [0 if drive["controller"] != "nmpc" and k == 0 else None for k in range(steps)]
        drive["plans"] = {"k": [], "dX": [], "dY": []}
    for section in report["sections"]:
        for panel in section.get("panels", []):
            panel["cells"] = [["none"] * len(row) for row in panel["cells"]]
    return report


def light_shares(pdf):
    """Of each page of a PDF: the share of its pixels that are light."""
    with tempfile.NamedTemporaryFile(suffix=".pdf") as file:
        file.write(pdf)
        file.flush()
        command = [browser.program("pdftoppm"), "-r", "40", file.name]
        images = subprocess.run(command, capture_output=True, check=True).stdout
    shares = []
    while images:
        header = re.match(rb"P6\s(\d+)\s(\d+)\s255\s", images)
        size = 3 * int(header[1]) * int(header[2])
        pixels = images[header.end():header.end() + size]
        shares.append(sum(value > 200 for value in pixels) / size)
        images = images[header.end() + size:]
    return shares


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.page = cls.write(report_fixture.report())
        cls.chromium = cls.enterClassContext(browser.Browser())

    @classmethod
    def write(cls, report, change=lambda html: html):
        made = subprocess.run([RENDER_REPORT, TITLE], input=json.dumps(report), capture_output=True, text=True,
                              check=True)
        path = os.path.join(cls.folder.name, "report.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(change(made.stdout))
        return path

    def setUp(self):
        self.chromium.set_scheme("light")
        self.chromium.set_width(1280)

    def open(self, plots=report_fixture.PLOTS):
        check_page(self.chromium, self.write(report_fixture.report()), plots)

    def texts(self, selector):
        return self.chromium.run("return [...document.querySelectorAll(arguments[0])].map(e => e.textContent)",
                                 selector)

    def assert_check_fails(self, path, pattern):
        with self.assertRaisesRegex(AssertionError, pattern):
            check_page(self.chromium, path, report_fixture.PLOTS)

    def test_everything_of_the_data_is_there(self):
        self.open()
        report = report_fixture.report()
        self.assertEqual(self.chromium.run("return document.title"), TITLE)
        self.assertEqual(self.texts("h1"), [report["title"]])
        self.assertEqual(self.texts(".subtitle"), [report["subtitle"]])
        self.assertEqual(self.texts("h2"), [s["title"] for s in report["sections"] if s["title"]])
        labels = self.texts(".legend .label")
        for drive in report["drives"].values():
            self.assertIn(drive["name"], labels)
        for label in ("unsolved step", "obstacle and its margin", "short by less than a centimetre", "infeasible"):
            self.assertIn(label, labels)
        self.assertIn("N = 8, 14 steps unsolved", self.texts(".legend .detail"))
        self.assertEqual(self.texts("section:nth-of-type(3) th"), ["quantity", "controller", "paper", "here"])
        self.assertEqual(self.texts("td.bad"), ["✗14", "✗1"])
        self.assertEqual(self.texts("section:nth-of-type(3) th.number"), ["paper", "here"])
        self.assertEqual(self.texts("td[rowspan]"), ["infeasible steps", "clearance", "mean solve time"])
        self.assertEqual(self.texts("section:nth-of-type(3) tbody tr:last-child .number"),
                         ["0", "✗1", "0.10 m", "✓0.08 m", "–", "9 310 µs"])
        self.assertEqual(self.texts(".tile dd.good"), ["✓0.082 m", "✓0.71 radii"])
        captions = self.texts("figcaption .name")
        for title, times in (("Course over time: LPVMPC, trust region", 1), ("Driven paths", 2),
                             ("At obstacle 1", 2), ("At obstacle 2", 2), ("Steering angle", 2),
                             ("Scheduling error", 1), ("Trust region", 1), ("lpv", 2)):
            self.assertEqual(sum(name.startswith(title) for name in captions), times, title)

    def test_the_page_is_small(self):
        self.assertLess(os.path.getsize(self.page), 400_000)

    def test_a_cursor_over_one_plot_moves_those_of_its_section_and_the_vehicles(self):
        self.open()
        before = [plot["hash"] for plot in read_plots(self.chromium)]
        self.chromium.point(time_plot(2), 0.5, 0.5)
        self.chromium.wait_for(PLANE_READOUT + ".startsWith('t = ')", "the plane to tell the cursor's time")
        places = self.chromium.run("""
          return [...document.querySelectorAll(arguments[0] + " .plots .u-over")].map(over => {
            const cursor = over.querySelector(".u-cursor-x").getBoundingClientRect();
            const area = over.getBoundingClientRect();
            return (cursor.right - area.left) / area.width;
          })""", DRIVES)
        self.assertEqual(len(places), 7)
        for place in places:
            self.assertAlmostEqual(place, 0.5, delta=0.01)
        readouts = self.texts(f"{DRIVES} .plots .readout")
        for text in readouts + self.texts(f"{DRIVES} > figure .readout"):
            self.assertAlmostEqual(float(re.match(r"t = (\d+\.\d+) s", text)[1]), 6.0, delta=0.05)
        changed = [i for i, plot in enumerate(read_plots(self.chromium)) if plot["hash"] != before[i]]
        self.assertEqual(changed, [0, 1, 2, 3])  # only planes and course of this section; cursors are not in a canvas

        self.chromium.point("h1", 0.5, 0.5)
        self.chromium.wait_for(PLANE_READOUT + " === ''", "the cursor to go")
        self.assertEqual([plot["hash"] for plot in read_plots(self.chromium)], before)

    def test_the_decisions_are_listed_and_the_one_at_the_cursor_is_marked(self):
        self.open()
        decisions = f"{DRIVES} .decisions tbody tr"
        self.assertEqual(self.texts(decisions), [f"{i}{d['t']:.2f}{d['decision']}{d['reason']}".replace("1 on", "1\u00a0on")
                                                 for i, d in enumerate(report_fixture.DECISIONS, 1)])
        self.assertEqual(self.texts(f"{decisions}.now"), [])
        course = f"{DRIVES} .course .u-over"
        for across, shown in ((0.2, "drives"), (0.5, "passes object 1 on the left"), (0.9, "yields to object 2")):
            self.chromium.point(course, across, 0.5)
            readout = f"document.querySelector('{DRIVES} .course .readout').textContent"
            self.chromium.wait_for(f"return {readout} === {shown!r}", shown)
            self.chromium.wait_for(f"return document.querySelector('{decisions}.now')?.textContent.replace('\u00a0', ' ')"
                                   f".includes({shown!r})", f"the mark at {shown}")

    def course_pixels(self, points):
        """The greatest difference of colour channels, and the lightness, of the course's canvas at shares of its area."""
        return self.chromium.run("""
          const figure = document.querySelector(arguments[0] + " .course figure");
          const [canvas, over] = [figure.querySelector("canvas"), figure.querySelector(".u-over")];
          const [outer, area] = [canvas.getBoundingClientRect(), over.getBoundingClientRect()];
          const scale = canvas.width / outer.width;
          return arguments[1].map(([across, down]) => {
            const x = (area.left - outer.left + across * area.width) * scale;
            const y = (area.top - outer.top + down * area.height) * scale;
            const [r, g, b, a] = canvas.getContext("2d").getImageData(x, y, 1, 1).data;
            return a === 0 ? "" : `${r},${g},${b}`;
          })""", DRIVES, points)

    def test_the_course_shows_where_an_object_is_when_it_is_there(self):
        self.open()
        # The picture reaches from 4 % and 5 m below the first place of the vehicle to as far beyond its last one.
        last = report_fixture.SPEED * report_fixture.T_S * (report_fixture.STEPS - 1)
        rim = 0.04 * last + 5.0

        def at(t, s):
            return [t / (report_fixture.T_S * report_fixture.STEPS), 1.0 - (s + rim) / (last + 2.0 * rim)]

        grey = "170,176,185"
        self.assertEqual(self.course_pixels([at(1.0, 80.0), at(11.0, 80.0), at(7.0, 126.0), at(9.0, 126.0)]), [grey] * 4)
        for pixel in self.course_pixels([at(1.0, 84.0), at(3.0, 126.0), at(11.0, 126.0)]):
            self.assertNotEqual(pixel, grey)

    def test_a_fold_is_drawn_when_it_is_opened(self):
        self.open()
        self.assertEqual(self.texts("details summary"), ["✗A drive for those who ask"])
        self.assertEqual(self.texts("details figure"), [])
        self.chromium.run("document.querySelector('details summary').click()")
        self.chromium.wait_for("return document.querySelectorAll('details .uplot').length === 1 + 2 + 4", "its plots")
        for plot in read_plots(self.chromium):
            self.assertGreaterEqual(plot["coloured"], LEAST_COLOURED, plot["title"])
        self.chromium.run("const s = document.querySelector('details summary'); s.click(); s.click()")
        self.assertEqual(self.chromium.run("return document.querySelectorAll('details .uplot').length"), 1 + 2 + 4)
        self.assertEqual(complaints(self.chromium), [])

    def metres(self, across, down):
        self.chromium.point(PLANE, across, down)
        text = self.chromium.wait_for(PLANE_READOUT, "coordinates")
        X, Y = re.findall(r"−?\d+\.\d+", text)
        return float(X.replace("−", "-")), float(Y.replace("−", "-"))

    def metres_per_pixel(self):
        low, high = self.metres(0.2, 0.8), self.metres(0.8, 0.2)
        width, height = self.chromium.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                                          "return [b.width, b.height]", PLANE)
        return (high[0] - low[0]) / (0.6 * width), (high[1] - low[1]) / (0.6 * height)

    def test_the_plane_has_one_scale_whatever_the_zoom_and_the_width(self):
        self.open()
        across, up = whole = self.metres_per_pixel()
        self.assertAlmostEqual(across / up, 1.0, delta=0.02)
        self.chromium.drag(PLANE, (0.5, 0.1), (0.6, 0.9))
        across, up = self.metres_per_pixel()
        self.assertAlmostEqual(across / up, 1.0, delta=0.02)
        self.assertLess(across, 0.95 * whole[0])
        self.chromium.set_width(760)
        self.chromium.wait_for("return document.querySelector('figure .uplot').clientWidth < 760",
                               "the plots to shrink")
        across, up = self.metres_per_pixel()
        self.assertAlmostEqual(across / up, 1.0, delta=0.02)
        self.chromium.set_width(1280)
        self.chromium.wait_for("return document.querySelector('figure .uplot').clientWidth > 1000",
                               "the plots to grow")
        self.chromium.double_click(PLANE)
        self.assertAlmostEqual(self.metres_per_pixel()[0] / whole[0], 1.0, delta=0.02)

    def painted(self, shape, margin, points):
        """Whether an obstacle of 8 m by 4 m covers these points in its own axes."""
        return self.chromium.run(PEN + """
          const [shape, margin, points] = arguments;
          const ctx = Object.assign(document.createElement("canvas"), {width: 200, height: 200}).getContext("2d");
          const onCanvas = (value, axis) => axis === "x" ? 100 + 10 * value : 100 - 10 * value;
          const pen = makePen({ctx, valToPos: onCanvas, bbox: {width: 200}, scales: {x: {min: -10, max: 10}}});
          pen.obstacle({X: 1, Y: 2, shape, r_x: 4, r_y: 2, heading: 0.5}, margin, {fill: "#000"});
          return points.map(([ahead, left]) => {
            const X = 1 + ahead * Math.cos(0.5) - left * Math.sin(0.5);
            const Y = 2 + ahead * Math.sin(0.5) + left * Math.cos(0.5);
            return ctx.getImageData(onCanvas(X, "x"), onCanvas(Y, "y"), 1, 1).data[3] > 0;
          })""", shape, margin, points)

    def test_an_obstacle_is_drawn_in_its_shape_and_size(self):
        self.open()
        corners = [(3.8, 1.8), (3.8, -1.8), (-3.8, -1.8), (-3.8, 1.8)]
        sides, beyond = [(3.8, 0), (0, 1.8)], [(4.2, 0), (0, -2.2)]
        self.assertEqual(self.painted("box", 0, corners + sides + beyond), [True] * 6 + [False] * 2)
        self.assertEqual(self.painted("ellipse", 0, corners + sides + beyond), [False] * 4 + [True] * 2 + [False] * 2)
        # The margin reaches its length beyond sides and corners.
        self.assertEqual(self.painted("box", 1, [(4.8, 1.8), (0, -2.8), (4.6, 2.6), (4.85, 2.85)]),
                         [True, True, True, False])

    def test_a_cell_of_the_map_tells_its_numbers(self):
        self.open()
        self.chromium.point("section:last-of-type figure:last-of-type .u-over", 0.99, 0.01)
        self.assertEqual(self.texts("section:last-of-type figure:last-of-type .readout"), ["20 m/s, 1.0 m: infeasible"])

    def test_the_outcomes_of_the_map_rise_in_grey(self):
        self.open()
        for scheme, sign in (("light", -1), ("dark", 1)):
            self.chromium.set_scheme(scheme)
            greys = []
            for outcome in ("clear", "marginal", "touch", "infeasible", "off-road"):
                value = self.chromium.run("return getComputedStyle(document.documentElement)"
                                          ".getPropertyValue('--' + arguments[0])", outcome)
                red, green, blue = (int(value[i:i + 2], 16) for i in (1, 3, 5))
                greys.append(0.30 * red + 0.59 * green + 0.11 * blue)
            for before, after in zip(greys, greys[1:]):
                self.assertGreater(sign * (after - before), 20, scheme)

    def test_nothing_stands_out_of_the_window(self):
        self.open()
        for width in (1600, 900, 420):
            self.chromium.set_width(width)
            self.chromium.wait_for("return [...document.querySelectorAll('.uplot')].every(plot => "
                                   "plot.clientWidth === plot.parentElement.clientWidth)", "the plots to fit")
            self.assertLessEqual(self.chromium.run("return document.documentElement.scrollWidth"), width)
        self.assertEqual(self.texts(".fault"), [])

    def test_the_dark_scheme_changes_every_canvas(self):
        self.open()
        light = read_plots(self.chromium)
        self.chromium.set_scheme("dark")
        self.chromium.wait_for("return getComputedStyle(document.body).backgroundColor === 'rgb(20, 23, 27)'",
                               "the dark paper")
        for before, after in zip(light, read_plots(self.chromium), strict=True):
            self.assertNotEqual(before["hash"], after["hash"], after["title"])
            if "lpv" not in after["title"]:  # the map's most frequent colours are equally light in both schemes
                self.assertGreater(after["lightness"], before["lightness"] + 20, after["title"])
        self.assertEqual(complaints(self.chromium), [])

    def test_it_is_printed_in_light_colours_also_from_a_dark_screen(self):
        self.chromium.set_scheme("dark")
        self.open()
        screen = [plot["hash"] for plot in read_plots(self.chromium)]
        shares = light_shares(self.chromium.print_pdf())
        self.assertGreaterEqual(len(shares), 3)
        for share in shares:
            self.assertGreater(share, 0.8)
        self.chromium.wait_for("return !document.documentElement.hasAttribute('data-print')", "the screen to be back")
        self.assertEqual([plot["hash"] for plot in read_plots(self.chromium)], screen)

    def test_data_of_another_form_are_told(self):
        def without_steering(report):
            del report["drives"]["standard"]["series"]["delta"]

        def short(report):
            report["drives"]["standard"]["series"]["psi"].pop()

        def of_nobody(report):
            report["sections"][3]["drives"].append("nobody")

        def off_road(report):
            report["drives"]["trust"]["road"] = "lane"

        def of_no_shape(report):
            report["drives"]["trust"]["obstacles"][0]["shape"] = "triangle"

        def of_too_few_places(report):
            report["drives"]["trust"]["obstacles"][1]["places"]["s"].pop()

        def without_reason(report):
            del report["drives"]["trust"]["decisions"][0]["reason"]

        def folded_nobody(report):
            report["sections"][-1]["sections"][0]["drives"] = ["nobody"]

        def without_cells(report):
            report["sections"][-2]["panels"][0]["cells"].pop()

        for change, fault in ((without_steering, "drives.standard.series.delta is missing"),
                              (short, "drives.standard.series.psi is not as long as t"),
                              (of_nobody, 'sections.3. shows drive "nobody"'),
                              (off_road, 'drives.trust.road is "lane"'),
                              (of_no_shape, "drives.trust.obstacles.0..shape is of another kind"),
                              (of_too_few_places, "drives.trust.obstacles.1..places.s is not as long as k"),
                              (without_reason, "drives.trust.decisions.0..reason is missing"),
                              (folded_nobody, 'sections.7..sections.0. shows drive "nobody"'),
                              (without_cells, "sections.6..panels.0..cells")):
            with self.subTest(fault):
                report = copy.deepcopy(report_fixture.report())
                change(report)
                self.assert_check_fails(self.write(report), fault)
                self.assertRegex(str(complaints(self.chromium)), "The data of this report is not what it must be")
                self.assertIsNone(self.chromium.run("return document.documentElement.dataset.ready ?? null"))

    def test_the_check_sees_a_page_that_is_not_whole(self):
        def assert_seen(script, pattern):
            path = self.write(report, lambda html: html.replace("<script>", f"<script>{script}</script><script>", 1))
            self.assert_check_fails(path, pattern)

        self.assert_check_fails(self.write(emptied(report_fixture.report())), "nothing is drawn")
        for plot in read_plots(self.chromium):
            self.assertLess(plot["coloured"], LEAST_COLOURED, plot["title"])
        report = report_fixture.report()
        assert_seen("CanvasRenderingContext2D.prototype.stroke = () => {};", "nothing is drawn")
        assert_seen("console.warn('hm');", "complains")
        assert_seen("new Image().src = 'http://127.0.0.1:9/x.png';", "complains")
        # An error during drawing, long after the page was built.
        assert_seen("Path2D.prototype.ellipse = () => { throw new Error('no ellipse'); };", "no ellipse")
        report["sections"].pop(-2)  # the last section with plots
        self.assert_check_fails(self.write(report), "plots reported")


if __name__ == "__main__":
    RENDER_REPORT = sys.argv.pop(1)
    unittest.main()
