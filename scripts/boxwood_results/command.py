"""What plot and report share: arguments, errors, exit codes."""

import argparse
import os
import sys
from pathlib import Path

from boxwood.results.reader import BadFile


def parser(description, example, several=False):
    made = argparse.ArgumentParser(
        description=description,
        epilog=f"Example: {example}\n\nExit codes: 0 done; 2 bad usage or a file that cannot be read or written.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if several:
        made.add_argument("files", type=Path, nargs="+", metavar="FILE.h5", help="result files of scripts/sweep")
    else:
        made.add_argument("file", type=Path, metavar="FILE.h5", help="a result file of scripts/sweep")
    return made


def read(path):
    """A result file, ready to be drawn; says so if another program changed it."""
    from .run import read as read_run

    made = read_run(path)
    if made.changed:
        print(f"{Path(sys.argv[0]).name}: warning: {made.changed}", file=sys.stderr)
    return made


def run(main):
    """Runs main() and turns what the user can mend into a message and exit code 2."""
    name = Path(sys.argv[0]).name
    try:
        code = main()
        sys.stdout.flush()
    except BadFile as error:
        code = 2
        print(f"{name}: {error}", file=sys.stderr)
    except BrokenPipeError:
        code = 0  # the reader, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        code = 2
        print(f"{name}: cannot write '{error.filename}': {error.strerror}", file=sys.stderr)
    except KeyboardInterrupt:
        code = 130
    sys.exit(code)
