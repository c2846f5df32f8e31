"""What more threads give each contender, against itself with one thread."""

import math

from .. import labels, stats, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..moving import WITHOUT
from ..run import TOTAL, TOTAL_WORDS
from ..selection import MOST_LINES, wrong_notes

NAME = "speedup"
TITLE = "What threads give"
HOW_TO_READ = (
    "Higher is better; the dotted line is ideal. Each point is a contender's time with one thread over "
    "its time with t, paired within rounds; bars are intervals of at least 95 %."
)
COLUMNS = ("task", "scene", "n", "variant", "library", "status", "threads", "speedup", "speedup_lo", "speedup_hi",
           "rounds")


def base_of(cells):
    """The cell with one thread: serial if there is one."""
    single = [cell for cell in cells if cell.job.threads == 1]
    return min(single, key=lambda c: c.executor != "serial", default=None)


def lines_of(cells):
    """[(base, [cells with more threads, by threads])] per contender and executor."""
    contenders = {}
    for cell in cells:
        contenders.setdefault((cell.contender, cell.precision), []).append(cell)
    for group in contenders.values():
        base = base_of(group)
        if base is None:
            continue
        for executor in sorted({cell.executor for cell in group if cell.job.threads > 1}):
            line = sorted((c for c in group if c.executor == executor and c.job.threads > 1),
                          key=lambda c: c.job.threads)
            yield base, line


def best_lines(lines):
    """The fastest of each of our builders and every peer, at most MOST_LINES."""
    kept, families = [], set()
    for base, line in sorted(lines, key=lambda item: item[1][-1].median(TOTAL)):
        if line[-1].ours and line[-1].family in families:
            continue
        families.add(line[-1].family)
        kept.append((base, line))
    return kept[:MOST_LINES]


def draw_panel(ax, job, lines, rows):
    ends, most, lowest, highest = [], 1, 1.0, 1.0
    for place, (base, line) in enumerate(lines):
        threads, ratios = [1], [stats.Interval(0, 1.0, math.nan, math.nan)]
        for cell in line:
            ratio = stats.paired_ratio(base.rounds(TOTAL), cell.rounds(TOTAL))
            threads.append(cell.job.threads)
            ratios.append(ratio)
            rows.append((job.task, job.scene, job.n, cell.label, cell.library, cell.status, cell.job.threads,
                         ratio.mid, ratio.lo, ratio.hi, ratio.n))
        last = line[-1]
        ax.plot(threads, [r.mid for r in ratios], **style.point_style(last, 5.5), linewidth=1.4, zorder=3)
        for x, ratio in zip(threads, ratios):
            if ratio.known:  # set aside a little, so that bars of neighbours do not cover each other
                aside = x * (1 + 0.006 * (place - (len(lines) - 1) / 2))
                ax.plot([aside, aside], [ratio.lo, ratio.hi], color=style.look(last.family)[0], linewidth=1)
        if last.status == "wrong":
            style.cross_out(ax, threads[-1], ratios[-1].mid)
        ends.append((threads[-1], ratios[-1].mid, f"{last.label}  {ratios[-1].mid:.2f}x",
                     style.text_colour(last.family)))
        most = max(most, threads[-1])
        lowest = min(lowest, *(r.lo if r.known else r.mid for r in ratios))
        highest = max(highest, *(r.hi if r.known else r.mid for r in ratios))
    ax.plot((1, most), (1, most), color="#888888", linestyle=":", linewidth=1.2)
    ends.append((most, most, "ideal", "#666666"))
    ax.set_xlim(1 - 0.04 * most, most * 1.03)
    ax.set_ylim(min(0.9, lowest * 0.95), max(highest, most) * 1.05)
    ax.set_xticks(sorted({1, *(cell.job.threads for _, line in lines for cell in line)}))
    style.title(ax, f"{job.scene} {job.n:,} · {job.task} · {TOTAL_WORDS.get(job.task, 'build and one query')}")
    ax.set_xlabel(METRICS["threads"].axis)
    ax.set_ylabel(METRICS["speedup"].axis)
    return ends


def draw(run):
    groups = {}
    for cell in run.cells:
        if cell.rounds(TOTAL) and not cell.contender.startswith(WITHOUT):
            groups.setdefault((cell.job.task, cell.job.scene, cell.job.seed), {}).setdefault(cell.job.n, []).append(cell)
    by_ask = {}
    for (task, _, _), sizes in sorted(groups.items()):
        cells = sizes[max(sizes)]
        lines = best_lines(lines_of(cells))
        if lines:
            by_ask.setdefault(task, []).append((lines[0][0].job, lines, cells))
    if not by_ask:
        raise Skip("no contender was timed with one thread and with more")
    pictures = []
    for task, groups_of_ask in by_ask.items():
        figure, axes = style.panels(len(groups_of_ask), width=4.1, labels_right=2.1)
        rows, notes = [], []
        for ax, (job, lines, cells) in zip(axes, groups_of_ask):
            labels.at_line_ends(ax, draw_panel(ax, job, lines, rows))
            notes += wrong_notes(cells)
        said = "; ".join(f"{row[3]} on {row[1]} with {row[6]} threads {row[7]:.2f}x" for row in rows)
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {task}", f"Speed-up by threads: {said}.",
                                COLUMNS, rows, notes))
    return pictures
