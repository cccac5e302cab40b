"""index.html: all results of the demo on one page, which refers only to files in its folder."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any

STYLE = """
body { background: #16181c; color: #d8dade; font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto;
       max-width: 1100px; padding: 0 1rem }
h1, h2 { font-weight: 500 } img { max-width: 100%; border-radius: 6px } code { color: #ffb38a }
table { border-collapse: collapse } td, th { padding: .2rem .8rem; text-align: right; border-bottom: 1px solid #333 }
td:first-child, th:first-child { text-align: left } a { color: #8ab8ff }
"""


def write(out: Path, numbers: dict[str, Any]) -> None:
    head, compared = numbers["head"], numbers["comparison"]
    within = "within" if compared["rms"] <= compared["allowed_rms"] else "above"
    parts = [
        "<!doctype html><html lang=en><meta charset=utf-8><title>Skinglow</title>",
        f"<style>{STYLE}</style><h1>Skin that glows in the color of your lights</h1>",
        f"<p>{html.escape(head['name'])} at {head['unit_mm']:g} mm per unit, {numbers['vertices']:,} vertices; "
        f"{html.escape(head['license'])}. Rendered by Blender {html.escape(numbers['blender'])} (Cycles) and "
        f"POV-Ray in {numbers['seconds']:.0f} s. Glow strength {numbers['strength']:g} in modes existing and paper, "
        "1 in mode physical.</p>",
        picture(
            "existing_and_proposed.png",
            "Existing and proposed method",
            "The same head and lights. The existing lookup is a fixed red; the proposed one is recolored.",
        ),
        picture(
            "color_change.png",
            "A light changes color",
            "The light behind the ear changes from orange to blue. The existing glow stays the same.",
        ),
        picture(
            "lookups.png",
            "The lookup images",
            "Transmitted light by thickness, for each set of lights.",
        ),
        picture("rim.png", "Rim lights", "Blender's studio light, or the rig given with --rig."),
        picture(
            "physical.png",
            "Mode physical: a single light behind the ear",
            "The transmittance of the skin times the irradiance on its far side, W/m^2, nothing scaled by hand; "
            f"exposure +{numbers['exposure_stops']:g} stops. Lighting per object also lights what the light does not "
            "reach (the corners of the eyes); lighting per pixel does not.",
        ),
        picture(
            "light_output.png",
            "The transmitted light as an AOV",
            "Light of the Skinglow node, written beside the picture: compositing changes it without another render.",
        ),
        picture(
            "blender_and_povray.png",
            "The same light in Blender and in POV-Ray",
            "Transmitted light only, as linear EXR, without antialiased edges: "
            f"RMS {compared['rms']:.2e}, max {compared['max']:.2e}; "
            f"{within} the 1/255 = {compared['allowed_rms']:.2e} allowed.",
        ),
        "<h2>Contribution of each light (Eq. 2 and 3)</h2>",
        *(lights(title, numbers["lights"][key]) for key, title in (("table1", "Table 1"), ("rim", "Rim"))),
        "<p>All figures: <a href=numbers.json>numbers.json</a>. "
        "The scene: <a href=head.blend>head.blend</a>, <a href=povray/scene.pov>povray/scene.pov</a>. "
        "Log: <a href=demo.log>demo.log</a>.</p></html>",
    ]
    (out / "index.html").write_text("\n".join(parts))


def picture(file: str, title: str, text: str) -> str:
    return f"<h2>{title}</h2><p>{text}</p><a href={file}><img src={file} alt='{title}'></a>"


def lights(title: str, rows: list[dict[str, Any]]) -> str:
    head = "<tr><th>light<th>distance, m<th>R<th>G<th>B<th>fraction<th>"
    body = "".join(
        f"<tr><td>{html.escape(row['name'])}<td>{_number(row['distance'])}"
        + "".join(f"<td>{value:.5f}" for value in row["weight"])
        + f"<td>{row['share']:.1%}<td>{html.escape(row['reason'] or '')}"
        for row in rows
    )
    return f"<h3>{title}</h3><table>{head}{body}</table>"


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.5f}"
