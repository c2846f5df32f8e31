"""Scenes that move: what each frame took, and each stage of it."""

import json
from dataclasses import dataclass, field
from statistics import median

from . import stats
from .findings import ratio_text, time_text
from .run import SCENE_ASKS, TOTAL
from .selection import largest_jobs

CALLED_FOR, EVERYTHING, WITHOUT = "required", "all_stages", "required.without_"
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
    """A scene with everything it tasks, on one number of threads, and the ways it was played."""

    job: object
    required: object = None
    everything: object = None
    without: dict = field(default_factory=dict)  # effect -> cell

    def ratio(self, cell):
        """Time of a frame of `cell` over that of what is called for."""
        return stats.paired_ratio(cell.rounds(TOTAL), self.required.rounds(TOTAL))

    def price(self, effect):
        """Time of a frame with the effect over the same without it."""
        return stats.paired_ratio(self.required.rounds(TOTAL), self.without[effect].rounds(TOTAL))


def played_scenes(run, largest=True):
    """What was played as it is called for and answered rightly; of each scene its largest size."""
    played = {}
    for job in largest_jobs(run.jobs) if largest else run.jobs:
        if job.task != SCENE_ASKS:
            continue
        for cell in run.of(job):
            if cell.status == "wrong":
                continue
            scene = played.setdefault((job, cell.executor), PlayedScene(job))
            if cell.contender == CALLED_FOR:
                scene.required = cell
            elif cell.contender == EVERYTHING:
                scene.everything = cell
            elif cell.contender.startswith(WITHOUT):
                scene.without[cell.contender.removeprefix(WITHOUT)] = cell
    return [scene for scene in played.values() if scene.required]


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


def interval_text(ratio):
    text = ratio_text(ratio.mid)
    return f"{text} ({ratio_text(ratio.lo, '')} to {ratio_text(ratio.hi, '')})" if ratio.known else text


def frame_ns(cell):
    return cell.median(TOTAL)


def take_home(run):
    """Sentences: only what is called for against everything on, and what effects cost."""
    lines = []
    for scene in played_scenes(run):
        said = f"{scene.job}: a frame of what the scene calls for takes {time_text(frame_ns(scene.required))}"
        if scene.everything:
            said += f"; with everything on {interval_text(scene.ratio(scene.everything))} as long"
        lines.append(said)
        prices = [f"{effect} {ratio_text(scene.price(effect).mid)}" for effect in sorted(scene.without)]
        if prices:
            lines.append(f"{scene.job}: with an effect over without it: {', '.join(prices)}")
    return lines
