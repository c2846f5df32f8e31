"""What a figure gives: a picture, the numbers in it, and words for those who cannot see it."""

import csv
import io
import re
from dataclasses import dataclass, field

from matplotlib import pyplot as plt
from matplotlib.text import Text


class Skip(Exception):
    """The run does not hold what the figure shows; the message says what is missing."""


@dataclass
class Picture:
    name: str  # file name without its ending
    figure: object
    title: str
    alt: str  # one sentence
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


def panels_of(figure):
    """[[axes]]: each panel with its colour bar."""
    bars = {ax: ax._colorbar.mappable.axes for ax in figure.axes if getattr(ax, "_colorbar", None)}
    return [[ax, *(bar for bar, of in bars.items() if of is ax)] for ax in figure.axes if ax not in bars]


def without_halos(figure):
    """Texts with a halo become paths in SVG: these stay texts, whose id says that the page draws the halo."""
    for number, text in enumerate(figure.findobj(lambda artist: isinstance(artist, Text) and artist.get_path_effects())):
        text.set_path_effects([])
        text.set_gid(f"halo{number}")


def svgs_of_panels(picture):
    """SVG with real text, one for each panel; the figure is used up."""
    without_halos(picture.figure)
    svgs = []
    for shown in panels_of(picture.figure):
        for ax in picture.figure.axes:
            ax.set_visible(ax in shown)
        out = io.StringIO()
        with plt.rc_context({"svg.hashsalt": picture.name, "svg.fonttype": "none"}):
            picture.figure.savefig(out, format="svg", bbox_inches="tight", pad_inches=0.06, facecolor="none",
                                   metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
        svgs.append(out.getvalue())
    plt.close(picture.figure)
    return svgs


STAMP = "Source"  # a text of PNG that PNG itself knows


def save_png(picture, path, stamp):
    """The picture with a text that says which run it shows."""
    path.parent.mkdir(parents=True, exist_ok=True)
    picture.figure.savefig(path, bbox_inches="tight", pad_inches=0.08, metadata={STAMP: stamp, "Software": None})
    plt.close(picture.figure)
    return path


def stamp_of(path):
    """Which run a PNG shows; empty if it does not say."""
    found = re.search(rb"tEXt" + STAMP.encode() + rb"\0([\x20-\x7e]*)", path.read_bytes())
    return found[1][:36].decode() if found else ""
