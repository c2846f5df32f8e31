"""How every figure looks: one colour and marker per contender family, axes in plain units."""

import math
import zlib

import matplotlib

matplotlib.use("Agg")

from matplotlib import colors
from matplotlib import pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullFormatter, NullLocator

from boxwood.results.words import count_text, time_tick

# By place in the registry that the file names (/variants.place): builders, policies or ways to play, which never stand
# beside each other, and peers. Okabe and Ito 2008 without its yellow, which is faint on white, and Tol's muted colours.
OURS = (("#009E73", "s"), ("#332288", "p"), ("#0072B2", "o"), ("#882255", "d"), ("#AA4499", "H"), ("#999933", "8"),
        ("#56B4E9", "^"), ("#44AA99", "<"), ("#117733", ">"), ("#6699CC", "X"), ("#CC6677", "D"))
PEERS = (("#7F7F7F", "*"), ("#E69F00", "v"), ("#D55E00", "D"), ("#CC79A7", "P"), ("#000000", "h"), ("#661100", "X"),
         ("#997700", "d"))
OUR_LOOK = ("#0072B2", "o")  # of all of ours, where names tell them apart
OTHER_MARKERS = ("<", ">", "p", "h", "d", "H", "8")
THIN = {"*": 1.7, "P": 1.25, "<": 1.15, ">": 1.15}  # markers that show too little at the size of the others
INK, FAINT = "#222222", "#B8B8B8"
ROW = 0.23  # inches of a row of ratios
TALL = 8  # inches from which the axis of the rows stands at the top, too

plt.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 9,
        "axes.titlesize": 9.5,
        "axes.titlelocation": "left",
        "axes.labelsize": 9,
        "axes.edgecolor": "#666666",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "#E6E6E6",
        "grid.linewidth": 0.7,
        "text.color": INK,
        "axes.labelcolor": INK,
        "xtick.color": INK,
        "ytick.color": INK,
        "svg.fonttype": "path",
        "savefig.dpi": 150,
        "figure.dpi": 100,
        "figure.max_open_warning": 0,
    }
)


def look(what):
    """(colour, marker) of a cell or kernel by its place, the same in every figure and every run. With settings, an
    optimizer, or beyond the palette it has the colour of its place and a marker of its own."""
    palette = OURS if what.ours else PEERS
    colour, marker = palette[what.place % len(palette)]
    if what.is_plain and what.place < len(palette):
        return colour, marker
    others = [other for other in OTHER_MARKERS if other != marker]
    return colour, others[zlib.crc32(what.family.encode()) % len(others)]


def kernel_look(kernel):
    return OUR_LOOK if kernel.ours else look(kernel.peer)


def looks(names):
    """{name: (colour, marker)} of kernels of ours, no two alike while the colours last."""
    return {name: OURS[place % len(OURS)] for place, name in enumerate(sorted(names))}


def text_colour(what):
    return readable(look(what)[0])


def readable(colour):
    """The colour, darkened until small text can be read on white."""
    red, green, blue = colors.to_rgb(colour)
    while 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.38:
        red, green, blue = red * 0.9, green * 0.9, blue * 0.9
    return red, green, blue


def point_style(cell, size=6):
    """Plot arguments of a cell's marker: filled if its answers were right, else hollow."""
    colour, marker = look(cell)
    filled = cell.status != "wrong"
    return {
        "marker": marker,
        "markersize": size * THIN.get(marker, 1),
        "color": colour,
        "markerfacecolor": colour if filled else "none",
        "markeredgecolor": "white" if filled else colour,
        "markeredgewidth": 0.6 if filled else 1.3,
        "linestyle": "-" if cell.ours else "--",
    }


def whiskers(ax, cell, x, y, over_x=None, over_y=None):
    """How far the rounds of a point lie apart, where its phases are given."""
    thin = {"color": look(cell)[0], "linewidth": 0.8, "alpha": 0.6, "zorder": 2, "scalex": False, "scaley": False}
    for phase, ends in ((over_x, lambda span: (span, (y, y))), (over_y, lambda span: ((x, x), span))):
        span = cell.spread(phase) if phase else None
        if span:
            ax.plot(*ends(span), **thin)


def cross_out(ax, x, y):
    """Marks a point whose answers were wrong."""
    ax.plot([x], [y], marker="x", markersize=11, color="#C00000", markeredgewidth=1.5, zorder=6)


def title(ax, text):
    """A panel's title, made smaller where it would run into the next panel."""
    inches = ax.get_position().width * ax.figure.get_figwidth()
    ax.set_title(text, fontsize=9.5 * min(1, max(56, 14 * inches) / len(text)))


def log_ticks(low, high):
    """Round numbers in [low, high], few enough to be read: the coarsest of these sets with three, or
    even steps where the range is small."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for steps in ((1,), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 7)):
        ticks = [step * 10.0**decade for decade in decades for step in steps]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) >= 3:
            return ticks[:: -(-len(ticks) // 7)]
    even = MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(low, high)
    return [tick for tick in even if low <= tick <= high]


def log_axis(axis, low, high, text, room=0.06):
    """A log axis over [low, high] and some room."""
    stretch = max((high / low) ** room, 1.12)
    low, high = low / stretch, high * stretch
    (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")
    axis.set_major_locator(FixedLocator(log_ticks(low, high)))
    axis.set_minor_locator(NullLocator())
    axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(FuncFormatter(lambda value, _: text(value)))
    (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(low, high)


def time_axis(axis, low, high, room=0.06):
    log_axis(axis, low, high, time_tick, room)


def count_axis(axis, low, high, room=0.06):
    log_axis(axis, low, high, count_text, room)


def draw_marks(ax, marks):
    """Ratios in rows: of each (ratio, height, (colour, marker), is_open, floor) a mark, pale if it is open, the bar of its
    interval and the band of its noise floor, within which nothing is claimed; and the line at 1."""
    ax.axvline(1, color="#555555", linewidth=1, zorder=1)
    for ratio, height, (colour, marker), is_open, floor in marks:
        strength = 0.45 if is_open else 1.0
        if not math.isnan(floor):
            ax.barh([height], [1 + floor - 1 / (1 + floor)], ROW, left=1 / (1 + floor), color="#DDDDDD", zorder=0)
        if ratio.known:
            ax.plot([ratio.lo, ratio.hi], [height, height], color=colour, linewidth=1.8, alpha=strength, zorder=3)
        ax.plot([ratio.mid], [height], marker=marker, markersize=6.5, color=colour, alpha=strength,
                markeredgecolor="white", markeredgewidth=0.6, zorder=4)


def row_heading(ax, x, height, text, size):
    """Above rows, over their grid; x in widths of the panel."""
    ax.text(x, height, text, transform=ax.get_yaxis_transform(), va="center", fontsize=size, weight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})


def row_texts(ax, height, name, said, name_colour=INK, said_colour=INK):
    """What stands left and right of a row."""
    where = {"transform": ax.get_yaxis_transform(), "va": "center"}
    ax.text(-0.03, height, name, ha="right", fontsize=8, color=name_colour, **where)
    ax.text(1.03, height, said, fontsize=7.5, color=said_colour, **where)


def ratio_axis(ax, low, high, label, room):
    """Below rows of ratios."""
    log_axis(ax.xaxis, low, high, lambda value: f"{value:g}x", room)
    ax.set_xlabel(label)
    ax.set_yticks([])
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)


def pair_of_panels(crowded):
    """Sizes for `panels` with labels beside points: two in a row, or one where labels are very long."""
    return {"width": 10.5, "height": 4.1, "columns": 1} if crowded else {"width": 5.4, "height": 3.9}


def panels(count, width=4.9, height=3.5, columns=2, labels_right=0.0):
    """A figure of `count` panels, at most `columns` beside each other. `labels_right` inches are kept
    free to the right of each panel for labels."""
    columns = min(columns, count)
    rows = -(-count // columns)
    left, top, bottom = 0.75, 0.35, 0.55
    full_width = columns * (width + labels_right)
    full_height = rows * height
    figure = plt.figure(figsize=(full_width, full_height))
    axes = []
    for index in range(count):
        row, column = divmod(index, columns)
        axes.append(
            figure.add_axes(
                (
                    (column * (width + labels_right) + left) / full_width,
                    1 - ((row + 1) * height - bottom) / full_height,
                    (width - left - 0.2) / full_width,
                    (height - top - bottom) / full_height,
                )
            )
        )
    return figure, axes
