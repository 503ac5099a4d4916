"""The command line. What needs no command (help, version) is answered here, with nothing imported yet."""

import os
import sys

from app import __version__

DONE, PROBLEM, INTERRUPTED = 0, 1, 130

HELP = """\
usage: inkbetween [FILE]
       inkbetween COMMAND ...

A desktop in-betweening editor: draw keyframes, say which point goes where, see every in-between at once.

  FILE                  a project (.inkb) to open in the editor

commands:
  check FILE            say what is wrong with the in-betweens of a project, frame by frame
  demo                  open the editor on a sample; without a display, export the sample's frames
  export FILE OUT       write numbered pictures, a film, a sheet, Lottie and more
  info FILE             say what is in a project
  new BEFORE [AFTER]    make a project of SVG drawings or of a Lottie animation

options:
  -h, --help            show this and exit
  --version             show the version and exit

"inkbetween export --help" and so on tell more. A file with the name of a command: inkbetween ./demo
"""


def main(arguments: list[str] | None = None) -> int:
    """Run one command; return 0, 1 after a problem, 2 after wrong usage, 130 when interrupted."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")  # file names may hold what a terminal cannot show
    try:
        try:
            return _run(sys.argv[1:] if arguments is None else arguments)
        finally:
            sys.stdout.flush()
    except OSError as e:
        # mostly a reader that has gone (inkbetween info | head); Python would complain again at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PROBLEM if isinstance(e, BrokenPipeError) else _report(e.strerror or e)


def _run(words: list[str]) -> int:
    if words[:1] in (["-h"], ["--help"]):
        sys.stdout.write(HELP)
    elif words[:1] == ["--version"]:
        sys.stdout.write(f"inkbetween {__version__}\n")
    else:
        return _run_command(words)
    return DONE


def _run_command(words: list[str]) -> int:
    from app.cli.commands import parse
    from app.cli.display import Problem

    try:
        command = parse(words)
    except SystemExit as e:  # argparse has said what is wrong, or shown its help
        return int(e.code or 0)
    from core.errors import InkbetweenError

    try:
        return command()
    except KeyboardInterrupt:
        return INTERRUPTED
    except (Problem, InkbetweenError) as e:
        return _report(e)


def _report(problem: object) -> int:
    sys.stderr.write(f"inkbetween: {problem}\n")
    return PROBLEM
