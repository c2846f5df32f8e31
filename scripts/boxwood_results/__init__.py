"""Draws Boxwood result files as figures and the report. Never measures, decides or writes one
(python_times alone holds what scripts/python_bench timed)."""

import sys
from pathlib import Path

# The reader is the module boxwood's, as it stands beside these scripts.
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
