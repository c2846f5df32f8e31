"""Scenes that move: what each frame took, and each stage of it."""

import json
from dataclasses import dataclass, field

from .findings import STAGES
from .run import ALL_STAGES, REQUIRED
from .selection import largest_jobs

SCREEN_NS = 1e9 / 60


@dataclass(frozen=True)
class EffectCost:
    """A row of /effect_costs: an effect, or all stages."""

    what: str
    with_ns: float  # of a frame
    without_ns: float
    extra_ns: float
    comparison: object  # of the two

    @property
    def ratio(self):
        return self.comparison.ratio


@dataclass
class PlayedScene:
    """A scene on one number of threads, and the ways it was played."""

    job: object
    required: object = None
    all_stages: object = None
    effects: list = field(default_factory=list)  # EffectCosts, the most costly first
    all_stages_cost: object = None  # EffectCost; None if it was not compared


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
    scenes = [scene for scene in played.values() if scene.required]
    compared = {(row.a.cell_id, row.b.cell_id): row for row in run.family(STAGES) if row.phase == row.b.total}
    for scene in scenes:
        for row in run.source["effect_costs"]:
            cost = EffectCost(row["what"], float(row["with_ns"]), float(row["without_ns"]), float(row["extra_ns"]),
                              compared[row["cell_without"], row["cell_with"]])
            if row["cell_without"] == scene.required.cell_id:
                scene.all_stages_cost = cost
            elif row["cell_with"] == scene.required.cell_id:
                scene.effects.append(cost)
        scene.effects.sort(key=lambda cost: -cost.ratio.mid)
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
