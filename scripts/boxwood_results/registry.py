"""The figures, and what is measured: label, unit and which way is better."""

from dataclasses import dataclass

from .figures import (
    accuracy, builder_tradeoff, condition, device_gains, effect_cost, escalation, forest, frame_times, kernel_cost, ledger,
    moved_share, robustness, run_health, size_scaling, thread_scaling, tree_quality, tree_quality_over_time, work,
)
from .picture import Skip

# In the order of the report. To add one: a module in figures/ with NAME, TITLE, HOW_TO_READ and
# draw(run) -> [Picture] that raises Skip where the run lacks the data, and its name here.
MODULES = (forest, builder_tradeoff, tree_quality, size_scaling, thread_scaling, device_gains, work, frame_times, moved_share,
           tree_quality_over_time, ledger, effect_cost, accuracy, robustness, condition, escalation, kernel_cost,
           run_health)


@dataclass(frozen=True)
class Drawn:
    name: str
    title: str
    how_to_read: str
    pictures: list
    skipped: str = ""  # why there is no picture


FIGURES = {module.NAME: module for module in MODULES}


def draw(name, run):
    module = FIGURES[name]
    try:
        pictures, skipped = module.draw(run), ""
    except Skip as reason:
        pictures, skipped = [], str(reason)
    return Drawn(name, module.TITLE, module.HOW_TO_READ, pictures, skipped)
