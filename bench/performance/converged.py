"""The finest runs of the collapses, which errors are against: docs/performance.md has them."""
from pathlib import Path

from headlines import MARK

PERFORMANCE = Path(__file__).resolve().parents[2] / "docs" / "performance.md"


def converged(scene: str) -> tuple[float, float]:
    """Peak y/L and run-out of the finest runs, which docs/performance.md has."""
    told = {mark["name"]: mark["text"] for mark in MARK.finditer(PERFORMANCE.read_text(encoding="utf-8")) if mark["kind"] == "="}
    return tuple(float(told[f"performance.converged.{scene}_{what}"]) for what in ("peak", "bulk"))
