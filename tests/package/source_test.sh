#!/bin/bash
# The sources as a part of another project: by FetchContent, and by add_subdirectory with a copy of them elsewhere; programs in C
# (shared, static) and Fortran. The two builds, in different directories from different directories, give the same bits.
#
# usage: source_test.sh SOURCE_DIRECTORY FEATURES [FC]    with CMAKE, CC, CXX, GENERATOR and perhaps OPTIONS in the environment
set -u
source_directory=$1 features=$2 FC=${3:-}
consumers=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/package/consumer.sh
. "$(dirname "$0")/consumer.sh"

# build HOW SOURCE_DIRECTORY BUILD_DIRECTORY [options]
build() {
    # shellcheck disable=SC2086
    "$CMAKE" -S "$consumers/source" -B "$3" -G "$GENERATOR" -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" \
        ${FC:+-DCMAKE_Fortran_COMPILER="$FC" -DWITH_FORTRAN=ON} -DGRANPERI_SOURCE="$2" -DCONSUMERS="$consumers" \
        ${OPTIONS:-} "${@:4}" >"$work/log" 2>&1 || { cat "$work/log"; fail "$1: configuring"; }
    "$CMAKE" --build "$3" -j2 >"$work/log" 2>&1 || { tail -n 30 "$work/log"; fail "$1: building"; }
    grep -i 'warning:' "$work/log" && fail "$1 warns"
    for program in shared static ${FC:+fortran}; do
        expect_run "$1, $program" "$3/$program"
    done
    ours "$3/static" | grep -q granperi && fail "the target granperi::granperi_static is the shared library"
    return 0
}

build FetchContent "$source_directory" "$work/one" -DFETCH=ON
mkdir -p "$work/the sources/of another"
tar -C "$source_directory" -c --exclude='./build*' --exclude=./.git --exclude=./results . | tar -x -C "$work/the sources/of another"
build add_subdirectory "$work/the sources/of another" "$work/another/two"

# Not of the Fortran module: gfortran puts the path of the source into its run-time messages, whatever -ffile-prefix-map says.
compared=0
while IFS= read -r library; do
    other=$work/another/two/granperi/${library#"$work/one/_deps/granperi-build/"}
    cmp "$library" "$other" || fail "other bits in another directory: ${library##*/}"
    compared=$((compared + 1))
done < <(find "$work/one/_deps/granperi-build" -type f \( -name libgranperi.a -o -name 'libgranperi.so.*' \))
((compared == 2)) || fail "only $compared libraries found"
echo "$compared libraries with the same bits from two directories"
echo "passed"
