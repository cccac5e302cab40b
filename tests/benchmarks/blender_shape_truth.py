"""The whole chain against the Monte Carlo truth, each lighting: an ear rendered with the add-on's own material.

Run in a Blender whose Python finds skinglow; needs ../shared/data/shape:

    python tests/benchmarks/blender_shape_truth.py [SIZE]         # a bpy wheel

For each ear and lighting what tests/blender/ear_truth.py compares: RMS over mean, percent, of the pixels that show
back-lit skin (all three channels together, and each), without the noise of the truth, whose two halves differ; and
brightness over the truth's.
"""

import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blender"))

from ear_truth import differences  # noqa: E402


def main() -> None:
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 160
    for ear in ("lps-a", "mh-a"):
        with tempfile.TemporaryDirectory() as folder:
            for weights, found in differences(ear, size, ("object", "surface", "shape"), Path(folder)):
                channels = ", ".join(f"{100.0 * value:.1f}" for value in found.channels)
                bright = ", ".join(f"{value:.2f}" for value in found.brightness)
                print(f"{ear} {weights}: {found.pixels} pixels, {found.seconds:.1f} s, all {100.0 * found.rms:.1f} %")
                print(f"    R G B {channels} %, brightness {bright}", flush=True)


main()
sys.stdout.flush()
os._exit(0)  # the 4.5 wheel hangs otherwise
