"""What the driver asks of an experiment, and what it gives to one."""

import dataclasses
import pathlib

import programs
import store
import volumes


@dataclasses.dataclass
class Bench:
    """What measurements need."""

    directory: pathlib.Path
    weir: programs.Weir
    store: store.Store
    files: volumes.VolumeFiles
    scale: float = 4
    quick: bool = False
    full: bool = False
    peers: tuple = ()  # of peers.find_peers
    kept: pathlib.Path = None  # file with figures of peers that are not found

    def volumes(self):
        """Those of the tables of errors that can be had."""
        wanted = volumes.small_set() if self.quick else volumes.report_set(self.scale)
        if self.full:
            wanted = wanted + volumes.full_set()
        return [volume for volume in wanted if self.files.available(volume)]

    def few_bytes_volumes(self):
        """Those of the tables of few bytes, and of what is derived, that can be had."""
        wanted = volumes.few_bytes_set(64) if self.quick else [*volumes.real_set(), *volumes.few_bytes_set(256)]
        return [volume for volume in wanted if self.files.available(volume)]

    def scratch(self, name):
        """A path for a file that is in the way afterwards, whose directory exists."""
        path = self.directory / "work" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path


class Experiment:
    """One part of the report. `name` names its folder of measurements, its CSV and its place in report.md."""

    name = ""

    def measure(self, bench):
        """Makes its measurements through bench.store, each of which a later run finds."""
        raise NotImplementedError

    def text(self, measured):
        """Its tables as Markdown, of what store `measured` holds; some of it may be missing."""
        raise NotImplementedError

    def rows(self, measured):
        """The same figures as flat dictionaries with the same keys, for the CSV."""
        raise NotImplementedError

    def broken_promises(self, measured):
        """A line for each thing that must hold and does not."""
        del measured
        return []

    def pictures(self, measured, directory):
        """Name among the report's pictures -> the file that measuring left in `directory`."""
        del measured, directory
        return {}


def describe(volume):
    """How measurements name a volume."""
    return {"volume": volume.name, "extent": list(volume.extent), "type": volume.type, "note": volume.note}


def method_options(method):
    """Of `weir convert`, for what tables call `method`."""
    return {"auto": (), "paper": ("--preset", "paper")}.get(method, ("--encoding", method))


def size_text(extent):
    return " x ".join(str(n) for n in extent)


def remove_volume(path):
    """A converted volume and its sidecar."""
    pathlib.Path(path).unlink(missing_ok=True)
    pathlib.Path(f"{path}.json").unlink(missing_ok=True)
