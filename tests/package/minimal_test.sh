#!/bin/bash
# The library without HDF5, OpenMP and Fortran module: it configures and builds where neither is asked for, loads neither, says so, and
# works; installed into a directory of libraries of several levels, as Debian has it.
#
# usage: minimal_test.sh SOURCE_DIRECTORY    with CMAKE, CC, CXX and GENERATOR in the environment
set -u
source_directory=$1
features="hdf5=0 openmp=0"
libdir=lib/$("$CC" -print-multiarch 2>/dev/null) # the only levels that find_package looks through
libdir=${libdir%/}
consumer=$(cd "$(dirname "$0")/consumer" && pwd)
command -v pkg-config >/dev/null || { echo "skipped: no pkg-config"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/package/consumer.sh
. "$(dirname "$0")/consumer.sh"
# shellcheck source=tests/package/consumer_fortran.sh
. "$(dirname "$0")/consumer_fortran.sh"

# The packages cannot be found, so that the build cannot use them by mistake. The library's own code has no warnings.
"$CMAKE" -S "$source_directory" -B "$work/build" -G "$GENERATOR" -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" \
    -DCMAKE_BUILD_TYPE=Release -DGRANPERI_HDF5=OFF -DGRANPERI_OPENMP=OFF -DGRANPERI_BUILD_FORTRAN=OFF -DGRANPERI_BUILD_TESTS=OFF \
    -DGRANPERI_BUILD_EXAMPLES=OFF -DGRANPERI_LEVEL=one -DGRANPERI_WERROR=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON \
    -DCMAKE_INSTALL_LIBDIR="$libdir" >"$work/log" 2>&1 || { cat "$work/log"; fail "configuring"; }
"$CMAKE" --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; fail "building"; }
"$CMAKE" --install "$work/build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; fail "installing"; }

found=$(ours "$work/prefix/$libdir/libgranperi.so")
case $found in *hdf5* | *omp*) fail "libgranperi.so loads $found" ;; esac
readelf -dW "$work/prefix/$libdir/libgranperi.so" | grep -E 'NEEDED.*(hdf5|omp)' && fail "libgranperi.so needs them"
PKG_CONFIG_PATH=$work/prefix/$libdir/pkgconfig pkg-config --static --libs granperi |
    grep -E 'hdf5|omp' && fail "granperi.pc names them"
use_pkg_config "$work/prefix" "$libdir"
use_cmake "$work/prefix"
# Who asks for the Fortran module is told that it is not there.
PKG_CONFIG_PATH=$work/prefix/$libdir/pkgconfig pkg-config --libs granperi-fortran >"$work/log" 2>&1 &&
    fail "there is no Fortran module, but pkg-config finds it"
grep -q "granperi-fortran" "$work/log" || fail "pkg-config does not say what is missing"
FC=${FC:-gfortran}
if command -v "$FC" >/dev/null; then
    expect_refusal "$work/prefix" \
        "it was installed without its Fortran module: build granperi anew with -DGRANPERI_BUILD_FORTRAN=ON" Fortran
fi
for program in pc_shared pc_static cmake/shared cmake/static; do
    found=$(LD_LIBRARY_PATH=$work/prefix/$libdir ours "$work/$program")
    case $found in *hdf5* | *omp*) fail "$program loads $found" ;; esac
done
echo "passed"
