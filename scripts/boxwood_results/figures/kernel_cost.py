"""What accuracy costs where people pay for it: whole queries with each kernel under the same tree."""

from .. import style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..selection import largest_jobs
from ..words import time_text

NAME = "kernel_cost"
TITLE = "What a kernel costs in a whole query"
HOW_TO_READ = (
    "Shorter is better. Each bar is the time of one whole query with one kernel under the same tree; the number is its "
    "time over that of the fastest of its tree. A hollow bar answered wrongly: how many answers are missing or too many "
    "stands beside it."
)
COLUMNS = ("task", "scene", "n", "threads", "tree", "kernel", "status", "query_ns", "times_the_fastest", "missing", "extra")
TASKS = ("triangle_pairs", "rays_closest", "rays_any")


def groups(run):
    """{(job, tree): cells that differ by kernel alone}."""
    found = {}
    for job in largest_jobs(run.jobs):
        if job.task not in TASKS:
            continue
        for cell in run.of(job):
            if cell.ours and cell.kernel:
                tree = cell.label.replace("." + cell.kernel, "")
                found.setdefault((job, tree), []).append(cell)
    return {key: cells for key, cells in found.items() if len({c.kernel for c in cells}) > 1}


def draw(run):
    by_task = {}
    for (job, tree), cells in groups(run).items():
        by_task.setdefault(job.task, []).append((job, tree, sorted(cells, key=lambda c: c.median("query"))))
    if not by_task:
        raise Skip("no whole query was run with two kernels under the same tree")
    pictures = []
    for task, jobs in by_task.items():
        most = max(len(cells) for *_, cells in jobs)
        figure, axes = style.panels(len(jobs), width=6.0, height=1.25 + 0.26 * most)
        rows = []
        for ax, (job, tree, cells) in zip(axes, jobs):
            for y, cell in enumerate(cells):
                time, wrong = cell.median("query"), cell.status == "wrong"
                colour = style.look("binned_sah")[0]  # of all of ours: the names tell them apart
                ax.barh(y, time, height=0.7, color="white" if wrong else colour, edgecolor=colour, linewidth=1.2)
                lost = f"  {int(cell.check['missing']):,} missing, {int(cell.check['extra']):,} extra" if wrong else ""
                ax.text(time, y, f" {cell.times_fastest:.2f}x{lost}", va="center", fontsize=7.5)
                rows.append((job.task, job.scene, job.n, job.threads, tree, cell.kernel, cell.status, time,
                             cell.times_fastest, int(cell.check["missing"]) if cell.check is not None else None,
                             int(cell.check["extra"]) if cell.check is not None else None))
            ax.set_yticks(range(len(cells)), [cell.kernel for cell in cells], fontsize=7.5)
            ax.set_ylim(len(cells) - 0.4, -0.6)
            ax.set_xlim(0, 1.45 * max(cell.median("query") for cell in cells))
            ax.xaxis.set_major_formatter(lambda value, _: time_text(value) if value else "0")
            ax.xaxis.set_major_locator(style.MaxNLocator(4))
            ax.grid(axis="y", visible=False)
            ax.set_title(f"{job}\n{tree}", fontsize=8.5)
            ax.set_xlabel(METRICS["query"].axis, fontsize=8)
            box = ax.get_position()
            ax.set_position([box.x0 + 0.28 * box.width, box.y0, 0.72 * box.width, box.height])
        said = "; ".join(f"{row[5]} on {row[1]}: {row[8]:.2f} times the fastest" for row in rows)
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {task}", f"{said}.", COLUMNS, rows))
    return pictures
