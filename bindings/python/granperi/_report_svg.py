"""Pictures of a report as SVG, which a page can hold and which need no package."""
from __future__ import annotations

import html
import math
from typing import Sequence

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d00", "#56b4e9", "#5b5b5b", "#a0522d")
FONT = 17  # pixels in a picture of 900: readable at half size


def ticks(low: float, high: float, logarithmic: bool) -> list[float]:
    """Round numbers between the ends, some four to seven of them."""
    if logarithmic:
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        digits = (1,) if last - first > 4 else (1, 2, 5) if last - first > 1 else (1, 2, 3, 5, 7)
        values = [digit * 10.0**k for k in range(first, last + 1) for digit in digits]
    else:
        step = 10.0 ** math.floor(math.log10((high - low) / 4))
        step = next(step * k for k in (1, 2, 5, 10) if (high - low) / (step * k) <= 5)
        values = [round(k * step, 12) for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
    return [value for value in values if low * (1 - 1e-9) - 1e-300 <= value <= high * (1 + 1e-9) or low <= value <= high]


class Picture:
    """Axes with a frame on two sides. Coordinates of what is drawn are those of the axes."""

    def __init__(self, x: tuple[float, float], y: tuple[float, float], x_label: str, y_label: str, title: str = "",
                 width: int = 900, height: int = 480, log_x: bool = False, log_y: bool = False, right: int = 20):
        self.width, self.height = width, height
        longest = max(len(f"{value:g}") for value in ticks(*y, log_y) or [0])
        self.left, self.right, self.top, self.bottom = 52 + 10 * longest, right, 40 if title else 16, 62
        self.x, self.y, self.log_x, self.log_y = x, y, log_x, log_y
        self.parts: list[str] = []
        x0, x1, y0, y1 = self.left, width - self.right, height - self.bottom, self.top
        if title:
            self.text(x0, 24, title, weight="600")
        for value in ticks(*x, log_x):
            at = self._px(value)
            self._path(f"M{at:.1f} {y0}V{y1}", "#e4e4e4", 1)
            self.text(at, y0 + 24, f"{value:g}", anchor="middle")
        for value in ticks(*y, log_y):
            at = self._py(value)
            self._path(f"M{x0} {at:.1f}H{x1}", "#e4e4e4", 1)
            self.text(x0 - 8, at + 6, f"{value:g}", anchor="end")
        self._path(f"M{x0} {y1}V{y0}H{x1}", "#333", 1.5)
        self.text((x0 + x1) / 2, height - 10, x_label, anchor="middle")
        middle = (y0 + y1) / 2
        self.parts.append(f'<text transform="translate(20 {middle:.0f}) rotate(-90)" text-anchor="middle">'
                          f"{html.escape(y_label)}</text>")

    def _px(self, value: float) -> float:
        return self._place(value, self.x, self.log_x, self.left, self.width - self.right)

    def _py(self, value: float) -> float:
        return self._place(value, self.y, self.log_y, self.height - self.bottom, self.top)

    @staticmethod
    def _place(value: float, ends: tuple[float, float], logarithmic: bool, begin: float, end: float) -> float:
        low, high = ends
        if logarithmic:
            value, low, high = math.log10(max(value, low / 1e3)), math.log10(low), math.log10(high)
        return begin + (value - low) / (high - low) * (end - begin)

    def _path(self, path: str, colour: str, width: float, dashes: str = "") -> None:
        more = f' stroke-dasharray="{dashes}"' if dashes else ""
        self.parts.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width:g}"{more}/>')

    def text(self, x: float, y: float, text: str, anchor: str = "start", colour: str = "#222", weight: str = "") -> None:
        """At pixels."""
        more = f' font-weight="{weight}"' if weight else ""
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}"{more}>{html.escape(text)}</text>')

    def line(self, points: Sequence[tuple[float, float]], colour: str, dashes: str = "", width: float = 2.5) -> None:
        self._path("M" + "L".join(f"{self._px(x):.1f} {self._py(y):.1f}" for x, y in points), colour, width, dashes)

    def level(self, y: float, text: str, colour: str = "#777") -> None:
        """A line across, with a text in the room at its right end."""
        if self.y[0] <= y <= self.y[1]:
            at = self._py(y)
            self._path(f"M{self.left} {at:.1f}H{self.width - self.right}", colour, 1.5, "7 5")
            self.text(self.width - self.right + 8, at + 6, text, colour=colour)

    def points(self, points: Sequence[tuple[float, float]], colour: str, radius: float = 6, hollow: bool = False) -> None:
        fill = "#fff" if hollow else colour
        self.parts += [f'<circle cx="{self._px(x):.1f}" cy="{self._py(y):.1f}" r="{radius:g}" fill="{fill}" stroke="{colour}" '
                       f'stroke-width="2"/>' for x, y in points]

    def star(self, x: float, y: float, colour: str = "#c8102e") -> None:
        a, b = self._px(x), self._py(y)
        tips = [(r * math.sin(k * math.pi / 5), -r * math.cos(k * math.pi / 5)) for k in range(10)
                for r in ([13.0, 5.5][k % 2],)]
        self.parts.append(f'<polygon points="{" ".join(f"{a + u:.1f},{b + v:.1f}" for u, v in tips)}" fill="{colour}"/>')

    def bar(self, x: float, y: float, half: float, colour: str) -> None:
        """An error bar."""
        a, low, high = self._px(x), self._py(y - half), self._py(y + half)
        self._path(f"M{a:.1f} {low:.1f}V{high:.1f}M{a - 6:.1f} {low:.1f}h12M{a - 6:.1f} {high:.1f}h12", colour, 2)

    def legend(self, entries: Sequence[tuple[str, str]]) -> None:
        """Of colour and text, in the room at the right."""
        for k, (colour, text) in enumerate(entries[:8]):
            y = self.top + 18 + 28 * k
            x = self.width - self.right + 16
            self.parts.append(f'<circle cx="{x}" cy="{y - 6}" r="6" fill="{colour}"/>')
            self.text(x + 14, y, text)

    def svg(self, label: str) -> str:
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" role="img" '
                f'aria-label="{html.escape(label, quote=True)}" font-family="system-ui, sans-serif" font-size="{FONT}" fill="#222">'
                + "".join(self.parts) + "</svg>")


def bars(entries: Sequence[tuple[str, float]], unit: str, label: str, width: int = 560) -> str:
    """Shares of a whole as bars beneath each other; narrow, so that they can be read on a telephone."""
    most = max((value for _, value in entries), default=1.0) or 1.0
    height = 30 * len(entries) + 8
    left = 20 + 10 * max((len(name) for name, _ in entries), default=0)  # of the bars
    parts = []
    for k, (name, value) in enumerate(entries):
        y = 30 * k + 22
        long = (width - left - 90) * value / most
        parts += [f'<text x="{left - 10}" y="{y}" text-anchor="end">{html.escape(name)}</text>',
                  f'<rect x="{left}" y="{y - 16}" width="{long:.1f}" height="20" fill="{COLOURS[0]}"/>',
                  f'<text x="{left + 8 + long:.1f}" y="{y}">{value:.1f} {html.escape(unit)}</text>']
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{html.escape(label)}" '
            f'style="max-width: {width}px" font-family="system-ui, sans-serif" font-size="{FONT}" fill="#222">' + "".join(parts)
            + "</svg>")
