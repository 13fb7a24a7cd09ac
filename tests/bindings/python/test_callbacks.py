"""Callbacks, Ctrl-C, the GIL, threads."""
import os
import signal
import threading
import time
import traceback

import pytest
from conftest import needs_openmp

import granperi


def test_called_after_every_nth_step(sim):
    steps = []
    sim.set_callback(lambda it: steps.append(it.state.step), every=3)
    sim.step(10)
    assert steps == [3, 6, 9]
    sim.step(2)
    assert steps[-1] == 12
    sim.set_callback(None)
    sim.step(10)
    assert steps[-1] == 12


def test_it_gets_the_simulation_itself(sim):
    seen = []
    sim.set_callback(seen.append)
    sim.step()
    assert seen == [sim] and seen[0] is sim


def test_a_true_value_stops_the_run(sim):
    sim.set_callback(lambda it: it.state.step == 4)
    assert sim.run(1.0) is False and sim.state.step == 4
    assert sim.step(2) is True


def test_an_exception_comes_out_as_it_was_raised(sim):
    error = KeyError("mine")

    def inner():
        raise error

    def look(it):
        inner()

    sim.set_callback(look, every=5)
    with pytest.raises(KeyError) as caught:
        sim.run(10)
    assert caught.value is error and error.__context__ is None and error.__cause__ is None
    assert [frame.name for frame in traceback.extract_tb(error.__traceback__)][-2:] == ["look", "inner"]
    assert sim.state.step == 5
    sim.set_callback(None)
    assert sim.step(3) and sim.state.step == 8


def test_also_what_is_no_error(sim):
    def leave(it):
        raise SystemExit(3)

    sim.set_callback(leave)
    with pytest.raises(SystemExit, match="3"):
        sim.step()


def test_what_may_be_called_inside(sim):
    refused = []

    def look(it):
        it.set_plate_velocity(0, 0.1, 0)
        it.set_gravity(1, -9)
        assert it.plate_load(0).fy <= 0 and len(it.surface([0])) == 1 and len(it.x) == 50
        for call in (it.step, lambda: it.run(1), lambda: it.add_material(), it.close, lambda: it.set_callback(None)):
            try:
                call()
            except granperi.StateError as error:
                refused.append(str(error))

    sim.set_callback(look)
    sim.step()
    assert len(refused) == 5 and not sim.closed
    assert (sim.state.gravity_x, sim.state.gravity_y) == (1, -9)


def test_wrong_callbacks(sim):
    for callback, every in ((5, 1), (print, 0), (print, -1), (print, 1.5)):
        with pytest.raises(granperi.ArgumentError):
            sim.set_callback(callback, every)


def interrupt_in(seconds, process=True):
    """SIGINT to the process, from another thread, while the main one is in the library."""
    timer = threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT) if process
                            else signal.raise_signal(signal.SIGINT))
    timer.start()
    return timer


def test_ctrl_c_stops_after_the_present_step(sim):
    timer = interrupt_in(0.2)
    with pytest.raises(KeyboardInterrupt):
        sim.run(1e6)
    timer.join()
    state = sim.state
    assert 0 < state.time < 1e6 and state.step > 0
    assert sim.step(5) and sim.state.step == state.step + 5


def test_ctrl_c_waits_for_one_step_only(make_block):
    """A callback raises the signal itself: no further step may be taken, whatever the clock says."""
    with make_block() as sim:
        def press(it):
            if it.state.step == 7:
                signal.raise_signal(signal.SIGINT)

        sim.set_callback(press)
        with pytest.raises(KeyboardInterrupt):
            sim.run(1e6)
        assert sim.state.step == 7


def test_ctrl_c_in_a_run_without_callback_stops_after_the_step_it_comes_in():
    """The flag of the signal's handler alone, without the look at the clock that handles other signals."""
    with granperi.Simulation(spacing=0.002, threads=1) as sim:
        sim.add_column(width=0.2, height=0.1)  # 5000 particles: a step takes milliseconds, the signal does not
        sim.add_plate(granperi.Plate.floor(-1, 1))
        sim.step()
        pressed = []

        def press():
            while sim._engine.watch.step < 5:
                time.sleep(0.001)
            os.kill(os.getpid(), signal.SIGINT)
            pressed.append(sim._engine.watch.step)  # of steps that are complete, while the signal is on its way

        thread = threading.Thread(target=press)
        thread.start()
        with pytest.raises(KeyboardInterrupt):
            sim.step(10**6)
        thread.join()
        assert 5 <= pressed[0] <= sim.state.step <= pressed[0] + 2


def test_another_handler_of_the_signal(sim):
    seen = []
    before = signal.signal(signal.SIGINT, lambda number, frame: seen.append(number))
    try:
        timer = interrupt_in(0.05)
        begin = time.monotonic()
        sim.set_callback(lambda it: time.monotonic() > begin + 0.5)
        assert sim.run(1e6) is False  # the handler has not raised: the run goes on to its own end
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [signal.SIGINT]


def test_the_handler_of_the_signal_is_the_same_after_a_run(sim):
    before = signal.getsignal(signal.SIGINT)
    sim.step(3)
    assert signal.getsignal(signal.SIGINT) is before
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
        time.sleep(1)


def test_other_signals_are_handled_during_a_run(sim):
    class Alarm(Exception):
        pass

    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(Alarm):
            sim.run(1e6)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_steps_run_without_the_gil(sim):
    """Another thread counts while the main one is in a single call of the library."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    sim.step(3000)  # some 50 ms; in 300, faster than they were, the other thread had 67 turns
    progress = counted[0] - before
    stop.set()
    thread.join()
    # With the GIL held, the other thread would get a turn at the call's beginning and end only.
    assert progress > 100


def test_a_second_thread_is_refused_while_a_run_is_on(sim):
    begun, refused = threading.Event(), []
    end = [False]

    def look(it):
        begun.set()
        return end[0]

    def other():
        begun.wait()
        for use in (lambda: sim.x, sim.step, sim.close, lambda: sim.state):
            try:
                use()
            except granperi.StateError as error:
                refused.append("in use by another thread" in str(error))
        end[0] = True

    sim.set_callback(look)
    thread = threading.Thread(target=other)
    thread.start()
    assert sim.run(1e6) is False
    thread.join()
    assert refused == [True] * 4 and not sim.closed


def test_distinct_simulations_in_distinct_threads(make_block):
    def work(results, k):
        with make_block() as sim:
            sim.set_callback(lambda it: None, every=7)
            sim.step(200)
            results[k] = sim.x.tobytes()

    results = {}
    threads = [threading.Thread(target=work, args=(results, k)) for k in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert len(set(results.values())) == 1 and len(results) == 4


def test_an_exception_in_another_thread_stays_there(make_block):
    caught = []

    def work():
        with make_block() as sim:
            def look(it):
                raise ValueError("there")

            sim.set_callback(look)
            try:
                sim.step()
            except ValueError as error:
                caught.append(str(error))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert caught == ["there"]


@needs_openmp
def test_results_do_not_depend_on_threads(make_block):
    states = []
    for threads in (1, 2):
        with make_block(threads=threads) as sim:
            sim.step(50)
            states.append(sim.x.tobytes())
    assert states[0] == states[1]


def test_errors_are_of_the_thread(sim):
    """Two threads fail at once; each gets the text of its own call."""
    wrong = []

    def fail(value):
        for _ in range(300):
            try:
                granperi.Simulation(spacing=value)
            except granperi.ArgumentError as error:
                if f"= {value:g}:" not in str(error):
                    wrong.append(str(error))

    threads = [threading.Thread(target=fail, args=(-1.0 - k,)) for k in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert not wrong
