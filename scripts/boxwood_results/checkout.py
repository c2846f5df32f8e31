"""Which machine and which commit a file was made by, of what no sweep measures."""

import json
import os
import subprocess
from datetime import datetime, timezone

ENV = ("host", "cpu", "isa_max", "ncpu", "git_commit", "git_dirty", "created_utc", "versions")
PROGRAM = "build/release/boxwood"


def environment(root, versions, peers=()):
    """{key of ENV: value}. versions: {package: version} of what else took part; peers: those whose version and build it gets here."""
    def output_of(*arguments):
        return subprocess.run(arguments, cwd=root, capture_output=True, text=True, check=False).stdout.strip()

    doctor = json.loads(output_of(root / PROGRAM, "doctor", "--json"))
    isas, found = doctor["isa"], {peer["name"]: peer for peer in doctor["peers"] if peer["present"]}
    beside = {name: f"{found[name]['version']} ({found[name]['build']})" for name in peers if name in found}
    changes = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":(exclude)results/published")
    values = (os.uname().nodename, doctor["cpu"], isas["supported"][0], len(os.sched_getaffinity(0)), output_of("git", "rev-parse", "HEAD"),
              int(bool(changes)), datetime.now(timezone.utc).isoformat(timespec="seconds"),
              {**versions, **beside, "compiler": doctor["compiler"], "ours for": isas["used"]})
    return dict(zip(ENV, values))


def environment_of(found):
    """The same of a file. Those of before 2026-11-29 do not say which instruction sets the processor has: ""."""
    return {key: found[key] for key in ENV if key != "isa_max"} | {"isa_max": found.get("isa_max", "")}


def machine(env):
    """What two files of one machine have in common."""
    return env["host"], env["cpu"], env["isa_max"]
