"""Scene files (TOML) as they are written."""
from __future__ import annotations

import dataclasses
import enum
import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import ArgumentTypeError

if TYPE_CHECKING:
    from ._objects import Config
    from ._scene_tables import Run


def _value(name: str, value: Any) -> str:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, enum.IntFlag):
        return str(int(value))
    if isinstance(value, enum.Enum):
        return json.dumps(value.name.lower())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_value(name, item) for item in value)}]"
    raise ArgumentTypeError(f"{name} = {value!r:.80}: cannot be written to a scene file; expected numbers, texts or lists of them")


def _table(header: str, values: dict[str, Any]) -> str:
    return "\n".join([header, *(f"{name} = {_value(name, value)}" for name, value in values.items() if value is not None)])


def text_of_scene(config: "Config", run: "Run", tables: list[tuple[str, dict[str, Any]]]) -> str:
    """The preset and what differs from it, how it is run, and the tables in their order."""
    defaults = config._own_defaults()
    chosen = {name.rstrip("_"): getattr(config, name) for name, value in config
              if name in ("preset", "spacing") or value != defaults[name]}
    chosen = {"preset": chosen.pop("preset"), **chosen}
    running = {field.name: getattr(run, field.name) for field in dataclasses.fields(run)
               if field.name in ("end", "every") or getattr(run, field.name) != field.default}
    sections = [_table("[config]", chosen), _table("[run]", running), *(_table(f"[[{kind}]]", values) for kind, values in tables)]
    return "\n\n".join(sections) + "\n"
