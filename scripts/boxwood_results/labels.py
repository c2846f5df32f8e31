"""Direct labels that do not overlap: beside points, and at the ends of lines."""

import math

import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Bbox

SIZE = 7.5  # points
HALO = (withStroke(linewidth=2.2, foreground="white", alpha=0.85),)  # texts stay readable on lines
RINGS = (7, 13, 21, 31, 43, 57)  # distances tried, in points
DIRECTIONS = (0, 180, 90, 270, 45, 315, 135, 225, 20, 340, 160, 200)  # degrees, the best first


def text_size(figure, text):
    """Width and height in pixels."""
    probe = figure.text(0, 0, text, fontsize=SIZE)
    extent = probe.get_window_extent(figure.canvas.get_renderer())
    probe.remove()
    return extent.width, extent.height


def overlap(a, b):
    width = min(a.x1, b.x1) - max(a.x0, b.x0)
    height = min(a.y1, b.y1) - max(a.y0, b.y0)
    return max(width, 0) * max(height, 0)


def candidates(x, y, width, height, pixels):
    """(distance, box) of the places tried for a label at pixel (x, y)."""
    for ring in RINGS:
        for degrees in DIRECTIONS:
            along_x = math.cos(math.radians(degrees))
            along_y = math.sin(math.radians(degrees))
            centre_x = x + along_x * (ring * pixels + width / 2)
            centre_y = y + along_y * (ring * pixels + height / 2)
            yield ring, Bbox.from_bounds(centre_x - width / 2, centre_y - height / 2, width, height)


def along(start, end, every):
    """Points from `start` to `end`, both pixels, at most `every` pixels apart."""
    count = max(1, math.ceil(math.dist(start, end) / every))
    return [(start[0] + t / count * (end[0] - start[0]), start[1] + t / count * (end[1] - start[1]))
            for t in range(count + 1)]


def held(box, points):
    """How many of the points are within the box."""
    x, y = np.reshape(points, (-1, 2)).T
    return np.count_nonzero((x >= box.x0) & (x <= box.x1) & (y >= box.y0) & (y <= box.y1))


def apart(box, x, y):
    """How far a point is from a box."""
    return math.hypot(max(box.x0 - x, 0, x - box.x1), max(box.y0 - y, 0, y - box.y1))


def beside_points(ax, labels, later=(), lines=()):
    """labels: [(x, y, text, colour)] in data units; later: more of them that choose last; lines: what is
    drawn besides, as [(x, y), ...] each. Each label goes to the nearest free place within the axes, with a
    thin line to its point unless it is right beside it and clearly beside no other. Those in a crowd choose
    first; texts keep clear of other texts, points and lines as far as there is room, and thin lines of texts
    and points."""
    figure = ax.figure
    pixels = figure.dpi / 72
    frame = ax.get_window_extent()
    all_labels = [*labels, *later]
    marks = [ax.transData.transform((x, y)) for x, y, *_ in all_labels]
    taken = [Bbox.from_bounds(x - 4 * pixels, y - 4 * pixels, 8 * pixels, 8 * pixels) for x, y in marks]
    corners = [[ax.transData.transform(point) for point in line] for line in lines]
    drawn = [step for line in corners for a, b in zip(line, line[1:]) for step in along(a, b, 4 * pixels)]

    def crowd(index):
        if index >= len(labels):
            return 0
        x, y = marks[index]
        return sum(abs(x - a) < 90 * pixels and abs(y - b) < 25 * pixels for a, b in marks[: len(labels)])

    for index in sorted(range(len(all_labels)), key=crowd, reverse=True):
        (x, y, text, colour), (at_x, at_y) = all_labels[index], marks[index]
        width, height = text_size(figure, text)
        best, least = None, math.inf
        steps_drawn = np.array(drawn)
        for ring, box in candidates(at_x, at_y, width, height, pixels):
            if ring >= least:  # nor is any that follows nearer
                break
            outside = box.width * box.height - overlap(box, frame)
            cost = ring + 10 * (sum(overlap(box, other) for other in taken) + outside)
            cost += 2 * held(box, steps_drawn)
            if ring > RINGS[1]:
                steps = along((at_x, at_y), ((box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2), 6 * pixels)[1:]
                outer = [step for step in steps if not box.contains(*step)]
                cost += 12 * sum(held(other, outer) for other in taken)
            if cost < least:
                best, least = (ring, box), cost
        ring, box = best
        taken.append(box)
        others = [mark for place, mark in enumerate(marks) if place != index]
        is_joined = ring > RINGS[1] or any(apart(box, *mark) < 1.5 * apart(box, at_x, at_y) for mark in others)
        if is_joined:
            ends = (at_x, at_y), ((box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2)
            drawn += [step for step in along(*ends, 4 * pixels) if not box.contains(*step)]
        ax.annotate(
            text,
            (x, y),
            xytext=((box.x0 - at_x) / pixels, (box.y0 - at_y) / pixels),
            textcoords="offset points",
            fontsize=SIZE,
            color=colour,
            path_effects=HALO,
            zorder=7,
            annotation_clip=False,
            arrowprops=None
            if not is_joined
            else {"arrowstyle": "-", "color": colour, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 3},
        )


def spread(wanted, gap, low, high):
    """Positions near `wanted`, in its order, at least `gap` apart and within [low, high] if they fit:
    neighbours that are too near become a block around their mean."""
    blocks = []  # [sum of (wanted - offset), count]
    for value in sorted(wanted):
        blocks.append([value, 1])
        while len(blocks) > 1:
            (sum_a, n_a), (sum_b, n_b) = blocks[-2], blocks[-1]
            if sum_b / n_b - sum_a / n_a >= gap * n_a:
                break
            blocks[-2:] = [[sum_a + sum_b - gap * n_a * n_b, n_a + n_b]]
    placed = [total / n + gap * k for total, n in blocks for k in range(n)]
    if placed and placed[-1] > high:
        placed = [min(p, high - gap * (len(placed) - 1 - i)) for i, p in enumerate(placed)]
    if placed and placed[0] < low:
        placed = [max(p, low + gap * i) for i, p in enumerate(placed)]
    return placed


def at_line_ends(ax, labels):
    """labels: [(x, y, text, colour)] of last points. They stand in a column right of the axes, each
    joined to its line."""
    pixels = ax.figure.dpi / 72
    frame = ax.get_window_extent()

    def height_of(label):
        return ax.transData.transform(label[:2])[1]

    ends = sorted(labels, key=height_of)
    heights = spread([height_of(end) for end in ends], 10.5 * pixels, frame.y0, frame.y1)
    for (x, y, text, colour), height in zip(ends, heights):
        ax.annotate(
            text,
            (x, y),
            xytext=(1 + 14 * pixels / frame.width, (height - frame.y0) / frame.height),
            textcoords="axes fraction",
            fontsize=SIZE,
            color=colour,
            va="center",
            annotation_clip=False,
            arrowprops={
                "arrowstyle": "-", "color": colour, "linewidth": 0.5, "shrinkA": 1, "shrinkB": 4,
                "relpos": (0, 0.5),
            },
        )
