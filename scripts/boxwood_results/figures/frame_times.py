"""How long frames take, the usual one and the worst, against what an application can spend."""

from .. import style
from ..metrics import METRICS
from ..moving import SCREEN_NS
from ..picture import Picture, Skip
from ..selection import choose, largest_jobs, left_out_note, wrong_notes
from boxwood.results.words import time_text

NAME = "frame_times"
TITLE = "Frame times"
HOW_TO_READ = (
    "Left is better. Each row is a way to play the scene: the filled mark is its median frame, the ticks are the 95th "
    "and 99th percentile, the ring is the worst frame. A frame is one update and one query, and counts by its "
    "median over the rounds. Dashed: 1 ms and 16.6 ms, a frame of a screen at 60 Hz."
)
MIN_FRAMES = 20  # fewer have no 95th percentile
COLUMNS = ("task", "scene", "n", "threads", "contender", "library", "status", "frames", "p50_ns", "p95_ns", "p99_ns",
           "worst_ns", "over_1_ms", "over_16_6_ms")
LIMITS = ((1e6, "1 ms"), (SCREEN_NS, "16.6 ms"))
ROW, LEFT, PANEL, RIGHT = 0.24, 2.35, 3.3, 0.95  # inches


def numbers(cell):
    """(p50, p95, p99, worst)."""
    return tuple(float(cell.frame_stats[name]) for name in ("p50_ns", "p95_ns", "p99_ns", "max_ns"))


def draw_panel(ax, job, cells, rows):
    found = sorted(((numbers(cell), cell) for cell in cells), key=lambda item: (item[0], item[1].name))
    low, high = min(marks[0] for marks, _ in found), max(marks[3] for marks, _ in found)
    ends = [low, high, *(at for at, _ in LIMITS if low / 4 <= at <= 4 * high)]
    style.time_axis(ax.xaxis, min(ends), max(ends), room=0.05)
    for at, words in LIMITS:
        if ax.get_xlim()[0] < at < ax.get_xlim()[1]:
            ax.axvline(at, color="#444444", linewidth=1, linestyle="--", zorder=1)
            ax.text(at, 1.0, words, transform=ax.get_xaxis_transform(), ha="center", va="bottom", fontsize=7)
    for y, (marks, cell) in enumerate(found):
        colour, marker = style.look(cell)
        p50, p95, p99, worst = marks
        ax.plot([p50, worst], [y, y], color=colour, linewidth=1.2, zorder=2)
        ax.plot([p95, p99], [y, y], linestyle="", marker="|", markersize=8, color=colour, markeredgewidth=1.5, zorder=3)
        ax.plot([worst], [y], marker="o", markersize=5.5, markerfacecolor="white", markeredgecolor=colour, zorder=4)
        ax.plot([p50], [y], marker=marker, markersize=6.5, color=colour, markeredgecolor="white", markeredgewidth=0.6,
                zorder=5)
        if cell.status == "wrong":
            style.cross_out(ax, p50, y)
        ax.text(-0.025, y, cell.label, transform=ax.get_yaxis_transform(), ha="right", va="center", fontsize=7.5,
                color=style.text_colour(cell))
        ax.text(1.025, y, f"{time_text(p50)} to {time_text(worst)}", transform=ax.get_yaxis_transform(), va="center",
                fontsize=7)
        rows.append((job.task, job.scene, job.n, job.where.column, cell.label, cell.library, cell.status,
                     int(cell.frame_stats["n"]), *marks, *(float(cell.frame_stats[name]) for name in COLUMNS[-2:])))
    ax.set_ylim(len(found) - 0.4, -0.6)
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.grid(axis="y", visible=False)
    ax.set_xlabel(METRICS["frame"].axis)
    ax.set_title(f"{job.scene} {job.n:,} · {job.where}", fontsize=9.5 * min(1, 50 / len(job.scene)), pad=14)


def draw_all(run, task, where, jobs):
    columns = min(2, len(jobs))
    lines = [jobs[start:start + columns] for start in range(0, len(jobs), columns)]
    heights = [1.15 + ROW * max(len(cells) for _, cells, *_ in line) for line in lines]
    width, full = LEFT + PANEL + RIGHT, sum(heights)
    figure = style.plt.figure(figsize=(columns * width, full))
    rows, notes, top = [], [], full
    for line, height in zip(lines, heights):
        for column, (job, cells, left_out, wrong) in enumerate(line):
            panel = ROW * len(cells)
            ax = figure.add_axes(((column * width + LEFT) / (columns * width), (top - 0.5 - panel) / full,
                                  PANEL / (columns * width), panel / full))
            draw_panel(ax, job, cells, rows)
            notes += left_out_note(left_out, f"ways to play {job}") + wrong
        top -= height
    return Picture(f"{NAME}_{task}_{where.column}", figure, f"{TITLE}: {run.tasks[task].title}, {where}",
                   f"Median and worst frame of {len(rows)} ways to play scenes of {task}.", COLUMNS, rows, notes)


def draw(run):
    groups = {}
    for job in largest_jobs(run.jobs):
        cells = [c for c in run.of(job) if len(c.frames) >= MIN_FRAMES and not c.lacks_effect]
        if cells:
            shown, left_out = choose(cells)
            groups.setdefault((job.task, job.where), []).append((job, shown, left_out, wrong_notes(cells)))
    if not groups:
        raise Skip(f"no scene of {MIN_FRAMES} or more frames was timed (bench/configs/policies.toml does)")
    return [draw_all(run, task, where, jobs) for (task, where), jobs in groups.items()]
