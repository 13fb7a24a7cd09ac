"""The scenario of scenario.c, in Python, leaves the same particles to the last bit."""
import os
import subprocess
from pathlib import Path

import pytest


def test_the_same_hashes_as_in_c(python):
    program = os.environ.get("GRANPERI_SCENARIO")
    if not program:
        pytest.skip("GRANPERI_SCENARIO names no program built from scenario.c")
    in_c = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    in_python = python(str(Path(__file__).parent / "scenario.py"), "")
    assert in_python.returncode == 0, in_python.stderr
    assert in_python.stdout == in_c and in_c.count("hash") == 3
