"""What is plotted: label, unit and which way is better, stated once for axes and tables."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Metric:
    label: str
    unit: str  # of the CSV column; axes write the unit beside each number
    better: str

    @property
    def axis(self):
        return f"{self.label} ({self.better})" if self.better else self.label


METRICS = {
    "build": Metric("time to build", "ns", "lower is better"),
    "query": Metric("time of one query", "ns", "lower is better"),
    "frame": Metric("time of one frame", "ns", "lower is better"),
    "device_gains": Metric("time", "ns", "lower is better"),
    "n": Metric("items n", "", ""),
    "ratio": Metric("peer's time / Boxwood's time", "", "right: Boxwood is faster"),
    "thread_scaling": Metric("time on one thread / on t", "", "higher is better"),
    "threads": Metric("threads t", "", ""),
    "box_tests": Metric("box tests per box or ray", "", "lower is better"),
    "node_visits": Metric("node visits per box or ray", "", "lower is better"),
    "query_each": Metric("query time per box or ray", "ns", "lower is better"),
    "sah": Metric("box tests of a random ray", "", "lower is better"),
    "sah_cost": Metric("surface-area cost of the tree", "", "lower is better"),
}
