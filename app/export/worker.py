"""A process that paints pictures: it reads jobs from its input and answers on its output until the input ends.

It is a plain program and no fork: a fork of a program with threads and a window may hang. It paints what it is
sent, vertices and colours; what is between the keyframes has been worked out before. When the program that
started it goes away, however suddenly, the input ends and so does this.
"""

import pickle
import struct
import sys
from typing import BinaryIO

HEADER = struct.Struct("<BQ")
READY, DONE, FAILED = range(3)


def send(stream: BinaryIO, kind: int, body: bytes) -> None:
    """Write one message."""
    stream.write(HEADER.pack(kind, len(body)))
    stream.write(body)
    stream.flush()


def receive(stream: BinaryIO) -> tuple[int, bytes]:
    """Read one message; raises EOFError where the stream ends."""
    kind, length = HEADER.unpack(_exactly(stream, HEADER.size))
    return kind, _exactly(stream, length)


def _exactly(stream: BinaryIO, count: int) -> bytes:
    content = stream.read(count)
    if len(content) < count:
        raise EOFError
    return content


def main() -> None:
    """Answer jobs until there are no more."""
    from app.export.render import Look, finish, paint
    from core.errors import InkbetweenError

    jobs, answers = sys.stdin.buffer, sys.stdout.buffer
    try:
        look: Look = pickle.loads(receive(jobs)[1])
        send(answers, READY, b"")
        while True:
            job = pickle.loads(receive(jobs)[1])
            try:
                send(answers, DONE, finish(paint(job, look), job, look))
            except InkbetweenError as e:
                send(answers, FAILED, pickle.dumps((type(e), str(e))))
            except MemoryError:
                send(answers, FAILED, pickle.dumps((InkbetweenError, "no memory left; choose a smaller size")))
    except (EOFError, BrokenPipeError):
        pass


if __name__ == "__main__":
    main()
