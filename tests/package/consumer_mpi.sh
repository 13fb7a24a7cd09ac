# For the tests of the package: the library for several processes, by pkg-config and as the component mpi. Needs what consumer.sh
# needs.

# use_mpi PREFIX LIBDIR
use_mpi() {
    local prefix=$1 lib=$1/$2 flags
    for file in "$lib/libgranperi-mpi.so" "$lib/libgranperi-mpi.so.0" "$prefix/bin/granperi-mpi" "$lib/pkgconfig/granperi-mpi.pc" \
        "$prefix/include/granperi/gp_mpi.h"; do
        [ -e "$file" ] || fail "$file is not installed"
    done
    flags=$(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --cflags --libs granperi-mpi)
    # shellcheck disable=SC2086
    $CC -std=c99 -Wall -Wextra -Werror "$consumer/../consumer_mpi/main.c" -o "$work/pc_mpi" $flags || fail "pkg-config, mpi: $flags"
    LD_LIBRARY_PATH=$lib "$work/pc_mpi" || fail "pkg-config, mpi: the program returned $?"
    mkdir -p "$work/cmake_mpi"
    cat >"$work/cmake_mpi/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.18)
project(consumer C)
find_package(granperi REQUIRED COMPONENTS mpi)
add_executable(main "$consumer/../consumer_mpi/main.c")
target_link_libraries(main granperi::granperi_mpi)
END
    "$CMAKE" -S "$work/cmake_mpi" -B "$work/cmake_mpi/build" "-DCMAKE_PREFIX_PATH=$prefix" >"$work/mpi.log" 2>&1 &&
        "$CMAKE" --build "$work/cmake_mpi/build" >>"$work/mpi.log" 2>&1 || { cat "$work/mpi.log"; fail "the component mpi"; }
    "$work/cmake_mpi/build/main" || fail "the component mpi: the program returned $?"
    rm -rf "$work/cmake_mpi"
    echo "several processes: by pkg-config and as a component"
}
