"""Error against condition number, with bounds: does a kernel lose digits as theory says?"""

from .. import labels, style
from ..kernels import MIN_ERROR
from ..picture import Picture, Skip

NAME = "condition"
TITLE = "Error against condition number"
HOW_TO_READ = (
    "Lower is better. Each line is the worst relative error of one kernel over all cases of one decade of the condition "
    "number (extent over distance), up to 10^20, beyond what doubles tell apart; the CSV file of scripts/plot has more. An error of 1 leaves no digit, and what is above 20 is drawn at 20. Hollow marks on "
    "dashed lines are peers. Dots and dashes: the bound that a certified kernel itself gave there, which its error may "
    "not pass. Dotted: u times the condition and u times its square, u = 2^-53."
)
COLUMNS = ("task", "kernel", "library", "log10_condition", "n", "max_rel_err", "bound")
FLOOR, CEILING = MIN_ERROR, 20.0
MARKS = 12  # on a line, about
LAST = 20  # decade that is drawn


def lines_of(run):
    """{task: {(ours, library, kernel, promise): {decade: (n, error, bound)}}} of those with two decades or more that are drawn."""
    tasks = {task: {} for task in dict.fromkeys(point.task for point in run.kernels)}
    for row in run.source["kernel_conditions"]:
        key = (not row["is_peer"], row["library"], row["kernel"], row["promise"])
        tasks[row["task"]].setdefault(key, {})[float(row["log10_condition"])] = (
            int(row["n"]), float(row["max_rel_err"]), float(row["bound"]))
    return {task: {key: line for key, line in lines.items() if len([decade for decade in line if decade <= LAST]) >= 2} for task, lines in tasks.items()}


def draw(run):
    pictures = []
    for task, lines in lines_of(run).items():
        if not lines:
            continue
        figure, (ax,) = style.panels(1, width=6.8, height=4.6, labels_right=1.9)
        decades = sorted({d for line in lines.values() for d in line if d <= LAST})
        ax.set_yscale("log")
        ax.set_ylim(FLOOR / 3, 30)
        ax.set_xlim(decades[0] - 0.3, decades[-1] + 0.3)
        ax.xaxis.set_major_locator(style.MaxNLocator(8, integer=True))
        for power in (1, 2):
            ys = [FLOOR * 10.0 ** min(power * d, 300) for d in decades]
            ax.plot(decades, ys, color="#888888", linestyle=":", linewidth=1)
        rows, ends = [], []
        looks = style.looks({kernel for ours, _, kernel, _ in lines if ours})
        for (ours, library, kernel, promise), line in sorted(lines.items(), key=lambda item: (not item[0][0], item[0][2])):
            colour, marker = looks[kernel] if ours else style.look(run.peers[library])
            rows += [(task, kernel, library, x, *line[x]) for x in sorted(line)]
            xs = [x for x in sorted(line) if x <= LAST]
            ys = [min(max(line[x][1], FLOOR), CEILING) for x in xs]
            ax.plot(xs, ys, color=colour, marker=marker, markersize=4, markevery=max(1, len(xs) // MARKS), linewidth=1.3, linestyle="-" if ours else "--",
                    markerfacecolor=colour if ours else "white")
            if promise == "certified":
                bound = [max(line[x][2], FLOOR) for x in xs]
                ax.plot(xs, bound, color=colour, linewidth=1, linestyle="-.")
                ends.append((xs[-1], bound[-1], f"{kernel}: its bound", style.readable(colour)))
            ends.append((xs[-1], ys[-1], kernel, style.readable(colour)))
        style.title(ax, task)
        ax.set_xlabel("log10 of the condition number L/d")
        ax.set_ylabel("worst relative error")
        labels.at_line_ends(ax, ends)
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
                                f"Worst relative error of {len(lines)} kernels of {task} by decade of the condition number.", COLUMNS, rows))
    if not pictures:
        raise Skip("no distance kernel was judged over more than one decade of condition numbers")
    return pictures
