"""What the tests of the reports share. They are skipped (77) by a Python without what the reports are drawn with."""
from __future__ import annotations

import subprocess
import sys

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
