# SPDX-License-Identifier: GPL-3.0-or-later
"""A thread for work of which only the newest request matters: each key has one task at a time.

A task gives its answers one after the other, coarse ones first. One that is replaced goes on to its first answer, or
nothing would be seen while requests keep coming; then it ends. Tasks that gave fewer answers come first, so that each
key has a coarse answer before any has its last. Nothing here knows of Blender.
"""

import time
from collections.abc import Callable, Generator, Hashable, Iterator
from dataclasses import dataclass
from threading import Condition, Thread
from typing import Any

#: Asked by a task as it goes on, with the fraction that is done; returns whether to go on.
Progress = Callable[[float], bool]


@dataclass(eq=False)
class _Work:
    key: Hashable
    task: Callable[[Progress], Iterator[Any]]
    not_before: float  #: time.monotonic() at which it may begin
    answers: int = 0
    fraction: float = 0.0  #: of the answer that it works on
    replaced: bool = False  #: ends after its first answer
    canceled: bool = False  #: ends now
    steps: Iterator[Any] | None = None  #: the task as it runs

    def go_on(self, fraction: float) -> bool:
        self.fraction = fraction
        return not (self.canceled or (self.replaced and self.answers > 0))

    def end(self) -> None:
        """Frees what the task holds: it refers to itself by its progress."""
        if isinstance(self.steps, Generator):
            self.steps.close()
        self.steps = None


class NewestWins:
    """Starts its thread with the first request."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._changed = Condition()
        self._thread: Thread | None = None
        self._waiting: dict[Hashable, _Work] = {}
        self._running: _Work | None = None
        self._answers: list[tuple[Hashable, Any]] = []
        self._stopped = False

    def submit(
        self, key: Hashable, task: Callable[[Progress], Iterator[Any]], delay: float = 0.0, abandon: bool = False
    ) -> None:
        """Replaces the task of a key.

        task     called on the thread; an iterator of answers. An exception is its last answer
        delay    seconds before it begins
        abandon  whether the one before is of no use any more: it ends without an answer
        """
        with self._changed:
            self._waiting[key] = _Work(key, task, time.monotonic() + delay)
            running = self._running
            if running is not None and running.key == key:
                running.replaced = True
                running.canceled = running.canceled or abandon
            if abandon:
                self._answers = [answer for answer in self._answers if answer[0] != key]
            if self._thread is None:
                self._stopped = False
                self._thread = Thread(target=self._run, name=self._name, daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def drop(self, keys: Callable[[Hashable], bool] = lambda _key: True) -> None:
        """Ends the tasks of these keys; their answers are not given."""
        with self._changed:
            for key in [key for key in self._waiting if keys(key)]:
                del self._waiting[key]
            if self._running is not None and keys(self._running.key):
                self._running.canceled = True
            self._answers = [answer for answer in self._answers if not keys(answer[0])]
            self._changed.notify_all()

    def take(self) -> list[tuple[Hashable, Any]]:
        """The answers since the last call, oldest first, each with its key."""
        with self._changed:
            answers, self._answers = self._answers, []
            return answers

    @property
    def is_busy(self) -> bool:
        """Whether there is work, or answers to take."""
        with self._changed:
            return bool(self._waiting or self._running or self._answers)

    def progress(self, key: Hashable) -> float | None:
        """Fraction done of the answer that a key's task works on; None: it has none."""
        with self._changed:
            if self._running is not None and self._running.key == key:
                return self._running.fraction
            return 0.0 if key in self._waiting else None

    def stop(self, seconds: float) -> None:
        """Ends all tasks and the thread, and waits so long for it."""
        with self._changed:
            thread, self._thread = self._thread, None
            self._stopped = True
            self._changed.notify_all()
        self.drop()
        if thread is not None:
            thread.join(seconds)

    def _next(self) -> _Work | None:
        """Waits for the next task; None: stopped."""
        with self._changed:
            while not self._stopped:
                now = time.monotonic()
                ready = [work for work in self._waiting.values() if work.not_before <= now]
                if ready:
                    self._running = min(ready, key=lambda work: work.answers)
                    del self._waiting[self._running.key]
                    return self._running
                soonest = min((work.not_before for work in self._waiting.values()), default=None)
                self._changed.wait(None if soonest is None else soonest - now)
            return None

    def _run(self) -> None:
        while (work := self._next()) is not None:
            answer, ended = self._advance(work)
            with self._changed:
                self._running = None
                if answer is not None and not work.canceled:
                    work.answers += 1
                    self._answers.append((work.key, answer))
                if not ended and not work.canceled and not work.replaced:
                    work.fraction = 0.0
                    self._waiting[work.key] = work
                    continue
            work.end()

    def _advance(self, work: _Work) -> tuple[Any, bool]:
        """The next answer of a task, if there is one, and whether it is the last."""
        try:
            if work.steps is None:
                work.steps = iter(work.task(work.go_on))
            return next(work.steps), False
        except StopIteration:
            return None, True
        except BaseException as error:  # noqa: BLE001  given to whoever takes the answers
            return (None if work.replaced and work.answers else error), True
