"""Scenes that move: what each frame took, and each stage of it."""

import json
from dataclasses import dataclass, field
from statistics import median

from .findings import STAGES
from .run import ALL_STAGES, REQUIRED, TOTAL
from .selection import largest_jobs

SCREEN_NS = 1e9 / 60


def frame_medians(cell, of=sum):
    """Of each frame the median over the rounds, in order: update and query together, or what `of` makes
    of the two. The median takes out what disturbed one round, not what one frame costs."""
    return [median(of(times) for times in cell.frames[frame]) for frame in sorted(cell.frames)]


def percentile(values, part):
    """As numpy's, of values in any order."""
    values = sorted(values)
    at = part * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


@dataclass
class PlayedScene:
    """A scene on one number of threads, and the ways it was played."""

    job: object
    required: object = None
    all_stages: object = None
    without: dict = field(default_factory=dict)  # effect -> cell
    ratios: dict = field(default_factory=dict)  # cell id of the other way -> Ratio

    def ratio(self):
        """Time of a frame with all stages over that with the required ones; None if it was not compared."""
        return self.all_stages and self.ratios.get(self.all_stages.cell_id)

    def cost(self, effect):
        """Time of a frame with the effect over the same without it; None if it was not compared."""
        return self.ratios.get(self.without[effect].cell_id)


def played_scenes(run, largest=True):
    """What was played with its required stages and answered rightly; of each scene its largest size."""
    played = {}
    for job in largest_jobs(run.jobs) if largest else run.jobs:
        for cell in run.of(job):
            if cell.status == "wrong" or not cell.stages_played:
                continue
            scene = played.setdefault((job, cell.executor), PlayedScene(job))
            if cell.stages_played == REQUIRED:
                scene.required = cell
            elif cell.stages_played == ALL_STAGES:
                scene.all_stages = cell
            else:
                scene.without[cell.stages_played] = cell
    scenes = [scene for scene in played.values() if scene.required]
    for scene in scenes:
        for row in run.family(STAGES, scene.required.total):
            if scene.required in (row.a, row.b):
                other = row.b if row.a is scene.required else row.a
                scene.ratios[other.cell_id] = row.ratio
    return scenes


def moved_share(cell):
    """((effects with their settings), share of the bodies that move) of a scene of one group whose
    effects have one share; None for others."""
    try:
        groups = json.loads(cell.scene_json)["groups"]
    except (ValueError, KeyError, TypeError):
        return None
    if len(groups) != 1 or not groups[0].get("effects"):
        return None
    effects = [dict(effect) for effect in groups[0]["effects"]]
    shares = {float(effect.pop("share", 1)) for effect in effects}
    if len(shares) != 1:
        return None
    words = ", ".join(
        effect.pop("name", "?") + "".join(f" {key} {value:g}" for key, value in sorted(effect.items()))
        for effect in effects
    )
    return f"{groups[0].get('generator', '?')}, {words}", shares.pop()


def frame_ns(cell):
    return cell.median(TOTAL)
