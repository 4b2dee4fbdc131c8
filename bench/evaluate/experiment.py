"""The interface between the driver and the experiments."""

import dataclasses
import pathlib

import programs
import store
import volumes


@dataclasses.dataclass
class Bench:
    """Everything that an experiment needs to measure."""

    directory: pathlib.Path
    weir: programs.Weir
    store: store.Store
    files: volumes.VolumeFiles
    scale: float = 4
    quick: bool = False
    full: bool = False
    peers: tuple = ()  # from peers.find_peers
    kept: pathlib.Path = None  # the file with figures of peers that are not installed

    def volumes(self):
        """Returns the available volumes for the tables of errors."""
        wanted = volumes.small_set() if self.quick else volumes.report_set(self.scale)
        if self.full:
            wanted = wanted + volumes.full_set()
        return [volume for volume in wanted if self.files.available(volume)]

    def few_bytes_volumes(self):
        """Returns the available volumes for the tables of few bytes and of derived quantities."""
        wanted = volumes.few_bytes_set(64) if self.quick else [*volumes.real_set(), *volumes.few_bytes_set(256)]
        return [volume for volume in wanted if self.files.available(volume)]

    def scratch(self, name):
        """Returns the path of a temporary file, which the caller deletes. Its directory exists."""
        path = self.directory / "work" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path


class Experiment:
    """One part of the report. `name` names its folder of measurements, its CSV and its place in report.md."""

    name = ""

    def measure(self, bench):
        """Makes the experiment's measurements through bench.store, where a later run finds each of them."""
        raise NotImplementedError

    def text(self, measured):
        """Returns the experiment's tables as Markdown, from the store `measured`. Measurements may be missing."""
        raise NotImplementedError

    def rows(self, measured):
        """Returns the same figures for the CSV, as flat dictionaries that all have the same keys."""
        raise NotImplementedError

    def broken_promises(self, measured):
        """Returns a line for each promise that does not hold."""
        del measured
        return []

    def pictures(self, measured, directory):
        """Returns a dictionary: name among the report's pictures -> file that the measurement left in `directory`."""
        del measured, directory
        return {}


def describe(volume):
    """Returns the volume's name in measurements."""
    return {"volume": volume.name, "extent": list(volume.extent), "type": volume.type, "note": volume.note}


def method_options(method):
    """Returns the options of `weir convert` for the tables' `method`."""
    return {"auto": (), "paper": ("--preset", "paper")}.get(method, ("--encoding", method))


def size_text(extent):
    return " x ".join(str(n) for n in extent)


def remove_volume(path):
    """A converted volume and its sidecar."""
    pathlib.Path(path).unlink(missing_ok=True)
    pathlib.Path(f"{path}.json").unlink(missing_ok=True)
