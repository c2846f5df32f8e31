"""Several result files over time: what the newest finds, in all files of one machine. Machines are never pooled."""

from . import labels, style
from .checkout import machine as machine_of
from .metrics import METRICS
from .picture import Picture, cell_text
from .run import TOTAL
from boxwood.results.words import time_text

TITLE = "Over commits"
HOW_TO_READ = (
    "Lower is better. Each panel is a headline of the newest file: our contender and its rival in every file of this machine, in "
    "the order of time. Marks are medians, bars reach from the least time of the rounds to their 95th percentile. The rival is the "
    "control: where it moves too, the machine did. `boxwood compare` decides between two files, round by round."
)
COLUMNS = ("cell", "phase", "created", "commit", "rounds", "median_ns", "min_ns", "p95_ns")
MAX_PANELS = 12


def created(run):
    return cell_text(run.source.attrs.get("created_utc"))


def commit(run):
    return run.source["env"][0]["git_commit"][:8]


def of_machines(runs):
    """{(host, processor, its instruction sets): its files by time}."""
    machines = {}
    for run in sorted(runs, key=created):
        for row in run.source["env"]:
            machines.setdefault(machine_of(row), []).append(run)
    return {machine: of for machine, of in machines.items() if len(of) > 1}


def headlines(run):
    """[(our cell, the rival's)] of the newest file."""
    found = {}
    for finding in run.findings:
        if finding.is_headline and finding.ours is not None and finding.rival is not None:
            found.setdefault(finding.ours.name, (finding.ours, finding.rival))
    return list(found.values())[:MAX_PANELS]


def draw_line(ax, runs, known, cell, rows):
    """One contender in every file that timed it; gives its last point, or none."""
    colour = style.text_colour(cell)
    points = []
    for place, (run, cells) in enumerate(zip(runs, known)):
        there = cells.get(cell.name)
        span = there.spread(there.total) if there is not None else None
        if span is None:
            continue
        points.append((place, there.median(TOTAL)))
        ax.plot([place, place], span, color=colour, linewidth=1.2, alpha=0.6, zorder=2)
        rows.append((cell.name, there.total, created(run), commit(run), run.rounds, there.median(TOTAL), *span))
    if points:
        ax.plot(*zip(*points), **style.point_style(cell, 6), linewidth=1.2, zorder=3)
    return [(*point, f"{cell.label}  {time_text(point[1])}", colour) for point in points[-1:]]


def draw_machine(number, machine, runs):
    pairs = headlines(runs[-1])
    if not pairs:
        return None
    known = [{cell.name: cell for cell in run.cells if cell.timed} for run in runs]
    figure, axes = style.panels(len(pairs), width=4.1, labels_right=2.1)
    rows = []
    for ax, pair in zip(axes, pairs):
        ends = [end for cell in pair for end in draw_line(ax, runs, known, cell, rows)]
        shown = [time for line in ax.lines for time in line.get_ydata()]
        style.time_axis(ax.yaxis, min(shown), max(shown))
        ax.set_xlim(-0.3, len(runs) - 0.7)
        ax.set_xticks(range(len(runs)), [f"{commit(run)}\n{created(run)[:10]}" for run in runs], fontsize=7)
        style.title(ax, str(pair[0].job))
        ax.set_ylabel(METRICS["build"].axis if pair[0].task.is_build else f"time of {pair[0].task.total_title}")
        labels.at_line_ends(ax, ends)
    host, processor, _ = machine
    return Picture(f"history_{number}", figure, f"{host}, {processor}",
                   f"Times of {len(pairs)} headlines in {len(runs)} files of {host} over time.", COLUMNS, rows)


def pictures(runs):
    """One for each machine with two files or more."""
    drawn = [draw_machine(number, machine, of) for number, (machine, of) in enumerate(of_machines(runs).items())]
    return [picture for picture in drawn if picture]
