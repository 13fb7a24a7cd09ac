"""A report as one page of HTML that needs nothing beside it."""
from __future__ import annotations

import html
import math
import os
import re
from typing import Any, Sequence

from ._report_runs import QUANTITIES, REST
from ._report_svg import COLOURS, Picture, bars
from ._state import MARKS

Report = Any  # that of _report_result, which imports this

STYLE = """
.granperi-report { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 62rem; margin: 0 auto; padding: 0 1rem 3rem }
.granperi-report h1 { font-size: 1.5rem; margin: 1.2rem 0 .2rem } .granperi-report h2 { font-size: 1.15rem; margin: 2rem 0 .4rem }
.granperi-report p { max-width: 46rem } .granperi-report svg { width: 100%; height: auto; max-width: 900px }
.granperi-report .answer { background: #eef4fa; border-left: 4px solid #0072b2; padding: .7rem 1rem; font-size: 1.1rem }
.granperi-report .no { background: #fdf1ea; border-color: #d55e00 }
.granperi-report .wide { overflow-x: auto } .granperi-report .wide svg { min-width: 600px }
.granperi-report table { border-collapse: collapse; margin: .5rem 0 } .granperi-report td, .granperi-report th
{ padding: .25rem .7rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap }
.granperi-report td:first-child, .granperi-report th:first-child { text-align: left }
.granperi-report .words td:last-child, .granperi-report .words th:last-child { text-align: left; white-space: normal; min-width: 11rem }
.granperi-report tr.forecast { color: #777 }
.granperi-report .pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(400px, 100%), 1fr)); gap: .5rem }
"""
NAMES = {"peak_height": "peak", "width_50": "width, 50 %", "width_90": "width, 90 %", "width_98": "width, 98 %",
         REST: "time of rest"}


def page(report: Report) -> str:
    title = html.escape(f"Error against run time: {_short(report)}")
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{title}</title>\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n</head>\n<body>\n' + body(report)
            + "\n</body>\n</html>\n")


def body(report: Report) -> str:
    """The page without its head, as a notebook shows it."""
    parts = [f"<style>{STYLE}</style>", '<div class="granperi-report">',
             f"<h1>Error against run time: {html.escape(_short(report))}</h1>",
             f"<p>{len(report.runs)} runs to {report.end:g} s at {len(report.spacings)} spacings, {report.seconds:.3g} s. Stated errors "
             "hold in 9 of 10 cases, chance included.</p>",
             f'<p class="answer{"" if report.recommendation.runs else " no"}">{html.escape(str(report.recommendation))}</p>',
             *(f"<p>{html.escape(text)}</p>" for text in (report.ended, *report.advice()) if text),
             "<h2>What a run errs by, and what it takes</h2>", _error_picture(report), _rows(report),
             "<h2>Does it converge?</h2>", _verdicts(report), '<div class="pair">', *_convergence_pictures(report), "</div>",
             "<p>Small dots: runs. Full dots: their means, with two standard errors. At spacing 0: what they tend to, with its "
             "error.</p>",
             "<h2>What a step is made of</h2>", _stages(report), _marks(report), _left_out(report), _warnings(report), "</div>"]
    return "\n".join(part for part in parts if part)


def _short(report: Report) -> str:
    return os.path.basename(report.name)


def _name(name: str) -> str:
    return NAMES.get(name, name)


def _shown(report: Report) -> list[str]:
    return [name for name in (*NAMES, *report.own) if name in report.convergence and report.scale[name] > 0]


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], classes: Sequence[str] = (), words: bool = False) -> str:
    """classes: of the rows; words: the last column is text."""
    text = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
    lines = [f"<tr>{text}</tr>"]
    for k, row in enumerate(rows):
        kind = f' class="{classes[k]}"' if classes and classes[k] else ""
        lines.append(f"<tr{kind}>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>")
    return _wide(f'<table{" class=words" if words else ""}>' + "\n".join(lines) + "</table>")


def _wide(content: str) -> str:
    """What scrolls where it has no room, in place of the page, and stays large enough to be read."""
    return f'<div class="wide">{content}</div>'


def _error_picture(report: Report) -> str:
    names = _shown(report)[:8]
    if not names:
        return ""
    curves = {name: [(row.cpu_seconds, 100 * row.errors[name] / report.scale[name], row.runs) for row in report.rows
                     if math.isfinite(row.errors[name])] for name in names}
    x = [row.cpu_seconds for row in report.rows]
    y = [error for curve in curves.values() for _, error, _ in curve]
    asked = 100 * report.accuracy
    if min(y) / 10 < asked < 10 * max(y):  # how far it is to what was asked for
        y.append(asked)
    picture = Picture((min(x) / 1.3, max(x) * 1.3), (max(min(y), 1e-3) / 1.3, max(y) * 1.3), "CPU s of one run",
                      "error of one run, %", log_x=True, log_y=True, right=190)
    picture.level(asked, f"{asked:g} % asked for")
    for colour, name in zip(COLOURS, names):
        run = [(at, error) for at, error, runs in curves[name] if runs]
        forecast = [(at, error) for at, error, runs in curves[name] if not runs]
        picture.line(run, colour)
        picture.line([run[-1], *forecast], colour, "4 5", 1.8)
        picture.points(run, colour)
        picture.points(forecast, colour, 5, hollow=True)
    chosen = report.recommendation
    if chosen.runs == 1:
        picture.star(min(max(chosen.cpu_seconds, picture.x[0]), picture.x[1]), 100 * max(chosen.errors.values()))
    picture.legend([(colour, _name(name)) for colour, name in zip(COLOURS, names)])
    return _wide(picture.svg("error of one run against CPU time")) + (
        "<p>Full: run. Hollow: forecast." + (" Star: recommended." if chosen.runs == 1 else "") + "</p>")


def _rows(report: Report) -> str:
    names = _shown(report)
    head = ["spacing, m", "particles", "CPU s", "runs", *(_name(name) for name in names)]
    rows = [[f"{row.spacing:.4g}", str(row.particles), f"{row.cpu_seconds:.2g}", str(row.runs) if row.runs else "forecast",
             *(report._percent(row, name, "–") for name in names)] for row in report.rows]
    return _table(head, rows, ["" if row.runs else "forecast" for row in report.rows])


def _rounded(value: float, error: float) -> str:
    """As many places as the error has, of which two digits are shown."""
    if not (error > 0 and math.isfinite(value)):
        return f"{value:.5g}"
    return f"{value:.{min(max(1 - math.floor(math.log10(error)), 0), 9)}f}"


def _verdict_row(report: Report, name: str) -> list[str]:
    verdict, order = report._judged(name)
    if name not in report.convergence:
        return [_name(name), "–", "–", "–", verdict]
    one = report.convergence[name]
    unit = QUANTITIES[name][0] if name in QUANTITIES else "s" if name == REST else ""
    limit = f"{_rounded(one.limit, one.limit_error)} ± {one.limit_error:.2g} {unit}".rstrip()
    return [_name(name), limit, f"{one.levels[-1].scatter:.2g}", order or "–", verdict]


def _verdicts(report: Report) -> str:
    return _table(["quantity", "limit of zero spacing", "scatter of one run", "observed order", "verdict"],
                  [_verdict_row(report, name) for name in (*NAMES, *report.own)], words=True)


def _convergence_pictures(report: Report) -> list[str]:
    pictures = []
    for colour, name in zip(COLOURS, [name for name in (*NAMES, *report.own) if name in report.convergence][:8]):
        one = report.convergence[name]
        dots = [(1000 * run.spacing, run.values[name]) for run in report.runs if run.spacing in report.spacings]
        ends = [one.limit - one.limit_error, one.limit + one.limit_error, *(value for _, value in dots)]
        low, high = min(ends), max(ends)
        room = 0.08 * (high - low) or 0.01 * abs(high) or 1.0
        unit = QUANTITIES[name][0] if name in QUANTITIES else "s" if name == REST else ""
        most = 1080 * report.spacings[0]
        picture = Picture((-0.04 * most, most), (low - room, high + room), "spacing, mm", _name(name) + (f", {unit}" if unit else ""),
                          title=f"{_name(name)}: {one.verdict}", width=520, height=380)
        picture.points(dots, colour, 2.5)
        means = [(1000 * level.spacing, level.mean) for level in one.levels]
        picture.line(means, colour)
        for level in one.levels:
            picture.bar(1000 * level.spacing, level.mean, 2 * level.standard_error, colour)
        picture.points(means, colour)
        picture.bar(0.0, one.limit, one.limit_error, "#222")
        picture.points([(0.0, one.limit)], "#222")
        pictures.append(picture.svg(f"{_name(name)} against spacing"))
    return pictures


def _stages(report: Report) -> str:
    stages = sorted(((entry.name.replace("_", " "), entry.seconds) for entry in report.plan
                     if entry.kind == 0 and entry.active), key=lambda entry: -entry[1])
    total = sum(seconds for _, seconds in stages)
    if not total > 0:
        return ""
    shares = [(name, 100 * seconds / total) for name, seconds in stages]
    shown = [entry for entry in shares if entry[1] >= 1][:12]
    rest = 100 - sum(share for _, share in shown)
    if rest >= 0.05:
        shown.append((f"{len(shares) - len(shown)} others", rest))
    each = 1e9 * report.cost.per_step(report.spacings[-1])
    return (f"<p>Wall-clock time of the stages at the finest spacing, {each:.0f} ns of CPU time per particle and step in "
            "all.</p>" + bars(shown, "%", "time of each stage"))


def _marks(report: Report) -> str:
    rows = [_verdict_row(report, name) for name in MARKS.values() if name in report.convergence]
    return _details("Marks of the mass", "x that has 1, 5, ... % of the mass on its left, in m.",
                    _table(["mark", "limit of zero spacing", "scatter of one run", "observed order", "verdict"], rows,
                           words=True)) if rows else ""


def _left_out(report: Report) -> str:
    rows = [[entry.name.replace("_", " "), "field" if entry.kind else "stage", entry.reason]
            for entry in report.plan if not entry.active]
    table = _table(["what", "kind", "why"], rows, words=True)
    return _details("What the scene leaves out", f"{len(rows)} stages and fields cost this scene nothing.", table) if rows else ""


def _warnings(report: Report) -> str:
    if not report.warnings:
        return ""
    alike: dict[str, list[str]] = {}  # but for their numbers
    for text in report.warnings:
        alike.setdefault(re.sub(r"[-+]?\d[\d.e+-]*", "#", text), []).append(text)
    items = [html.escape(texts[0]) + (f" (and {len(texts) - 1} alike)" if len(texts) > 1 else "") for texts in alike.values()]
    return _details("What the library warned of", "At some of the spacings.", "<ul><li>" + "</li><li>".join(items) + "</li></ul>")


def _details(title: str, text: str, content: str) -> str:
    return f"<details><summary><strong>{html.escape(title)}</strong> {html.escape(text)}</summary>{content}</details>"
