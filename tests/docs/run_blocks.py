#!/usr/bin/env python3
"""Runs every code block of a page in Markdown, in its order, in one scratch directory, as a reader would.

usage: run_blocks.py PAGE.md... [--prefix DIRECTORY] [--cc CC] [--fc FC] [--python PYTHON] [--work DIRECTORY] [--list]

  --prefix   an installed granperi: its programs, libraries, pkg-config files and CMake packages are found first
  --work     where to run, in a directory per page, kept; else a directory that goes again
  --list     only says what would be done with each block

What is done with a fenced block depends on its language
  sh             run by sh -e
  python         run; the blocks of a page share their names, as in one session
  c, fortran     a whole program: compiled with what pkg-config says, and run. Anything else is the inside of a program: of
                 int main, or of a block in a program that uses granperi, unless the page says otherwise (around)
  text, none     nothing
  others         an error, unless a comment before the block says what to do
and on a comment in the line before it, which no reader of the page sees
  <!-- block: file NAME -->            written to the file NAME, not run: a block of sh further down does that
  <!-- block: skip REASON -->          not run
  <!-- block: fails TEXT -->           does not compile, or ends with an error, and what it says holds TEXT
  <!-- block: output -->               what the last block printed; "..." stands for anything
  <!-- block: around LANGUAGE ... -->  further lines of the comment are the program around fragments in this language from
                                       here on, with @block@ in a line where the fragment goes
"""

import argparse
import collections
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

Block = collections.namedtuple("Block", "line language text directive argument")
AROUND = {
    "c": "#include <granperi/gp.h>\n#include <math.h>\n#include <stdio.h>\n#include <stdlib.h>\n\n"
         "int main(void) {\n@block@\n    return 0;\n}\n",
    "fortran": "program fragment\n    use granperi\n    implicit none\n    block\n@block@\n    end block\nend program\n",
}
WHOLE = {"c": r"\bint main\s*\(", "fortran": r"(?im)^\s*(program|module)\s+\w+\s*$"}
SECONDS = 300


class PageError(Exception):
    pass


def blocks_of(page):
    """The page's fenced blocks and the programs around them, in order."""
    with open(page, encoding="utf-8") as source:
        lines = source.read().split("\n")
    found, directive, k = [], None, 0
    while k < len(lines):
        line = lines[k]
        comment = re.match(r"<!-- block: (\w+) ?(.*)", line)
        fence = re.match(r"(```+|~~~+) *([\w+-]*)", line)
        if comment:
            name, rest = comment.groups()
            body = []
            while "-->" not in lines[k]:
                k += 1
                body.append(lines[k])
            if name == "around":
                found.append(Block(k + 1, rest.strip(), "\n".join(body[:-1]) + "\n", "around", ""))
            elif name in ("file", "skip", "fails", "output"):
                directive = (name, rest.replace("-->", "").strip())
            else:
                raise PageError("%s:%d: unknown directive %s" % (page, k + 1, name))
        elif fence:
            begin, body = k + 1, []
            k += 1
            while k < len(lines) and not lines[k].startswith(fence.group(1)):
                body.append(lines[k])
                k += 1
            if k == len(lines):
                raise PageError("%s:%d: this block has no end" % (page, begin))
            found.append(Block(begin, fence.group(2), "\n".join(body) + "\n", *(directive or ("run", ""))))
            directive = None
        elif directive and line.strip():
            raise PageError("%s:%d: there is no block behind the directive" % (page, k + 1))
        k += 1
    return found


SESSION = """
import contextlib, io, json, sys, traceback
names = {"__name__": "__main__"}
for line in sys.stdin:
    request, said, good = json.loads(line), io.StringIO(), True
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            exec(compile("\\n" * request["line"] + request["text"], request["page"], "exec"), names)
        except BaseException:
            traceback.print_exc()
            good = False
    print(json.dumps([good, said.getvalue()]), file=sys.__stdout__, flush=True)
"""


class Runner:
    """Each method runs one block and returns (whether it went well, what it said)."""

    def __init__(self, page, arguments, work):
        self.page, self.arguments, self.work = page, arguments, work
        self.around = dict(AROUND)
        self.environment = environment(arguments.prefix)
        self.session = None

    def command(self, command):
        result = subprocess.run(command, cwd=self.work, env=self.environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=SECONDS)
        return result.returncode == 0, result.stdout

    def sh(self, block):
        return self.command(["sh", "-e", "-c", block.text])

    def compiled(self, block):
        text = block.text
        if not re.search(WHOLE[block.language], text):
            text = self.around[block.language].replace("@block@\n", text)
        name, package = ("block.c", "granperi") if block.language == "c" else ("block.f90", "granperi-fortran")
        with open(os.path.join(self.work, name), "w") as target:
            target.write(text)
        good, flags = self.command(["pkg-config", "--cflags", "--libs", package])
        if not good:
            return good, flags
        compiler = self.arguments.cc + ["-std=c99"] if block.language == "c" else self.arguments.fc
        good, said = self.command([*compiler, "-Wall", name, "-o", "block", *shlex.split(flags), "-lm"])
        return self.command(["./block"]) if good else (good, said)

    c = fortran = compiled

    def python(self, block):
        if self.session is None:
            self.session = subprocess.Popen([*self.arguments.python, "-c", SESSION], cwd=self.work, env=self.environment,
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True)
        self.session.stdin.write(json.dumps({"line": block.line, "page": self.page, "text": block.text}) + "\n")
        self.session.stdin.flush()
        answer = self.session.stdout.readline()
        return tuple(json.loads(answer)) if answer else (False, "the interpreter died")

    def end(self):
        if self.session:
            self.session.stdin.close()
            self.session.wait(SECONDS)


def environment(prefix):
    found = dict(os.environ, OMP_WAIT_POLICY="passive", MPLBACKEND="Agg")
    if prefix is None:
        return found

    def put_first(name, *directories):
        found[name] = ":".join([*(path for path in directories if os.path.isdir(path)), *filter(None, [found.get(name)])])

    libraries = [root for root, directories, _ in os.walk(prefix) if "pkgconfig" in directories]
    put_first("PATH", os.path.join(prefix, "bin"))
    put_first("CMAKE_PREFIX_PATH", prefix)
    put_first("PKG_CONFIG_PATH", *(os.path.join(path, "pkgconfig") for path in libraries))
    put_first("LD_LIBRARY_PATH", *libraries)
    return found


def matches(expected, said):
    pattern = ".*?".join(re.escape(part) for part in expected.strip().split("..."))
    return re.fullmatch(pattern, said.strip(), re.S) is not None


def run_page(page, arguments, work):
    """Number of blocks that were not as they ought to be."""
    runner, wrong, said = Runner(page, arguments, work), 0, ""
    for block in blocks_of(page):
        what, good, last = block.directive, True, said
        if block.directive == "around":
            if block.language not in AROUND or "@block@\n" not in block.text:
                raise PageError("%s:%d: around needs c or fortran, and a line @block@" % (page, block.line))
            runner.around[block.language] = block.text
        elif block.directive == "skip":
            what = "skipped: " + block.argument
        elif block.directive == "file":
            what = "file " + block.argument
            if not arguments.list:
                path = os.path.join(work, block.argument)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w") as target:
                    target.write(block.text)
        elif block.directive == "output":
            good = arguments.list or matches(block.text, last)
        elif block.language in ("", "text"):
            continue
        elif block.language not in ("sh", "c", "fortran", "python"):
            raise PageError("%s:%d: nothing is known to do with %s" % (page, block.line, block.language))
        elif not arguments.list:
            good, said = getattr(runner, block.language)(block)
            last = said
            if block.directive == "fails":
                good = not good and block.argument in said
        print("%s:%d: %s %s: %s" % (page, block.line, block.language, what, "ok" if good else "FAILED"))
        if not good:
            wrong += 1
            print(last)
    runner.end()
    return wrong


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("pages", nargs="+")
    parser.add_argument("--prefix", type=os.path.abspath)
    parser.add_argument("--cc", default="cc", type=shlex.split)
    parser.add_argument("--fc", default="gfortran", type=shlex.split)
    parser.add_argument("--python", default=sys.executable, type=shlex.split)
    parser.add_argument("--work", type=os.path.abspath)
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    wrong = 0
    for page in arguments.pages:
        with tempfile.TemporaryDirectory() as scratch:
            work = os.path.join(arguments.work, os.path.basename(page)) if arguments.work else scratch
            os.makedirs(work, exist_ok=True)
            try:
                wrong += run_page(os.path.abspath(page), arguments, work)
            except PageError as error:
                sys.exit(str(error))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
