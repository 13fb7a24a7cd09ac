#!/bin/bash
# The installed package: cmake --install to a fresh prefix, then a C program outside the tree through pkg-config and
# through find_package, shared and static; and all of that once more after the prefix has been moved.
#
# usage: install_test.sh BUILD_DIRECTORY LIBDIR FEATURES [FC]    with CMAKE and CC in the environment
#   LIBDIR    the build's CMAKE_INSTALL_LIBDIR, e.g. lib
#   FEATURES  e.g. "hdf5=1 openmp=1"
#   FC        the Fortran compiler, if the build has the Fortran module
set -u
build=$1 libdir=$2 features=$3 FC=${4:-}
consumer=$(cd "$(dirname "$0")/consumer" && pwd)
# shellcheck disable=SC2034
consumer_fortran=$(cd "$(dirname "$0")/consumer_fortran" && pwd)
command -v pkg-config >/dev/null || { echo "skipped: no pkg-config"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/package/consumer.sh
. "$(dirname "$0")/consumer.sh"
# shellcheck source=tests/package/consumer_fortran.sh
. "$(dirname "$0")/consumer_fortran.sh"
# shellcheck source=tests/package/consumer_mpi.sh
. "$(dirname "$0")/consumer_mpi.sh"

prefix=$work/first
"$CMAKE" --install "$build" --prefix "$prefix" >"$work/install.log" 2>&1 ||
    { cat "$work/install.log"; fail "cmake --install"; }
for file in include/granperi/gp.h "$libdir/libgranperi.so" "$libdir/libgranperi.so.0" "$libdir/libgranperi.a" \
    "$libdir/pkgconfig/granperi.pc" "$libdir/cmake/granperi/granperi-config.cmake"; do
    [ -e "$prefix/$file" ] || fail "$file is not installed"
done
several= # processes, if the build has them
grep -q '^GRANPERI_MPI:BOOL=ON' "$build/CMakeCache.txt" && several=yes
extra=$(find "$prefix" -name '*.h*' ! -path "$prefix/include/granperi/gp.h" \
    ! -path "$prefix/include/granperi/${several:+gp_mpi.h}")
[ -z "$extra" ] || fail "a header that is not public is installed: $extra"

# Nothing may know where it was built or installed.
source=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
for path in "$(cd "$build" && pwd)" "$source" "$prefix"; do
    found=$(grep -rlF -- "$path" "$prefix/$libdir/pkgconfig" "$prefix/$libdir/cmake" "$prefix/include")
    [ -z "$found" ] || fail "$path is written in $found"
    readelf -d "$prefix/$libdir/libgranperi.so" | grep -F -- "$path" && fail "the library has a run path into $path"
done

use_pkg_config "$prefix" "$libdir"
use_cmake "$prefix"
if [ -n "$FC" ]; then
    for file in "$libdir/libgranperi_fortran.a" "$libdir/pkgconfig/granperi-fortran.pc" "$libdir/granperi/fortran/granperi.mod"; do
        [ -e "$prefix/$file" ] || fail "$file is not installed"
    done
    use_fortran_pkg_config "$prefix" "$libdir"
    use_fortran_cmake "$prefix"
    expect_refusal "$prefix" "the component fortran needs a project with LANGUAGES Fortran" C
    expect_refusal "$prefix" "it has no component cobol: there are fortran and mpi" Fortran cobol
fi

moved="$work/somewhere else/deeper" # and with a blank in its name
mkdir -p "$(dirname "$moved")"
mv "$prefix" "$moved"
use_cmake "$moved"
[ -z "$FC" ] || use_fortran_cmake "$moved"
mv "$moved" "$work/second"
[ -z "$several" ] || use_mpi "$work/second" "$libdir"
use_pkg_config "$work/second" "$libdir"
[ -z "$FC" ] || use_fortran_pkg_config "$work/second" "$libdir"
echo "passed"
