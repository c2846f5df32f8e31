"""Time of a frame against the share of the bodies that move."""

from .. import labels, style
from ..metrics import METRICS
from ..moving import moved_share
from ..picture import Picture, Skip
from ..run import TOTAL
from ..selection import MAX_LINES, wrong_notes

NAME = "moved_share"
TITLE = "How time grows with the share that moves"
HOW_TO_READ = (
    "Lower is better; both axes are logarithmic. Each line is one way to play the same scene while a smaller or larger "
    "share of its bodies moves. A line that falls to the left does less where less moves; a flat one pays for all."
)
MIN_SHARES = 3
COLUMNS = ("scene", "n", "threads", "contender", "library", "status", "moved_share", "frame_ns")


def groups_of(run):
    """{(task, scene and effects, n, where, seed): {contender: {share: cell}}}."""
    groups = {}
    for cell in run.cells:
        if not cell.timed or cell.lacks_effect:
            continue
        found = moved_share(cell)
        if found:
            words, share = found
            job = cell.job
            lines = groups.setdefault((job.task, words, job.n, job.where, job.seed), {})
            lines.setdefault((cell.contender, cell.executor), {})[share] = cell
    return groups


def choose_lines(lines):
    """The best of each family where all moves, then the rest, at most MAX_LINES."""
    order, families = [], set()
    for line in sorted(lines, key=lambda line: line[max(line)].median(TOTAL)):
        family = line[max(line)].family
        order.append((family in families, len(order), line))
        families.add(family)
    return [line for _, _, line in sorted(order, key=lambda item: item[:2])][:MAX_LINES]


def draw_panel(ax, key, lines, rows):
    _, words, n, where, _ = key
    ends, times, shares = [], [], set()
    for line in lines:
        x = sorted(line)
        y = [line[share].median(TOTAL) for share in x]
        cell = line[x[-1]]
        ax.plot(x, y, **style.point_style(cell, 5.5), linewidth=1.4, zorder=3)
        for share, time in zip(x, y):
            if line[share].status == "wrong":
                style.cross_out(ax, share, time)
            rows.append((words, n, where.column, cell.label, cell.library, line[share].status, share, time))
        ends.append((x[-1], y[-1], cell.label, style.text_colour(cell)))
        times += y
        shares.update(x)
    style.log_axis(ax.xaxis, min(shares), max(shares), lambda value: f"{100 * value:g} %", room=0.03)
    style.time_axis(ax.yaxis, min(times), max(times))
    style.title(ax, f"{words} · {n:,} · {where}")
    ax.set_xlabel("share of the bodies that move")
    ax.set_ylabel(METRICS["frame"].axis)
    return ends


def draw(run):
    panels = []
    for key, lines in sorted(groups_of(run).items()):
        lines = [line for line in lines.values() if len(line) >= MIN_SHARES]
        if lines:
            panels.append((key, choose_lines(lines)))
    if not panels:
        raise Skip(f"no scene was played with {MIN_SHARES} or more shares of its bodies moving")
    figure, axes = style.panels(len(panels), width=4.1, labels_right=2.1)
    rows, notes = [], []
    for ax, (key, lines) in zip(axes, panels):
        labels.at_line_ends(ax, draw_panel(ax, key, lines, rows))
        notes += wrong_notes([cell for line in lines for cell in line.values()])
    return [Picture(NAME, figure, TITLE, f"Time of a frame by the share of the bodies that moves, in {len(panels)} scenes.", COLUMNS, rows, notes)]
