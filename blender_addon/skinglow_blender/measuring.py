# SPDX-License-Identifier: GPL-3.0-or-later
"""Thickness of several meshes measured in a thread, so that Blender's window stays alive meanwhile."""

from threading import Thread

import numpy as np

from .errors import core
from .thickness_attribute import Geometry, measure

#: Seconds that the end of Blender waits for the thread; the core asks far more often whether to go on.
PATIENCE = 10.0


class Measuring:
    """Measures what it is given from the moment it is made. The thread sees arrays alone, never Blender's data."""

    def __init__(self, geometries: dict[str, Geometry]) -> None:
        core()  # where it is missing that is said here, not in the thread
        self.geometries = geometries  #: by name of the object
        self.thicknesses: dict[str, np.ndarray] = {}  #: what is done, mm at each vertex
        self.cancelled = False  #: set it, and the thread ends soon
        self._share = 0.0
        self._fault: BaseException | None = None
        self._thread = Thread(target=self._run, name="Skinglow thickness", daemon=True)
        self._thread.start()

    @property
    def done(self) -> float:
        """The share of all meshes that is done, 0 to 1."""
        return (len(self.thicknesses) + self._share) / max(len(self.geometries), 1)

    @property
    def running(self) -> bool:
        """Whether the thread still works."""
        return self._thread.is_alive()

    def wait(self) -> dict[str, np.ndarray]:
        """The thicknesses, mm, by name of the object; raises what the measuring raised."""
        self._thread.join()
        if self._fault is not None:
            raise self._fault
        return self.thicknesses

    def cancel(self) -> None:
        """Stops the thread and waits for its end."""
        self.cancelled = True
        self._thread.join(PATIENCE)

    def _run(self) -> None:
        try:
            for name, geometry in self.geometries.items():
                values = measure(geometry, self._go_on)
                # The share first: what is shown may pause, but never runs backwards past a mesh.
                self._share = 0.0
                self.thicknesses[name] = values
        except BaseException as error:  # noqa: BLE001  raised again by wait(), where a person sees it
            self._fault = error

    def _go_on(self, share: float) -> bool:
        self._share = share
        return not self.cancelled
