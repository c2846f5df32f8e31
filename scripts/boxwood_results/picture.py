"""What a figure gives: a picture, the numbers in it, and words for those who cannot see it."""

import csv
import io
import re
from dataclasses import dataclass, field

from matplotlib import pyplot as plt


class Skip(Exception):
    """The run does not hold what the figure shows; the message says what is missing."""


@dataclass
class Picture:
    name: str  # file name without its ending
    figure: object
    title: str
    alt: str
    columns: tuple
    rows: list
    notes: list = field(default_factory=list)


def cell_text(value):
    """Numbers in shortest round-trip form; what is missing is empty."""
    if value is None or value != value:
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)


def as_csv(picture):
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(picture.columns)
    writer.writerows([cell_text(value) for value in row] for row in picture.rows)
    return out.getvalue()


def save(picture, folder, formats):
    """Writes the picture in each format and its numbers as CSV; gives the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for ending in formats:
        path = folder / f"{picture.name}.{ending}"
        with plt.rc_context({"svg.hashsalt": picture.name}):
            metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(ending)
            picture.figure.savefig(path, bbox_inches="tight", pad_inches=0.08, metadata=metadata)
        paths.append(path)
    path = folder / f"{picture.name}.csv"
    path.write_text(as_csv(picture), encoding="utf-8")
    return [*paths, path]


def as_inline_svg(picture):
    """The picture for the inside of an HTML page: nothing to fetch, ids that no other picture has."""
    out = io.StringIO()
    with plt.rc_context({"svg.hashsalt": picture.name}):
        picture.figure.savefig(
            out, format="svg", bbox_inches="tight", pad_inches=0.08,
            metadata={"Date": None, "Creator": None, "Format": None, "Type": None},
        )
    svg = out.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", svg)
    svg = svg.replace("xlink:href=", "href=")
    svg = re.sub(r'\bid="', f'id="{picture.name}-', svg)
    svg = re.sub(r'href="#', f'href="#{picture.name}-', svg)
    svg = re.sub(r"url\(#", f"url(#{picture.name}-", svg)
    return svg
