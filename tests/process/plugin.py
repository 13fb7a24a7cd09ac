"""Loads the library with ctypes, uses it with two threads, and closes it, again and again.

usage: plugin.py LIBRARY ROUNDS
"""
import _ctypes
import ctypes
import os
import sys

path, rounds = sys.argv[1], int(sys.argv[2])
threads = []
for k in range(rounds):
    library = ctypes.CDLL(path, mode=ctypes.RTLD_GLOBAL if k % 2 else ctypes.RTLD_LOCAL)
    config = (ctypes.c_uint64 * 100)()
    column = (ctypes.c_double * 100)()
    sim = ctypes.c_void_p()
    config_size = 232
    assert library.gp_config_init(config, ctypes.c_size_t(config_size), 0) == 0
    ctypes.c_int32.from_buffer(config, 168).value = 2  # threads: tests/abi/layout.txt
    assert library.gp_create(config, ctypes.byref(sim)) == 0
    assert library.gp_column_init(column, ctypes.c_size_t(72)) == 0
    column[3], column[4] = 0.2, 0.15
    assert library.gp_add_column(sim, column, None) == 0
    assert library.gp_step(sim, ctypes.c_int64(2)) == 0
    library.gp_destroy(sim)
    _ctypes.dlclose(library._handle)
    threads.append(len(os.listdir("/proc/self/task")))
print("%d times loaded, used with 2 threads, closed: %d threads" % (rounds, threads[-1]))
assert max(threads) == min(threads), threads
