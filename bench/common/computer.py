"""The machine that numbers are measured on."""
from __future__ import annotations

import os
import re
from pathlib import Path


def processor() -> str:
    names = re.findall(r"^model name\s*:\s*(.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    return names[0] if names else "unknown"


def compiler(build: Path) -> str:
    files = list(build.glob("CMakeFiles/*/CMakeCXXCompiler.cmake"))
    text = files[0].read_text(encoding="utf-8") if files else ""
    return " ".join(re.findall(r'set\(CMAKE_CXX_COMPILER_(?:ID|VERSION) "([^"]*)"\)', text)) or "unknown"


def description(build: Path) -> str:
    return f"{processor()}, {os.cpu_count()} cores; {compiler(build)}"
