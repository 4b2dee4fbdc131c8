"""A file elsewhere, of which ranges are read by several threads: http_file.py and fsspec_file.py ask for them."""

from __future__ import annotations

import os
import threading
import weakref
from typing import Any, Callable, Optional, Sequence
from urllib.parse import urlsplit, urlunsplit

from .errors import InputError, IoError

#: Bytes from an offset on.
Range = tuple[int, int]

#: Longer ranges are read in pieces of so many bytes, at once.
_PIECE = 8 << 20
READS_AT_ONCE = 8
#: What servers answer where a file is missing: some stores say 401 or 403.
MISSING_FILE_STATUSES = (401, 403, 404, 410)
#: No sidecar is longer.
LONGEST_SIDECAR = 4 << 20


class RemoteFile:
    """A file of which parts are read, and counted. May be used by several threads."""

    def __init__(self) -> None:
        self.requests = 0
        self.bytes_read = 0
        self._lock = threading.Lock()
        self._reads: list[_Read] = []  # those under way
        self._forked = False
        _files.add(self)

    def begin_again(self) -> None:
        """In a process that was forked: connections, locks and threads are those of the other one."""
        self._lock = threading.Lock()
        self._reads = []
        self._forked = True

    def _connect(self) -> None:
        """Makes what requests go through, anew."""

    def _leave_the_forks_connections(self) -> None:
        with self._lock:
            if self._forked:
                self._connect()
            self._forked = False

    def read(self, ranges: Sequence[Range]) -> list[bytes]:
        """The bytes of each range, all there or an exception. In pieces, several at once."""
        pieces = [_pieces(*asked) for asked in ranges]
        found = iter(self._run(self._read_piece, [piece for parts in pieces for piece in parts]))
        return [b"".join(next(found) for _ in parts) for parts in pieces]

    def _run(self, work: Callable[[Range], Any], pieces: Sequence[Range]) -> list[Any]:
        """What `work` makes of each piece, by threads that interrupt() makes nobody wait for."""
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
        """`work` through the connections that there are now, whatever _give_up() makes of those to come."""
        return work

    def _give_up(self) -> None:
        """Lets requests that are under way end by themselves, and keeps them from those to come."""

    def read_beside(self, url: str) -> Optional[str]:
        """The text of another, short file of the same place; None where it is missing."""
        raise NotImplementedError

    def _read_piece(self, piece: Range) -> bytes:
        raise NotImplementedError

    def _count(self, data: bytes) -> bytes:
        with self._lock:
            self.requests += 1
            self.bytes_read += len(data)
        return data


#: All there are, which a fork copies.
_files: weakref.WeakSet[RemoteFile] = weakref.WeakSet()


def _begin_again() -> None:
    for file in list(_files):
        file.begin_again()


os.register_at_fork(after_in_child=_begin_again)


def _start(work: Callable[[], None], threads: int) -> int:
    """As many of `threads` threads that do `work` as the system starts."""
    for started in range(threads):
        try:
            threading.Thread(target=work, daemon=True).start()
        except RuntimeError:
            return started
    return threads


class _Read:
    """Pieces of a file, read several at once by threads of their own, which a caller need not wait for, and which keep no
    program from ending: one that waits for a server cannot be told to stop."""

    def __init__(self, read_piece: Callable[[Range], Any], pieces: Sequence[Range]) -> None:
        self._read_piece = read_piece
        self._left = list(enumerate(pieces))[::-1]
        self._found: list[Any] = [None] * len(pieces)
        self._missing = len(pieces)
        self._failure: Optional[BaseException] = None
        self._changed = threading.Condition()

    def run(self) -> list[Any]:
        """The pieces, all there or an exception: the first one."""
        wanted = min(READS_AT_ONCE, len(self._found))
        if _start(self._read_pieces, wanted) == 0 and wanted > 0:
            self._read_pieces()  # here, where the system starts no thread
        with self._changed:
            self._changed.wait_for(lambda: self._failure is not None or self._missing == 0)
            if self._failure is not None:
                raise self._failure
        return self._found

    def fail(self, failure: BaseException) -> None:
        """Ends it with `failure`, but for one that is there already; pieces that nobody has begun are left."""
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
            except BaseException as error:  # goes on to whoever waits
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
    """Of the sidecar beside the file at `url`, for http and https with the same query, and without a fragment."""
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not (parts.query or parts.fragment):
        return url + ".json"
    return urlunsplit(parts._replace(path=parts.path + ".json", fragment=""))


def changed_while_read(url: str) -> InputError:
    """Raised where a file is another one than before."""
    return InputError(f"{url}: changed while it was read; open it again")


def sidecar_text(url: str, data: bytes) -> str:
    """The text of a sidecar at `url`. Raises InputError."""
    if len(data) > LONGEST_SIDECAR:
        raise InputError(f"{url}: more than {LONGEST_SIDECAR} bytes are no sidecar")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InputError(f"{url}: is no text, so no sidecar") from None
