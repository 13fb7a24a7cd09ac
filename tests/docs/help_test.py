#!/usr/bin/env python3
"""Each program says with --help what it does and which options it has: exit status 0, on standard output, and nothing else done.

usage: help_test.py "PROGRAM [ARGUMENT...]"...
"""
import os
import shlex
import subprocess
import sys
import tempfile


def fault_of(command, directory):
    """What is wrong with the help of a program; "" if nothing."""
    result = subprocess.run([*command, "--help"], cwd=directory, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, universal_newlines=True, timeout=60)
    if result.returncode != 0:
        return "ends with %d: %s" % (result.returncode, result.stderr[-300:])
    if result.stderr:
        return "writes to standard error: " + result.stderr[:300]
    name = os.path.basename(command[-1] if command[-1].endswith(".py") else command[0])
    if len(result.stdout.split()) < 15:
        return "says too little: %r" % result.stdout
    if not any(line.startswith("usage: ") for line in result.stdout.splitlines()):
        return "%s has no line that begins with usage: %r" % (name, result.stdout)
    if os.listdir(directory):
        return "leaves files: %s" % os.listdir(directory)
    return ""


def main():
    wrong = 0
    for program in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as directory:
            fault = fault_of(shlex.split(program), directory)
        print("%s: %s" % (program, fault or "ok"))
        wrong += bool(fault)
    return 1 if wrong or len(sys.argv) == 1 else 0


if __name__ == "__main__":
    sys.exit(main())
