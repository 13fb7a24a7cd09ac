# For the tests of the package: builds consumer/main.c against an installed library in each way there is, and runs it.
# Needs: CMAKE, CC, consumer (its directory), work (a directory for what is built).

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

# ours PROGRAM: which of the libraries in question it loads, one a line.
ours() {
    ldd "$1" | grep -oE '^[[:space:]]*lib(granperi|hdf5|gomp|omp|stdc\+\+)[^ ]*' | tr -d '[:space:]' || true
}

# expect_run HOW PROGRAM: it runs and knows its features ($features, e.g. "hdf5=1 openmp=1").
expect_run() {
    local said
    said=$("$2" "$work") || fail "$1: the program returned $?"
    echo "$1: $said"
    case $said in
    *" $features: "*) ;;
    *) fail "$1: expected $features" ;;
    esac
}

# use_pkg_config PREFIX LIBDIR: shared, and static.
use_pkg_config() {
    local prefix=$1 lib=$1/$2 flags
    export PKG_CONFIG_PATH=$lib/pkgconfig
    [ "$(pkg-config --modversion granperi)" = "$(sed -n 's/^Version: //p' "$lib/pkgconfig/granperi.pc")" ] ||
        fail "pkg-config finds another granperi"
    # From pkg-config's words alone; they may hold no path but those of this prefix.
    flags=$(pkg-config --cflags --libs granperi)
    case $flags in *hdf5* | *stdc++* | *fopenmp*) fail "a shared link names private libraries: $flags" ;; esac
    # shellcheck disable=SC2086
    $CC -std=c99 -Wall -Wextra -Werror "$consumer/main.c" -o "$work/pc_shared" $flags ||
        fail "pkg-config, shared: $flags"
    LD_LIBRARY_PATH=$lib ldd "$work/pc_shared" | grep -q "libgranperi.so.0 => .*$2/" ||
        fail "pc_shared loads another library"
    LD_LIBRARY_PATH=$lib expect_run "pkg-config, shared" "$work/pc_shared"

    # Of the two libraries beside each other the linker would take the shared one.
    flags=$(pkg-config --static --cflags --libs granperi | sed 's/-lgranperi\b/-l:libgranperi.a/')
    # shellcheck disable=SC2086
    $CC -std=c99 -Wall -Wextra -Werror "$consumer/main.c" -o "$work/pc_static" $flags ||
        fail "pkg-config, static: $flags"
    ours "$work/pc_static" | grep -q granperi && fail "pc_static loads libgranperi.so"
    expect_run "pkg-config, static" "$work/pc_static"
}

# use_cmake PREFIX: both targets from a project in C.
use_cmake() {
    rm -rf "$work/cmake"
    # Without -DCMAKE_CXX_COMPILER and flags of any kind: as a stranger would. The cache of packages is of no use to us.
    "$CMAKE" -S "$consumer" -B "$work/cmake" -DCMAKE_C_COMPILER="$CC" -DCMAKE_PREFIX_PATH="$1" \
        -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF >"$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; fail "find_package"; }
    grep -q 'Warning' "$work/cmake.log" && { cat "$work/cmake.log"; fail "find_package warns"; }
    grep "^granperi_DIR:PATH=$1/" "$work/cmake/CMakeCache.txt" >/dev/null || fail "find_package finds another granperi"
    "$CMAKE" --build "$work/cmake" >"$work/cmake.log" 2>&1 ||
        { tail -n 30 "$work/cmake.log"; fail "a build with find_package"; }
    expect_run "find_package, shared" "$work/cmake/shared"
    expect_run "find_package, static" "$work/cmake/static"
    ours "$work/cmake/shared" | grep -q granperi || fail "the target granperi::granperi is not the shared library"
    ours "$work/cmake/static" | grep -q granperi && fail "the target granperi::granperi_static is the shared library"
    return 0
}
