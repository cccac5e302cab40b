# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the thickness of meshes in a thread, so that Blender's window stays responsive."""

from collections.abc import Sequence
from threading import Thread

import numpy as np

from ..errors import core
from ..read.measured_geometry import Geometry
from .thickness_attribute import measure

#: Seconds to wait for the thread when Blender quits; the core checks far more often whether to go on.
MAX_WAIT = 10.0


class Measuring:
    """Starts to measure on construction. The thread accesses arrays only, never Blender's data."""

    def __init__(self, geometries: dict[str, Geometry], names: Sequence[str] = ()) -> None:
        core()  # raises here rather than in the thread if it is missing
        self.names = names  #: of the objects, for people
        self.geometries = geometries  #: by key of the object (identity.key_of)
        self.thicknesses: dict[str, tuple[np.ndarray, np.ndarray]] = {}  #: finished meshes, as `measure` returns them
        self.canceled = False  #: set it to stop the thread
        self._fraction = 0.0
        self._fault: BaseException | None = None
        self._thread = Thread(target=self._run, name="Skinglow thickness", daemon=True)
        self._thread.start()

    @property
    def done(self) -> float:
        """Overall progress, 0 to 1."""
        return (len(self.thicknesses) + self._fraction) / max(len(self.geometries), 1)

    @property
    def running(self) -> bool:
        """Whether the thread is still running."""
        return self._thread.is_alive()

    def wait(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Waits for the thread; returns what `measure` does by key of the object, or raises the thread's exception."""
        self._thread.join()
        if self._fault is not None:
            raise self._fault
        return self.thicknesses

    def cancel(self) -> None:
        """Stops the thread and waits for its end."""
        self.canceled = True
        self._thread.join(MAX_WAIT)

    def _run(self) -> None:
        try:
            for key, geometry in self.geometries.items():
                values = measure(geometry, self._progress)
                # Reset the fraction first: the progress shown may pause, but must not decrease.
                self._fraction = 0.0
                self.thicknesses[key] = values
        except BaseException as error:  # noqa: BLE001  raised again by wait()
            self._fault = error

    def _progress(self, fraction: float) -> bool:
        self._fraction = fraction
        return not self.canceled
