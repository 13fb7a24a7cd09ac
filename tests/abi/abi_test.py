#!/usr/bin/env python3
"""What compiled programs rely on: the header, the exported names, the layout of the structs.

usage: abi_test.py CHECK --header GP_H --library LIBRARY [--work DIRECTORY] [--cc CC] [--cxx CXX] [--flags FLAGS]
                   [--pinned FILE [--update]]

CHECK is one of
  header   the header compiles alone in every language it is for, without a warning
  symbols  the library exports what the header declares and nothing else; its SONAME
  link     a C program that uses every declared function links and runs
  layout   sizes, offsets and constants are those of the file given by --pinned (--update writes it)
Exits with 77 where a check does not apply.
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile

failures = []


def fail(*what):
    print("FAILED:", *what)
    failures.append(what)


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, **options)


class Header:
    def __init__(self, path):
        with open(path) as source:
            text = re.sub(r"/\*.*?\*/", " ", source.read(), flags=re.S)
        # (name, whole declaration) of every function
        self.functions = [(match.group(1), " ".join(match.group(0).split()))
                          for match in re.finditer(r"^GP_API\s[^;(]*?\b(gp_\w+)\s*\([^;]*\)\s*;", text, re.M)]
        # name -> its fields
        self.structs = {}
        for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S):
            fields = []
            for declaration in filter(None, (part.strip() for part in body.split(";"))):
                for declarator in declaration.split(","):
                    fields.append(re.search(r"(\w+)\s*(\[\w+\])?$", declarator).group(1))
            self.structs[name] = fields
        self.constants = re.findall(r"\b(GP_\w+)\s*=", " ".join(re.findall(r"\benum \{(.*?)\}", text, re.S)))
        self.constants += [name for name in re.findall(r"^#define (GP_\w+) [^\n]", text, re.M)
                           if not name.startswith(("GP_API", "GP_VERSION_"))]
        declared = len(re.findall(r"^GP_API\b", text, re.M))
        if declared != len(self.functions) or not self.structs or not self.constants:
            fail("this script understands", len(self.functions), "of", declared, "declarations in the header")


def write(arguments, name, text):
    path = os.path.join(arguments.work, name)
    with open(path, "w") as target:
        target.write(text)
    return path


def check_header(arguments, header):
    text = '#include "%s"\n#include "%s"\n' % (arguments.header, arguments.header)
    strict = ["-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wundef", "-Werror", "-fsyntax-only"]
    c = write(arguments, "header.c", text + "int header_is_not_empty;\n")
    cxx = write(arguments, "header.cpp", text)
    for standard in ("c99", "c11", "c17"):
        compile_header(arguments.cc + ["-std=" + standard, "-Wstrict-prototypes"] + strict + [c])
    for standard in ("c++11", "c++14", "c++17", "c++20"):
        compile_header(arguments.cxx + ["-std=" + standard, "-Wold-style-cast"] + strict + [cxx])
    # Its macros keep to its own corner of the name space.
    for line in run(arguments.cc + ["-std=c99", "-dM", "-E", c]).stdout.splitlines():
        name = line.split()[1].split("(")[0]
        if name.lower().startswith(("gp", "granperi")) and not name.startswith(("GP_", "GRANPERI_GP_H", "gp_load")):
            fail("the macro", name)


def compile_header(command):
    result = run(command)
    if result.returncode != 0:
        fail(" ".join(command), "\n" + result.stdout)


def check_symbols(arguments, header):
    listed = run(["nm", "-D", "--defined-only", arguments.library])
    if listed.returncode != 0:
        return fail(listed.stdout)
    exported = {line.split()[-1].split("@")[0] for line in listed.stdout.splitlines()}
    # gp_load is also a type: the header has it as a macro over gp_load_file, and binaries as a function.
    declared = {name for name, _ in header.functions} | {"gp_load"}
    for name in sorted(declared - exported):
        fail("declared, but not exported:", name)
    for name in sorted(exported - declared):
        fail("exported, but not declared:", name)
    print(len(exported), "exported names")
    dynamic = run(["readelf", "-d", arguments.library]).stdout
    soname = re.search(r"\(SONAME\).*\[(.*)\]", dynamic)
    if not soname or soname.group(1) != "libgranperi.so.0":
        fail("SONAME is", soname and soname.group(1))
    if re.search(r"\(TEXTREL\)", dynamic):
        fail("the code has to be relocated when it is loaded")


def check_link(arguments, header):
    text = '#include "%s"\n#include <stdio.h>\n' % arguments.header
    text += "typedef void (*function)(void);\n"
    text += "static const function functions[] = {\n"
    text += "".join("    (function)%s,\n" % name for name, _ in header.functions)
    text += "};\nint main(void) {\n    unsigned k, n = sizeof functions / sizeof functions[0];\n"
    text += "    /* gp_load, the type and the call */\n    gp_load load;\n    gp_sim *sim = NULL;\n"
    text += "    load.struct_size = (uint32_t)sizeof load;\n"
    text += "    if (gp_load(\"nowhere\", &sim) >= 0 || sim || load.struct_size == 0)\n"
    text += "        return 1;\n"
    text += "    for (k = 0; k < n; ++k)\n        if (!functions[k])\n            return 1;\n"
    text += "    printf(\"%u functions, version %s\\n\", n, gp_version_string());\n    return 0;\n}\n"
    source = write(arguments, "link.c", text)
    program = os.path.join(arguments.work, "link")
    directory = os.path.dirname(arguments.library)
    result = run(arguments.cc + ["-std=c99", "-Wall", "-Wextra", "-Werror"] + arguments.flags +
                 [source, "-o", program, arguments.library, "-Wl,-rpath," + directory])
    if result.returncode != 0:
        return fail("link:", result.stdout)
    result = run([program])
    print(result.stdout, end="")
    if result.returncode != 0 or "%d functions" % len(header.functions) not in result.stdout:
        fail("the program returned", result.returncode, result.stdout)


def check_layout(arguments, header):
    text = '#include "%s"\n#include <stdio.h>\n' % arguments.header
    text += "#define SIZE(type) printf(#type \" size %u\\n\", (unsigned)sizeof(type))\n"
    text += "#define FIELD(type, field) printf(#type \".\" #field \" at %u size %u\\n\", "
    text += "(unsigned)offsetof(type, field), "
    text += "(unsigned)sizeof(((type *)0)->field))\n"
    text += "#define VALUE(name) printf(#name \" = %ld\\n\", (long)(name))\n"
    text += "int main(void) {\n    if (sizeof(void *) != 8 || sizeof(long) != 8)\n        return 77;\n"
    text += "    SIZE(gp_status);\n"
    for name, fields in header.structs.items():
        text += "    SIZE(%s);\n" % name + "".join("    FIELD(%s, %s);\n" % (name, field) for field in fields)
    text += "".join("    VALUE(%s);\n" % name for name in header.constants) + "    return 0;\n}\n"
    source = write(arguments, "layout.c", text)
    program = os.path.join(arguments.work, "layout")
    result = run(arguments.cc + ["-std=c99", source, "-o", program])
    if result.returncode != 0:
        return fail(result.stdout)
    result = run([program])
    if result.returncode == 77:
        print("skipped: the layout is pinned for 64-bit systems")
        sys.exit(77)
    found = result.stdout.splitlines()
    if arguments.update:
        with open(arguments.pinned, "w") as target:
            target.write(result.stdout)
        return
    with open(arguments.pinned) as source:
        pinned = source.read().splitlines()
    for line in pinned:
        if line not in found:
            fail("no longer so:", line)
    for line in found:
        if line not in pinned:
            fail("not pinned:", line)
    print(len(found), "sizes, offsets and constants")
    if failures:
        print("If this is meant, and no program is broken by it: abi_test.py layout --update")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("check", choices=["header", "symbols", "link", "layout"])
    parser.add_argument("--header", required=True, type=os.path.abspath)
    parser.add_argument("--library", type=os.path.abspath)
    parser.add_argument("--work", type=os.path.abspath, help="kept; else a directory that goes again")
    parser.add_argument("--cc", default="cc", type=shlex.split)
    parser.add_argument("--cxx", default="c++", type=shlex.split)
    parser.add_argument("--flags", default="", type=shlex.split)
    parser.add_argument("--pinned")
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    scratch = tempfile.TemporaryDirectory()
    arguments.work = arguments.work or scratch.name
    os.makedirs(arguments.work, exist_ok=True)
    {"header": check_header, "symbols": check_symbols, "link": check_link,
     "layout": check_layout}[arguments.check](arguments, Header(arguments.header))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
