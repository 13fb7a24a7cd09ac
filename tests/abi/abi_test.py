#!/usr/bin/env python3
"""What compiled programs rely on: the header, the exported names, the layout of the structs.

usage: abi_test.py CHECK --header GP_H [GP_MPI_H] --library LIBRARY [--work DIRECTORY] [--cc CC] [--cxx CXX] [--flags FLAGS]
                   [--pinned FILE [--update]] [--static LIBRARY --static-flags FLAGS] [--source DIRECTORY --source-flags FLAGS]
                   [--older DIRECTORY]

CHECK is one of
  header   the header compiles alone in every language it is for, without a warning
  symbols  the library exports what the header declares and nothing else; its SONAME
  link     a C program that uses every declared function links and runs, with the shared library and, given --static, the static
  older    what the header in the directory given by --older has is where it was, what is new lies behind it, and the program there,
           compiled with that header, runs with the library
  layout   sizes, offsets and constants are those of the file given by --pinned (--update writes it)
  diff     abidiff finds no difference between the header and the dump given by --pinned (--update writes it), and, given
           --source, the code and the header
Of the library for several processes, header, symbols and link are checked with both of its headers.
Exits with 77 where a check does not apply.
"""

import argparse
import glob
import os
import re
import shlex
import shutil
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
    def __init__(self, paths):
        text = ""
        for path in paths:
            with open(path) as source:
                text += re.sub(r"/\*.*?\*/", " ", source.read(), flags=re.S)
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
    text = '#include "%s"\n' % arguments.header[-1] * 2
    strict = ["-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wundef", "-Werror", "-fsyntax-only"]
    c = write(arguments, "header.c", text + "int header_is_not_empty;\n")
    cxx = write(arguments, "header.cpp", text)
    compilers = [(arguments.cc, arguments.cxx)]
    compilers += [([name], [other]) for name, other in (("gcc", "g++"), ("clang", "clang++"))
                  if shutil.which(name) and shutil.which(other)]
    checked = []
    for cc, cxx_compiler in compilers:
        for standard in ("c99", "c11", "c17"):
            compile_header(cc + ["-std=" + standard, "-Wstrict-prototypes"] + strict + arguments.flags + [c])
        for standard in ("c++11", "c++14", "c++17", "c++20"):
            compile_header(cxx_compiler + ["-std=" + standard, "-Wold-style-cast"] + strict + arguments.flags + [cxx])
        checked.append(run(cc + ["--version"]).stdout.split("\n")[0])
    print("7 standards each:", "; ".join(checked))
    # Its macros keep to its own corner of the name space.
    for line in run(arguments.cc + ["-std=c99", "-dM", "-E"] + arguments.flags + [c]).stdout.splitlines():
        name = line.split()[1].split("(")[0]
        if name.lower().startswith(("gp", "granperi")) and not name.startswith(("GP_", "GRANPERI_GP_", "gp_load")):
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
    if not soname or soname.group(1) != os.path.basename(arguments.library).split(".")[0] + ".so.0":
        fail("SONAME is", soname and soname.group(1))
    if re.search(r"\(TEXTREL\)", dynamic):
        fail("the code has to be relocated when it is loaded")


def check_link(arguments, header):
    text = '#include "%s"\n#include <stdio.h>\n' % arguments.header[-1]
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
    ways = [("shared", [arguments.library, "-Wl,-rpath," + directory])]
    if arguments.static:
        ways.append(("static", [arguments.static] + arguments.static_flags))
    for way, libraries in ways:
        result = run(arguments.cc + ["-std=c99", "-Wall", "-Wextra", "-Werror"] + arguments.flags +
                     [source, "-o", program] + libraries)
        if result.returncode != 0:
            return fail("link:", way, result.stdout)
        result = run([program])
        print(way + ":", result.stdout, end="")
        if result.returncode != 0 or "%d functions" % len(header.functions) not in result.stdout:
            fail("the program returned", result.returncode, result.stdout)


def layout_of(arguments, path, header):
    """Sizes, offsets and constants of a header, one a line; None where they are not those of 64 bits."""
    text = '#include "%s"\n#include <stdio.h>\n' % path
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
        fail(result.stdout)
        return ""
    result = run([program])
    if result.returncode == 77:
        print("skipped: the layout is pinned for 64-bit systems")
        sys.exit(77)
    return result.stdout


def check_layout(arguments, header):
    layout = layout_of(arguments, arguments.header[0], header)
    if arguments.update:
        with open(arguments.pinned, "w") as target:
            target.write(layout)
        return
    found = layout.splitlines()
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


def check_older(arguments, header):
    path = os.path.join(arguments.older, "granperi", "gp.h")
    older = Header([path])
    before, now = (layout_of(arguments, *which).splitlines() for which in ((path, older), (arguments.header[0], header)))
    # Structs with a struct_size have grown, and there are more fields to or together.
    grown = ["%s size" % name for name, fields in older.structs.items() if fields[0] == "struct_size"]
    for line in before:
        if line not in now and not line.startswith((*grown, "GP_FIELD_ALL ")):
            fail("no longer so:", line)
    # What a program of then leaves at the end of a struct is not a field of now: nobody has set it.
    sizes = dict(re.findall(r"^(\w+) size (\d+)$", "\n".join(before), re.M))
    for name, field, place in re.findall(r"^(\w+)\.(\w+) at (\d+)", "\n".join(now), re.M):
        if name in older.structs and field not in older.structs[name] and int(place) < int(sizes[name]):
            fail("%s.%s lies at %s: expected behind the %s bytes of then" % (name, field, place, sizes[name]))
    program = os.path.join(arguments.work, "older")
    result = run(arguments.cc + ["-std=c99", "-Wall", "-Wextra", "-Werror", "-I", arguments.older] + arguments.flags +
                 [os.path.join(arguments.older, "program.c"), "-o", program, arguments.library,
                  "-Wl,-rpath," + os.path.dirname(arguments.library)])
    if result.returncode != 0:
        return fail("link:", result.stdout)
    result = run([program, arguments.work])
    print(result.stdout, end="")
    if result.returncode != 0:
        fail("the program of then returned", result.returncode)


SONAME = "-Wl,-soname,libgranperi.so.0"


def declared_library(arguments, header):
    """A library that has every declared function, without code: what abidiff is to know of the header."""
    text = "#define GP_BUILDING\n#include <granperi/gp.h>\n"
    for _, declaration in header.functions:
        text += declaration[len("GP_API "):-1] + " { __builtin_trap(); }\n"
    write(arguments, "declared.c", text)
    include = os.path.dirname(os.path.dirname(arguments.header[0]))
    # By relative names, for they are in the dump.
    result = run(arguments.cc + ["-std=c99", "-w", "-g", "-O0", "-shared", "-fPIC", "-I", include, SONAME, "declared.c", "-o",
                                 "libdeclared.so"], cwd=arguments.work)
    if result.returncode != 0:
        fail(result.stdout)
    return os.path.join(arguments.work, "libdeclared.so")


def compiled_library(arguments):
    """The library's own interface with what debuggers know of it. Only its interface: the rest is left undefined."""
    library = os.path.join(arguments.work, "libcompiled.so")
    source = arguments.source
    result = run(arguments.cxx + ["-std=c++17", "-w", "-g", "-O0", "-fPIC", "-shared", "-fvisibility=hidden", "-DGP_BUILDING",
                                  SONAME, "-I", source + "/src", "-I", source + "/include",
                                  "-Wl,--version-script=" + source + "/cmake/granperi.map"] + arguments.source_flags +
                 sorted(glob.glob(source + "/src/api*.cpp")) + ["-o", library])
    if result.returncode != 0:
        fail(result.stdout)
    return library


def check_diff(arguments, header):
    if not shutil.which("abidiff") or not shutil.which("abidw"):
        print("skipped: no abidiff (Debian: abigail-tools)")
        sys.exit(77)
    if run(arguments.cc + ["-dumpmachine"]).stdout.split("-")[0] != "x86_64":
        print("skipped: the dump is of x86-64")
        sys.exit(77)
    declared = declared_library(arguments, header)
    if arguments.update:
        result = run(["abidw", "--no-comp-dir-path", "--no-corpus-path", "--no-show-locs", "--no-elf-needed", "--no-parameter-names",
                      "--out-file", arguments.pinned, declared])
        return fail(result.stdout) if result.returncode != 0 else None
    result = run(["abidiff", arguments.pinned, declared])
    if result.returncode != 0:
        fail("the ABI is no longer that of", arguments.pinned, "(docs/abi.md says what may change)\n" + result.stdout)
        print("If this is meant: ninja update_abi")
    if arguments.source:
        # gp_load has no prototype: in C it is a type.
        result = run(["abidiff", "--headers-dir1", arguments.source + "/include", "--headers-dir2", arguments.source + "/include",
                      "--drop-private-types", "--no-added-syms", declared, compiled_library(arguments)])
        if result.returncode != 0:
            fail("the code has another ABI than the header\n" + result.stdout)
    print(len(header.functions), "functions as in the dump")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("check", choices=["header", "symbols", "link", "older", "layout", "diff"])
    parser.add_argument("--header", required=True, nargs="+", type=os.path.abspath)
    parser.add_argument("--library", type=os.path.abspath)
    parser.add_argument("--work", type=os.path.abspath, help="kept; else a directory that goes again")
    parser.add_argument("--cc", default="cc", type=shlex.split)
    parser.add_argument("--cxx", default="c++", type=shlex.split)
    parser.add_argument("--flags", default="", type=shlex.split)
    parser.add_argument("--pinned")
    parser.add_argument("--older", type=os.path.abspath)
    parser.add_argument("--static", type=os.path.abspath)
    parser.add_argument("--static-flags", default="", type=shlex.split)
    parser.add_argument("--source", type=os.path.abspath)
    parser.add_argument("--source-flags", default="", type=shlex.split)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    scratch = tempfile.TemporaryDirectory()
    arguments.work = arguments.work or scratch.name
    os.makedirs(arguments.work, exist_ok=True)
    {"header": check_header, "symbols": check_symbols, "link": check_link, "older": check_older,
     "layout": check_layout, "diff": check_diff}[arguments.check](arguments, Header(arguments.header))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
