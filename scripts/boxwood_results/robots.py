"""The robots of the track `robots`: one of the project's own, and some that others made, which are no part of it."""

from pathlib import Path

SWEEP = "robots"
OWN = Path("scenes") / "examples" / "arm.urdf"
OTHERS = (Path("panda") / "panda.urdf", Path("z1") / "z1.urdf")  # below a folder of robots


def folder_beside(root):
    """Where those of others stand, if nothing else is said."""
    return Path(root).parent / "shared" / "data" / "robots"


def options(root, folder):
    """([the options of a sweep that bring the robots], [those that are not there])."""
    there = [folder / one for one in OTHERS if (folder / one).is_file()]
    missing = [folder / one for one in OTHERS if folder / one not in there]
    return [word for file in (Path(root) / OWN, *there) for word in ("--robot", str(file))], missing
