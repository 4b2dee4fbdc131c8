"""Opens packed files at URLs. Only the head and the requested blocks are read, in few requests."""

from __future__ import annotations

import json
import re
from typing import Any, Mapping, Optional, Union

from . import _core
from .errors import UsageError
from .fsspec_file import FsspecFile
from .grid import Grid
from .http_file import HttpFile
from .options import shown_url, text_of
from .remote_file import RemoteFile, sidecar_url


def open_remote_file(url: str, storage_options: Optional[dict[str, Any]]) -> RemoteFile:
    """Returns the RemoteFile that reads ranges of the file at `url`. Raises UsageError."""
    options = _dictionary("storage_options", storage_options)
    if url.partition("://")[0].lower() in ("http", "https"):
        headers = _headers_alone(options)
        if headers is not None:
            return HttpFile(url, headers)
    return FsspecFile(url, options)


def _dictionary(shown: str, value: Any) -> dict[str, Any]:
    """Returns `value` as a dictionary; None becomes an empty one. Raises UsageError for anything else, without
    showing `value`, which may hold a password."""
    if value is None:
        return {}
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise UsageError(
            f"{shown} is of type {value.__class__.__name__}, it must be a dictionary whose keys are texts"
        )
    return dict(value)


def _headers(shown: str, value: Any) -> dict[str, str]:
    """Returns `value` as the headers of a request. Raises UsageError for headers that a request cannot carry."""
    headers = _dictionary(shown, value)
    for name, text in headers.items():
        if not isinstance(text, str):
            raise UsageError(f"{shown}[{name!r}] is of type {text.__class__.__name__}, it must be a text")
        if not re.fullmatch(r"[!-9;-~]+", name) or not re.fullmatch(r"[^\x00\r\n\u0100-\U0010ffff]*", text):
            raise UsageError(f"{shown}[{name!r}] has a character that no header has, a line break for instance; remove it")
    return headers


def _headers_alone(options: Mapping[str, Any]) -> Optional[dict[str, str]]:
    """Returns the headers in fsspec's `options` of http. None if there are other options, too.

    With headers alone HttpFile is used: if a server does not support ranges, fsspec reads the whole file into memory,
    but HttpFile refuses the file.
    """
    client = _dictionary("storage_options['client_kwargs']", options.get("client_kwargs"))
    if options.keys() - {"headers", "client_kwargs"} or client.keys() - {"headers"}:
        return None
    of_client = _headers("storage_options['client_kwargs']['headers']", client.get("headers"))
    return {**of_client, **_headers("storage_options['headers']", options.get("headers"))}


class RemoteGrid(Grid):
    """A packed NanoVDB file at a URL. Only the requested parts are read. weir.open makes a RemoteGrid.

    Values, samples, levels and macrocells equal those of a Grid of the same file. Bytes that were read are kept, see
    `cache` of weir.open. `requests` and `bytes_read` count what was read. render and verify need the whole file and
    raise UsageError.
    """

    _samples_decode_their_blocks = True

    def __init__(
        self, url: str, cache: Union[int, str] = "256MiB", storage_options: Optional[dict[str, Any]] = None
    ) -> None:
        self._url = url
        self._path = shown_url(url)
        self._cache = cache
        self._storage_options = storage_options
        self._file = open_remote_file(url, storage_options)
        self._core = _core.open_remote(self._path, self._file.read, self._file.interrupt, text_of(cache))
        self._sidecar: Optional[dict[str, Any]] = None
        self._sidecar_read = False

    @property
    def requests(self) -> int:
        """How many requests returned bytes so far. Redirects, failed attempts and missing sidecars are not counted."""
        return self._file.requests

    @property
    def bytes_read(self) -> int:
        """How many bytes of the file and its sidecar were read so far."""
        return self._file.bytes_read

    @property
    def sidecar(self) -> Optional[dict[str, Any]]:
        """What weir.convert returned, read once from the URL with ".json" after its path. None if there is no sidecar.

        Raises InputError if the sidecar is damaged or belongs to another file.
        """
        self._refuse_closed()
        if not self._sidecar_read:
            url = sidecar_url(self._url)
            text = self._file.read_beside(url)
            if text is not None:
                self._sidecar = json.loads(self._core.checked_sidecar(text, shown_url(url)))
            self._sidecar_read = True
        return self._sidecar

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the grid as its whole URL, with cache and storage_options, secrets too. Unpickling opens the URL."""
        self._refuse_closed()
        return RemoteGrid, (self._url, self._cache, self._storage_options)
