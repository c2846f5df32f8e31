"""Our best on a device beside our best on processors, by size."""

from dataclasses import dataclass

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from boxwood.results.reader import NO_COUNT
from boxwood.results.words import count_text, time_text

NAME = "device_gains"
TITLE = "From which size a device wins"
HOW_TO_READ = (
    "Lower is better; both axes are logarithmic. End to end is from the host's boxes to the host's answers; resident, all "
    "stays on the device; the device alone is what its own clock says of end to end. The dotted line is what "
    "copies from and to pageable memory take, and the device's own memory. The upright line is the smallest measured size from which on the "
    "device wins against the fastest of one, two and all threads."
)
COLUMNS = ("task", "scene", "n", "what", "threads", "contender", "time_ns", "wins_from", "loses_to")


@dataclass(frozen=True)
class Line:
    """A column of /device_gains and the one that names whose time it is."""

    time: str
    cell: str  # of the limit: whose it is
    words: str
    look: dict


PROCESSORS, DEVICE = "#0072B2", "#D55E00"
LINES = (
    Line("cpu_1_ns", "cell_1", "1 thread", {"color": PROCESSORS, "marker": "o", "linestyle": "-"}),
    Line("cpu_2_ns", "cell_2", "2 threads", {"color": PROCESSORS, "marker": "s", "linestyle": "-"}),
    Line("cpu_all_ns", "cell_all", "all threads", {"color": PROCESSORS, "marker": "^", "linestyle": "-"}),
    Line("end_to_end_ns", "cell_device", "end to end", {"color": DEVICE, "marker": "D", "linestyle": "-"}),
    Line("device_ns", "cell_device", "the device alone", {"color": DEVICE, "marker": "v", "linestyle": "--"}),
    Line("resident_ns", "cell_resident", "resident", {"color": DEVICE, "marker": "P", "linestyle": "-"}),
    Line("graph_ns", "cell_graph", "resident, by a graph", {"color": DEVICE, "marker": "X", "linestyle": "-."}),
    Line("limit_ns", "cell_device", "limit, end to end", {"color": "#666666", "marker": "", "linestyle": ":"}),
)


def groups_of(run):
    """{(task, scene, seed): [rows of /device_gains by size]}."""
    scenes = {row["scene_id"]: row for row in run.source["scenes"]}
    groups = {}
    for row in run.source["device_gains"]:
        scene = scenes[row["scene_id"]]
        groups.setdefault((row["task"], scene["name"], int(scene["seed"])), []).append(row)
    return groups


def words_of(line, row):
    """What a line is called at its end; all threads may be no more than two."""
    if line.time == "cpu_all_ns":
        return f"all {int(row['threads'])} threads"
    return line.words


def lines_of(rows):
    """[(line, [rows that have its time])]; all threads are left out where they are one or two."""
    few = {int(row["threads"]) for row in rows} <= {0, 1, 2}
    found = [(line, [row for row in rows if row[line.time] == row[line.time]]) for line in LINES
             if not (few and line.time == "cpu_all_ns")]
    return [(line, having) for line, having in found if having]


def draw_panel(ax, run, key, rows, breaks, names, out):
    task, scene, _ = key
    wins_from, loses_to = breaks
    ends, times, sizes = [], [], {int(row["n"]) for row in rows}
    for line, having in lines_of(rows):
        x, y = [int(row["n"]) for row in having], [float(row[line.time]) for row in having]
        times += y
        ax.plot(x, y, markersize=5.5, markeredgecolor="white", markeredgewidth=0.6, linewidth=1.4, zorder=3, **line.look)
        ends.append((x[-1], y[-1], f"{words_of(line, having[-1])}  {time_text(y[-1])}", style.readable(line.look["color"])))
        out += [(task, scene, n, line.words, int(row["threads"]) if line.time == "cpu_all_ns" else "",
                 names.get(int(row[line.cell]), ""), time, wins_from, loses_to)
                for row, n, time in zip(having, x, y)]
    style.count_axis(ax.xaxis, min(sizes), max(sizes), room=0.03)
    style.time_axis(ax.yaxis, min(times), max(times))
    if wins_from is not None:
        ax.axvline(wins_from, color=DEVICE, linewidth=1, alpha=0.6, zorder=1)
        ax.text(wins_from, 1, f" wins at {count_text(wins_from)} and above ", transform=ax.get_xaxis_transform(), va="top",
                ha="right" if wins_from > min(sizes) else "left", fontsize=7.5, color=style.readable(DEVICE))
    style.title(ax, f"{scene} · {task} · {run.tasks[task].total_title}")
    ax.set_xlabel(METRICS["n"].axis)
    ax.set_ylabel(METRICS["device_gains"].axis)
    return ends


def size(value):
    """None where there is none."""
    return None if int(value) == NO_COUNT else int(value)


def draw(run):
    groups = groups_of(run)
    if not groups:
        raise Skip("nothing was timed on a device (bench/configs/gpu.toml does, where there is one)")
    scenes = {row["scene_id"]: row for row in run.source["scenes"]}
    ends_of = {(row["task"], scenes[row["scene_id"]]["name"], int(scenes[row["scene_id"]]["seed"])): row
               for row in run.source["device_break_even"]}
    names = {cell.cell_id: cell.contender for cell in run.cells}
    pictures = []
    for task in dict.fromkeys(key[0] for key in groups):
        panels = {key: rows for key, rows in groups.items() if key[0] == task}
        # One size is no line: where others have several, the table has it.
        panels = {key: rows for key, rows in panels.items() if len(rows) > 2} or panels
        figure, axes = style.panels(len(panels), width=4.1, labels_right=1.9)
        rows, said = [], []
        for ax, (key, of_panel) in zip(axes, panels.items()):
            found = ends_of.get(key)
            breaks = (size(found["wins_from"]), size(found["loses_to"])) if found is not None else (None, None)
            labels.at_line_ends(ax, draw_panel(ax, run, key, of_panel, breaks, names, rows))
            said.append(f"{key[1]}: on a device, end to end, {found['words']}" if found is not None
                        else f"{key[1]}: no processor was timed beside the device")
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
                                f"Time against n on a device and on processors for {task}: {len(rows)} times.", COLUMNS, rows,
                                [f"{text}." for text in said]))
    return pictures
