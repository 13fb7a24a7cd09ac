"""The build backend of pip install . (PEP 517): CMake builds the library and the package, this packs what it built into a wheel.

It needs nothing but Python itself, so that pip installs with or without a network. What the build needs of the system is a C
and a C++ compiler, CMake, make or ninja, Eigen, HDF5, Python's headers, and cffi in this Python or in the one that this
environment was made with; what is missing is said before anything is built.

Two settings, each as pip install . --config-settings=NAME=VALUE or in the environment:
  library   GRANPERI_LIBRARY        bundled: the package has the library in it [default in the root of the sources];
                                    installed: it uses the one that pkg-config finds [always in bindings/python]
  options   GRANPERI_CMAKE_OPTIONS  for CMake, as on a command line, e.g. -DGRANPERI_HDF5=OFF

A wheel without pip: python3 bindings/python/backend/granperi_backend.py DIRECTORY
"""
from __future__ import annotations

import base64
import hashlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import time
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parent  # bindings/python
ROOT = PACKAGE.parent.parent
#: Of the root of the sources, what a build needs.
IN_SDIST = ("CMakeLists.txt", "pyproject.toml", "LICENSE", "README.md", "CHANGELOG.md", "cmake", "pkgconfig", "include", "src",
            "bindings/python")
EVERYTHING = ("build-essential cmake ninja-build pkg-config libeigen3-dev libhdf5-dev python3-dev python3-cffi python3-numpy "
              "python3-h5py python3-matplotlib")
NO_LIBRARY = """\
the library granperi was not found: {what}
With library=installed the package is built against the installed C library, which pkg-config finds. Install it first
(cmake --install build), and where it is not in a directory that pkg-config knows, name it:
    PKG_CONFIG_PATH=PREFIX/lib/pkgconfig pip install ...
Or let pip build the library into the package: pip install . in the root of the sources."""
#: What CMake says of what it does not find, the package on Debian, and what it costs to do without.
NOT_FOUND = (
    (r'"Eigen3"', "the headers of Eigen 3.3 or later", "libeigen3-dev", ""),
    (r"Could NOT find HDF5", "the HDF5 C library with its headers", "libhdf5-dev",
     " Without it there are no result files and no checkpoints: pip install . --config-settings=options=-DGRANPERI_HDF5=OFF"),
    (r"Could NOT find OpenMP", "OpenMP of the C++ compiler", "g++, or libomp-dev for clang",
     " Without it there is one thread only: pip install . --config-settings=options=-DGRANPERI_OPENMP=OFF"),
)


class BuildError(SystemExit):
    """Ends the build with a text; pip shows it."""

    def __init__(self, text: str):
        super().__init__(f"granperi: {text}")


# ------------------------------------------------------------------------------------------------------- hooks


def get_requires_for_build_wheel(config_settings=None) -> list[str]:
    """cffi from the package index where no Python here has it."""
    check_tools(library_of(config_settings))
    return [] if python_with_cffi() else ["cffi>=1.15"]


def get_requires_for_build_sdist(config_settings=None) -> list[str]:
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None) -> str:
    library = library_of(config_settings)
    check_tools(library)
    python = python_with_cffi()
    if python is None:
        raise BuildError("cffi is missing in this Python (" + sys.executable + "), and in the one that it was made with. "
                         "On Debian: sudo apt-get install python3-cffi; else: pip install cffi")
    project = project_table()
    with tempfile.TemporaryDirectory(prefix="granperi-") as work:
        build(library, python, Path(work), shlex.split(setting(config_settings, "options", "GRANPERI_CMAKE_OPTIONS", "")))
        return pack_wheel(Path(work) / "python", Path(wheel_directory), project, version_of(library))


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None) -> str:
    """So that pip sees to what is needed before minutes of building."""
    project, version = project_table(), version_of(library_of(config_settings))
    name = f"{project['name']}-{version}.dist-info"
    directory = Path(metadata_directory) / name
    directory.mkdir()
    for file, content in information(project, version).items():
        (directory / file).write_bytes(content)
    return name


def build_sdist(sdist_directory, config_settings=None) -> str:
    """What is needed to build the wheel with its library, and PKG-INFO."""
    if not in_root():
        raise BuildError("a source distribution is made in the root of the sources, as the library is a part of it")
    project, version = project_table(), version_of("bundled")
    name = f"{project['name']}-{version}"
    with tarfile.open(Path(sdist_directory) / (name + ".tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for path in sources():
            archive.add(ROOT / path, f"{name}/{path}", recursive=False)
        info = tarfile.TarInfo(f"{name}/PKG-INFO")
        text = metadata_text(project, version).encode()
        info.size, info.mtime = len(text), int(time.time())
        archive.addfile(info, io.BytesIO(text))
    return name + ".tar.gz"


# ---------------------------------------------------------------------------------------------------- settings


def setting(given, name: str, variable: str, default: str) -> str:
    return (given or {}).get(name) or os.environ.get(variable) or default


def in_root() -> bool:
    """Whether the library's sources are what is being built, and not bindings/python alone (pip's hooks run in the project)."""
    return Path.cwd() == ROOT and (ROOT / "src").is_dir()


def library_of(given) -> str:
    library = setting(given, "library", "GRANPERI_LIBRARY", "bundled" if in_root() else "installed")
    if library not in ("bundled", "installed"):
        raise BuildError(f"library = {library!r} (GRANPERI_LIBRARY): expected 'bundled' or 'installed'")
    if library == "bundled" and not in_root():
        raise BuildError("library = 'bundled' needs the sources of the library: pip install . in their root")
    return library


def project_table() -> dict:
    return tomllib.loads((PACKAGE / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def version_of(library: str) -> str:
    """Of the library that the package is for."""
    if library == "installed":
        return pkg_config("--modversion")
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^project\(granperi VERSION ([\d.]+)", text, re.M)[1]


def pkg_config(option: str) -> str:
    answer = subprocess.run(["pkg-config", option, "granperi"], capture_output=True, text=True)
    if answer.returncode != 0:
        raise BuildError(NO_LIBRARY.format(what=answer.stderr.strip()))
    return answer.stdout.strip()


# ------------------------------------------------------------------------------------------------------- build


def check_tools(library: str) -> None:
    """Ends the build with all that is missing, and how to get it, before anything is built."""
    missing = []
    for variable, names, what in (("CC", ("cc", "gcc", "clang"), "a C compiler (cc)"),
                                  ("CXX", ("c++", "g++", "clang++"), "a C++17 compiler (c++)")):
        named = shlex.split(os.environ.get(variable, ""))
        if not any(map(shutil.which, named[:1] or names)) and (variable == "CC" or library == "bundled"):
            missing.append(f"{what}{f', {variable} = {shlex.join(named)}' if named else ''}")
    version = re.search(r"version (\d+)\.(\d+)", output_of("cmake", "--version"))
    if version is None:
        missing.append("CMake 3.20 or later (cmake)")
    elif (int(version[1]), int(version[2])) < (3, 20):
        missing.append(f"CMake 3.20 or later (cmake is {version[1]}.{version[2]})")
    if not any(map(shutil.which, ("ninja", "make", "gmake"))):
        missing.append("ninja or make")
    if not (Path(sysconfig.get_path("include")) / "Python.h").exists():
        missing.append(f"Python's headers ({sysconfig.get_path('include')}/Python.h)")
    if library == "installed" and shutil.which("pkg-config") is None:
        missing.append("pkg-config")
    if missing:
        raise BuildError("cannot be built, missing: " + "; ".join(missing) + "\nOn Debian 12 all that it needs: sudo apt-get "
                         "install " + EVERYTHING)
    if library == "installed":
        pkg_config("--exists")


def output_of(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True).stdout
    except OSError:
        return ""


def python_with_cffi() -> str | None:
    """This Python, or the one that its environment was made with: Debian's python3-cffi is in the latter."""
    for python in (sys.executable, getattr(sys, "_base_executable", None)):
        if python and subprocess.run([python, "-c", "import cffi"], env=environment(python),
                                     capture_output=True).returncode == 0:
            return python
    return None


def environment(python: str) -> dict[str, str]:
    """pip hides the packages of the system from a build by PYTHONPATH: to another Python than this they are shown."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH" or python == sys.executable}


def build(library: str, python: str, work: Path, options: list[str]) -> None:
    command = ["cmake", "-S", str(ROOT if library == "bundled" else PACKAGE), "-B", str(work), "-DCMAKE_BUILD_TYPE=Release",
               f"-DGRANPERI_PYTHON={python}"]
    if library == "bundled":
        command += ["-DGRANPERI_BUILD_PYTHON=ON", "-DGRANPERI_PYTHON_BUNDLE=ON", "-DGRANPERI_BUILD_TESTS=OFF",
                    "-DGRANPERI_BUILD_EXAMPLES=OFF", "-DGRANPERI_BUILD_FORTRAN=OFF"]
    if shutil.which("ninja"):
        command += ["-G", "Ninja"]
    run(command + options, python)
    run(["cmake", "--build", str(work), "--target", "granperi_python_package", "--parallel", str(os.cpu_count() or 1)], python)


def run(command: list[str], python: str) -> None:
    print("+", shlex.join(command), flush=True)
    process = subprocess.Popen(command, env=environment(python), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = []
    for line in process.stdout:
        print(line, end="", flush=True)
        said.append(line)
    if process.wait() != 0:
        text = "".join(said)
        for pattern, what, package, without in NOT_FOUND:
            if re.search(pattern, text):
                raise BuildError(f"cannot be built, missing: {what}. On Debian: sudo apt-get install {package}.{without}")
        raise BuildError(f"{command[0]} failed, see above")


# --------------------------------------------------------------------------------------------------- archives


def sources() -> list[Path]:
    """Files of the sources, relative to their root, in order."""
    found = []
    for name in IN_SDIST:
        path = ROOT / name
        found += [path] if path.is_file() else [p for p in path.rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return sorted(path.relative_to(ROOT) for path in found)


def metadata_text(project: dict, version: str) -> str:
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"License: {project['license']['text']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {needed}" for needed in project["dependencies"]]
    for extra, packages in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {package} ; extra == "{extra}"' for package in packages)]
    lines += ["Description-Content-Type: text/markdown", "", (PACKAGE / project["readme"]).read_text(encoding="utf-8")]
    return "\n".join(lines)


def information(project: dict, version: str) -> dict[str, bytes]:
    """The files of the directory .dist-info."""
    scripts = "".join(f"{name} = {target}\n" for name, target in project["scripts"].items())
    files = {"METADATA": metadata_text(project, version).encode(),
             "WHEEL": f"Wheel-Version: 1.0\nGenerator: granperi_backend\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode(),
             "entry_points.txt": ("[console_scripts]\n" + scripts).encode()}
    if (ROOT / "LICENSE").exists():
        files["LICENSE"] = (ROOT / "LICENSE").read_bytes()
    return files


def tag() -> str:
    """This platform, and every Python from 3.11: the extension has the limited ABI."""
    return "cp311-abi3-" + re.sub(r"[-.]", "_", sysconfig.get_platform())


def pack_wheel(built: Path, directory: Path, project: dict, version: str) -> str:
    """The wheel of what stands in `built`."""
    stem = f"{project['name']}-{version}"
    files = {str(path.relative_to(built)): path.read_bytes() for path in sorted(built.rglob("*"))
             if path.is_file() and "__pycache__" not in path.parts}
    info = stem + ".dist-info/"
    files.update({info + name: content for name, content in information(project, version).items()})
    record = [f"{name},sha256={digest_of(content)},{len(content)}" for name, content in files.items()]
    files[info + "RECORD"] = "\n".join([*record, info + "RECORD,,", ""]).encode()
    directory.mkdir(parents=True, exist_ok=True)
    name = f"{stem}-{tag()}.whl"
    with zipfile.ZipFile(directory / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path)  # of 1980: equal builds are equal files
            entry.external_attr = (0o755 if re.search(r"\.so(\.\d+)*$", path) else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return name


def digest_of(content: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    target = Path(sys.argv[1]).resolve()
    os.chdir(ROOT if (ROOT / "src").is_dir() else PACKAGE)
    print(target / build_wheel(target))
