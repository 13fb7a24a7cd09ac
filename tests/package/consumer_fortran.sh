# For the tests of the package, beside consumer.sh: the same for the Fortran module.
# Needs what consumer.sh needs, and FC, consumer_fortran (its directory).

# use_fortran_pkg_config PREFIX LIBDIR: with the shared library, and with nothing shared of ours.
use_fortran_pkg_config() {
    local lib=$1/$2 flags
    export PKG_CONFIG_PATH=$lib/pkgconfig
    flags=$(pkg-config --cflags --libs granperi-fortran) || fail "pkg-config granperi-fortran"
    # shellcheck disable=SC2086
    (cd "$work" && "$FC" -Wall -Wextra -Werror "$consumer_fortran/main.f90" -o pc_fortran $flags) ||
        fail "pkg-config, Fortran: $flags"
    LD_LIBRARY_PATH=$lib expect_run "pkg-config, Fortran" "$work/pc_fortran"
    flags=$(pkg-config --static --cflags --libs granperi-fortran | sed 's/-lgranperi\b/-l:libgranperi.a/')
    # shellcheck disable=SC2086
    (cd "$work" && "$FC" "$consumer_fortran/main.f90" -o pc_fortran_static $flags) ||
        fail "pkg-config, Fortran, static: $flags"
    ours "$work/pc_fortran_static" | grep -q granperi && fail "pc_fortran_static loads libgranperi.so"
    expect_run "pkg-config, Fortran, static" "$work/pc_fortran_static"
}

# configure PROJECT PREFIX: as a stranger would.
configure() {
    rm -rf "$work/cmake_fortran"
    FC="$FC" "$CMAKE" -S "$1" -B "$work/cmake_fortran" -DCMAKE_PREFIX_PATH="$2" \
        -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF >"$work/cmake.log" 2>&1
}

use_fortran_cmake() {
    configure "$consumer_fortran" "$1" || { cat "$work/cmake.log"; fail "find_package, Fortran"; }
    grep -q 'Warning' "$work/cmake.log" && { cat "$work/cmake.log"; fail "find_package, Fortran, warns"; }
    "$CMAKE" --build "$work/cmake_fortran" >"$work/cmake.log" 2>&1 ||
        { tail -n 30 "$work/cmake.log"; fail "a build with find_package, Fortran"; }
    expect_run "find_package, Fortran" "$work/cmake_fortran/program"
}

# expect_refusal PREFIX TEXT LANGUAGE [COMPONENT]: find_package fails, and its message holds the text.
expect_refusal() {
    mkdir -p "$work/refused"
    cat >"$work/refused/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.20)
project(refused LANGUAGES $3)
find_package(granperi 0.2 REQUIRED COMPONENTS ${4:-fortran})
END
    configure "$work/refused" "$1" && fail "find_package ought to have refused: $2"
    # CMake breaks lines of its messages.
    tr -s '[:space:]' ' ' <"$work/cmake.log" | grep -qF -- "$2" || { cat "$work/cmake.log"; fail "no message: $2"; }
    echo "find_package refuses: $2"
}
