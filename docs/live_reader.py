#!/usr/bin/env python3
"""Follows `crankloop live` from Python, with the standard library alone: signals, inputs by name, edges.

    live_reader.py /dev/shm/engine                    prints speed and edges each second, until live ends
    live_reader.py /dev/shm/engine --seconds 10 --pause 0.05

As a module:

    block = Block("/dev/shm/engine")
    block.signals()["intake.pressure_Pa"]             all numbers as they were after one tick; None while they change
    edges = Edges(block)
    for due_ns, wheel, level in edges.read(): ...     since the last call; edges.lost says how many were missed

docs/live.md has the layout. Words are read whole, because memoryview copies aligned words by one load each; their order
is that of the program on x86. On other processors a lock taken in between keeps it.
"""
import argparse
import mmap
import struct
import threading
import time

MAGIC, VERSION, FIXED_BYTES = 0x4C4B5243, 4, 256
STARTING, RUNNING, ENDED = 0, 1, 2
SIGNAL_NAMES, SIGNALS, INPUT_NAMES, INPUTS, WHEEL_NAMES, EDGES = 1, 2, 3, 4, 5, 6

_lock = threading.Lock()


def _fence():
    with _lock:  # taking and giving back a lock orders loads and stores around it
        pass


class BlockError(Exception):
    """One line: PATH: why."""


class Block:
    """The block of a running live. Raises BlockError where there is none of this version."""

    def __init__(self, path):
        try:
            with open(path, "r+b") as file:
                self._map = mmap.mmap(file.fileno(), 0)
        except (OSError, ValueError) as error:
            raise BlockError(f"{path}: cannot be opened: {error}") from None
        size = len(self._map)
        if size < FIXED_BYTES:
            raise BlockError(f"{path}: is no block of crankloop live")
        self.words = memoryview(self._map)[: size // 4 * 4].cast("I")
        magic, version = self.words[0], self.words[1]
        if magic == 0:
            raise BlockError(f"{path}: is not ready yet")
        if magic != MAGIC:
            raise BlockError(f"{path}: is no block of crankloop live")
        if version != VERSION:
            raise BlockError(f"{path}: is a block of version {version} of crankloop live; this reader's is {VERSION}")
        if self.words[2] != size:
            raise BlockError(f"{path}: is a block that is not whole")
        self.numbers = memoryview(self._map)[: size // 8 * 8].cast("Q")
        self.sections = {}  # kind -> (offset, count, entry_bytes)
        count, at = self.words[8], self.words[9] // 4
        for i in range(count):
            kind, *place = self.words[at + 4 * i : at + 4 * i + 4]
            self.sections.setdefault(kind, tuple(place))
        self.tick_s = struct.unpack_from("=d", self._map, 16)[0]
        self.signal_names = self._names(SIGNAL_NAMES)
        self.input_names = self._names(INPUT_NAMES)
        self.wheel_names = self._names(WHEEL_NAMES)

    @property
    def state(self):
        """RUNNING, or ENDED; the block of the next run is another file."""
        return self.words[3]

    def outputs_ticks(self):
        """Ticks that live has completed; a live that does not count on has died."""
        return self.numbers[17]

    def speed_rad_s(self):
        """None while it is being written."""
        words = self._locked(128, 60)
        return None if words is None else struct.unpack("=d", words[16:24])[0]

    def signals(self):
        """Name -> number, all of one tick; None while they are being written."""
        return self._numbers(SIGNALS, self.signal_names)

    def inputs(self):
        """Name -> number, as they are now: to be changed and written back."""
        return self._numbers(INPUTS, self.input_names)

    def write_inputs(self, numbers):
        """All of them, each period: who writes the section drives the engine. One writer."""
        offset, count, _ = self.sections[INPUTS]
        values = struct.pack(f"={count}d", *(numbers[name] for name in self.input_names))
        odd = (self.words[offset // 4] | 1) & 0xFFFFFFFF
        self.words[offset // 4] = odd
        _fence()
        for i, word in enumerate(struct.unpack(f"={2 * count}I", values)):
            self.words[offset // 4 + 2 + i] = word
        _fence()
        self.words[offset // 4] = (odd + 1) & 0xFFFFFFFF

    def _names(self, kind):
        offset, count, size = self.sections.get(kind, (0, 0, 0))
        texts = (self._map[offset + i * size : offset + (i + 1) * size] for i in range(count))
        return [text.split(b"\0", 1)[0].decode() for text in texts]

    def _numbers(self, kind, names):
        offset, count, _ = self.sections.get(kind, (0, 0, 0))
        words = self._locked(offset, 4 * count // 2) if count else b""
        return None if words is None else dict(zip(names, struct.unpack(f"={count}d", words)))

    def _locked(self, offset, count):
        """`count` words behind a sequence number and 4 bytes, as bytes."""
        before = self.words[offset // 4]
        _fence()
        words = bytes(self.words[offset // 4 + 2 : offset // 4 + 2 + count])
        _fence()
        return words if before % 2 == 0 and self.words[offset // 4] == before else None


class Edges:
    """A reader's place in the ring. read + lost is what was written since it began."""

    def __init__(self, block):
        if EDGES not in block.sections:
            raise BlockError("the engine has no trigger wheel")
        self._block = block
        offset, self.depth, _ = block.sections[EDGES]
        self._counter, self._entries = offset // 8, offset + 64
        self.next = self.begin = block.numbers[self._counter]
        self.count = self.lost = 0

    def read(self, most=4096):
        """(due_ns, wheel, level) of the edges since the last call, at most so many. Never waits."""
        numbers, depth = self._block.numbers, self.depth
        written = numbers[self._counter]
        _fence()
        if written < self.next:
            return []
        oldest = max(0, written - depth + 1)  # the writer may be at the one before
        self.lost += max(0, oldest - self.next)
        self.next = max(self.next, oldest)
        end = min(written, self.next + most)
        edges, first = [], self._entries // 8
        for n in range(self.next, end):
            at = first + 2 * (n % depth)
            word = numbers[at + 1]
            edges.append((numbers[at], word & 0xFFFFFFFF, word >> 32))
        _fence()
        oldest = max(0, numbers[self._counter] - depth + 1)
        torn = min(max(0, oldest - self.next), len(edges))  # overwritten while they were copied
        self.next = end
        self.lost += torn
        self.count += len(edges) - torn
        return edges[torn:]


class Alternation:
    """Counts edges that came twice or not at all: the levels of a wheel alternate, times do not go back."""

    def __init__(self):
        self.levels, self.last_ns, self.wrong = {}, 0, 0

    def take(self, due_ns, wheel, level):
        self.wrong += due_ns < self.last_ns or self.levels.get(wheel) == level
        self.levels[wheel], self.last_ns = level, due_ns


def follow(block, seconds, pause_s, report):
    """Until live ends or the seconds are over. Calls report(edges) each second."""
    edges, check = Edges(block), Alternation()
    end, next_report = time.monotonic() + seconds, time.monotonic() + 1
    ticks, alive = -1, time.monotonic()
    while True:
        now = time.monotonic()
        last = block.state != RUNNING or now >= end
        if block.outputs_ticks() != ticks:
            ticks, alive = block.outputs_ticks(), now
        if now - alive > 1:
            raise BlockError("live has written nothing for 1 s: it has died or hangs")
        while True:
            lost = edges.lost
            new = edges.read()
            if edges.lost != lost:
                check.levels.clear()
            for edge in new:
                check.take(*edge)
            if not new:
                break
        if last:
            return edges, check
        if now >= next_report:
            next_report += 1
            report(edges)
        time.sleep(pause_s)


def show(block, edges):
    speed_rad_s = None
    while speed_rad_s is None:  # written for a fraction of a microsecond in each tick
        speed_rad_s = block.speed_rad_s()
    print(f"# {speed_rad_s * 9.549296585513721:.1f} rpm, {edges.count} edges", flush=True)


def main():
    parser = argparse.ArgumentParser(description="Follow the trigger edges of crankloop live.")
    parser.add_argument("path")
    parser.add_argument("--seconds", type=float, default=1e9)
    parser.add_argument("--pause", type=float, default=0.01, help="seconds between two looks at the ring")
    options = parser.parse_args()
    try:
        block = Block(options.path)
        edges, check = follow(block, options.seconds, options.pause, lambda edges: show(block, edges))
    except BlockError as error:
        raise SystemExit(f"live_reader: {error}") from None
    print(f"begin = {edges.begin}\nread = {edges.count}\nlost = {edges.lost}")
    print(f"written = {edges.next}\nwrong = {check.wrong}")


if __name__ == "__main__":
    main()
