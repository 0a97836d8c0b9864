"""Data of a report (tools/report/report_page.hpp) that hold everything that a page can show."""

import math

T_S = 0.05
HORIZON = 8
STEPS = 240
SPEED = 12.0
OBSTACLE = {"id": 1, "shape": "ellipse", "r_x": 1.6, "r_y": 1.1, "margin": 0.4, "from": 0, "to": STEPS - 1,
            "places": {"k": [0], "X": [78.0], "Y": [15.6], "heading": [0.2], "s": [[80.0]], "half_length": [1.6]}}
CROSSED = range(100, 190)  # steps at which the second obstacle is on the road
CROSSING = {"id": 2, "shape": "box", "r_x": 1.8, "r_y": 0.8, "margin": 0.3, "from": 20, "to": STEPS - 1,
            "places": {"k": list(range(20, STEPS)),
                       "X": [round(127.0 - 0.4 * T_S * k, 3) for k in range(20, STEPS)],
                       "Y": [round(12.0 + 1.0 * T_S * k, 3) for k in range(20, STEPS)],
                       "heading": [0.4] * (STEPS - 20),
                       "s": [[126.0] if k in CROSSED else [] for k in range(20, STEPS)],
                       "half_length": [2.5 if k in CROSSED else 0.0 for k in range(20, STEPS)]}}
DECISIONS = [{"t": 0.05, "decision": "drives", "reason": "the way is free"},
             {"t": 4.5, "decision": "passes object 1 on the left", "reason": "staying behind would take longer"},
             {"t": 7.0, "decision": "yields to object 2", "reason": "an object crosses first"}]
UNSOLVED = {"standard": set(range(118, 131)) | {140}, "trust": {160}}


def reference(s):
    """Place and heading at arc length s of a straight that turns into a bend and back."""
    return s, 14.0 * (1.0 - math.cos(s / 45.0)), math.atan(14.0 / 45.0 * math.sin(s / 45.0))


def road(length):
    lines = {"reference": ([], []), "left": ([], []), "right": ([], [])}
    for i in range(int(length) + 1):
        X, Y, psi = reference(float(i))
        for name, shift in (("reference", 0.0), ("left", 4.0), ("right", -4.0)):
            lines[name][0].append(round(X - shift * math.sin(psi), 3))
            lines[name][1].append(round(Y + shift * math.cos(psi), 3))
    return {name: {"X": X, "Y": Y} for name, (X, Y) in lines.items()}


def pose(k, evasion):
    s = SPEED * T_S * k
    X, Y, psi = reference(s)
    shift = evasion * math.exp(-(((s - 77.0) / 14.0) ** 2))
    slope = shift * -2.0 * (s - 77.0) / 14.0**2
    return X - shift * math.sin(psi), Y + shift * math.cos(psi), psi + math.atan(slope)


def drive(key, name, evasion, wobble, controller="lpv"):
    poses = [pose(k, evasion) for k in range(STEPS + HORIZON + 1)]
    series = {n: [] for n in ("t", "X", "Y", "psi", "s", "stop", "upsilon", "upsilon_ref", "delta", "a", "solve_time",
                              "scheduling_error", "active_rows", "largest_slack", "solved")}
    plans = {"k": [], "dX": [], "dY": []}
    scheduling = controller != "nmpc"
    for k in range(STEPS):
        X, Y, psi = poses[k]
        near = math.exp(-(((k - 128) / 20.0) ** 2))
        solved = None if k == 0 else 0 if k in UNSOLVED[key] else 1
        values = {
            "t": k * T_S, "X": X, "Y": Y, "psi": psi, "s": SPEED * T_S * k, "stop": 120.0 if k > 140 else None,
            "upsilon": SPEED - 1.4 * near + 0.1 * math.sin(k / 9.0), "upsilon_ref": SPEED,
            "delta": 0.05 * math.sin(k / 24.0) - wobble * near * math.sin(k / 3.0),
            "a": -1.8 * near * math.sin(k / 11.0),
            "solve_time": None if solved is None else 18.0 * (1.0 + 6.0 * near) * (1.0 + 0.2 * math.sin(k * 1.7)),
            "scheduling_error": None if solved is None or not scheduling else 0.1 + 0.7 * near * abs(math.sin(k / 7.0)),
            "active_rows": None if solved is None or not scheduling else round(6 * near),
            "largest_slack": None if solved is None or not scheduling else max(0.0, near - 0.8),
            "solved": solved,
        }
        for n, value in values.items():
            series[n].append(round(value, 4) if isinstance(value, float) else value)
        if solved is None:
            continue
        spread = 1.0 + 0.8 * near * wobble * 10.0
        plans["k"].append(k)
        plans["dX"].append([round(x - X, 3) for x, _, _ in poses[k:k + HORIZON + 1]])
        plans["dY"].append([round((y - Y) * spread, 3) for _, y, _ in poses[k:k + HORIZON + 1]])
    series["upsilon"][60] = None  # a gap
    return {"name": name, "controller": controller, "horizon": HORIZON, "t_s": T_S, "road": "bend",
            "obstacles": [OBSTACLE, CROSSING], "decisions": DECISIONS if key == "trust" and scheduling else [],
            "outline": {"front": 2.0, "rear": 2.4, "width": 1.8},
            "limits": {"delta": [-0.593, 0.593], "a": [-0.45, 2.0]}, "series": series, "plans": plans}


def outcome(speed, shift, strength):
    trouble = speed * shift / strength
    ends = {"clear": 4, "marginal": 5, "touch": 7, "infeasible": 13, "off-road": math.inf}
    return next(name for name, end in ends.items() if trouble < end)


def report():
    """A report with two overlaid drives, one of them with decisions, one without scheduling too, fans, tables, tiles, maps
    and a fold."""
    speeds = list(range(8, 21))
    shifts = [round(0.1 * i, 1) for i in range(1, 11)]
    cells = [[[outcome(v, s, strength) for v in speeds] for s in shifts] for strength in (1.0, 1.8)]
    cells[1][0][0] = "none"
    return {
        "title": "Two controllers in one bend",
        "subtitle": "A fixture: </script><!-- an obstacle, a crossing one, steps without a solution",
        "roads": {"bend": road(150)},
        "drives": {
            "trust": drive("trust", "LPVMPC, trust region", 3.4, 0.04),
            "standard": drive("standard", "LPVMPC, standard", 2.9, 0.11, "lpv-standard"),
            "nonlinear": {**drive("trust", "Nonlinear MPC", 3.2, 0.0, "nmpc"), "plans": {"k": [], "dX": [], "dY": []}},
        },
        "sections": [
            {"type": "text", "title": "", "paragraphs": [
                "Both controllers drive the same road at 12 m/s. The first obstacle stands in the bend, the second "
                "crosses it."]},
            {"type": "figures", "title": "At a glance", "paragraphs": [], "items": [
                {"label": "smallest clearance", "value": "0.082 m", "verdict": "good"},
                {"label": "unsolved steps, standard", "value": "14 of 239", "verdict": "bad"},
                {"label": "solve time, median", "value": "21 µs", "verdict": ""},
                {"label": "solve time, p99", "value": "148 µs", "verdict": ""},
                {"label": "scheduling error, p99", "value": "0.71 radii", "verdict": "good"}]},
            {"type": "table", "title": "Paper and here",
             "paragraphs": ["What the paper reports, and what was measured."],
             "columns": ["quantity", "controller", "paper", "here"], "rows": [
                 ["infeasible steps", "standard", "12", {"text": "14", "verdict": "bad"}],
                 ["infeasible steps", "trust region", "0", {"text": "1", "verdict": "bad"}],
                 ["clearance", "trust region", "0.10 m", {"text": "0.08 m", "verdict": "good"}],
                 ["mean solve time", "trust region", "3 400 µs", "21 µs"],
                 ["mean solve time", "nonlinear", "–", "9 310 µs"]],
             "note": "Solve times are of different machines."},
            {"type": "drives", "title": "LPVMPC with and without trust region", "paragraphs": [
                "Without the trust region the prediction leaves the region in which the model holds."],
             "drives": ["trust", "standard"]},
            {"type": "drives", "title": "Nonlinear MPC", "paragraphs": [], "drives": ["nonlinear"]},
            {"type": "fans", "title": "Open-loop predictions", "paragraphs": [], "fans": [
                {"title": "Trust region", "drive": "trust", "from": 108, "to": 132},
                {"title": "Standard", "drive": "standard", "from": 108, "to": 132}]},
            {"type": "map", "title": "By speed and shift", "paragraphs": [], "speeds": speeds, "shifts": shifts,
             "panels": [{"title": "lpv-standard, N = 8", "cells": cells[0]},
                        {"title": "lpv, N = 8", "cells": cells[1]}],
             "marks": [{"speed": 12, "shift": 0.5, "panel": None, "label": "01"},
                       {"speed": 16.5, "shift": 0.8, "panel": 1, "label": "02"}]},
            {"type": "fold", "title": "A drive for those who ask", "verdict": "bad", "paragraphs": ["It is closed."],
             "sections": [{"type": "drives", "title": "", "paragraphs": [], "drives": ["nonlinear"]}]},
        ],
    }


PLOTS = (1 + 2 + 1 + 7) + (1 + 2 + 4) + 2 + 2
