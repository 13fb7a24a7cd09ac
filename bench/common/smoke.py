"""What the tests of the reports share. They are skipped (77) by a Python without what the reports are drawn with."""
from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import matplotlib  # noqa: F401
    import numpy  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def call(*command: object) -> str:
    """What the program prints; it has to succeed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    print(done.stdout, done.stderr, sep="")
    assert done.returncode == 0, f"{command[1]} ended with status {done.returncode}"
    return done.stdout


@dataclass(frozen=True)
class Workplace:
    """Where a report's runner and its report are tried: built programs, and results and documents of their own."""

    tools: Path  # runner.py and report.py
    build: Path
    found: Path
    docs: Path

    @classmethod
    def asked_for(cls, tools: Path, about: str | None) -> Workplace:
        parser = argparse.ArgumentParser(description=about)
        parser.add_argument("--build", type=Path, required=True)
        parser.add_argument("--work", type=Path, required=True)
        arguments = parser.parse_args()
        shutil.rmtree(arguments.work, ignore_errors=True)
        docs = arguments.work / "docs"
        docs.mkdir(parents=True)
        return cls(tools, arguments.build, arguments.work / "results", docs)

    def run(self, name: str) -> str:
        runner = (sys.executable, self.tools / "runner.py", "--build", self.build, "--results", self.found)
        return call(*runner, "--only", name)

    def report(self, name: str) -> tuple[str, list[str]]:
        """The text, and the names of the pictures, all of which it shows."""
        call(sys.executable, self.tools / "report.py", "--results", self.found, "--docs", self.docs)
        text = (self.docs / name).read_text(encoding="utf-8")
        images = sorted(path.name for path in (self.docs / "images").iterdir())
        for image in images:
            assert f"images/{image}" in text, f"{image} is not shown"
        return text, images
