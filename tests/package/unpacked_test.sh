#!/bin/bash
# Debian packages, unpacked beside the system: programs in C, for several processes and in Fortran are built against them, Python
# imports them.
#
# usage: unpacked_test.sh ROOT WORK    with CMAKE, CC and FC in the environment
set -u
prefix=$1/usr work=$2
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck disable=SC2034
consumer=$here/consumer consumer_fortran=$here/consumer_fortran features="hdf5=1 openmp=1"
# shellcheck source=tests/package/consumer.sh
. "$here/consumer.sh"
# shellcheck source=tests/package/consumer_fortran.sh
. "$here/consumer_fortran.sh"
# shellcheck source=tests/package/consumer_mpi.sh
. "$here/consumer_mpi.sh"
libdir=lib/$("$CC" -print-multiarch)

use_pkg_config "$prefix" "$libdir"
use_cmake "$prefix"
use_fortran_pkg_config "$prefix" "$libdir"
use_fortran_cmake "$prefix"
use_mpi "$prefix" "$libdir"
said=$(cd "$work" && LD_LIBRARY_PATH=$prefix/$libdir PYTHONPATH=$prefix/lib/python3/dist-packages /usr/bin/python3 -c "
import granperi
with granperi.Simulation(spacing=0.0025) as sim:
    sim.add_column(width=0.025, height=0.025)
    sim.add_plate(granperi.Plate.floor(-0.1, 0.1))
    sim.step(3)
    print(granperi.__file__, sim.state.step)") || fail "Python"
echo "Python: $said"
case $said in "$prefix"*" 3") ;; *) fail "Python imports another granperi" ;; esac
said=$(readelf -d "$prefix"/lib/python3/dist-packages/granperi/_granperi*.so) || fail "no extension"
grep -E 'RPATH|RUNPATH' <<<"$said" && fail "the extension has a run path"
echo "passed"
