"""Processor time."""

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
