# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends what a render waits for: Esc in a window, Ctrl-C without one.

Both tell Blender to cancel the render too, which it does when the add-on's handler returns. Python is not told of
either while a handler runs, so Esc is watched for by an operator (ui/waiting_operators.py), and in background mode the
signal is taken meanwhile, and passed on when the update is over.
"""

import ctypes
import signal
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import bpy

from ..session import SESSION
from .guard import faults_shown


def may_go_on(_fraction: float) -> bool:
    """The progress function of what a render waits for."""
    return not SESSION.interrupted


def require_uninterrupted() -> None:
    """Raises KeyboardInterrupt if the last update was: handlers, where it happened, cannot."""
    if SESSION.interrupted:
        raise KeyboardInterrupt


def pass_on() -> None:
    """Sends the signals that came meanwhile to whoever they were for."""
    signals, SESSION.signals = SESSION.signals, []
    for each in signals:
        signal.raise_signal(each)


@contextmanager
def interruptible() -> Iterator[None]:
    """While a render waits: Esc or Ctrl-C sets SESSION.interrupted, which holds until the next update."""
    if threading.current_thread() is threading.main_thread():
        with ExitStack() as taken:
            for each in (signal.SIGINT, signal.SIGTERM):
                taken.enter_context(_taken(each))
            yield
        return
    SESSION.waiting += 1
    bpy.app.timers.register(_watch, first_interval=0.0)
    try:
        yield
    finally:
        SESSION.waiting -= 1


@faults_shown()
def _watch() -> None:
    """Watches in all windows, as the render may have one of its own."""
    for window in bpy.context.window_manager.windows if SESSION.waiting else ():
        with bpy.context.temp_override(window=window):
            bpy.ops.skinglow.watch_for_escape("INVOKE_DEFAULT")


def _interrupt(number: int, _frame: object) -> None:
    SESSION.interrupted = True
    SESSION.signals.append(number)


@contextmanager
def _taken(number: int) -> Iterator[None]:
    # Blender's handler is not one of Python's, whose own functions could not put it back.
    handler, set_handler = ctypes.pythonapi.PyOS_getsig, ctypes.pythonapi.PyOS_setsig
    handler.restype = set_handler.restype = ctypes.c_void_p
    set_handler.argtypes = (ctypes.c_int, ctypes.c_void_p)
    before = handler(number)
    of_python = signal.signal(number, _interrupt)
    try:
        yield
    finally:
        signal.signal(number, signal.SIG_DFL if of_python is None else of_python)
        set_handler(number, before)
