"""python3 -m granperi: run a scene file, draw and compare results, ask what the library has."""
from __future__ import annotations

import argparse
import os
import sys
import warnings
from typing import Sequence

from . import _cli_animate, _cli_compare, _cli_history, _cli_info, _cli_plot, _cli_report, _cli_run, _cli_sweep
from ._cli import Commands, Terminated
from ._errors import ArgumentError, Error

COMMANDS = (_cli_run, _cli_report, _cli_sweep, _cli_plot, _cli_animate, _cli_history, _cli_compare, _cli_info)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m granperi", description=__doc__.splitlines()[0])
    commands = Commands(parser)
    for command in COMMANDS:
        command.add(commands)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit status: 0, 1 for an error, 2 for wrong arguments, 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP."""
    options = _parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *more, **others: print(f"granperi: {message}", file=sys.stderr)
            options.function(options)
    except KeyboardInterrupt as interrupt:
        print("granperi: interrupted", file=sys.stderr)
        return 128 + interrupt.number if isinstance(interrupt, Terminated) else 130
    except BrokenPipeError:  # who reads what we print has enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (Error, ImportError, OSError) as error:
        print(f"granperi: {error}", file=sys.stderr)
        return 2 if isinstance(error, ArgumentError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
