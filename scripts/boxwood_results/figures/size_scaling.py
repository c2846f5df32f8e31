"""Time against the number of items, with a fitted exponent."""

import math
from dataclasses import dataclass

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import TOTAL
from ..selection import MAX_LINES, wrong_notes

NAME = "size_scaling"
TITLE = "How time grows with n"
HOW_TO_READ = (
    "Lower is better; both axes are logarithmic, so a straight line is a power of n. Beside each name "
    "is the fitted exponent, with its interval over the rounds where there are enough rounds. The dotted "
    "guide grows as n log n. The column off_line says how far the farthest time is from the fit."
)
MIN_SIZES = 4
COLUMNS = ("task", "scene", "threads", "phase", "variant", "library", "status", "n", "median_ns", "exponent",
           "exponent_lo", "exponent_hi", "off_line")
FIT_COLUMNS = ("exponent", "exponent_lo", "exponent_hi", "off_line")


def lines_of(run, task, scene, seed, where):
    """{(contender, precision, executor): [cells by rising n]} with enough sizes."""
    lines = {}
    for cell in run.cells:
        job = cell.job
        if (job.task, job.scene, job.seed, job.where) == (task, scene, seed, where) and cell.timed \
                and not cell.lacks_effect:
            lines.setdefault((cell.contender, cell.precision, cell.executor), []).append(cell)
    return [sorted(line, key=lambda c: c.job.n) for line in lines.values() if len(line) >= MIN_SIZES]


def choose_lines(lines, phase):
    """The best of each family at the largest n, then the rest of the peers, at most MAX_LINES."""
    order, families = [], set()
    for line in sorted(lines, key=lambda line: (-line[-1].job.n, line[-1].median(phase))):
        order.append((line[-1].family in families, len(order), line))
        families.add(line[-1].family)
    kept = [line for again, _, line in sorted(order, key=lambda o: o[:2]) if not (again and line[-1].ours)]
    return kept[:MAX_LINES]


@dataclass(frozen=True)
class Fit:
    """A row of /size_scaling; NaN where there is none, as of wrong answers."""

    mid: float = math.nan
    lo: float = math.nan
    hi: float = math.nan
    off_line: float = math.nan


def fits_of(run):
    """{(cell id of the largest size, phase): Fit}."""
    return {
        (int(row["cell_id"]), row["phase"]): Fit(*(float(row[name]) for name in FIT_COLUMNS))
        for row in run.source["size_scaling"]
    }


def exponent_text(fit):
    if fit.mid != fit.mid:
        return "wrong"
    if fit.lo != fit.lo:
        return f"n^{fit.mid:.2f}"
    return f"n^{fit.mid:.2f} ({fit.lo:.2f} to {fit.hi:.2f})"


def phase_name(cell, phase):
    return cell.total if phase == TOTAL else phase


def phases_of(task):
    """Those worth a panel of their own."""
    return (TOTAL,) if task.in_frames or task.is_build else ("build", "query", TOTAL)


def draw_panel(ax, lines, phase, known_fits, rows):
    ends, all_times, sizes = [], [], set()
    for line in lines:
        fit = known_fits.get((line[-1].cell_id, phase_name(line[-1], phase)), Fit())
        x, y = [cell.job.n for cell in line], [cell.median(phase) for cell in line]
        sizes.update(x)
        all_times += y
        cell = line[-1]
        ax.plot(x, y, **style.point_style(cell, 5.5), linewidth=1.4, zorder=3)
        for size, time, at in zip(x, y, line):
            if at.status == "wrong":
                style.cross_out(ax, size, time)
            rows.append((at.job.task, at.job.scene, at.job.where.column, phase_name(at, phase), at.label, at.library, at.status, size,
                         time, fit.mid, fit.lo, fit.hi, fit.off_line))
        ends.append((x[-1], y[-1], f"{cell.label}  {exponent_text(fit)}", style.text_colour(cell)))
    low, high = min(sizes), max(sizes)
    start = min(all_times) / 1.6
    guide = [start * (n * math.log(n)) / (low * math.log(low)) for n in (low, high)]
    ax.plot((low, high), guide, color="#888888", linestyle=":", linewidth=1.2, zorder=1)
    ends.append((high, guide[1], "guide: n log n", "#666666"))
    style.count_axis(ax.xaxis, low, high, room=0.03)
    style.time_axis(ax.yaxis, min([*all_times, *guide]), max([*all_times, *guide]))
    job = lines[0][-1].job
    style.title(ax, f"{job.scene} · {job.task} · {job.where} · {phase_name(lines[0][-1], phase)}")
    ax.set_xlabel(METRICS["n"].axis)
    ax.set_ylabel(f"time of {lines[0][-1].task.total_title} (lower is better)" if phase == TOTAL else METRICS[phase].axis)
    return ends


def draw(run):
    groups = sorted({(job.task, job.scene, job.seed, job.where) for job in run.jobs})
    by_task = {}
    for group in groups:
        lines = lines_of(run, *group)
        for phase in phases_of(run.tasks[group[0]]):
            usable = [line for line in lines if all(cell.has(phase) for cell in line)
                      and (phase != "build" or all(cell.keeps_structure for cell in line))]
            if usable:
                by_task.setdefault(group[0], []).append((choose_lines(usable, phase), phase))
    if not by_task:
        raise Skip(f"no scene was timed with {MIN_SIZES} or more sizes")
    pictures = []
    for task, all_panels in by_task.items():
        figure, axes = style.panels(len(all_panels), width=4.1, labels_right=2.75)
        rows = []
        for ax, (lines, phase) in zip(axes, all_panels):
            ends = draw_panel(ax, lines, phase, fits_of(run), rows)
            labels.at_line_ends(ax, ends)
        cells = [cell for lines, _ in all_panels for line in lines for cell in line]
        pictures.append(
            Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
                    f"Time against n of {task} on log axes, with fitted exponents of n.", COLUMNS, rows,
                    sorted(set(wrong_notes(cells))))
        )
    return pictures
