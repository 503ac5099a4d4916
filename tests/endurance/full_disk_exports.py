"""A disk that is full while each format is exported: what is said, what is left.

A small tmpfs is mounted for it, so it needs Linux and root. For each: the exit code is 1, the message is one
sentence, the file of yesterday is whole, and nothing else has appeared. Ends with 1 if any of that is not so.

Run from the root: sudo python tests/endurance/full_disk_exports.py
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

SAMPLE = ROOT / "resources" / "samples" / "walking leg.inkb"
DISK = 256 * 1024
ROOM = 4096
"""Bytes left free: less than any of the formats needs."""

YESTERDAY = b"the file of yesterday"


def fill(disk):
    """Leave only `ROOM` bytes."""
    free = os.statvfs(disk)
    count = free.f_bavail * free.f_frsize - ROOM
    (disk / "filler").write_bytes(bytes(max(count, 0)))


def contents(disk):
    """Return every file with its bytes, but for the filler."""
    return {
        p.relative_to(disk).as_posix(): p.read_bytes()
        for p in disk.rglob("*")
        if p.is_file() and p.name != "filler"
    }


def old_files(disk, form):
    """Put a file of yesterday where the export goes; return what OUT is."""
    from app.export.formats import FORMATS

    spec = FORMATS[form]
    out = disk / ("out" if spec.frames else f"out{spec.ending or '.oca'}")
    if spec.frames:
        out.mkdir()
        (out / f"a.0001{spec.ending}").write_bytes(YESTERDAY)
    elif spec.folder:
        out.mkdir()
        (out / "out.oca").write_bytes(YESTERDAY)
    else:
        out.write_bytes(YESTERDAY)
    return out


def export(disk, form):
    """Export one format onto the full disk; return what is wrong."""
    out = old_files(disk, form)
    fill(disk)
    before = contents(disk)
    words = ["export", str(SAMPLE), str(out), "--format", form, "--force", "--name", "a"]
    ended = subprocess.run(
        [sys.executable, "-m", "app", *words], capture_output=True, text=True, cwd=ROOT, check=False
    )
    print(f"  {form:10} {ended.returncode} {ended.stderr.strip()}")
    return _wrong(ended, before, contents(disk), frames=form in ("png", "svg-frames"))


def _wrong(ended, before, after, *, frames):
    found = []
    if ended.returncode != 1 or ended.stderr.count("\n") != 1 or "no space left on device" not in ended.stderr:
        found.append("not one sentence that says so")
    whole = {n: c for n, c in after.items() if not (frames and c != YESTERDAY and _is_whole(c))}
    expected = {n: c for n, c in before.items() if n in whole or not frames}
    if whole != expected:
        found.append(f"left behind {sorted(after.keys() ^ before.keys())}")
    return found


def _is_whole(content):
    """Whether a frame that was replaced before the disk was full is complete."""
    return content.endswith(b"IEND\xaeB`\x82") or content.rstrip().endswith(b"</svg>")


def main():
    """Try everything; return 1 if something is wrong."""
    from app.export.formats import FORMATS

    bad = {}
    for name in FORMATS:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "tmpfs", folder], check=True)
            try:
                wrong = export(Path(folder), name)
            finally:
                subprocess.run(["umount", folder], check=True)
        if wrong:
            bad[name] = wrong
    for name, wrong in bad.items():
        print(f"WRONG {name}: {'; '.join(wrong)}")
    print(f"{len(FORMATS) - len(bad)} of {len(FORMATS)} as they should be")
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
