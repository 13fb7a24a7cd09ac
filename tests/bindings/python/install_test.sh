#!/bin/bash
# The package as a user installs it: the library into a fresh prefix, the package by pip, offline, into a fresh virtual
# environment, found through pkg-config alone; and what is said where the library is missing.
#
# usage: install_test.sh BUILD_DIRECTORY LIBDIR SOURCE_DIRECTORY PYTHON     with CMAKE in the environment
set -u
build=$1 libdir=$2 source=$3 python=$4
command -v pkg-config >/dev/null || { echo "skipped: no pkg-config"; exit 77; }
"$python" -c "import venv, ensurepip, cffi, matplotlib" || { echo "skipped: no venv, pip, cffi or matplotlib"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }
unset PYTHONPATH LD_LIBRARY_PATH PKG_CONFIG_PATH

"$CMAKE" --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake --install"; }
cp -r "$source/bindings/python" "$work/package" # pip builds in the tree: a clean one stays clean
cd "$work" || exit 1
"$python" -m venv --system-site-packages "$work/venv" || fail "venv"
pip=("$work/venv/bin/python" -m pip install --no-index --disable-pip-version-check)

# Without the library: a message that says what to do.
PKG_CONFIG_LIBDIR=$work/nowhere "${pip[@]}" ./package >"$work/log" 2>&1 && fail "it installs without the library"
grep -q "the library granperi was not found" "$work/log" && grep -q "PKG_CONFIG_PATH=PREFIX" "$work/log" ||
    { cat "$work/log"; fail "no message on the missing library"; }

PKG_CONFIG_PATH=$work/prefix/$libdir/pkgconfig "${pip[@]}" ./package >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "pip install"; }
site=$("$work/venv/bin/python" -c "import granperi; print(granperi.__path__[0])") || fail "import granperi"
[[ $site == "$work/venv/"* ]] || fail "granperi is imported from $site"
ls "$site"/_granperi.abi3.so >/dev/null || fail "the extension is not of the limited ABI: $(ls "$site")"
[ -e "$site/py.typed" ] || fail "no py.typed"

cat >scene.toml <<TOML
[config]
spacing = 0.01
[run]
end = 0.05
output = "none"
[[column]]
width = 0.1
height = 0.05
[[floor]]
x_left = -1
x_right = 1
TOML
"$work/venv/bin/granperi" run scene.toml | grep -q "^n_particles *50$" || fail "the program granperi"
version=$(PKG_CONFIG_PATH=$work/prefix/$libdir/pkgconfig pkg-config --modversion granperi)
"$work/venv/bin/python" -m pip --disable-pip-version-check list 2>/dev/null | grep -q "^granperi *$version\$" ||
    fail "the package's version is not $version"

# The library goes away afterwards.
mv "$work/prefix" "$work/elsewhere"
"$work/venv/bin/python" -c "import granperi" >"$work/log" 2>&1 && fail "it is imported without the library"
grep -q "the C library granperi was not found. Install it" "$work/log" || { cat "$work/log"; fail "no message"; }
LD_LIBRARY_PATH=$work/elsewhere/$libdir "$work/venv/bin/python" -c "import granperi" || fail "LD_LIBRARY_PATH"
echo "passed"
