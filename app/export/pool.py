"""Pictures painted side by side and handed back in their order.

QPainter holds the interpreter, so threads would wait for each other: each painter is a process of its own. Until
the first one is up, and where there is too little to paint to start any, the calling thread paints while others
encode.
"""

import contextlib
import os
import pickle
import queue
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from app.export.render import Job, Look, finish, paint
from app.export.whole import temporary_of
from app.export.worker import DONE, READY, receive, send
from core.errors import InkbetweenError

MOST_PAINTERS = 8
MOST_ENCODERS = 4
PIXELS_IN_FLIGHT = 48_000_000
"""Pictures rendered and not yet written hold up to 12 bytes a pixel: half a gigabyte at most."""
WORTH_A_PROCESS = 120_000_000
"""Pixels in all; fewer are painted in the time that a process takes to start."""
STOPPED = InkbetweenError(
    "a process that painted has ended before its time; is the memory full? Try a smaller size, or one process"
)


def useful_processes(count: int, size: tuple[int, int]) -> int:
    """Return how many processes are worth starting for so many pictures."""
    if count * size[0] * size[1] < WORTH_A_PROCESS:
        return 1
    return max(1, min(os.cpu_count() or 1, MOST_PAINTERS, count))


def most_waiting(size: tuple[int, int], painters: int) -> int:
    """Return how many pictures may be in the works at once."""
    return max(1, min(painters + 1, PIXELS_IN_FLIGHT // (size[0] * size[1])))


def painted(
    jobs: Iterable[Job], look: Look, processes: int, cancelled: Callable[[], bool]
) -> Iterator[bytes | None]:
    """Yield what comes of every job, in order: see `finish`.

    Ends early when `cancelled` says so; then, and after an error, no process, thread or half file is left.
    Jobs are taken from the iterable in the calling thread, a few ahead.
    """
    crew = _Processes(look, processes) if processes > 1 else _Threads(look)
    waiting: deque[Future[bytes]] = deque()
    most = most_waiting(look.size, crew.count)
    with contextlib.closing(crew):
        for job in jobs:
            if cancelled():
                break
            while waiting and (len(waiting) >= most or waiting[0].done()):
                yield waiting.popleft().result()
            waiting.append(crew.submit(job))
        while waiting:
            yield waiting.popleft().result()


class _Threads:
    """Paints in the calling thread; encodes in others, because zlib lets the interpreter go."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self.count = min(MOST_ENCODERS, os.cpu_count() or 1)
        self._encoders = ThreadPoolExecutor(self.count, thread_name_prefix="export encoder")

    def submit(self, job: Job) -> Future[bytes]:
        return self._encoders.submit(finish, paint(job, self._look), job, self._look)

    def close(self) -> None:
        self._encoders.shutdown(cancel_futures=True)


class _Processes:
    """Some processes that paint; for each a thread that waits for its answers."""

    def __init__(self, look: Look, count: int) -> None:
        self.count = count
        self._look = look
        self._meanwhile = _Threads(look)
        self._up = threading.Event()
        self._jobs: queue.SimpleQueue[tuple[Job, Future[bytes]] | None] = queue.SimpleQueue()
        self._started: list[subprocess.Popen[bytes]] = []
        self._ready: list[subprocess.Popen[bytes]] = []
        with contextlib.suppress(OSError):  # where none can be started, the calling thread paints on
            for _ in range(count):
                self._start()
        self._threads = [
            threading.Thread(target=self._serve, args=(p,), name="export painter", daemon=True)
            for p in self._started
        ]
        for thread in self._threads:
            thread.start()

    def _start(self) -> None:
        command = [sys.executable, "-P", "-c", "from app.export.worker import main; main()"]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        painter = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            start_new_session=True,  # Ctrl+C is for the program that started it
        )
        self._started.append(painter)

    def submit(self, job: Job) -> Future[bytes]:
        if not self._up.is_set():
            return self._meanwhile.submit(job)
        future: Future[bytes] = Future()
        self._jobs.put((job, future))
        return future

    def _serve(self, painter: "subprocess.Popen[bytes]") -> None:
        """Carry jobs to one process and its answers back; one that never comes up is not asked."""
        if not self._is_ready(painter):
            return
        self._ready.append(painter)
        self._up.set()
        while (taken := self._jobs.get()) is not None:
            job, future = taken
            if not future.set_running_or_notify_cancel():
                continue
            try:
                answer = _asked(painter, job)
            except (OSError, EOFError, ValueError) as e:
                if not isinstance(e, InkbetweenError):
                    _forget_part(job, painter.pid)
                    e = STOPPED
                future.set_exception(e)
            else:
                future.set_result(answer)

    def _is_ready(self, painter: "subprocess.Popen[bytes]") -> bool:
        try:
            send(painter.stdin, READY, pickle.dumps(self._look))
            return receive(painter.stdout)[0] == READY
        except (OSError, EOFError):
            return False

    def close(self) -> None:
        """Let what is under way come to its end, then end the processes."""
        with contextlib.suppress(queue.Empty):
            while True:
                taken = self._jobs.get_nowait()
                if taken is not None:
                    taken[1].cancel()
        for painter in self._started:
            if painter not in self._ready:
                painter.kill()  # it has not begun yet, and nobody waits for it any more
        for _ in self._threads:
            self._jobs.put(None)
        for thread in self._threads:
            thread.join()
        self._meanwhile.close()
        for painter in self._started:
            for stream in (painter.stdin, painter.stdout):
                with contextlib.suppress(OSError):
                    stream.close()
            painter.wait()


def _asked(painter: "subprocess.Popen[bytes]", job: Job) -> bytes:
    """Return what a process makes of a job; raises EOFError or OSError if it has ended."""
    send(painter.stdin, DONE, pickle.dumps(job.light()))
    kind, body = receive(painter.stdout)
    if kind != DONE:
        error, text = pickle.loads(body)
        raise error(text)
    return body


def _forget_part(job: Job, pid: int) -> None:
    """Take away what a process that has died was writing."""
    if job.path is not None:
        with contextlib.suppress(OSError):
            temporary_of(job.path, pid).unlink(missing_ok=True)
