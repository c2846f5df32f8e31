"""How far up their tiers the adaptive kernels had to go, family by family."""

from .. import style
from ..kernels import by_kernel_family
from ..picture import Picture, Skip

NAME = "escalation"
TITLE = "Escalations of the adaptive kernels"
HOW_TO_READ = (
    "Each bar is one family of hard cases: which share of its calls each tier decided. Tier 0 is the cheapest; the "
    "more of the darker colours, the dearer the input."
)
COLUMNS = ("task", "kernel", "cases", "n", "tier_0", "tier_1", "tier_2", "tier_3")
COLOURS = ("#CFE3F1", "#56B4E9", "#0072B2", "#00314D")


def draw(run):
    pictures = []
    for task, points in by_kernel_family(run).items():
        ours = [p for p in points if p.ours and p.supported]
        shares = {(row["kernel"], row["cell_id"]): [float(row[f"share_{k}"]) for k in range(4)]
                  for row in run.source["escalations"] if row["task"] == task}
        adaptive = sorted({kernel for kernel, _ in shares})
        if not adaptive:
            continue
        families = list(dict.fromkeys(p.cases for p in ours))
        height, names, panel = 1.15 + 0.17 * len(families), 2.2, 2.3
        width = (names + panel + 0.2) * len(adaptive)
        figure = style.plt.figure(figsize=(width, height))
        rows = []
        for place, kernel in enumerate(adaptive):
            ax = figure.add_axes((((names + panel + 0.2) * place + names) / width, 0.75 / height, panel / width,
                                  0.17 * len(families) / height))
            for point in [p for p in ours if p.kernel == kernel]:
                y, left = families.index(point.cases), 0.0
                for share, colour in zip(shares.get((kernel, point.cell.cell_id), ()), COLOURS):
                    if share > 0:
                        ax.barh(y, 100 * share, left=left, height=0.78, color=colour)
                    left += 100 * share
                rows.append((task, kernel, point.cases, point.n, *point.tiers))
            ax.set_xlim(0, 100)
            ax.set_ylim(len(families) - 0.4, -0.6)
            ax.set_yticks(range(len(families)), families, fontsize=6.5)
            ax.tick_params(axis="y", length=0)
            ax.grid(False)
            ax.set_xlabel("% of the calls", fontsize=7.5)
            ax.tick_params(axis="x", labelsize=7)
            style.title(ax, kernel)
            ax.title.set_fontsize(8)
            handles = [style.plt.Rectangle((0, 0), 1, 1, color=colour) for colour in COLOURS]
            ax.legend(handles, [f"tier {tier}" for tier in range(4)], loc="upper center", fontsize=6.5, frameon=False,
                      bbox_to_anchor=(0.5, -0.42 / (0.17 * len(families))), ncols=4, handlelength=1, columnspacing=0.8)
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}", f"Which share of the calls each tier of {len(adaptive)} adaptive kernels of {task} decided.",
                                COLUMNS, rows))
    if not pictures:
        raise Skip("no adaptive kernel went beyond its first tier")
    return pictures
