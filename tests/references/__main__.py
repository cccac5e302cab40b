"""python -m tests.references table     writes the table in docs/accuracy.md, as the installed package measures
python -m tests.references record    records anew what has no reference but itself
"""

from __future__ import annotations

import sys

from tests.references import recorded
from tests.references.all import REFERENCES, write_table


def main() -> None:
    if sys.argv[1:] == ["table"]:
        write_table()
    elif sys.argv[1:] == ["record"]:
        recorded.recording = {}
        for each in REFERENCES:
            if each.source == "recorded":
                each.measure()
        recorded.write(recorded.recording)
    else:
        sys.exit(__doc__)


main()
