"""What the commands of `python -m granperi` share: each is a module _cli_NAME with a function add(commands)."""
from __future__ import annotations

import argparse
from typing import Any, Callable


class Commands:
    """The commands of the command line, to which each module adds its own."""

    def __init__(self, parser: argparse.ArgumentParser):
        self._all = parser.add_subparsers(dest="command", required=True, metavar="command")

    def add(self, name: str, function: Callable[[argparse.Namespace], None], help: str, **more: Any) -> argparse.ArgumentParser:
        """A command that calls function(options); the parser, for its arguments."""
        one = self._all.add_parser(name, help=help, description=help, **more)
        one.set_defaults(function=function)
        return one
