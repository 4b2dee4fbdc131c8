"""Measurements on disk: a JSON file for each, so that what is finished is never done twice.

DIR/state/EXPERIMENT/NAME.json holds {"experiment", "name", "date", "machine", "weir", "load", "result"}; `load` is the
machine's load average of the minute before, `result` whatever the experiment measured. A file appears whole or not at
all.
"""

import datetime
import json
import os
import pathlib
import re
import sys


class Store:
    """The measurements of one directory.

    `origin` says of every new measurement where it is from ("machine", "weir"); with `again`, measurements that are
    there already are made anew, once a run.
    """

    def __init__(self, directory, origin=None, again=False):
        self._state = pathlib.Path(directory) / "state"
        self._origin = origin or {}
        self._again = again

    def measure(self, experiment, name, function):
        """Returns the result of `experiment`'s measurement `name`: the stored one, or that of function(), then
        stored."""
        path = self._path(experiment, name)
        if path.exists() and not self._again:
            return json.loads(path.read_text())["result"]
        print(f"{experiment}: {name}", file=sys.stderr, flush=True)
        load = os.getloadavg()[0]  # taken before the measurement: the load of other programs
        record = {"experiment": experiment, "name": name, **self._origin, "load": load, "result": function()}
        record["date"] = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
        _write(path, record)
        return record["result"]

    def adopt(self, record):
        """Adds a record of another store, unless this store has a record of that name."""
        path = self._path(record["experiment"], record["name"])
        if not path.exists():
            _write(path, record)

    def records(self, experiment="*"):
        """Returns all records of an experiment, in the order in which they were named."""
        paths = self._state.glob(f"{experiment}/*.json")
        return sorted((json.loads(path.read_text()) for path in paths), key=lambda r: (r["experiment"], r["name"]))

    def results(self, experiment):
        return [record["result"] for record in self.records(experiment)]

    def _path(self, experiment, name):
        return self._state / experiment / (re.sub(r"[^A-Za-z0-9._-]", "_", name) + ".json")


def _write(path, record):
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(record, indent=1) + "\n")
    os.replace(partial, path)
