"""What more threads give each contender, against itself with one thread."""

from .. import labels, style
from ..findings import THREADS
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import TOTAL
from ..selection import MAX_LINES, wrong_notes
from boxwood.results.words import ratio_text

NAME = "thread_scaling"
TITLE = "What threads give"
HOW_TO_READ = (
    "Higher is better; the dotted line is ideal. Each point is a contender's time with one thread over "
    "its time with t, paired within rounds; bars are the intervals that decided."
)
COLUMNS = ("task", "scene", "n", "variant", "library", "status", "threads", "gain", "gain_lo", "gain_hi", "verdict",
           "rounds")


def lines_of(run):
    """{(task, scene, seed, n): [[comparisons with one thread, by threads]]}, a line per contender and executor."""
    groups = {}
    for row in run.family(THREADS):
        cell = row.b
        if row.phase != cell.total or cell.lacks_effect or row.verdict == "wrong":
            continue
        job = cell.job
        lines = groups.setdefault((job.task, job.scene, job.seed, job.n), {})
        lines.setdefault((cell.contender, cell.precision, cell.executor), []).append(row)
    return {key: [sorted(line, key=lambda row: row.b.job.where.threads) for line in lines.values()]
            for key, lines in groups.items()}


def best_lines(lines):
    """The fastest of each of our builders and every peer, at most MAX_LINES."""
    kept, families = [], set()
    for line in sorted(lines, key=lambda line: line[-1].b.median(TOTAL)):
        cell = line[-1].b
        if cell.ours and cell.family in families:
            continue
        families.add(cell.family)
        kept.append(line)
    return kept[:MAX_LINES]


def draw_panel(ax, job, lines, rows):
    ends, most, lowest, highest = [], 1, 1.0, 1.0
    for place, line in enumerate(lines):
        last = line[-1].b
        gains = [(row.b.job.where.threads, row.gain) for row in line]
        rows += [(job.task, job.scene, job.n, row.b.label, row.b.library, row.b.status, threads, gain.mid, gain.lo, gain.hi,
                  row.verdict, row.rounds) for row, (threads, gain) in zip(line, gains)]
        ax.plot([1, *(t for t, _ in gains)], [1.0, *(g.mid for _, g in gains)], **style.point_style(last, 5.5),
                linewidth=1.4, zorder=3)
        for x, gain in gains:
            if gain.known:  # set aside a little, so that bars of neighbours do not cover each other
                aside = x * (1 + 0.006 * (place - (len(lines) - 1) / 2))
                ax.plot([aside, aside], [gain.lo, gain.hi], color=style.look(last)[0], linewidth=1)
        x, gain = gains[-1]
        ends.append((x, gain.mid, f"{last.label}  {ratio_text(gain.mid)}x", style.text_colour(last)))
        most = max(most, x)
        lowest = min(lowest, *(g.lo if g.known else g.mid for _, g in gains))
        highest = max(highest, *(g.hi if g.known else g.mid for _, g in gains))
    ax.plot((1, most), (1, most), color="#888888", linestyle=":", linewidth=1.2)
    ends.append((most, most, "ideal", "#666666"))
    ax.set_xlim(1 - 0.04 * most, most * 1.03)
    ax.set_ylim(min(0.9, lowest * 0.95), max(highest, most) * 1.05)
    ax.set_xticks(sorted({1, *(row.b.job.where.threads for line in lines for row in line)}))
    style.title(ax, f"{job.scene} {job.n:,} · {job.task} · {lines[0][-1].b.task.total_title}")
    ax.set_xlabel(METRICS["threads"].axis)
    ax.set_ylabel(METRICS["thread_scaling"].axis)
    return ends


def draw(run):
    largest, by_task = {}, {}
    for (task, scene, seed, n), lines in lines_of(run).items():
        if n >= largest.get((task, scene, seed), (0, None))[0]:
            largest[task, scene, seed] = (n, lines)
    for (task, _, _), (_, lines) in sorted(largest.items()):
        lines = best_lines(lines)
        by_task.setdefault(task, []).append((lines[0][-1].a.job, lines))
    if not by_task:
        raise Skip("no contender was timed with one thread and with more")
    pictures = []
    for task, panels in by_task.items():
        figure, axes = style.panels(len(panels), width=4.1, labels_right=2.1)
        rows, notes = [], []
        for ax, (job, lines) in zip(axes, panels):
            labels.at_line_ends(ax, draw_panel(ax, job, lines, rows))
            notes += wrong_notes([cell for cell in run.cells if cell.job.scene == job.scene and cell.job.task == task])
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}", f"Time on one thread over the time on several threads, for {task}.",
                                COLUMNS, rows, notes))
    return pictures
