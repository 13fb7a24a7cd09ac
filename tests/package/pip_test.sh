#!/bin/bash
# pip install of the sources as a user has them, without a network: a source distribution builds the library into the package, in
# a fresh virtual environment with an empty home; the package then needs no other library and takes none. And what is said where
# tools are missing.
#
# usage: pip_test.sh SOURCE_DIRECTORY PYTHON OTHER_LIBRARY_DIRECTORY    with OPTIONS, for CMake, in the environment
set -u
source=$1 python=$2 other=$3
"$python" -c "import venv, ensurepip, cffi, matplotlib" || { echo "skipped: no venv, pip, cffi or matplotlib"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }
mkdir "$work/home" "$work/dist" "$work/tools"
cd "$source" || exit 1
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=bindings/python/backend "$python" -c "
import sys, granperi_backend
print(granperi_backend.build_sdist(sys.argv[1]))" "$work/dist" >"$work/log" || { cat "$work/log"; fail "the source distribution"; }
sdist=$work/dist/$(tail -n 1 "$work/log")
cd "$work/home" || exit 1
"$python" -m venv --system-site-packages "$work/venv" || fail "venv"
# Nothing of this shell's environment helps.
clean=(env -i "HOME=$work/home" "GRANPERI_CMAKE_OPTIONS=${OPTIONS:-}")
pip=("$work/venv/bin/python" -m pip install --no-index --disable-pip-version-check)

# refused TEXT COMMAND...: fails, and says so
refused() {
    local text=$1
    shift
    "$@" >"$work/log" 2>&1 && fail "it builds: $*"
    grep -q -- "$text" "$work/log" || { cat "$work/log"; fail "it does not say: $text"; }
}
# Programs by these names stand in for what a system has.
fake() {
    printf '#!/bin/sh\n%s\n' "$2" >"$work/tools/$1"
    chmod 755 "$work/tools/$1"
}
path=$work/tools:/usr/bin:/bin
refused "missing: .*a C++17 compiler (c++), CXX = no-such" "${clean[@]}" PATH="$path" CXX=no-such "${pip[@]}" "$sdist"
refused "sudo apt-get install build-essential cmake" "${clean[@]}" PATH="$path" CXX=no-such "${pip[@]}" "$sdist"
fake cmake 'echo cmake version 3.18.4'
refused "CMake 3.20 or later (cmake is 3.18)" "${clean[@]}" PATH="$path" "${pip[@]}" "$sdist"
fake cmake 'case $1 in --version) echo cmake version 3.25.1 ;; *) echo "Could NOT find HDF5 (missing: HDF5_LIBRARIES)"; exit 1 ;; esac'
refused "the HDF5 C library with its headers. On Debian: sudo apt-get install libhdf5-dev" "${clean[@]}" PATH="$path" "${pip[@]}" "$sdist"
refused "options=-DGRANPERI_HDF5=OFF" "${clean[@]}" PATH="$path" "${pip[@]}" "$sdist"
rm "$work/tools/cmake"
refused "library = 'mine' (GRANPERI_LIBRARY): expected 'bundled' or 'installed'" "${clean[@]}" PATH="$path" \
    "${pip[@]}" "$sdist" --config-settings=library=mine
refused "the library granperi was not found" "${clean[@]}" PATH="$path" PKG_CONFIG_LIBDIR="$work/nowhere" GRANPERI_LIBRARY=installed \
    "${pip[@]}" "$sdist"

"${clean[@]}" PATH="$path" "${pip[@]}" "$sdist" >"$work/log" 2>&1 || { tail -n 40 "$work/log"; fail "pip install"; }
run=("${clean[@]}" PATH=/usr/bin:/bin "$work/venv/bin/python")
said=$("${run[@]}" -c "
import granperi
with granperi.Simulation(spacing=0.01) as sim:
    sim.add_column(width=0.1, height=0.05)
    sim.add_plate(granperi.Plate.floor(-0.5, 0.6))
    sim.record('run.h5', 0.02, 0.01) if granperi.has_feature('hdf5') else sim.run(0.02)
    print(granperi.__path__[0], sim.n_particles)") || fail "a run"
case $said in "$work/venv/"*" 50") ;; *) fail "it says: $said" ;; esac
[ -e run.h5 ] || fail "no result file"
"$work/venv/bin/granperi" info >/dev/null || fail "the program granperi"
# Its library is its own, whatever else the loader is told of.
cat >which.py <<'PYTHON'
import granperi

own = granperi.__path__[0] + "/libgranperi.so."
libraries = {line.split()[-1] for line in open("/proc/self/maps") if "/libgranperi" in line}
assert libraries and all(path.startswith(own) for path in libraries), libraries
PYTHON
"${run[@]}" which.py || fail "another library is loaded"
LD_LIBRARY_PATH=$other "$work/venv/bin/python" which.py || fail "LD_LIBRARY_PATH puts another library under it"
"$work/venv/bin/python" -m pip uninstall -y granperi >"$work/log" 2>&1 || { cat "$work/log"; fail "uninstall"; }
[ -z "$(find "$work/venv" -path '*granperi*' -print -quit)" ] || fail "left behind: $(find "$work/venv" -path '*granperi*')"
echo "passed"
