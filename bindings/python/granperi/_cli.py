"""What the commands of `python3 -m granperi` share: each is a module _cli_NAME with a function add(commands)."""
from __future__ import annotations

import argparse
import contextlib
import signal
import sys
from types import FrameType
from typing import Any, Callable, Iterator

from ._progress import has_tqdm


class Terminated(KeyboardInterrupt):
    """SIGTERM: a batch system wants its processor back; SIGHUP: the terminal is gone."""

    def __init__(self, number: int):
        self.number = number


@contextlib.contextmanager
def saved_when_terminated(hint: str) -> Iterator[None]:
    """SIGTERM and, unless nohup has it ignored, SIGHUP interrupt what is inside as Ctrl-C does; the hint says how it goes on after
    that."""
    def terminate(number: int, frame: "FrameType | None") -> None:
        raise Terminated(number)

    before = {number: signal.signal(number, terminate) for number in (signal.SIGTERM, signal.SIGHUP)
              if signal.getsignal(number) != signal.SIG_IGN}
    try:
        yield
    except KeyboardInterrupt:
        if hint:
            print(f"granperi: {hint}", file=sys.stderr)
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class Commands:
    """The commands of the command line, to which each module adds its own."""

    def __init__(self, parser: argparse.ArgumentParser):
        self._all = parser.add_subparsers(dest="command", required=True, metavar="command")

    def add(self, name: str, function: Callable[[argparse.Namespace], None], help: str, **more: Any) -> argparse.ArgumentParser:
        """A command that calls function(options); the parser, for its arguments."""
        one = self._all.add_parser(name, help=help, description=help, **more)
        one.set_defaults(function=function)
        return one


def bar_is_shown(options: argparse.Namespace) -> bool:
    """--progress or --no-progress; without either, on a terminal that has tqdm."""
    return options.progress if options.progress is not None else sys.stderr.isatty() and has_tqdm()


def whole_above_0(text: str) -> int:
    """The type of an argument that counts something."""
    with contextlib.suppress(ValueError):
        if (number := int(text)) >= 1:
            return number
    raise argparse.ArgumentTypeError(f"{text}: expected a whole number >= 1")
