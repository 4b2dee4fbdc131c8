"""Writes the report: report.md with each experiment's tables filled in, and the same figures as CSV and JSON."""

import csv
import json
import pathlib
import shutil

from behind import behind_text
from experiments.peers import Peers
from peer_tables import OTHERS

IMAGES = "images/evaluation"  # relative to the report
NOT_MEASURED = "*Not measured yet.*"


def write_report(experiments, measured, directory):
    """Writes evaluation.md, evaluation.json, a CSV for each experiment and the pictures into `directory`."""
    directory = pathlib.Path(directory)
    text = (pathlib.Path(__file__).parent / "report.md").read_text()
    rows = {}
    shutil.rmtree(directory / IMAGES, ignore_errors=True)  # removes pictures that no experiment makes any more
    (directory / IMAGES).mkdir(parents=True)
    for experiment in experiments:
        has_any = bool(measured.records(experiment.name))
        text = text.replace(f"@{experiment.name}@", experiment.text(measured) if has_any else NOT_MEASURED)
        if not has_any:
            continue
        rows[experiment.name] = experiment.rows(measured)
        write_csv(directory / f"{experiment.name}.csv", rows[experiment.name])
        for name, path in experiment.pictures(measured, directory).items():
            shutil.copyfile(path, directory / IMAGES / name)
    text = text.replace("@promises@", promises_text(broken_promises(experiments, measured)))
    text = text.replace("@first@", Peers().first_text(measured) if measured.records(Peers.name) else NOT_MEASURED)
    text = text.replace("@behind@", behind_text(measured))
    text = text.replace("@origin@", origin_text(measured.records()))
    (directory / "evaluation.md").write_text(text)
    (directory / "evaluation.json").write_text(json.dumps(rows, indent=1) + "\n")


def broken_promises(experiments, measured):
    """Returns a line for each promise that does not hold."""
    return [f"{experiment.name}: {line}" for experiment in experiments if measured.records(experiment.name)
            for line in (*several_versions(experiment, measured), *experiment.broken_promises(measured))]


def several_versions(experiment, measured):
    """Returns a line if the experiment's figures are of several versions of weir. Figures of peers may be older."""
    versions = sorted({record["weir"] for record in measured.records(experiment.name)
                       if record["result"].get("method") not in OTHERS})
    return [f"measured by {' and by '.join(versions)}; measure it with --again"] if len(versions) > 1 else []


def promises_text(broken):
    if not broken:
        return ("The run checks, for all that is measured here: sizes are met to the byte. No error is above that of the paper's preset.\n"
                "More bytes never give more error (packed files may have one exception, the step from which on they have a preview).\n"
                "Noise stays below its bound. No voxel's error is above `--max-error`. Lossless files have no error, and their pictures\n"
                "show none. Memory stays below its ceiling.")
    return "**Promises that are not kept:**\n\n" + "\n".join(f"* {line}" for line in broken)


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]) if rows else [], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def origin_text(records):
    """Returns when, on which machine and by which version the measurements were made, a line for each combination."""
    groups = {}
    for record in records:
        groups.setdefault((record["machine"], record["weir"]), []).append(record)
    lines = []
    for (machine, version), group in groups.items():
        dates = sorted(record["date"][:10] for record in group)
        names = ", ".join(sorted({record["experiment"] for record in group}))
        when = dates[0] if dates[0] == dates[-1] else f"{dates[0]} to {dates[-1]}"
        lines.append(f"* {when}, {version}, {machine}: {names}")
    return "\n".join(lines)


def publish(directory, docs):
    """Copies the report and its pictures to where users read them."""
    directory, docs = pathlib.Path(directory), pathlib.Path(docs)
    shutil.copyfile(directory / "evaluation.md", docs / "evaluation.md")
    shutil.rmtree(docs / IMAGES, ignore_errors=True)
    shutil.copytree(directory / IMAGES, docs / IMAGES)
