"""Open project files that are made to fill the memory or the time, each in a process of its own.

    python tests/endurance/hostile.py

Prints the seconds, the most memory in MB and the sentence of each; none may take over 2 s or 500 MB.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from measure import peak_mb

STAGE = b'"stage":{"width":9,"height":9,"background":null},"rate":[24,1],"length":9,'
HEAD = b'{"format":"inkbetween","version":2,' + STAGE
STYLE = b'{"fill":null,"stroke":null,"width":0}'
SPAN = b'{"method":"auto","easing":[0,0,1,1],"turns":0,"pairs":[]}'
FRAME = b'{"frame":%d,"drawing":{"style":' + STYLE + b',"outlines":[%s]},"span":' + SPAN + b"}"
LONGEST_S, LARGEST_MB = 2.0, 500


def keyframe(outlines, span=SPAN):
    return b'{"frame":1,"drawing":{"style":' + STYLE + b',"outlines":[' + outlines + b']},"span":' + span + b"}"


def film(keyframes):
    return HEAD + b'"layers":[{"id":1,"name":"","visible":true,"keyframes":[' + keyframes + b"]}]}"


def outline(number, points):
    return b'{"id":%d,"closed":false,"points":[%s]}' % (number, points)


def pairs(inside):
    return SPAN.replace(b"[]}", b"[" + inside + b"]}")


def cases():
    """Return the hostile files by name; made when they are wanted, for they are large."""
    megabyte = 2**20
    points = b"[0,0],[1,0]"
    square = keyframe(outline(1, points))
    return {
        "120 MB of vertices in one outline": lambda: film(
            keyframe(outline(1, b"[0,0]," * (20 * megabyte) + b"[1,1]"))
        ),
        "exactly the most vertices": lambda: film(keyframe(outline(1, b"[0,0]," * 1_999_999 + b"[1,1]"))),
        "vertices in many outlines": lambda: film(
            keyframe(b",".join(outline(i + 1, b"[0,0]," * 99 + b"[1,1]") for i in range(30_000)))
        ),
        "exactly the most outlines": lambda: film(
            keyframe(b",".join(outline(i + 1, points) for i in range(50_000)))
        ),
        "exactly the most keyframes": lambda: film(b",".join(FRAME % (i + 1, b"") for i in range(50_000))),
        "120 MB of empty lists": lambda: film(b"[]," * (40 * megabyte) + b"[]"),
        "120 MB of empty objects": lambda: film(b"{}," * (40 * megabyte) + b"{}"),
        "500,000 empty pins": lambda: film(keyframe(b"", SPAN[:-1] + b',"pins":[' + b"{}," * 499_980 + b"{}]}")),
        "240,000 pairs of one outline": lambda: film(
            keyframe(outline(1, points), pairs(b'{"before":1,"after":1},' * 239_999 + b'{"before":1,"after":1}'))
            + b","
            + square.replace(b'"frame":1', b'"frame":2')
        ),
        "120 MB of anchors": lambda: film(
            keyframe(b"", pairs(b'{"before":1,"after":1,"anchors":[' + b"[0,0]," * (20 * megabyte) + b"[0,0]]}"))
        ),
        "120 MB of muted anchors": lambda: film(
            keyframe(b"", pairs(b'{"before":1,"after":1,"muted":[' + b"0," * (60 * megabyte) + b"0]}"))
        ),
        "120 MB of positions": lambda: film(
            keyframe(
                b"",
                pairs(
                    b'{"before":1,"after":1,"correspondence":{"before":[0],"after":['
                    + b"0," * (60 * megabyte)
                    + b'0],"counts":[2,2],"closed":true,"flipped":false}}'
                ),
            )
        ),
        "120 MB of knots": lambda: film(
            keyframe(b"", SPAN[:-1] + b',"knots":[' + b"[0,0,0,0,0,0]," * (8 * megabyte) + b"[0,0,0,0,0,0]]}")
        ),
        "120 MB of exposures": lambda: film(
            keyframe(b"", SPAN[:-1] + b',"exposures":[' + b"1," * (60 * megabyte) + b"1]}")
        ),
        "1000 layers that follow each other": lambda: (
            HEAD
            + b'"layers":['
            + b",".join(
                b'{"id":%d,"name":"","visible":true,"keyframes":[],"parent":%d}' % (i + 1, (i + 1) % 1000 + 1)
                for i in range(1000)
            )
            + b"]}"
        ),
        "exactly the most vertices, in version 1": lambda: film(
            keyframe(outline(1, b"[0,0]," * 1_999_999 + b"[1,1]"))
        ).replace(b'"version":2', b'"version":1'),
        "a name of 120 MB": lambda: film(b"").replace(b'"name":""', b'"name":"' + b"x" * (120 * megabyte) + b'"'),
        "a method of 120 MB": lambda: film(square.replace(b"auto", b"x" * (120 * megabyte))),
        "a field named by 120 MB": lambda: film(square.replace(b'"turns"', b'"' + b"x" * (120 * megabyte) + b'"')),
        "a number of 120 MB": lambda: film(keyframe(outline(1, b"[1" + b"0" * (120 * megabyte) + b",0]"))),
        "a turn of 120 MB": lambda: film(square.replace(b'"turns":0', b'"turns":' + b"9" * (120 * megabyte))),
        "60 million lists in each other": lambda: film(b"[" * (60 * megabyte)),
        "20 million objects in each other": lambda: b'{"a":' * (20 * megabyte),
        "unknown fields of 120 MB": lambda: HEAD + b'"x":[' + b"0," * (60 * megabyte) + b"0]}",
        "120 MB of spaces": lambda: b" " * (120 * megabyte) + film(square),
        "more than a file may have": lambda: b" " * (129 * megabyte) + film(square),
    }


def open_one(path):
    """Open one file and print what came of it as a line of JSON."""
    from core.errors import InkbetweenError
    from core.io.project import load

    start = time.perf_counter()
    try:
        load(path)
        said = "opened"
    except InkbetweenError as e:
        said = str(e)
    seconds = time.perf_counter() - start
    print(json.dumps((seconds, peak_mb(), said)))


def opened(path):
    """Return the seconds, the MB and the sentence, from a process that does nothing else."""
    done = subprocess.run([sys.executable, __file__, str(path)], capture_output=True, text=True, check=False)
    if done.returncode:
        return LONGEST_S + 1, 0.0, f"ended with {done.returncode}: {done.stderr[-300:]}"
    return json.loads(done.stdout)


def main():
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hostile.inkb"
        for name, make in cases().items():
            path.write_bytes(make())
            seconds, peak, said = opened(path)
            bad += seconds > LONGEST_S or peak > LARGEST_MB or len(said) > 600
            print(f"{seconds:5.2f} s {peak:4.0f} MB  {name}: {said.replace(str(path), '')[:110]}")
    print("all within the limits" if not bad else f"{bad} beyond the limits")
    return bad > 0


if __name__ == "__main__":
    sys.exit(open_one(sys.argv[1]) if len(sys.argv) > 1 else main())
