"""Processor time and memory."""

from __future__ import annotations

import resource
from collections.abc import Callable
from typing import Any, TypeVar

Result = TypeVar("Result")


def timed(function: Callable[..., Result], *arguments: Any, **options: Any) -> tuple[Result, float]:  # noqa: ANN401
    """The result of a call and its CPU seconds: user and system, all threads, less affected by other work."""
    before = resource.getrusage(resource.RUSAGE_SELF)
    result = function(*arguments, **options)
    after = resource.getrusage(resource.RUSAGE_SELF)
    return result, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def spent() -> str:
    """By all programs that this one ran and awaited: processor time, and the memory of the largest at its peak."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    kilobytes = max(used.ru_maxrss, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    return f"{used.ru_utime + used.ru_stime:.0f} s of processor time, {kilobytes / 1e6:.1f} GB of memory at the peak"
