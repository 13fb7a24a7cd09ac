#!/usr/bin/env python3
"""The library among its neighbours in a process: host programs are compiled against it as it is built, and run.

usage: process_test.py CHECK --library LIBRARY --include DIRECTORY [--cc CC] [--cxx CXX]

CHECK is one of
  floats   flush-to-zero, rounding, traps, in the host's thread and in OpenMP's
  threads  two simulations in two threads of the host, and on stacks of 256 KiB
  region   inside and between parallel regions of the host; with the library's OpenMP
  libomp   the same with another OpenMP runtime, clang's
  plugin   dlopen, use, dlclose, again and again; in C and in Python
  forks    fork before and after the first use, and exec
  locale   a host with a decimal comma
  hdf5     a host with serial HDF5 of its own
  mpi      a host with parallel HDF5 of its own
Exits with 77 where a check does not apply.
"""

import argparse
import filecmp
import os
import pathlib
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def run(command, **options):
    """Its output, if it succeeds; else the end of this test, with what it said."""
    options.setdefault("timeout", 250)
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            errors="replace", **options)
    if result.returncode != 0:
        sys.exit("FAILED: %s returned %d:\n%s" % (" ".join(map(str, command)), result.returncode, result.stdout))
    return result.stdout


def environment(**more):
    # Threads that wait sleep: the tests share the processors.
    return {**os.environ, "OMP_WAIT_POLICY": "passive", **more}


class Test:
    def __init__(self, arguments, work):
        self.library, self.include, self.work = arguments.library, arguments.include, work
        self.cc, self.cxx = arguments.cc, arguments.cxx

    def build(self, name, *flags, compiler=None, to=None):
        """The host program from its source here, against the shared library."""
        source = HERE / name
        compiler = compiler or (self.cxx if source.suffix == ".cpp" else self.cc)
        standard = "-std=c++17" if source.suffix == ".cpp" else "-std=c99"
        program = self.work / (to or source.stem)
        run([*compiler, standard, "-O1", "-Wall", "-Wextra", "-I", self.include, source, "-o", program, self.library,
             "-Wl,-rpath," + str(self.library.parent), *flags])
        return program

    def floats(self):
        program = self.build("floats.c", "-fopenmp", "-D_POSIX_C_SOURCE=200809L", "-Wno-unused-function", "-lm")
        print(run([program, self.work], env=environment()), end="")
        print(run([program, "--cost"], env=environment()), end="")

    def threads(self):
        program = self.build("threads.c", "-pthread")
        print(run([program, self.work], env=environment(OMP_STACKSIZE="256K")), end="")
        small = 256 * 1024
        limit = lambda: resource.setrlimit(resource.RLIMIT_STACK, (small, small))
        print("ulimit -s 256:", run([program, self.work], env=environment(OMP_STACKSIZE="256K"), preexec_fn=limit), end="")

    def regions(self, program, **more):
        for nested in (1, 2):
            print("%d active levels:" % nested,
                  run([program, 3], env=environment(OMP_MAX_ACTIVE_LEVELS=str(nested), **more)), end="")

    def runtime(self, program, **more):
        """The file from which the library gets OpenMP in this host."""
        said = run([program, 1], env=environment(LD_DEBUG="bindings", **more))
        for line in said.splitlines():
            if "omp_in_parallel'" in line and "file %s" % self.library.parent in line:
                return line.split(" to ")[1].split()[0]
        sys.exit("FAILED: nobody serves omp_in_parallel")

    def region(self):
        program = self.build("region.c", "-fopenmp")
        self.regions(program)

    def libomp(self):
        if not shutil.which("clang"):
            skip("no clang")
        try:
            program = self.build("region.c", "-fopenmp=libomp", compiler=["clang"], to="libomp")
        except SystemExit as problem:
            if "omp.h" in str(problem) or "-lomp" in str(problem):
                skip("no libomp")
            raise
        # libomp has GNU's entry points, too, and the loader finds it first: it serves both. Where libgomp comes first, each of
        # the two has its own.
        for wanted, more in (("libomp", {}), ("libgomp", {"LD_PRELOAD": "libgomp.so.1"})):
            runtime = self.runtime(program, **more)
            print("the host has libomp, the library", runtime)
            if wanted not in runtime:
                sys.exit("FAILED: this was to be " + wanted)
            self.regions(program, **more)

    def plugin(self):
        program = self.build("plugin.c", "-ldl")
        for policy in ("passive", "active"): # threads that wait: asleep, or running in a loop
            print("%s:" % policy, run([program, self.library, 12], env=environment(OMP_WAIT_POLICY=policy)), end="")
        print("Python's ctypes:", run([sys.executable, HERE / "plugin.py", self.library, 6], env=environment()), end="")

    def forks(self):
        print(run([self.build("forks.c")], env=environment()), end="")

    def locale(self):
        names = self.work / "locales"
        names.mkdir()
        if not shutil.which("localedef"):
            skip("no localedef")
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(names / "de_DE.UTF-8")], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        if made.returncode != 0:
            skip("no locale with a decimal comma can be made: " + made.stdout)
        program = self.build("locale.cpp")
        said = {}
        for name, sign in (("C", "."), ("de_DE.UTF-8", ",")):
            directory = self.work / name
            directory.mkdir()
            said[name] = run([program, directory, sign], env=environment(LC_ALL=name, LANGUAGE="de", LOCPATH=str(names)))
            (directory / "locale.gpc").unlink(missing_ok=True) # knows seconds and paths; the program has loaded it
        if said["C"] != said["de_DE.UTF-8"]:
            sys.exit("FAILED: the library says, without and with a decimal comma:\n" + "\n".join(said.values()))
        files = sorted(path.name for path in (self.work / "C").iterdir())
        for name in files:
            if not filecmp.cmp(self.work / "C" / name, self.work / "de_DE.UTF-8" / name, shallow=False):
                sys.exit("FAILED: another file with a decimal comma: " + name)
        print(said["C"], end="")
        print("the same %d lines and %d files with a decimal comma" % (said["C"].count("\n"), len(files)))

    def host_hdf5(self, name, *flags):
        flags = [word for flag in flags for word in shlex.split(flag)]
        program = self.build("hdf5.c", *flags, to=name)
        print(run([program, self.work], env=environment(OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                                                        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")), end="")
        for path in ("own.h5", "frames.h5"):
            if shutil.which("h5dump"):
                run(["h5dump", "-H", self.work / path])
        return program

    def pkg_config(self, package):
        found = subprocess.run(["pkg-config", "--cflags", "--libs", package], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               text=True)
        if found.returncode != 0:
            skip("pkg-config does not know " + package)
        return found.stdout

    def hdf5(self):
        self.host_hdf5("serial", self.pkg_config("hdf5-serial"))

    def mpi(self):
        program = self.host_hdf5("parallel", "-DPARALLEL", self.pkg_config("hdf5-openmpi"), self.pkg_config("ompi-c"))
        loaded = run(["ldd", program])
        print("in one process:", ", ".join(name for name in ("libhdf5_serial.so", "libhdf5_openmpi.so") if name in loaded))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    checks = [name for name in ("floats threads region libomp plugin forks locale hdf5 mpi").split()]
    parser.add_argument("check", choices=checks)
    parser.add_argument("--library", required=True, type=lambda path: pathlib.Path(path).absolute())
    parser.add_argument("--include", required=True, type=lambda path: pathlib.Path(path).absolute())
    parser.add_argument("--cc", default="cc", type=shlex.split)
    parser.add_argument("--cxx", default="c++", type=shlex.split)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        getattr(Test(arguments, pathlib.Path(work)), arguments.check)()
    print("passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
