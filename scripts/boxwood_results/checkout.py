"""Which machine and which commit a file was made by, of what no sweep measures."""

import os
import platform
import subprocess
from datetime import datetime, timezone
from pathlib import Path

ENV = ("host", "cpu", "ncpu", "git_commit", "git_dirty", "created_utc", "versions")


def environment(root, versions):
    """{key of ENV: value}. versions: {package: version} of what else took part."""
    def output_of(*arguments):
        return subprocess.run(arguments, cwd=root, capture_output=True, text=True, check=False).stdout.strip()

    cpu = next((line.split(":", 1)[1].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
                if line.startswith("model name")), platform.machine())
    changes = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":(exclude)results/published")
    values = (platform.node(), cpu, len(os.sched_getaffinity(0)), output_of("git", "rev-parse", "HEAD"), int(bool(changes)),
              datetime.now(timezone.utc).isoformat(timespec="seconds"), versions)
    return dict(zip(ENV, values))
