"""The thread for work of which only the newest request matters."""

import importlib.util
import time
from pathlib import Path
from threading import Event

import pytest

PATH = Path(__file__).parents[2] / "blender_addon/skinglow_blender/live/newest_wins.py"


@pytest.fixture
def worker():
    spec = importlib.util.spec_from_file_location("newest_wins", PATH)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    made = module.NewestWins("test")
    yield made
    made.stop(10.0)


def taken(worker, count, seconds=10.0):
    """So many answers, in their order."""
    answers, end = [], time.monotonic() + seconds
    while len(answers) < count:
        answers += worker.take()
        assert time.monotonic() < end, answers
        time.sleep(0.001)
    return answers


class Steps:
    """A task that gives numbered answers, each when it is let."""

    def __init__(self, name, count=2):
        self.name, self.count = name, count
        self.begun, self.let, self.ended = Event(), [Event() for _ in range(count)], Event()

    def __call__(self, progress):
        try:
            for i, let in enumerate(self.let):
                self.begun.set()
                while not let.wait(0.002):
                    if not progress(i / self.count):
                        raise RuntimeError("stopped")
                yield f"{self.name}{i}"
        finally:
            self.ended.set()

    def open(self):
        for let in self.let:
            let.set()
        return self


def test_answers_come_in_their_order_and_then_there_is_nothing_to_do(worker):
    worker.submit("ear", Steps("a", 3).open())
    assert taken(worker, 3) == [("ear", "a0"), ("ear", "a1"), ("ear", "a2")]
    while worker.is_busy:
        time.sleep(0.001)
    assert worker.progress("ear") is None


def test_a_replaced_task_gives_its_first_answer_and_ends(worker):
    old, new = Steps("old", 3), Steps("new", 1).open()
    worker.submit("ear", old)
    old.begun.wait(10.0)
    worker.submit("ear", new)
    worker.submit("ear", new)
    old.let[0].set()
    assert taken(worker, 2) == [("ear", "old0"), ("ear", "new0")]
    assert old.ended.wait(10.0)


def test_a_replaced_task_that_has_answered_is_stopped_in_the_middle(worker):
    old = Steps("old", 2)
    old.let[0].set()
    worker.submit("ear", old)
    assert taken(worker, 1) == [("ear", "old0")]
    worker.submit("ear", Steps("new", 1).open())
    assert taken(worker, 1) == [("ear", "new0")]
    assert old.ended.is_set()


def test_an_abandoned_task_gives_nothing(worker):
    old = Steps("old", 1)
    worker.submit("ear", old)
    old.begun.wait(10.0)
    worker.submit("ear", Steps("new", 1).open(), abandon=True)
    assert taken(worker, 1) == [("ear", "new0")]


def test_each_key_has_a_first_answer_before_any_has_its_second(worker):
    gate = Steps("gate", 1)
    worker.submit("gate", gate)
    gate.begun.wait(10.0)
    worker.submit("ear", Steps("a").open())
    worker.submit("nose", Steps("b").open())
    gate.let[0].set()
    assert [answer for _key, answer in taken(worker, 5)] == ["gate0", "a0", "b0", "a1", "b1"]


def test_a_task_waits_for_its_time_and_a_newer_one_takes_its_place(worker):
    worker.submit("ear", Steps("late", 1).open(), delay=1000.0)
    worker.submit("nose", Steps("b", 1).open())
    assert taken(worker, 1) == [("nose", "b0")]
    assert worker.progress("ear") == 0.0
    worker.submit("ear", Steps("early", 1).open())
    assert taken(worker, 1) == [("ear", "early0")]


def test_an_exception_is_the_last_answer(worker):
    def fails(_progress):
        yield 1
        raise ValueError("no flesh")

    worker.submit("ear", fails)
    (_, first), (_, second) = taken(worker, 2)
    assert first == 1 and str(second) == "no flesh"


def test_what_is_dropped_gives_nothing(worker):
    old, other = Steps("old", 1), Steps("other", 1)
    worker.submit("ear", old)
    old.begun.wait(10.0)
    worker.submit("nose", other.open())
    worker.drop(lambda key: key == "ear")
    assert taken(worker, 1) == [("nose", "other0")]
    assert old.ended.is_set() and not worker.is_busy


def test_stopping_ends_the_thread_and_it_can_begin_again(worker):
    old = Steps("old", 1)
    worker.submit("ear", old)
    old.begun.wait(10.0)
    worker.stop(10.0)
    assert old.ended.is_set() and not worker.is_busy
    worker.submit("ear", Steps("new", 1).open())
    assert taken(worker, 1) == [("ear", "new0")]
