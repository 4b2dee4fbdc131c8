"""Where the time of a conversion goes, from its own trace."""

import collections
import json

import volumes
from experiment import Experiment, remove_volume
from experiments.speed import ENCODINGS, RATE, ROUNDS, read_twice, threads_here
from markdown import command, table

KINDS = ("cloud", "turbulence")
WAITS = ("survey pass", "encode pass")  # spans around others: what is not in one of those is waiting


def busy_ms(events):
    """Milliseconds of each name over all threads, without those of spans inside."""
    threads = collections.defaultdict(list)
    for event in events:
        if event.get("ph") == "X":
            threads[event["tid"]].append((event["ts"], -event["dur"], event["name"]))
    busy = collections.Counter()
    for spans in threads.values():
        around = []  # (end, name) of the spans that the current one lies in
        for begin, negative, name in sorted(spans):
            while around and around[-1][0] <= begin:
                around.pop()
            if around:
                busy[around[-1][1]] += negative / 1000
            busy[name] -= negative / 1000
            around.append((begin - negative, name))
    return dict(busy)


class Stages(Experiment):
    name = "stages"

    def measure(self, bench):
        edge = 128 if bench.quick else 512
        for kind in KINDS:
            for encoding in ENCODINGS:
                name = f"{kind}_{edge:04}_{encoding}"
                bench.store.measure(self.name, name, lambda k=kind, e=encoding: self._trace(bench, k, edge, e))

    @staticmethod
    def _trace(bench, kind, edge, encoding):
        volume = volumes.cube(kind, edge)
        output = bench.scratch("stages.nvdb")
        trace = bench.scratch("stages.json")
        rounds = []
        with bench.files.file(volume) as path:
            for _ in range(ROUNDS):
                read_twice(path, False)
                remove_volume(output)
                run = bench.weir.run("convert", path, "-o", output, "--rate", RATE, "--encoding", encoding,
                                     "--trace", trace)
                rounds.append((run.seconds, run.cpu_s, busy_ms(json.loads(trace.read_text()))))
        seconds, cpu_s, busy = min(rounds, key=lambda r: r[0])
        remove_volume(output)
        trace.unlink()
        return {"kind": kind, "edge": edge, "encoding": encoding, "threads": threads_here(), "seconds": seconds,
                "cpu_s": cpu_s, "busy_ms": busy}

    def rows(self, measured):
        return [{**{k: v for k, v in r.items() if k != "busy_ms"}, "stage": stage, "busy_ms": ms}
                for r in measured.results(self.name) for stage, ms in sorted(r["busy_ms"].items())]

    def text(self, measured):
        results = measured.results(self.name)
        work = collections.Counter()
        for result in results:
            work.update({k: v for k, v in result["busy_ms"].items() if k not in WAITS})
        stages = [stage for stage, _ in work.most_common()]
        header = ["milliseconds", *(f"{r['kind']} {r['edge']}^3, {r['encoding']}" for r in results)]
        lines = [[stage, *(f"{r['busy_ms'].get(stage, 0):.0f}" for r in results)] for stage in stages]
        lines.append(["the whole command, wall clock", *(f"{1000 * r['seconds']:.0f}" for r in results)])
        lines.append(["its processor time", *(f"{1000 * r['cpu_s']:.0f}" for r in results)])
        return "\n\n".join((table(header, lines), command(
            "bench/evaluate.sh --only stages --again          # on a machine that does nothing else",
            "weir convert turbulence_512x512x512_float32.raw --rate 8 --trace trace.json   # for ui.perfetto.dev")))
