# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a comparison with POV-Ray: report.json for programs, report.html for people."""

import json
from html import escape
from pathlib import Path
from typing import Any

import bpy

from ..whole_file import whole_file

#: A picture of 8 bits shows no smaller difference.
ALLOWED_RMS = 1.0 / 255.0
STYLE = """body { font: 15px sans-serif; margin: 2em; max-width: 70em } td, th { padding: .3em .8em; text-align: right }
td:first-child, td:nth-child(2) { text-align: left } .far { color: #b00 }
img { max-width: 100%; margin: .3em 0 1.5em }"""
HTML = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{style}</style></head>
<body>
{body}
</body></html>
"""
EXPLANATION = (
    "Differences in linear light where the skin is, with one ray through the center of each pixel; an RMS above 1/255 "
    "is red. Pixels next to a silhouette are left out: their share is below 'edges'. Percentiles are of the largest "
    "difference of a channel in each pixel. FLIP is what a person sees of the difference, 0 to 1, at exposures of 0 to "
    "4 stops (HDR-FLIP by NVIDIA, mean over the whole picture)."
)
COLUMNS = ("RMS", "maximum", "50 %", "95 %", "99.9 %", "FLIP", "pixels", "edges")


def write_report(directory: Path, skin: str, entries: list[dict[str, Any]], notes: list[str]) -> Path:
    """Writes both files; the path of report.html."""
    for entry in entries:
        if "rms" in entry:
            entry["within"] = entry["rms"] <= ALLOWED_RMS
    whole = {
        "skin": skin,
        "blender": bpy.app.version_string,
        "allowed_rms": ALLOWED_RMS,
        "notes": notes,
        "comparisons": entries,
    }
    with whole_file(directory / "report.json") as partial:
        partial.write_text(json.dumps(whole, indent=1), encoding="utf-8")
    head = "".join(f"<th>{escape(name)}</th>" for name in ("Mode", "Light", *COLUMNS))
    title = f"{skin}: light that comes through, by Blender {bpy.app.version_string} and POV-Ray"
    parts = [
        f"<h1>{escape(title)}</h1>",
        f"<p>{EXPLANATION}</p>",
        *(f"<p><b>{escape(note)}</b></p>" for note in notes),
        f"<table><tr>{head}</tr>",
        *map(_row, entries),
        "</table>",
        *map(_picture, entries),
    ]
    text = HTML.format(title=escape(title), style=STYLE, body="\n".join(parts))
    path = directory / "report.html"
    with whole_file(path) as partial:
        partial.write_text(text, encoding="utf-8")
    return path


def _row(entry: dict[str, Any]) -> str:
    names = f"<td>{escape(entry['mode'])}</td><td>{escape(entry['light'])}</td>"
    if "rms" not in entry:
        return f'<tr>{names}<td colspan="{len(COLUMNS)}">{escape(entry.get("error", "not compared"))}</td></tr>'
    shares = entry["percentiles"]
    values = (entry["rms"], entry["max"], shares["50"], shares["95"], shares["99.9"])
    cells = [f"{value:.2e}" for value in values] + [
        "" if entry["flip"] is None else f"{entry['flip']:.4f}",
        str(entry["compared_pixels"]),
        f"{entry['left_out_fraction']:.1%}",
    ]
    mark = "" if entry["within"] else ' class="far"'
    return f"<tr{mark}>{names}{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _picture(entry: dict[str, Any]) -> str:
    if "rms" not in entry:
        return ""
    title = f"{entry['mode']}, {entry['light']}: Blender, POV-Ray, difference (white: {entry['heat_map_white']:.2e})"
    return f'<h3>{escape(title)}</h3><img src="{entry["folder"]}/side_by_side.png" alt="{escape(title)}">\n'
