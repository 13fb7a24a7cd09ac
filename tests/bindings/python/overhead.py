#!/usr/bin/python3
"""What a step costs more from Python than from C, in CPU time of this thread.

    PYTHONPATH=<build>/python tests/bindings/python/overhead.py

Blocks of sim.step(1) and of the same number of steps in a single sim.step(n), one after the other, on an empty scene, where
the library does next to nothing. What is printed is the median difference of such pairs. No test: it asserts nothing.
"""
import statistics
import time

import granperi

STEPS, PAIRS = 20_000, 31


def cpu(call) -> float:
    begin = time.thread_time()
    call()
    return time.thread_time() - begin


def measure(sim, one_by_one) -> tuple[float, float, float]:
    """Median, and the middle half, of the differences in microseconds per step."""
    differences = [1e6 * (cpu(one_by_one) - cpu(lambda: sim.step(STEPS))) / STEPS for _ in range(PAIRS)]
    low, middle, high = statistics.quantiles(differences, n=4)
    return middle, low, high


def main() -> None:
    with granperi.Simulation(threads=1) as sim:
        sim.step()

        def steps():
            step = sim.step
            for _ in range(STEPS):
                step(1)

        print("sim.step(1) instead of a step in C:  %.2f us (middle half %.2f to %.2f)" % measure(sim, steps))
        sim.set_callback(lambda it: None)
        called = statistics.median(1e6 * cpu(lambda: sim.step(STEPS)) / STEPS for _ in range(PAIRS))
        sim.set_callback(None)
        plain = statistics.median(1e6 * cpu(lambda: sim.step(STEPS)) / STEPS for _ in range(PAIRS))
        print("a callback after every step:         %.2f us" % (called - plain))
        print("a step of the empty scene by itself: %.2f us, with the look at the clock and at Ctrl-C" % plain)


if __name__ == "__main__":
    main()
