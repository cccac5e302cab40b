"""How the programs that run inside Blender end."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from typing import Any, NoReturn


def run_and_exit(main: Callable[..., Any], *arguments: str) -> NoReturn:
    """Calls main and ends the process at once, with 3 after an exception: the 4.5 wheel hangs at an ordinary exit."""
    code = 0
    try:
        main(*arguments)
    except BaseException:
        traceback.print_exc()
        code = 3
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
