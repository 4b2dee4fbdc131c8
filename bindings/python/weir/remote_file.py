"""Reads ranges of a remote file with several threads. http_file.py and fsspec_file.py make the requests."""

from __future__ import annotations

import os
import threading
import weakref
from typing import Any, Callable, Optional, Sequence
from urllib.parse import urlsplit, urlunsplit

from .errors import InputError, IoError

#: (offset, count) of bytes.
Range = tuple[int, int]

#: Longer ranges are read in pieces of this many bytes, READS_AT_ONCE of them at a time.
_PIECE = 8 << 20
READS_AT_ONCE = 8
#: Statuses of servers for a missing file. Some stores answer 401 or 403.
MISSING_FILE_STATUSES = (401, 403, 404, 410)
#: The longest sidecar that is read, in bytes.
LONGEST_SIDECAR = 4 << 20


class RemoteFile:
    """A file that is read in parts. Counts requests and bytes. May be used by several threads."""

    def __init__(self) -> None:
        self.requests = 0
        self.bytes_read = 0
        self._lock = threading.Lock()
        self._reads: list[_Read] = []  # the reads under way
        self._forked = False
        _files.add(self)

    def begin_again(self) -> None:
        """Resets the file in a forked process: connections, locks and threads belong to the parent process."""
        self._lock = threading.Lock()
        self._reads = []
        self._forked = True

    def _connect(self) -> None:
        """Makes new connections for requests."""

    def _leave_the_forks_connections(self) -> None:
        with self._lock:
            if self._forked:
                self._connect()
            self._forked = False

    def read(self, ranges: Sequence[Range]) -> list[bytes]:
        """Returns all bytes of each range, or raises an exception. Reads several pieces at once."""
        pieces = [_pieces(*asked) for asked in ranges]
        found = iter(self._run(self._read_piece, [piece for parts in pieces for piece in parts]))
        return [b"".join(next(found) for _ in parts) for parts in pieces]

    def _run(self, work: Callable[[Range], Any], pieces: Sequence[Range]) -> list[Any]:
        """Returns what `work` returns for each piece. Does the work in threads, which interrupt() abandons."""
        self._leave_the_forks_connections()
        with self._lock:
            read = _Read(self._through_these_connections(work), pieces)
            self._reads.append(read)
        try:
            return read.run()
        finally:
            with self._lock:
                self._reads.remove(read)

    def interrupt(self) -> None:
        """Makes all calls of read that are under way raise IoError at once. A server may not answer for minutes."""
        with self._lock:
            reads = list(self._reads)
            if reads:
                self._give_up()
        for read in reads:
            read.fail(IoError("reading was interrupted"))

    def _through_these_connections(self, work: Callable[[Range], Any]) -> Callable[[Range], Any]:
        """Returns `work` bound to the current connections. _give_up() replaces them only for later requests."""
        return work

    def _give_up(self) -> None:
        """Abandons the requests that are under way, and keeps their connections from later requests."""

    def read_beside(self, url: str) -> Optional[str]:
        """Returns the text of a sidecar at `url`, beside this file. None if it is missing."""
        raise NotImplementedError

    def _read_piece(self, piece: Range) -> bytes:
        raise NotImplementedError

    def _count(self, data: bytes) -> bytes:
        with self._lock:
            self.requests += 1
            self.bytes_read += len(data)
        return data


#: All RemoteFiles of this process. A forked process resets its copies.
_files: weakref.WeakSet[RemoteFile] = weakref.WeakSet()


def _begin_again() -> None:
    for file in list(_files):
        file.begin_again()


os.register_at_fork(after_in_child=_begin_again)


def _start(work: Callable[[], None], threads: int) -> int:
    """Starts up to `threads` threads that do `work`. Returns how many the system started."""
    for started in range(threads):
        try:
            threading.Thread(target=work, daemon=True).start()
        except RuntimeError:
            return started
    return threads


class _Read:
    """Reads pieces of a file, several at once, in threads of its own. A thread that waits for a server cannot be
    stopped. So the threads are daemons: a caller need not wait for them, and they do not keep a program from
    ending."""

    def __init__(self, read_piece: Callable[[Range], Any], pieces: Sequence[Range]) -> None:
        self._read_piece = read_piece
        self._left = list(enumerate(pieces))[::-1]
        self._found: list[Any] = [None] * len(pieces)
        self._missing = len(pieces)
        self._failure: Optional[BaseException] = None
        self._changed = threading.Condition()

    def run(self) -> list[Any]:
        """Returns all pieces, or raises the first exception that occurred."""
        wanted = min(READS_AT_ONCE, len(self._found))
        if _start(self._read_pieces, wanted) == 0 and wanted > 0:
            self._read_pieces()  # in this thread, because the system started none
        with self._changed:
            self._changed.wait_for(lambda: self._failure is not None or self._missing == 0)
            if self._failure is not None:
                raise self._failure
        return self._found

    def fail(self, failure: BaseException) -> None:
        """Ends the read with `failure`, unless it has failed already. Pieces that were not begun are not read."""
        with self._changed:
            if self._failure is None:
                self._failure = failure
            self._changed.notify_all()

    def _read_pieces(self) -> None:
        while True:
            with self._changed:
                if self._failure is not None or not self._left:
                    return
                place, piece = self._left.pop()
            try:
                data = self._read_piece(piece)
            except BaseException as error:  # run() raises it in the thread that waits
                self.fail(error)
                return
            with self._changed:
                self._found[place] = data
                self._missing -= 1
                self._changed.notify_all()


def _pieces(offset: int, count: int) -> list[Range]:
    end = offset + count
    return [(at, min(_PIECE, end - at)) for at in range(offset, end, _PIECE)]


def sidecar_url(url: str) -> str:
    """Returns the URL of the sidecar of the file at `url`. For http and https, keeps the query, not the fragment."""
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not (parts.query or parts.fragment):
        return url + ".json"
    return urlunsplit(parts._replace(path=parts.path + ".json", fragment=""))


def changed_while_read(url: str) -> InputError:
    """Returns the error for a file that changed since it was first read."""
    return InputError(f"{url}: changed while it was read; open it again")


def sidecar_text(url: str, data: bytes) -> str:
    """Returns the bytes of a sidecar from `url` as text. Raises InputError if they are too many or not UTF-8."""
    if len(data) > LONGEST_SIDECAR:
        raise InputError(f"{url}: more than {LONGEST_SIDECAR} bytes are no sidecar")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InputError(f"{url}: is no text, so no sidecar") from None
