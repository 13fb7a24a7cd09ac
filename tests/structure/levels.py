#!/usr/bin/env python3
"""What a library with the engine for several instruction sets (cmake/levels.cmake) must not do on a processor that lacks some of
them: run or link any of their code before the processor has been asked.

    levels.py --base OBJECT --v3 OBJECT --library LIBRARY --static ARCHIVE
"""
import argparse
import re
import subprocess
import sys


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def names(*nm):
    """Names that other files see."""
    lines = (line.split() for line in output("nm", "--extern-only", "--defined-only", *nm).splitlines())
    return {words[-1] for words in lines if len(words) >= 3}


def main():
    parser = argparse.ArgumentParser()
    for option in ("base", "v3", "library", "static"):
        parser.add_argument("--" + option, required=True)
    arguments = parser.parse_args()
    failures = []

    def require(good, *text):
        if not good:
            failures.append(" ".join(map(str, text)))

    for level in ("base", "v3"):
        whole = getattr(arguments, level)
        seen = names(whole)
        require(seen == {f"granperi_level_{level}"}, whole, "has other names than that of its table:", *sorted(seen)[:9])
        weak = [words[-1] for words in map(str.split, output("nm", "--undefined-only", whole).splitlines()) if words[0] == "w"]
        require(not weak, whole, "has weak references, which a static link leaves empty:", *weak[:9])
        # Constructors of objects before main run whatever the processor.
        sections = re.findall(r"\.(?:init_array|ctors|preinit_array)\S*", output("readelf", "-SW", whole))
        require(not sections, whole, "computes something before main:", *sections)
        groups = re.findall(r"\bGROUP\b", output("readelf", "-SW", whole))
        require(not groups, whole, "has sections that the linker may take for those of another file")
    wide = re.search(r"%[yz]mm\d", output("objdump", "-d", "--no-show-raw-insn", arguments.base))
    require(not wide, arguments.base, "has instructions of AVX")
    require(re.search(r"%ymm\d", output("objdump", "-d", "--no-show-raw-insn", arguments.v3)), arguments.v3, "has none of AVX2")
    seen = names(arguments.static)
    other = sorted(name for name in seen if not name.startswith(("gp_", "granperi_level_")))
    require(not other, arguments.static, "has other names than the interface's:", *other[:9])
    require(names("-D", arguments.library) == {name for name in seen if name.startswith("gp_")},
            "the shared and the static library have different interfaces")
    for failure in failures:
        print("FAILED:", failure)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
