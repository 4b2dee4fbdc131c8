"""Reads ranges of a file by http or https, through urllib3."""

from __future__ import annotations

import base64
import contextlib
import functools
import re
import threading
from typing import TYPE_CHECKING, Any, Callable, Iterator, Mapping, NamedTuple, Optional
from urllib.parse import unquote_to_bytes, urljoin

from .errors import InputError, InputNotFoundError, InputPermissionError, IoError, UsageError
from .options import shown_url
from .remote_file import (
    LONGEST_SIDECAR,
    MISSING_FILE_STATUSES,
    READS_AT_ONCE,
    Range,
    RemoteFile,
    changed_while_read,
    sidecar_text,
)

if TYPE_CHECKING:
    import urllib3

#: Seconds before each repetition of a failed request.
_WAITS = (0.2, 0.4, 0.8)
#: The longest wait in seconds that is granted when a server asks for one.
_LONGEST_WAIT = 30
_MOST_REDIRECTS = 10
#: Content-Encodings whose bytes are not the file's own bytes.
_COMPRESSED = ("gzip", "x-gzip", "deflate", "compress", "x-compress", "br", "zstd")
#: Statuses of servers that are busy. A later request may succeed.
_BUSY = (429, 500, 502, 503, 504)
#: Headers that are not sent on to another server after a redirect.
_FOR_ONE_SERVER = ("authorization", "cookie", "proxy-authorization")
#: Headers that HttpFile sets itself. The caller's are ignored.
_OWN_HEADERS = ("accept-encoding", "if-range", "range")
#: An unwanted body of at most this many bytes is read to its end, so that the connection can be used again.
_SHORT_BODY = 16 << 10


class _BrokenConnection(IoError):
    """The body of an answer ended too early."""


class _Connections(NamedTuple):
    """The connection pool of requests. After `given_up` is set, no new requests go through the pool."""

    given_up: threading.Event
    pool: urllib3.PoolManager


class HttpFile(RemoteFile):
    """A file that is read by http or https from a server that answers range requests. Each request carries `headers`.
    User and password of the URL become the header Authorization, unless `headers` has one."""

    def __init__(self, url: str, headers: Optional[Mapping[str, str]] = None) -> None:
        super().__init__()
        self._url = url
        self._shown = shown_url(url)
        try:
            import urllib3
        except ImportError:
            raise UsageError(f"{self._shown}: reading it wants urllib3; install python3-urllib3") from None
        self._failures = urllib3.exceptions.HTTPError
        self._headers = {name: text for name, text in (headers or {}).items() if name.lower() not in _OWN_HEADERS}
        self._headers["Accept-Encoding"] = "identity"
        user = _parsed(url, self._shown).auth
        if user is not None and not any(name.lower() == "authorization" for name in self._headers):
            self._headers["Authorization"] = _basic_authorization(user)
        self._connect()
        self._version: Optional[str] = None  # sent as If-Range, so that the server notices that the file has changed
        self._tag: Optional[str] = None  # compared here, in case the server does not notice
        self._total: Optional[str] = None  # the file's length in bytes, as the server states it

    def _connect(self) -> None:
        import urllib3

        timeout = urllib3.Timeout(connect=10, read=30)
        self._connections = _Connections(
            threading.Event(), urllib3.PoolManager(maxsize=READS_AT_ONCE, block=True, timeout=timeout)
        )

    def _give_up(self) -> None:
        self._connections.given_up.set()
        self._connect()

    def _through_these_connections(self, work: Callable[[Range], Any]) -> Callable[[Range], Any]:
        return functools.partial(work, through=self._connections)

    def _read_piece(self, piece: Range, through: Optional[_Connections] = None) -> bytes:
        through = through or self._connections
        return self._again_where_it_breaks(functools.partial(self._ask_for, piece, through), through)

    def _again_where_it_breaks(self, ask: Callable[[], Any], through: _Connections) -> Any:
        """Returns what `ask` returns. While connections break, calls `ask` again, once for each of _WAITS."""
        for wait in _WAITS:
            try:
                return ask()
            except _BrokenConnection:
                if through.given_up.wait(wait):
                    break
        try:
            return ask()
        except _BrokenConnection as error:
            raise IoError(f"{error}; try again, or copy the file to this machine") from error

    def _ask_for(self, piece: Range, through: _Connections) -> bytes:
        offset, count = piece
        headers = {"Range": f"bytes={offset}-{offset + count - 1}"}
        if self._version is not None:
            headers["If-Range"] = self._version
        with self._answer(self._url, headers, through) as response:
            if response.status == 416:
                raise InputError(
                    f"{self._shown}: ends before byte {offset + count}; is it complete, and a NanoVDB file?"
                )
            if response.status == 200 and self._version is not None:
                raise changed_while_read(self._shown)
            if response.status == 200:
                raise InputError(
                    f"{self._shown}: its server sends whole files only (status 200); copy the file to this machine"
                )
            _check_status(self._shown, response)
            self._check_range(response, offset, count)
            data = self._body(response, count + 1, self._shown)
        if len(data) != count:
            raise InputError(f"{self._shown}: {len(data)} bytes instead of {count} at byte {offset}; is it complete?")
        return self._count(data)

    def _check_range(self, response: urllib3.HTTPResponse, offset: int, count: int) -> None:
        said = response.headers.get("Content-Range", "")
        first, last, total = _range_in(said)
        if response.status != 206 or first != offset or last >= offset + count:
            raise IoError(
                f"{self._shown}: its server answers bytes {offset} to {offset + count - 1} with status "
                f'{response.status} and Content-Range "{said}"; copy the file to this machine'
            )
        tag = _tag(response)
        if self._tag is None:
            self._tag = tag
        elif tag is not None and tag != self._tag:
            raise changed_while_read(self._shown)
        version = _version(response)
        if self._version is None:
            self._version = version
        elif tag is None and version is not None and version != self._version:
            raise changed_while_read(self._shown)
        if self._total is None:
            self._total = total
        elif total is not None and total != self._total:
            raise changed_while_read(self._shown)

    def read_beside(self, url: str) -> Optional[str]:
        self._leave_the_forks_connections()
        through = self._connections
        data = self._again_where_it_breaks(functools.partial(self._ask_for_sidecar, url, through), through)
        return None if data is None else sidecar_text(shown_url(url), self._count(data))

    def _ask_for_sidecar(self, url: str, through: _Connections) -> Optional[bytes]:
        with self._answer(url, {}, through) as response:
            if response.status in MISSING_FILE_STATUSES:
                return None
            _check_status(shown_url(url), response)
            return self._body(response, LONGEST_SIDECAR + 1, shown_url(url))

    @contextlib.contextmanager
    def _answer(self, url: str, headers: dict[str, str], through: _Connections) -> Iterator[urllib3.HTTPResponse]:
        """Yields the answer to a request. Afterwards, does not wait for the part of the body that was not read."""
        response = self._first_answer(url, {**self._headers, **headers}, through)
        try:
            yield response
        finally:
            self._leave(response)

    def _first_answer(self, url: str, headers: dict[str, str], through: _Connections) -> urllib3.HTTPResponse:
        """Returns the first answer that is no redirect and not from a busy server. Repeats once for each of _WAITS.

        urllib3's own redirects and retries are not used, because urllib3 reads the whole body of each skipped answer.
        """
        shown = shown_url(url)
        waits = iter(_WAITS)
        redirects = 0
        while True:
            if through.given_up.is_set():
                raise IoError(f"{shown}: reading was interrupted")
            try:
                response = through.pool.request(
                    "GET",
                    url,
                    headers=headers,
                    redirect=False,
                    retries=False,
                    preload_content=False,
                    decode_content=False,
                )
            except self._failures as error:
                wait = next(waits, None)
                if wait is None:
                    raise IoError(f"{shown}: cannot be read: {_reason(error)}") from error
                through.given_up.wait(wait)
                continue
            place = response.get_redirect_location()
            if place:
                self._leave(response)
                redirects += 1
                if redirects > _MOST_REDIRECTS:
                    raise IoError(f"{shown}: cannot be read: too many redirects")
                url, headers = _redirected(url, headers, place, shown)
                continue
            wait = next(waits, None) if response.status in _BUSY else None
            if wait is None:
                return response
            self._leave(response)
            through.given_up.wait(self._wait_asked_by(response, wait))

    def _wait_asked_by(self, response: urllib3.HTTPResponse, otherwise: float) -> float:
        import urllib3

        try:
            asked = urllib3.Retry().get_retry_after(response)
        except (self._failures, OverflowError, TypeError, ValueError):  # Retry-After is neither a number nor a date
            return otherwise
        return otherwise if asked is None else min(asked, _LONGEST_WAIT)

    def _leave(self, response: urllib3.HTTPResponse) -> None:
        """Releases an answer. Closes its connection if more than _SHORT_BODY bytes have not been read."""
        left = response.length_remaining
        if left is not None and left <= _SHORT_BODY:  # also for 0: only a read tells the connection that the body ended
            with contextlib.suppress(self._failures):
                response.read(left + 1, decode_content=False)
        if response.length_remaining != 0:  # the connection still has the rest of the body
            response.close()
        response.release_conn()

    def _body(self, response: urllib3.HTTPResponse, most: int, shown: str) -> bytes:
        coding = response.headers.get("Content-Encoding", "").strip()
        # A few compressed bytes could expand to any number. Other codings, such as "aws-chunked", are harmless: a
        # store noted them at the upload.
        if any(part.strip().lower() in _COMPRESSED for part in coding.split(",")):
            raise InputError(f"{shown}: its server sends compressed bytes ({coding[:40]}); copy the file to this machine")
        try:
            data = response.read(most, decode_content=False)
        except self._failures as error:
            raise _BrokenConnection(f"{shown}: the connection broke: {error}") from error
        if len(data) < most and response.length_remaining:
            raise _BrokenConnection(f"{shown}: the connection broke: {response.length_remaining} bytes did not come")
        return data


def _parsed(url: str, shown: str) -> urllib3.util.Url:
    """Parses a URL with urllib3, so that checks see the server that urllib3 connects to. Raises UsageError."""
    import urllib3

    try:
        parts = urllib3.util.parse_url(url)
    except ValueError:
        parts = None
    if parts is None or parts.scheme not in ("http", "https") or not parts.host:
        # A password with a slash or a number sign makes the URL invalid, and shown_url() does not hide it.
        hidden = re.sub(r"://.*@", "://***@", shown, flags=re.DOTALL)
        raise UsageError(f"{hidden}: is no URL of http or https; correct it")
    return parts


def _basic_authorization(user: str) -> str:
    """Returns the header Authorization for `user`, "user:password" with %-encoding as in a URL."""
    name, _, password = user.partition(":")
    both = unquote_to_bytes(name) + b":" + unquote_to_bytes(password)
    return "Basic " + base64.b64encode(both).decode()


def _redirected(url: str, headers: dict[str, str], place: str, shown: str) -> tuple[str, dict[str, str]]:
    """Returns the URL to which `place` redirects from `url`, and the headers of the request there."""
    try:
        target = urljoin(url, place)
        same_server = _server(url, shown) == _server(target, shown)
    except ValueError:
        where = shown_url(place)[:200]
        raise IoError(f"{shown}: its server redirects to {where!r}, which is no URL of http or https") from None
    if same_server:
        return target, headers
    return target, {name: text for name, text in headers.items() if name.lower() not in _FOR_ONE_SERVER}


def _server(url: str, shown: str) -> tuple[str, str, int]:
    parts = _parsed(url, shown)
    return parts.scheme, parts.host, parts.port or {"http": 80, "https": 443}[parts.scheme]


def _reason(error: Exception) -> str:
    """Returns the message of `error` without urllib3's descriptions of its own objects."""
    text = str(getattr(error, "reason", None) or error)
    return re.sub(r"^<[^>]*>: ", "", text)


def _range_in(said: str) -> tuple[int, int, Optional[str]]:
    """Returns (8, 15, "100") for the Content-Range "bytes 8-15/100". The total is None if it is unknown. Returns
    (-1, -1, None) for other texts."""
    found = re.match(r"bytes (\d+)-(\d+)/(\d+)?", said)
    return (int(found[1]), int(found[2]), found[3]) if found else (-1, -1, None)


def _version(response: urllib3.HTTPResponse) -> Optional[str]:
    """Returns the value for If-Range: a strong ETag, or Last-Modified. A weak tag does not promise equal bytes."""
    tag = response.headers.get("ETag")
    if tag is not None and not tag.startswith("W/"):
        return tag
    return response.headers.get("Last-Modified")


def _tag(response: urllib3.HTTPResponse) -> Optional[str]:
    """Returns the ETag of an answer without "W/", weak or strong. A different tag is taken for a changed file."""
    tag = response.headers.get("ETag")
    return None if tag is None else tag.removeprefix("W/")


def _check_status(url: str, response: urllib3.HTTPResponse) -> None:
    if response.status < 300:
        return
    said = f"{url}: its server says {response.status} {response.reason or ''}".rstrip()
    if response.status in (404, 410):
        raise InputNotFoundError(2, f"{said}; there is no such file", url)
    if response.status in (401, 403):
        raise InputPermissionError(13, f"{said}; it may not be read without other rights", url)
    raise IoError(said)
