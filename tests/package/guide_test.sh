#!/bin/bash
# What a new user does, from the guide alone: docs/guide/first_scene.md in a clean directory, its three programs built against an
# installed library that only pkg-config, CMake and pip know of. Python's package is installed by pip into an environment of its own.
#
# usage: guide_test.sh BUILD_DIRECTORY LIBDIR SOURCE_DIRECTORY PYTHON     with CMAKE in the environment
set -u
build=$1 libdir=$2 source=$3 python=$4
command -v pkg-config >/dev/null || { echo "skipped: no pkg-config"; exit 77; }
"$python" -c "import venv, ensurepip, cffi, matplotlib" || { echo "skipped: no venv, pip, cffi or matplotlib"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

"$CMAKE" --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake --install"; }
cp -r "$source/bindings/python" "$work/package" # pip builds in the tree
mkdir "$work/home"
# Nothing of this shell's environment helps to find it, and nothing of the build.
clean=(env -i "HOME=$work/home" "OMP_WAIT_POLICY=passive" "PATH=$work/venv/bin:$(dirname "$CMAKE"):/usr/local/bin:/usr/bin:/bin"
    "PKG_CONFIG_PATH=$work/prefix/$libdir/pkgconfig")
cd "$work/home" || exit 1
"$python" -m venv --system-site-packages "$work/venv" || fail "venv"
"${clean[@]}" "$work/venv/bin/python" -m pip install --no-index --disable-pip-version-check "$work/package" \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "pip install"; }
"${clean[@]}" "$work/venv/bin/python" "$source/tests/docs/run_blocks.py" "$source/docs/guide/first_scene.md" \
    --prefix "$work/prefix" --python "$work/venv/bin/python" || fail "docs/guide/first_scene.md"
