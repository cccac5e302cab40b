"""index.html: all results of the demo on one page that explains itself, with pictures of other studies beside them."""

from __future__ import annotations

import shutil
from html import escape
from pathlib import Path
from typing import Any

from studies.paths import IMAGES
from studies.turn.film import FRAMES

#: Pictures of docs that the page shows beside its own, by the study that makes them.
COMMITTED = {"round_the_ear_film.jpg": "turn", "ladder_person.png": "ladder", "ladder_person_pictures.png": "ladder"}
PARTS = {
    "round": "A light round the ear",
    "color": "Orange to blue",
    "paper": "The paper's figures",
    "physical": "Physical light",
    "ladder": "How far off",
    "povray": "Blender and POV-Ray",
    "skins": "Skins",
    "lights": "Each light",
}
FILM = """
<script>
const pictures = document.querySelectorAll(".film div"), slide = document.querySelector(".film input");
let way = 1;
const show = () => pictures.forEach(each => each.style.backgroundPositionX = 100 * slide.value / slide.max + "%");
const turn = setInterval(() => {
  if (+slide.value + way < 0 || +slide.value + way > +slide.max) way = -way;
  slide.value = +slide.value + way; show();
}, 450);
slide.addEventListener("input", () => { clearInterval(turn); show(); });
show();
</script>"""


def write(out: Path, numbers: dict[str, Any]) -> None:
    """Writes the page; it refers only to files in its folder."""
    folder = out / "from_docs"
    folder.mkdir(exist_ok=True)
    for name in COMMITTED:
        if (IMAGES / name).is_file():
            shutil.copy(IMAGES / name, folder)
    style = Path(__file__).with_name("page.css").read_text()
    body = "".join([_header(out, numbers), _nav(), *_sections(out, numbers), _footer(out, numbers)])
    (out / "index.html").write_text(
        "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
        f"<title>Skinglow</title><style>{style}</style><main>{body}</main></html>"
    )


def _header(out: Path, numbers: dict[str, Any]) -> str:
    first = "hero.png" if (out / "hero.png").is_file() else "physical_surface_ear.png"
    return (
        "<header><div><h1>Skin that glows in the color of your lights</h1>"
        "<p>Behind this ear there is a bulb. What you see of it came through the skin: Skinglow solves "
        "how light goes through thin skin, in Blender, while you move the light.</p>"
        f"<p class=dim>{_made(numbers)}</p></div>"
        f"<a href={first}><img src={first} alt='An ear, lit from behind'></a></header>"
    )


def _made(numbers: dict[str, Any]) -> str:
    head = numbers["head"]
    return (
        f"{escape(head['name'])}, {numbers['vertices']:,} vertices ({escape(head['license'])}). Cycles of Blender "
        f"{escape(numbers['blender'])} and POV-Ray; everything on this page that is of this run took "
        f"{numbers['seconds']:.0f} s."
    )


def _nav() -> str:
    return "<nav>" + "".join(f"<a href=#{name}>{title}</a>" for name, title in PARTS.items()) + "</nav>"


def _sections(out: Path, numbers: dict[str, Any]) -> list[str]:
    compared = numbers["comparison"]
    within = "within" if compared["rms"] <= compared["allowed_rms"] else "above"
    blender = f"Cycles of Blender {escape(numbers['blender'])}, this run"
    return [
        _section(
            "round",
            "A bulb is carried from behind the head to its side. Light comes through where flesh is thin and along the "
            "rim, folds shade each other, and at the end the ear is lit from outside. Move the slider.",
            _film(out),
        ),
        _section(
            "color",
            "One light behind the ear, orange above and blue below. The fixed red table that real-time skin uses "
            "(left) cannot follow; recolored by the lights (right) it does.",
            _picture("color_change.png", "The light changes from orange to blue", blender),
        ),
        _section(
            "paper",
            "The figures of Kim, Moon, Choi, Yang and Han, made again: the same head under the three lights of their "
            "Table 1 with the existing and the proposed method, and the lookup tables of each set of lights, "
            f"transmitted light by thickness. Both are scaled by {numbers['strength']:g}: they have no unit of light.",
            _picture("existing_and_proposed.png", "Existing and proposed method under the lights of Table 1", blender),
            _picture("lookups.png", "The lookup tables", "The core, this run"),
            _picture("rim.png", "Blender's rim lights, or those of --rig", blender),
        ),
        _section(
            "physical",
            "Mode physical has a unit: watts. A bulb behind the ear, nothing scaled by hand, exposure "
            f"+{numbers['exposure_stops']:g} stops. Lit per object, flesh glows that the bulb does not light; lit per "
            "pixel it does not; and through the shape, in the picture at the top, "
            "light comes in at the rim and runs along it.",
            _picture("physical.png", "Lit per object and per pixel", blender),
            "<p>The light alone is an output of the node. As a pass beside the picture it gets another color in "
            "compositing, without another render.</p>",
            _picture("light_output.png", "The transmitted light as a pass", blender),
        ),
        _section(
            "ladder",
            "Every method on one ear, a medium and four sets of lights, against a Monte Carlo in the flesh itself and "
            "beside Cycles' random walk. A picture takes the seconds below it after a light was moved; a table over "
            "thickness takes an ear for a plate, and it is none.",
            _committed(out, "ladder_person_pictures.png", "Every method, exposed alike in a row"),
            _committed(out, "ladder_person.png", "Error against run time"),
        ),
        _section(
            "povray",
            "POV-Ray's macros are the same equations in another language, without a line in common. Transmitted light "
            f"only, compared as linear floats: RMS {compared['rms']:.1e}, {within} the 1/255 = "
            f"{compared['allowed_rms']:.1e} that is allowed; at one pixel at most {compared['max']:.1e}.",
            _picture("blender_and_povray.png", "Blender, POV-Ray, and their difference", f"{blender}, and POV-Ray 3.7"),
        ),
        _section(
            "skins",
            "What skin is made of decides what comes through: melanin in the epidermis, blood below it, and how much "
            "oxygen that has. White light by thickness, solved by radiative transfer.",
            _picture("skins.png", "Melanin, blood and oxygen", "The core, this run"),
        ),
        _section(
            "lights",
            "What each light gives to skin (Eq. 2 and 3), as the add-on's panel lists it.",
            *(_lights(title, numbers["lights"][key]) for key, title in (("table1", "Table 1"), ("rim", "Rim"))),
        ),
    ]


def _section(name: str, text: str, *content: str) -> str:
    return f"<section id={name}><h2>{PARTS[name]}</h2><p>{text}</p>{''.join(content)}</section>"


def _picture(file: str, title: str, made_with: str, kind: str = "") -> str:
    image = f"<a href={file}><img src={file} alt='{escape(title)}' loading=lazy></a>"
    return (
        f"<figure class='{kind}'><div class=wide>{image}</div><figcaption>{title}. {made_with}.</figcaption></figure>"
    )


def _committed(out: Path, name: str, title: str) -> str:
    if not (out / "from_docs" / name).is_file():
        return ""
    study = COMMITTED[name]
    made_with = f"Not of this run: <code>python -m studies {study}</code>, on two cores"
    return _picture(f"from_docs/{name}", title, made_with, "paper")


def _film(out: Path) -> str:
    film = "from_docs/round_the_ear_film.jpg"
    if not (out / film).is_file():
        return ""
    rows = "".join(
        f'<div role=img aria-label="{label}" style="background-image:url({film});background-position-y:{y}%"></div>'
        for label, y in (("through the shape", 0), ("random walk", 100))
    )
    return (
        f"<figure><div class=film style='--frames:{FRAMES}'>{rows}"
        f"<input type=range min=0 max={FRAMES - 1} value=0 aria-label='where the light is'></div>"
        "<figcaption>Left: through the shape, EEVEE. Right: random walk, Cycles, as many seconds a frame. "
        f"Not of this run: <code>python -m studies turn</code>.</figcaption></figure>{FILM}"
    )


def _lights(title: str, rows: list[dict[str, Any]]) -> str:
    head = "<tr><th>light<th>distance, m<th>R<th>G<th>B<th>fraction<th>"
    body = "".join(
        f"<tr><td>{escape(row['name'])}<td>{_number(row['distance'])}"
        + "".join(f"<td>{value:.5f}" for value in row["weight"])
        + f"<td>{row['share']:.1%}<td>{escape(row['reason'] or '')}"
        for row in rows
    )
    return f"<p>{title}</p><div class=wide><table>{head}{body}</table></div>"


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.5f}"


def _footer(out: Path, numbers: dict[str, Any]) -> str:
    files = {
        "numbers.json": "all numbers",
        "head.blend": "the scene in Blender",
        "povray/scene.pov": "the scene in POV-Ray",
        "demo.log": "the log",
    }
    links = ", ".join(f"<a href={name}>{what}</a>" for name, what in files.items() if (out / name).exists())
    spent = f" It took {escape(numbers['spent'])}." if "spent" in numbers else ""
    return f"<h2>What it was made with</h2><p>{_made(numbers)}{spent}</p><p>{links}.</p>"
