"""The pages that lpvmpc writes of real drives, in a real browser.

usage: real_report_test.py LPVMPC SOURCE_DIR

Drives the demo (`run --out`) and the paper's comparisons (`paper --out`, which must hold its claims), and checks both
pages: every plot is drawn, and the browser has nothing to complain of.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import browser
import report_page_check

LPVMPC, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


def run(*arguments):
    done = subprocess.run([LPVMPC, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


class RealReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chromium = cls.enterClassContext(browser.Browser())
        cls.out = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))

    def text(self):
        return self.chromium.run("return document.body.innerText").replace("\u00a0", " ")

    def test_demo(self):
        run("run", "--scenario", SOURCE / "scenarios/demo/scenario.toml", "--out", self.out / "demo")
        page = self.out / "demo/report.html"
        # The plane, again at each of three obstacles, seven plots over time, and three fans.
        report_page_check.check_page(self.chromium, page, 1 + 3 + 7 + 3)
        self.assertIn("passed", self.text())
        self.assertLess(page.stat().st_size, 600_000)

    def test_paper(self):
        out = self.out / "paper"
        run("paper", "--repeat", "1", "--out", out)
        figures = json.loads((out / "paper.json").read_text())
        self.assertTrue(figures["passed"])
        self.assertEqual(sum(row["lpv"]["feasible"] for row in figures["feasibility"]), 10)
        # Two fans; the plane and seven plots over time of each of four comparisons; the plane again at two obstacles.
        report_page_check.check_page(self.chromium, out / "report.html", 2 + 4 * 8 + 2)
        text = self.text()
        for word in ("tracking-1", "obstacle-2", "infeasible: obstacle 1 at i", "standard LPVMPC", "306.7"):
            self.assertIn(word, text)
        again = self.out / "again.html"
        run("report", out, "-o", again)
        self.assertEqual(again.read_text(), (out / "report.html").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
