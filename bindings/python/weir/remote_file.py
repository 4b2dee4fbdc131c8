"""Ranges of a file elsewhere: by HTTP through urllib3, by all else through fsspec."""

from __future__ import annotations

import contextlib
import os
import re
import threading
import weakref
from typing import TYPE_CHECKING, Any, Callable, Iterator, Optional, Sequence

from .errors import InputError, InputNotFoundError, InputPermissionError, IoError, UsageError

if TYPE_CHECKING:
    import urllib3

#: Bytes from an offset on.
Range = tuple[int, int]

#: Longer ranges are read in pieces of so many bytes, at once.
_PIECE = 8 << 20
_AT_ONCE = 8
#: Seconds before a request that failed is made once more.
_WAITS = (0.2, 0.4, 0.8)
#: Seconds that a server may ask to wait.
_LONGEST_WAIT = 30
#: What a file system says of one version of a file: its size and tag, or times.
_OF_VERSION = ("size", "ETag", "etag", "generation", "mtime", "created", "modified", "LastModified", "last_modified")
#: No sidecar is longer.
_LONGEST_SIDECAR = 4 << 20


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
        read = _Read(work, pieces)
        with self._lock:
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
        wanted = min(_AT_ONCE, len(self._found))
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


class _BrokenConnection(IoError):
    """The body of an answer ended before its end."""


class HttpFile(RemoteFile):
    """A file by http or https, from a server that answers requests for ranges."""

    def __init__(self, url: str) -> None:
        super().__init__()
        try:
            import urllib3
        except ImportError:
            raise UsageError(f"{url}: reading it wants urllib3; install python3-urllib3") from None
        self._url = url
        self._failures = urllib3.exceptions.HTTPError
        self._connect()
        self._version: Optional[str] = None  # by which the server tells that the file has changed

    def _connect(self) -> None:
        self._given_up = threading.Event()
        self._pool = _connections(self._given_up)

    def _give_up(self) -> None:
        self._given_up.set()
        self._connect()

    def _read_piece(self, piece: Range) -> bytes:
        for wait in _WAITS:
            try:
                return self._ask_for(piece)
            except _BrokenConnection:
                if self._given_up.wait(wait):
                    raise
        return self._ask_for(piece)

    def _ask_for(self, piece: Range) -> bytes:
        offset, count = piece
        headers = {"Range": f"bytes={offset}-{offset + count - 1}", "Accept-Encoding": "identity"}
        if self._version is not None:
            headers["If-Range"] = self._version
        with self._answer(self._url, headers) as response:
            if response.status == 416:
                raise InputError(f"{self._url}: ends before byte {offset + count}; is it complete, and a NanoVDB file?")
            if response.status == 200 and self._version is not None:
                raise InputError(f"{self._url}: changed while it was read; open it again")
            if response.status == 200:
                raise InputError(f"{self._url}: its server sends whole files only (status 200); copy the file to this machine")
            _check_status(self._url, response)
            self._check_range(response, offset, count)
            data = self._body(response, count + 1)
        if len(data) != count:
            raise InputError(f"{self._url}: {len(data)} bytes instead of {count} at byte {offset}; is it complete?")
        return self._count(data)

    def _check_range(self, response: urllib3.HTTPResponse, offset: int, count: int) -> None:
        said = response.headers.get("Content-Range", "")
        first, last = _range_in(said)
        if response.status != 206 or first != offset or last >= offset + count:
            raise IoError(
                f"{self._url}: its server answers bytes {offset} to {offset + count - 1} with status {response.status} and "
                f'Content-Range "{said}"; copy the file to this machine'
            )
        version = _version(response)
        if self._version is None:
            self._version = version
        elif version is not None and version != self._version:
            raise InputError(f"{self._url}: changed while it was read; open it again")

    def read_beside(self, url: str) -> Optional[str]:
        self._leave_the_forks_connections()
        with self._answer(url, {"Accept-Encoding": "identity"}) as response:
            if response.status in (401, 403, 404, 410):  # some stores say 403 of what is missing
                return None
            _check_status(url, response)
            data = self._body(response, _LONGEST_SIDECAR + 1)
        return _sidecar_text(url, self._count(data))

    @contextlib.contextmanager
    def _answer(self, url: str, headers: dict[str, str]) -> Iterator[urllib3.HTTPResponse]:
        """The answer to a request, of which what is not read is not waited for."""
        try:
            response = self._pool.request("GET", url, headers=headers, preload_content=False)
        except self._failures as error:
            raise IoError(f"{url}: cannot be read: {_reason(error)}") from error
        try:
            yield response
        finally:
            if response.length_remaining != 0:  # the connection still has the rest of the body
                response.close()
            response.release_conn()

    def _body(self, response: urllib3.HTTPResponse, most: int) -> bytes:
        try:
            data = response.read(most)
        except self._failures as error:
            raise _BrokenConnection(f"{self._url}: the connection broke: {error}") from error
        if len(data) < most and response.length_remaining:
            raise _BrokenConnection(f"{self._url}: the connection broke: {response.length_remaining} bytes did not come")
        return data


class FsspecFile(RemoteFile):
    """A file by any of fsspec's file systems."""

    def __init__(self, url: str, options: dict[str, Any]) -> None:
        super().__init__()
        try:
            import fsspec.core
        except ImportError:
            raise UsageError(f"{url}: reading it wants fsspec; install python3-fsspec") from None
        self._url = url
        self._options = options
        try:
            self._connect()
        except (ImportError, ValueError) as error:
            raise UsageError(f"{url}: cannot be opened: {error}") from error
        self._version: Optional[dict[str, Any]] = None  # as of the first bytes that were read

    def read(self, ranges: Sequence[Range]) -> list[bytes]:
        if self._version is None:
            self._version = self._run(self._found_version, [(0, 0)])[0]
        found = super().read(ranges)
        version = self._run(self._found_version, [(0, 0)])[0]
        if self._version is not None and version is not None and version != self._version:
            raise InputError(f"{self._url}: changed while it was read; open it again")
        return found

    def _connect(self) -> None:
        import fsspec.core

        self._system, self._path = fsspec.core.url_to_fs(self._url, **self._options)

    def _found_version(self, _: Range) -> Optional[dict[str, Any]]:
        """What the file system says of the file now; None where it says nothing."""
        try:
            self._system.invalidate_cache(self._path)
            info = self._system.info(self._path)
        except Exception:  # each file system has its own; what it means is seen by reading
            return None
        # Of files here "created" is the time of any change, of the mode too.
        said = [name for name in _OF_VERSION if name in info and (name != "created" or "mtime" not in info)]
        return {name: info[name] for name in said}

    def _read_piece(self, piece: Range) -> bytes:
        offset, count = piece
        data = self._cat(self._path, offset, offset + count)
        if len(data) != count:
            raise InputError(
                f"{self._url}: {len(data)} bytes instead of {count} at byte {offset}; is it complete, and a NanoVDB file?"
            )
        return self._count(data)

    def read_beside(self, url: str) -> Optional[str]:
        self._leave_the_forks_connections()
        try:
            data = self._cat(self._path + ".json", 0, _LONGEST_SIDECAR + 1)
        except (FileNotFoundError, PermissionError):
            return None
        return _sidecar_text(url, self._count(data))

    def _cat(self, path: str, start: int, end: int) -> bytes:
        try:
            return self._system.cat_file(path, start=start, end=end)
        except FileNotFoundError as error:
            raise InputNotFoundError(2, f"{self._url}: there is no such file", self._url) from error
        except PermissionError as error:
            raise InputPermissionError(13, f"{self._url}: may not be read: {error}", self._url) from error
        except Exception as error:  # each file system has its own
            raise IoError(f"{self._url}: cannot be read: {error or error.__class__.__name__}") from error


def _connections(given_up: threading.Event) -> urllib3.PoolManager:
    """Connections that are tried again a few times, until `given_up`."""
    import urllib3

    class Retries(urllib3.Retry):
        def is_exhausted(self) -> bool:
            return given_up.is_set() or super().is_exhausted()

        def get_retry_after(self, response: urllib3.HTTPResponse) -> Optional[float]:
            wait = super().get_retry_after(response)
            return None if wait is None else min(wait, _LONGEST_WAIT)

    retries = Retries(total=len(_WAITS), backoff_factor=0.2, status_forcelist=(429, 500, 502, 503, 504), raise_on_status=False)
    return urllib3.PoolManager(maxsize=_AT_ONCE, block=True, retries=retries, timeout=urllib3.Timeout(connect=10, read=30))


def _reason(error: Exception) -> str:
    """What went wrong, without urllib3's own words for its objects."""
    text = str(getattr(error, "reason", None) or error)
    return re.sub(r"^<[^>]*>: ", "", text)


def _pieces(offset: int, count: int) -> list[Range]:
    end = offset + count
    return [(at, min(_PIECE, end - at)) for at in range(offset, end, _PIECE)]


def _range_in(said: str) -> tuple[int, int]:
    """The first and last byte of "bytes 8-15/100"; -1 where it says none."""
    found = re.match(r"bytes (\d+)-(\d+)/", said)
    return (int(found[1]), int(found[2])) if found else (-1, -1)


def _version(response: urllib3.HTTPResponse) -> Optional[str]:
    """What a server answers ranges of this version alone for; a weak tag promises too little."""
    tag = response.headers.get("ETag")
    if tag is not None and not tag.startswith("W/"):
        return tag
    return response.headers.get("Last-Modified")


def _check_status(url: str, response: urllib3.HTTPResponse) -> None:
    if response.status < 300:
        return
    said = f"{url}: its server says {response.status} {response.reason or ''}".rstrip()
    if response.status in (404, 410):
        raise InputNotFoundError(2, f"{said}; there is no such file", url)
    if response.status in (401, 403):
        raise InputPermissionError(13, f"{said}; it may not be read without other rights", url)
    raise IoError(said)


def _sidecar_text(url: str, data: bytes) -> str:
    if len(data) > _LONGEST_SIDECAR:
        raise InputError(f"{url}: more than {_LONGEST_SIDECAR} bytes are no sidecar")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InputError(f"{url}: is no text, so no sidecar") from None
