"""Runs the experiments and writes the report: see ../evaluate.sh."""

import argparse
import os
import pathlib
import signal
import sys

import programs
from experiment import Bench
from experiments.derived import Derived
from experiments.errors import Errors
from experiments.few_bytes import FewBytes
from experiments.headline import Headline
from experiments.lossless import Lossless
from experiments.metrics import Metrics
from experiments.peers import Peers, keep_records
from experiments.pictures import Pictures
from experiments.round_trip import RoundTrip
from experiments.sizes import Sizes
from experiments.speed import Speed
from experiments.stages import Stages
from experiments.two_passes import TwoPasses
from experiments.worst_case import WorstCase
from experiments.zfp import Zfp
from peers import find_peers
from report import broken_promises, publish, write_report
from store import Store
from volumes import VolumeFiles

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXPERIMENTS = (Sizes(), WorstCase(), Errors(), FewBytes(), Lossless(), Derived(), Metrics(), Zfp(), Peers(), RoundTrip(), Pictures(),
               Speed(), TwoPasses(), Stages(), Headline())


def parse(arguments):
    parser = argparse.ArgumentParser(prog="bench/evaluate.sh", description="Measures what docs/evaluation.md claims.")
    parser.add_argument("directory", nargs="?", type=pathlib.Path, help="default: build/evaluation, or "
                        "build/evaluation-quick with --quick")
    parser.add_argument("--only", default="", help="experiments, between commas: "
                        + ", ".join(experiment.name for experiment in EXPERIMENTS))
    parser.add_argument("--again", action="store_true", help="measure anew what is there already")
    parser.add_argument("--report", action="store_true", help="no measurement, only the report of those there are")
    parser.add_argument("--scale", type=float, default=4, help="divides the extents of the paper's large sets")
    parser.add_argument("--full", action="store_true", help="besides, the sets at the paper's extents")
    parser.add_argument("--quick", action="store_true", help="small volumes only, for the tests")
    parser.add_argument("--publish", action="store_true", help="copy report and pictures to docs/ as well")
    parser.add_argument("--kept", type=pathlib.Path, default=pathlib.Path(__file__).parent / "kept.json", metavar="FILE",
                        help="figures of peers for runs that do not find them; --publish writes it")
    parser.add_argument("--weir", type=pathlib.Path, default=ROOT / "build/release/weir", help="the command to measure")
    for name, program in (("sperr", "sperr3d"), ("sz3", "sz3")):
        parser.add_argument(f"--{name}", type=pathlib.Path, metavar="FILE", help=f"the command {program}; default: "
                            "on PATH")
        parser.add_argument(f"--{name}-commit", default="", metavar="ID", help="what it was built of, for the report")
    given = parser.parse_args(arguments)
    wanted = [name for name in given.only.split(",") if name]
    for name in wanted:
        if name not in [experiment.name for experiment in EXPERIMENTS]:
            parser.error(f"--only names {name}; there are "
                         + ", ".join(experiment.name for experiment in EXPERIMENTS))
    given.directory = given.directory or ROOT / ("build/evaluation-quick" if given.quick else "build/evaluation")
    given.experiments = [e for e in EXPERIMENTS if not wanted or e.name in wanted]
    return given


def main(arguments):
    given = parse(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    given.directory.mkdir(parents=True, exist_ok=True)
    if given.report:
        measured = Store(given.directory)
    else:
        weir = programs.Weir(given.weir.resolve())
        measured = Store(given.directory, {"machine": programs.machine(), "weir": weir.version()}, given.again)
        files = VolumeFiles(given.directory, os.environ.get("WEIR_DATA", ROOT.parent / "shared/data"), weir)
        bench = Bench(given.directory, weir, measured, files, given.scale, given.quick, given.full,
                      find_peers(given.sperr, given.sz3, given.sperr_commit, given.sz3_commit), given.kept)
        for experiment in given.experiments:
            experiment.measure(bench)
    write_report(EXPERIMENTS, measured, given.directory)
    if given.publish:
        publish(given.directory, ROOT / "docs")
        keep_records(measured, given.kept)
    broken = broken_promises(EXPERIMENTS, measured)
    for line in broken:
        print(line, file=sys.stderr)
    print(given.directory / "evaluation.md")
    return 1 if broken else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except programs.ProgramFailed as failure:
        sys.exit(f"bench/evaluate.sh: {failure}")
    except KeyboardInterrupt:
        sys.exit("bench/evaluate.sh: interrupted; what is measured is kept, run it again to go on")
