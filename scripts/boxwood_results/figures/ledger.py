"""The effects ledger: where a frame's time goes, stage by stage, beside the same with all stages."""

from .. import labels, style
from ..moving import played_scenes
from ..picture import Picture, Skip
from boxwood.results.words import time_text, time_tick

NAME = "ledger"
TITLE = "Only what the scene requires, against ourselves"
HOW_TO_READ = (
    "Shorter is better. Each pair of bars is one scene: the stages that it requires, and the same answers with all "
    "stages. A piece is the time of one stage in a mean frame; pieces too narrow for their name stand below "
    "the bar. What neither runs is named: it has no call, no time and no memory."
)
COLUMNS = ("scene", "n", "threads", "played", "stage", "required", "calls", "items", "ns_a_frame", "share", "bytes")
OF_EFFECTS = "#999933"
# Of the other stages, in the order of the plan.
COLOURS = ("#DDCC77", "#44AA99", "#88CCEE", "#0072B2", "#6699CC", "#56B4E9", "#332288", "#882255", "#CC79A7", "#D55E00",
           "#E69F00", "#AA4499", "#117733", "#009E73", "#7F7F7F", "#000000")
WIDTH, LEFT, PANEL = 10.5, 1.15, 7.6  # inches
BAR, STEP, LINE, HEAD, FOOT = 0.27, 0.38, 0.13, 0.3, 0.62
LETTERS = 135  # of a line of small text


def colours_of(cell):
    """{stage: colour}, the same for any scene of one plan."""
    others = [name for name, stage in cell.stages.items() if not stage["effect"]]
    places = {name: place for place, name in enumerate(others)}
    return {name: COLOURS[places[name] % len(COLOURS)] if name in places else OF_EFFECTS for name in cell.stages}


def is_dark(colour):
    red, green, blue = style.colors.to_rgb(colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue < 0.5


def costs(cell):
    """[(stage, ns a frame)] of the stages that ran."""
    return [(name, float(stage["ns"])) for name, stage in cell.stages.items() if stage["calls"]]


def frame_of(cell):
    """Time of a frame by its stages."""
    return float([stage["until_ns"] for stage in cell.stages.values()][-1])


def wrapped(words, lead, width):
    """The words behind `lead`, joined by commas, in lines of at most `width` letters."""
    lines, line = [], lead
    for place, word in enumerate(words):
        word += "," if place + 1 < len(words) else ""
        if len(line) + len(word) > width and line != lead:
            lines.append(line)
            line = "   "
        line += " " + word
    return [*lines, line]


def draw_bar(ax, cell, y, limit):
    """One stacked bar; gives the stages that are too narrow to be named inside."""
    left, narrow, colours = 0.0, [], colours_of(cell)
    pixels = ax.get_window_extent().width / limit
    for name, ns in costs(cell):
        colour = colours[name]
        ax.barh(y, ns, left=left, height=BAR, color=colour, edgecolor="white", linewidth=0.8)
        if labels.text_size(ax.figure, name)[0] + 8 < ns * pixels:
            ax.text(left + ns / 2, y, name, ha="center", va="center", fontsize=labels.SIZE,
                    color="white" if is_dark(colour) else style.INK, path_effects=() if is_dark(colour) else labels.HALO)
        else:
            narrow.append((name, ns))
        left = float(cell.stages[name]["until_ns"])
    ax.text(left, y, f" {time_text(frame_of(cell))} a frame", va="center", fontsize=8, weight="bold")
    return narrow


def narrow_lines(narrow):
    return wrapped([f"{name} {time_text(ns)}" for name, ns in narrow], "", LETTERS) if narrow else []


def idle_lines(scene):
    """What neither way to play the scene runs, in lines."""
    both = scene.all_stages.stages if scene.all_stages else {}
    idle = [stage for name, stage in scene.required.stages.items()
            if not stage["calls"] and not both.get(name, stage)["calls"]]
    effects = [stage["effect"] for stage in idle if stage["effect"]]
    stages = [stage["stage"] for stage in idle if not stage["effect"]]
    groups = (("not required (0):", stages), ("effects not required (0):", effects))
    return [line for lead, names in groups if names for line in wrapped(names, lead, LETTERS)]


def sides_of(scene):
    sides = [("required", scene.required), ("all stages", scene.all_stages)]
    return [(words, cell) for words, cell in sides if cell and cell.stages]


def height_of(scene):
    """Inches that the bars and their small text take: of each side at most as many lines as all its stages."""
    return sum(STEP + LINE * len(narrow_lines(costs(cell))) for _, cell in sides_of(scene))


def draw_scene(ax, scene, rows):
    sides = sides_of(scene)
    limit = 1.14 * max(frame_of(cell) for _, cell in sides)
    ax.set_xlim(0, limit)
    ax.set_ylim(height_of(scene), -0.02)
    top = 0.02
    for words, cell in sides:
        y = top + BAR / 2
        narrow = draw_bar(ax, cell, y, limit)
        ax.text(-0.012, y, words, transform=ax.get_yaxis_transform(), ha="right", va="center", fontsize=8.5)
        for place, line in enumerate(narrow_lines(narrow)):
            ax.text(0, y + BAR / 2 + 0.02 + LINE * place, line.strip(), va="top", fontsize=6.8, color="#555555")
        top += STEP + LINE * len(narrow_lines(narrow))
        rows += [(scene.job.scene, scene.job.n, scene.job.where.column, words.replace(" ", "_"), name,
                  int(stage["required"]), int(stage["calls"]), int(stage["items"]), float(stage["ns"]),
                  float(stage["share"]), int(stage["bytes"]))
                 for name, stage in cell.stages.items()]
    ratio = f": all stages take {scene.all_stages_cost.ratio.text} as long" if scene.all_stages_cost else ""
    ax.set_title(f"{scene.job}".replace(f" · {scene.job.task}", "") + ratio, fontsize=9.5)
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.grid(axis="y", visible=False)
    ax.xaxis.set_major_locator(style.MaxNLocator(6))
    ax.xaxis.set_major_formatter(lambda value, _: time_tick(value) if value else "0")
    ax.tick_params(axis="x", labelsize=7.5)
    for place, line in enumerate(idle_lines(scene)):
        ax.annotate(line, (0, 0), xycoords="axes fraction", xytext=(0, -22 - 9 * place), textcoords="offset points",
                    fontsize=6.8, color="#777777", va="top")


def draw(run):
    scenes = [scene for scene in played_scenes(run) if scene.required.stages]
    if not scenes:
        raise Skip("no scene was played with its queries (bench/configs/effects.toml does)")
    heights = [HEAD + FOOT + height_of(scene) for scene in scenes]
    figure = style.plt.figure(figsize=(WIDTH, sum(heights)))
    rows, top = [], sum(heights)
    for scene, height in zip(scenes, heights):
        ax = figure.add_axes((LEFT / WIDTH, (top - height + FOOT) / sum(heights), PANEL / WIDTH,
                              (height - HEAD - FOOT) / sum(heights)))
        draw_scene(ax, scene, rows)
        top -= height
    return [Picture(NAME, figure, TITLE, f"Time of a frame by stage in {len(scenes)} scenes, with what is required and with all stages.", COLUMNS, rows)]
