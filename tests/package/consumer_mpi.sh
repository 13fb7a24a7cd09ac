# For the tests of the package: the library for several processes, by pkg-config and as the component mpi, shared and static, on
# one process and on two. Needs what consumer.sh needs.

# on_two PROGRAM [ARGUMENTS]: more processes than cores give them away, and root may.
on_two() {
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1 \
        mpiexec -n 2 "$@"
}

# use_mpi PREFIX LIBDIR
use_mpi() {
    local prefix=$1 lib=$1/$2 flags
    for file in "$lib/libgranperi-mpi.so" "$lib/libgranperi-mpi.so.0" "$lib/libgranperi-mpi.a" "$prefix/bin/granperi-mpi" \
        "$lib/pkgconfig/granperi-mpi.pc" "$prefix/include/granperi/gp_mpi.h"; do
        [ -e "$file" ] || fail "$file is not installed"
    done
    flags=$(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --cflags --libs granperi-mpi)
    # shellcheck disable=SC2086
    $CC -std=c99 -Wall -Wextra -Werror "$consumer/../consumer_mpi/main.c" -o "$work/pc_mpi" $flags || fail "pkg-config, mpi: $flags"
    LD_LIBRARY_PATH=$lib "$work/pc_mpi" || fail "pkg-config, mpi: the program returned $?"
    LD_LIBRARY_PATH=$lib on_two "$work/pc_mpi" || fail "pkg-config, mpi: on two processes the program returned $?"
    LD_LIBRARY_PATH=$lib ldd "$work/pc_mpi" | grep -qE 'libgranperi\.so' && fail "pc_mpi loads the library for one process, too"
    flags=$(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --static --cflags --libs granperi-mpi | sed 's/-lgranperi-mpi\b/-l:libgranperi-mpi.a/')
    # shellcheck disable=SC2086
    $CC -std=c99 -Wall -Wextra -Werror "$consumer/../consumer_mpi/main.c" -o "$work/pc_mpi_static" $flags ||
        fail "pkg-config, mpi, static: $flags"
    ours "$work/pc_mpi_static" | grep -q granperi && fail "pc_mpi_static loads libgranperi-mpi.so"
    on_two "$work/pc_mpi_static" || fail "pkg-config, mpi, static: the program returned $?"
    LD_LIBRARY_PATH=$lib "$prefix/bin/granperi-mpi" --help | grep -q 'usage: mpirun' || fail "granperi-mpi --help"
    mkdir -p "$work/cmake_mpi"
    cat >"$work/cmake_mpi/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.18)
project(consumer C)
find_package(granperi REQUIRED COMPONENTS mpi)
add_executable(main "$consumer/../consumer_mpi/main.c")
target_link_libraries(main granperi::granperi_mpi)
add_executable(static "$consumer/../consumer_mpi/main.c")
target_link_libraries(static granperi::granperi_mpi_static)
END
    "$CMAKE" -S "$work/cmake_mpi" -B "$work/cmake_mpi/build" "-DCMAKE_PREFIX_PATH=$prefix" >"$work/mpi.log" 2>&1 &&
        "$CMAKE" --build "$work/cmake_mpi/build" >>"$work/mpi.log" 2>&1 || { cat "$work/mpi.log"; fail "the component mpi"; }
    "$work/cmake_mpi/build/main" || fail "the component mpi: the program returned $?"
    "$work/cmake_mpi/build/static" || fail "the component mpi, static: the program returned $?"
    rm -rf "$work/cmake_mpi"
    echo "several processes: by pkg-config and as a component, shared and static"
}
