"""The tables of a scene file, and where they and their keys stand in it, for messages."""
from __future__ import annotations

import dataclasses
import re
from typing import Any

from ._errors import ArgumentError


class SceneError(ArgumentError):
    """A scene file that cannot be read; the text names file, line and table."""


@dataclasses.dataclass
class Part:
    """One table of the file: its values, and where it stands."""

    kind: str
    values: dict[str, Any]
    file: str
    line: str  # ", line N" or nothing
    title: str

    def where(self, line: str = "") -> str:
        return f"{self.file}{line or self.line}, {self.title}"


class Lines:
    """Where tables and keys stand in the text, for messages; tomllib does not tell."""

    def __init__(self, text: str):
        self._at: dict[tuple[str, int, str], int] = {}
        count: dict[str, int] = {}
        table, k = "", 0
        for line, content in enumerate(text.splitlines(), 1):
            if header := re.match(r"\s*\[\[?\s*[\"']?([\w-]+)[\"']?\s*\]", content):
                table = header.group(1)
                k = count.get(table, 0)
                count[table] = k + 1
                self._at[table, k, ""] = line
            elif key := re.match(r"\s*[\"']?([\w-]+)[\"']?\s*[=.]", content):
                self._at.setdefault((table, k, key.group(1)), line)
                if not table:
                    self._at.setdefault((key.group(1), 0, ""), line)

    def where(self, table: str, k: int = 0, key: str = "") -> str:
        """", line N" of the key or the table; nothing if it cannot be told."""
        line = self._at.get((table, k, key), self._at.get((table, k, "")))
        return f", line {line}" if line else ""
