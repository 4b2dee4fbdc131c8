"""Packed files elsewhere: the head and the blocks that are asked for are read, in few requests."""

from __future__ import annotations

import json
from typing import Any, Optional, Union
from urllib.parse import urlsplit, urlunsplit

from . import _core
from .grid import Grid
from .options import text_of
from .remote_file import FsspecFile, HttpFile, RemoteFile


def open_remote_file(url: str, storage_options: Optional[dict[str, Any]]) -> RemoteFile:
    """What reads ranges of the file at `url`."""
    if urlsplit(url).scheme in ("http", "https") and not storage_options:
        return HttpFile(url)
    return FsspecFile(url, storage_options or {})


def sidecar_url(url: str) -> str:
    """Of the sidecar beside the file at `url`, with the same query."""
    parts = urlsplit(url)
    return urlunsplit(parts._replace(path=parts.path + ".json")) if parts.query else url + ".json"


class RemoteGrid(Grid):
    """A packed NanoVDB file elsewhere, of which only what is asked for is read. Made by weir.open.

    Values, samples, levels and macrocells are as of a Grid of the same file. What was read is kept, see `cache` of
    weir.open; `requests` and `bytes_read` count. render and verify want all of the file: UsageError.
    """

    def __init__(
        self, url: str, cache: Union[int, str] = "256MiB", storage_options: Optional[dict[str, Any]] = None
    ) -> None:
        self._path = url
        self._cache = cache
        self._storage_options = storage_options
        self._file = open_remote_file(url, storage_options)
        self._core = _core.open_remote(url, self._file.read, self._file.interrupt, text_of(cache))
        self._sidecar: Optional[dict[str, Any]] = None
        self._sidecar_read = False

    @property
    def requests(self) -> int:
        """How many were made so far."""
        return self._file.requests

    @property
    def bytes_read(self) -> int:
        """Of the file and its sidecar, so far."""
        return self._file.bytes_read

    @property
    def sidecar(self) -> Optional[dict[str, Any]]:
        """What weir.convert returned, from the URL with ".json" behind it, read once; None where there is none.

        Raises InputError where it is damaged, or of another file.
        """
        if not self._sidecar_read:
            path = sidecar_url(self._path)
            text = self._file.read_beside(path)
            if text is not None:
                self._sidecar = json.loads(self._core.checked_sidecar(text, path))
            self._sidecar_read = True
        return self._sidecar

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy in another process opens the URL there."""
        return RemoteGrid, (self._path, self._cache, self._storage_options)
