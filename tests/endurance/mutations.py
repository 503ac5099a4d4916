"""Open thousands of damaged project files and SVGs: each gives a document or a sentence, soon, in little memory.

    python tests/endurance/mutations.py [PROJECTS] [SVGS]

Bits are flipped, ends cut off, pieces repeated and moved, numbers and names exchanged; the fields of projects are
exchanged by Hypothesis. What opens is also written and read again, and every twentieth is painted. Batches run in
processes of their own, so that a crash is seen and memory is measured. Seconds are those of the processor: other
programs do not count.
"""

import copy
import json
import random
import subprocess
import sys
import time
from pathlib import Path
from xml.etree import ElementTree

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

ROOT = Path(__file__).resolve().parents[2]
BATCH = 500
LONGEST_S = 2.0
LARGEST_MB = 500
GIVEN_UP_S = 120

SVGS = (
    b"""<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300" viewBox="0 0 400 300">
<style>.a{fill:#f00;stroke:blue;stroke-width:2px} #b{opacity:.5}</style><defs><linearGradient id="g">
<stop offset="0" stop-color="red"/></linearGradient><path id="p" d="M10 10h80v80H10z"/></defs>
<g transform="translate(10 20) rotate(30) scale(1.5)"><use href="#p" x="40" class="a"/><circle cx="50" cy="50"
r="20" id="b" fill="url(#g)"/><rect x="1" y="2" width="30" height="20" rx="5"/></g><ellipse cx="9" cy="9" rx="4"
ry="5"/><path class="a"
d="M0 0C10 20 30 40 50 60S70 80 90 100q10 10 20 0t20 0A25 25 30 0 1 200 100l-5-5Z m9 9 9 9"/>
<polyline points="0,0 10,10 20,0" fill="none" stroke="#123"/><polygon points="0 0 10 10 20 0"/></svg>""",
    b"""<?xml version="1.0" encoding="UTF-8"?><svg version="1.1" xmlns="http://www.w3.org/2000/svg"
xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100" preserveAspectRatio="xMinYMax slice"><symbol
id="s" viewBox="0 0 10 10"><path d="M1,1 L9,1 9,9Z" style="fill:rgb(10%,20%,30%);stroke:none"/></symbol><g id="h"
style="fill:hsl(120,50%,50%)"><use xlink:href="#s" width="50" height="50"/></g><use xlink:href="#h"
transform="matrix(1 0 0 -1 0 100)"/><text>x</text><switch><g><line x1="0" y1="0" x2="9" y2="9"
stroke="black"/></g></switch></svg>""",
)
MOST_ELEMENTS = 20_000
TOKENS = (
    b"1e308",
    b"-1e308",
    b"NaN",
    b"1e-320",
    b"99999999999999999999",
    b"-0",
    b"",
    b"#p",
    b"url(#p)",
    b"z",
    b"A",
)
ARC = "M0 0 A1e9 1e-9 0 1 1 1e9 1e9"
WORDS = ("1e9", "-1e9 1e9 1e9 1", ARC, "scale(1e6)", "rotate(1e99)", "100%", "", "#h", "1e-9")
JUNK = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**30), 10**30) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


def projects():
    """Return the contents that are damaged: every kept version and a sample."""
    files = [*sorted((ROOT / "tests" / "data").glob("*.inkb")), ROOT / "resources" / "samples" / "letter.inkb"]
    return [f.read_bytes() for f in files]


# damage


def damaged(content, rng, tokens=()):
    """Return the bytes with one to four damages."""
    content = bytearray(content)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(content) + 1)
        end = min(len(content), at + rng.choice((1, 3, 20, 200)))
        how = rng.randrange(7)
        if how == 0 and at < len(content):
            content[at] ^= 1 << rng.randrange(8)
        elif how == 1:
            del content[at:]
        elif how == 2:
            del content[at:end]
        elif how == 3:
            content[at:at] = content[at:end] * rng.choice((2, 9, 300))
        elif how == 4:
            other = rng.randrange(len(content) + 1)
            content[other:other] = content[at:end]
        elif how == 5:
            content[at:end] = rng.randbytes(end - at)
        elif tokens:
            _exchange_word(content, rng, rng.choice(tokens))
    return bytes(content)


def _exchange_word(content, rng, token):
    """Put a token in the place of a number or a name."""
    at = rng.randrange(len(content) + 1)
    while at < len(content) and not chr(content[at]).isalnum():
        at += 1
    end = at
    while end < len(content) and (chr(content[end]).isalnum() or content[end] in b".-"):
        end += 1
    content[at:end] = token


def redrawn(content, rng):
    """Return the SVG, still well formed: attributes exchanged, elements repeated, nested and taken away."""
    root = ElementTree.fromstring(content)
    for _ in range(rng.randint(1, 6)):
        everything = list(root.iter())
        one, other = rng.choice(everything), rng.choice(everything)
        how = rng.randrange(6)
        if how == 0 and one.attrib:
            one.set(rng.choice(list(one.attrib)), rng.choice(WORDS))
        elif how == 1 and one.attrib and other.attrib:
            one.set(rng.choice(list(one.attrib)), rng.choice(list(other.attrib.values())))
        elif how == 2:
            times = rng.choice((1, 3, 100))
            if len(everything) + times * sum(1 for _ in other.iter()) < MOST_ELEMENTS:
                one.extend([copy.deepcopy(other) for _ in range(times)])
        elif how == 3 and len(one):
            one.remove(one[rng.randrange(len(one))])
        elif how == 4:
            one.tag = other.tag
        elif one.attrib:
            name = rng.choice(list(one.attrib))
            value = bytearray(one.get(name).encode())
            _exchange_word(value, rng, rng.choice(TOKENS))
            one.set(name, value.decode("utf-8", "replace"))
    return ElementTree.tostring(root)


def places(value, path=()):
    """Return every path inside a JSON value."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [p for key, child in inside for p in ((*path, key), *places(child, (*path, key)))]


def restructured(data, contents, known):
    """Return a project in which Hypothesis has exchanged, repeated and taken away fields."""
    which = data.draw(st.integers(0, len(contents) - 1))
    value = json.loads(contents[which])
    for _ in range(data.draw(st.integers(1, 3))):
        *way, last = data.draw(st.sampled_from(known[which]))
        place = value
        try:
            for key in way:
                place = place[key]
            old = place[last]
        except (KeyError, IndexError, TypeError):
            continue
        how = data.draw(st.sampled_from(["junk", "delete", "repeat", "number", "other"]))
        if how == "junk":
            place[last] = data.draw(JUNK)
        elif how == "delete":
            del place[last]
        elif how == "repeat" and isinstance(place, list):
            place[last:last] = [old] * data.draw(st.sampled_from([1, 2, 50, 1000]))
        elif how == "number" and isinstance(old, int | float):
            place[last] = data.draw(st.sampled_from([0, -1, 2**31, 1e9, -1e300, 10**400, 0.5, old + 1]))
        elif how == "other":
            place[last] = data.draw(st.sampled_from([None, [], {}, "", [[]], old, [old, old]]))
    return json.dumps(value).encode()


# opening


class Count:
    """What came of the files of a batch."""

    def __init__(self):
        self.opened = self.refused = 0
        self.slowest = 0.0
        self.wrong = []

    def take(self, content, open_it):
        start = time.process_time()
        try:
            then = open_it(content)
            self.opened += 1
        except InkbetweenError as e:
            self.refused += 1
            then = None
            if "\n" in str(e) or not str(e):
                self.wrong.append(f"not one sentence: {e!r}")
        except Exception as e:  # that is what is looked for
            self.wrong.append(f"uncaught: {e!r}")
            self.keep(content)
            return
        seconds = time.process_time() - start
        self.slowest = max(self.slowest, seconds)
        if seconds > LONGEST_S:
            self.wrong.append(f"{seconds:.1f} s")
            self.keep(content)
        if then is not None:
            self.use(then, content)

    def use(self, then, content):
        try:
            then()
        except Exception as e:
            self.wrong.append(f"after opening: {e!r}")
            self.keep(content)

    @staticmethod
    def keep(content):
        folder = Path("/tmp") if sys.platform != "win32" else Path.home()
        (folder / f"mutation-{abs(hash(content)) % 10**8}").write_bytes(content)


def open_project(content):
    document = decode(content)

    def then():
        assert decode(encode(document)) == document
        if random.random() < 0.05:
            thumbnail(document, 1, QSize(160, 90))

    return then


def open_svg(content):
    read_svg(content, tolerance=None)


def batch(kind, seed, amount):
    """Open `amount` damaged files and print what came of it as one line of JSON."""
    count, rng = Count(), random.Random(seed)
    contents = projects()
    if kind == "svg":
        for _ in range(amount):
            how = rng.choice((lambda c, r: damaged(c, r, TOKENS), redrawn))
            count.take(how(rng.choice(SVGS), rng), open_svg)
    elif kind == "bytes":
        for _ in range(amount):
            count.take(damaged(rng.choice(contents), rng), open_project)
    else:
        known = [sorted(places(json.loads(c)), key=str) for c in contents]

        @settings(
            max_examples=amount,
            database=None,
            deadline=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(st.data())
        def each(data):
            count.take(restructured(data, contents, known), open_project)

        each()
    peak = peak_mb()
    counted = (count.opened, count.refused, count.slowest, peak, sorted(set(count.wrong))[:5])
    print(json.dumps(counted))


def total(name, kinds, amount):
    """Run the batches of one kind of file and print their sums; return whether all went well."""
    opened = refused = crashed = 0
    slowest = peak = 0.0
    wrong = []
    for seed in range(amount // BATCH):
        command = [sys.executable, __file__, "batch", kinds[seed % len(kinds)], str(seed), str(BATCH)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=GIVEN_UP_S + 60, check=False)
        if done.returncode:
            crashed += 1
            wrong.append(f"batch {seed} ended with {done.returncode}: {done.stderr[-300:]}")
            continue
        o, r, s, p, w = json.loads(done.stdout.splitlines()[-1])
        opened, refused, slowest, peak = opened + o, refused + r, max(slowest, s), max(peak, p)
        wrong += w
    print(f"{name}: {opened + refused} files, {opened} opened, {refused} refused")
    print(f"  {crashed} crashes, {len(wrong)} wrong; slowest {slowest:.2f} s, most memory {peak:.0f} MB")
    for text in wrong[:20]:
        print(f"  {text}")
    return not wrong and peak < LARGEST_MB


def main():
    amounts = [int(x) for x in sys.argv[1:3]]
    amount, svgs = amounts if len(amounts) == 2 else (10_000, 2_000)
    good = total("projects", ("bytes", "fields"), amount)
    good = total("SVGs", ("svg",), svgs) and good
    return not good


if sys.argv[1:2] == ["batch"]:
    sys.path.insert(0, str(Path(__file__).parent))

    from measure import peak_mb
    from PySide6.QtCore import QSize

    from app.thumbnail import thumbnail
    from core.errors import InkbetweenError
    from core.io.project import decode, encode
    from core.io.svg import read_svg

    batch(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
elif __name__ == "__main__":
    sys.exit(main())
