"""Long work: progress, interruption, the interpreter's lock."""
import _thread
import signal
import sys
import threading

import pytest
import sparselens


def stages_of(call):
    said = []
    result = call(lambda stage, percent: said.append((stage, percent)))
    return result, said


@pytest.mark.parametrize("stage", ["warping", "clustering", "gathering", "planning"])
def test_progress(views, clustered, stage):
    ldi = sparselens.open_ldi(clustered)
    call = {"warping": lambda p: sparselens.warp(views, progress=p),
            "clustering": lambda p: sparselens.cluster(ldi, progress=p),
            "gathering": lambda p: sparselens.gather(ldi, progress=p),
            "planning": lambda p: sparselens.plan(views[0], progress=p)}[stage]
    _, said = stages_of(call)
    assert {name for name, _ in said} == {stage}
    percents = [percent for _, percent in said]
    assert percents == sorted(set(percents)) and percents[0] == 0 and percents[-1] == 100


def test_progress_is_called_here(clustered):
    threads = set()
    sparselens.gather(sparselens.open_ldi(clustered), progress=lambda *_: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_exception_in_progress_ends_the_work(clustered):
    said = []

    def stop(stage, percent):
        said.append(percent)
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        sparselens.gather(sparselens.open_ldi(clustered), progress=stop)
    assert said == [0]


@pytest.fixture
def one_thread():
    """Two threads begin both tiles of the picture at once, so that progress is at 100 before any is made."""
    sparselens.set_limits(threads=1)
    yield
    sparselens.set_limits(threads=0)


@pytest.fixture
def ctrl_c():
    """Sets Python's own Ctrl-C handler, which is missing if SIGINT is ignored, as in background jobs of a shell."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.filterwarnings("ignore:the aperture is larger")
def test_interrupt_ends_the_work(views, one_thread, ctrl_c):
    """Acts like Ctrl-C after the work has begun; the thread waits for that, not for a time."""
    ldi, said, begun = sparselens.warp(views), [], threading.Event()

    def tell(_, percent):
        said.append(percent)
        begun.set()

    other = threading.Thread(target=lambda: begun.wait() and _thread.interrupt_main())
    other.start()
    with pytest.raises(KeyboardInterrupt):
        sparselens.gather(ldi, lens_samples=1 << 16, lens_radius=2, focus_distance=1, progress=tell)
    other.join()
    assert said[-1] < 100
    sparselens.gather(ldi)  # nothing is broken


@pytest.fixture
def lock_kept():
    """The interpreter never takes its lock away: another thread runs only if the holder releases it."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    yield
    sys.setswitchinterval(interval)


def test_others_run_meanwhile(clustered, one_thread, lock_kept):
    """During gather, not only at its begin or end."""
    ldi, said, seen, started, done = sparselens.open_ldi(clustered), [], [], threading.Event(), threading.Event()

    def tick():
        started.set()
        while not done.wait(0.001):
            seen.append(said[-1] if said else None)

    other = threading.Thread(target=tick)
    other.start()
    started.wait()
    # Repeated if the machine was too busy to run the other thread in time. If the lock were kept, it would never run.
    for _ in range(20):
        said.clear()
        sparselens.gather(ldi, lens_samples=512, progress=lambda _, percent: said.append(percent))
        if meanwhile := any(percent is not None and percent < 100 for percent in seen):
            break
    done.set()
    other.join()
    assert meanwhile


def test_gathers_at_once(clustered):
    """Several threads may gather one LDI."""
    ldi = sparselens.open_ldi(clustered)
    alone, found = sparselens.gather(ldi, focus_distance=2.5), []
    threads = [threading.Thread(target=lambda: found.append(sparselens.gather(ldi, focus_distance=2.5)))
               for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3 and all((picture.planes == alone.planes).all() for picture in found)


def test_set_limits(clustered):
    ldi = sparselens.open_ldi(clustered)
    usual = sparselens.gather(ldi)
    sparselens.set_limits(threads=1)
    assert (sparselens.gather(ldi).planes == usual.planes).all()
    sparselens.set_limits(threads=0, max_memory=1000)
    with pytest.raises(sparselens.Error, match="max_memory"):
        sparselens.open_ldi(clustered)
    sparselens.set_limits(max_memory=0)
    sparselens.open_ldi(clustered)
