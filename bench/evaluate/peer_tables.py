"""The tables and the chart of the experiment `peers`."""

import statistics

from chart import error_chart
from experiment import size_text
from markdown import decibel, percent, table

TARGETS_DB = (60, 80, 100)
SHARES = (1, 2, 5, 10, 20)  # percent of dense float32
SPEED_DB = 80
OURS = ("auto", "packed")
OTHERS = ("sperr", "sz3", "zfp_rate", "zfp_accuracy")
METHODS = (*OURS, *OTHERS)
TITLES = {"auto": "auto", "packed": "packed", "sperr": "SPERR", "sz3": "SZ3", "zfp_rate": "ZFP's rate",
          "zfp_accuracy": "ZFP's accuracy"}


def by_volume(measured):
    """Returns volume's name -> method -> result, in the order of METHODS. A result of another weir version than the
    volume's first has no speeds."""
    by, versions = {}, {}
    for record in sorted(measured.records("peers"), key=lambda r: METHODS.index(r["result"]["method"])):
        result = record["result"]
        version = versions.setdefault(result["volume"], record["weir"])
        by.setdefault(result["volume"], {})[result["method"]] = (
            result if record["weir"] == version else {**result, "speeds": []})
    return by


def methods_of(by):
    return [method for method in METHODS if any(method in results for results in by.values())]


def targets_table(measured):
    """Returns the first table of the page: bytes for each error, and below them the speed at SPEED_DB."""
    by = by_volume(measured)
    methods = methods_of(by)
    lines = []
    for volume, results in by.items():
        extent = size_text(next(iter(results.values()))["extent"])
        for target in TARGETS_DB:
            points = {method: target_point(result, target) for method, result in results.items()}
            least = min((point["bytes"] for point in points.values() if point["bytes"]), default=0)
            cells = [_bytes_text(points.get(method), results.get(method), least) for method in methods]
            lines.append([f"{volume}, {extent}" if target == TARGETS_DB[0] else "", f"{target} dB", *cells])
    for key, way in (("compress_s", "compression"), ("decompress_s", "decompression")):
        lines.append([f"MB/s of {way}, median", f"{SPEED_DB} dB", *(_median_speed(by, method, key) for method in methods)])
    return table(["bytes of dense for", "", *(TITLES[method] for method in methods)], lines)


def target_point(result, target):
    return next(row for row in result["targets"] if row["target_db"] == target)


def _bytes_text(point, result, least):
    if not point or not point["bytes"]:
        return "-"
    text = percent(point["bytes"], result["dense_bytes"], 2)
    return f"**{text}**" if point["bytes"] == least else text


def _median_speed(by, method, key):
    """Returns the median speed in MB of dense values per second, with the most threads, as text."""
    speeds = [results[method]["dense_bytes"] / results[method]["speeds"][-1][key] / 1e6 for results in by.values()
              if method in results and results[method]["speeds"]]
    return f"{statistics.median(speeds):.0f}" if speeds else "-"


def shares_table(measured):
    by = by_volume(measured)
    methods = methods_of(by)
    lines = []
    for volume, results in by.items():
        for share in SHARES:
            points = [next((row for row in results[method]["shares"] if row["share"] == share), None)
                      if method in results else None for method in methods]
            lines.append([volume if share == SHARES[0] else "", f"{share} %",
                          *(decibel(point) if point and point["bytes"] else "-" for point in points)])
    return table(["PSNR in dB at", "of dense", *(TITLES[method] for method in methods)], lines)


def speed_table(measured):
    by = by_volume(measured)
    lines = []
    for volume, results in by.items():
        for method, result in results.items():
            cells = [f"{row[key]:.2f}" for row in result["speeds"] for key in ("compress_s", "decompress_s")]
            lines.append([volume if method == next(iter(results)) else "", TITLES[method], *cells])
    counts = sorted({row["threads"] for results in by.values() for r in results.values() for row in r["speeds"]})
    header = [f"seconds at {SPEED_DB} dB", "method", *(f"{count} thread{'s' if count > 1 else ''}, {way}"
                                                       for count in counts for way in ("compression", "decompression"))]
    return table(header, [line + ["-"] * (len(header) - len(line)) for line in lines])


def search_text(measured):
    """Returns how far from the target each peer's search ended at worst."""
    parts = []
    for method in ("sperr", "sz3", "zfp_rate"):
        above, below = [], []
        for volume, results in by_volume(measured).items():
            if method not in results:
                continue
            above += [(row["psnr_db"] - row["target_db"], f"{volume} at {row['target_db']} dB")
                      for row in results[method]["targets"] if row["bytes"] and row["psnr_db"] is not None]
            below += [(1 - row["bytes"] / (row["share"] * results[method]["dense_bytes"] / 100),
                       f"{volume} at {row['share']} %") for row in results[method]["shares"] if row["bytes"]
                      and not row["lossless"]]
        if above and below:
            parts.append(f"{TITLES[method]} {max(above)[0]:.2f} dB ({max(above)[1]}) and {100 * max(below)[0]:.1f} % of the "
                         f"bytes ({max(below)[1]})")
    return f"Farthest from what is compared: {'; '.join(parts)}." if parts else ""


def versions_text(measured):
    loads = [record["load"] for record in measured.records("peers")]
    versions = sorted({result["version"] for result in measured.results("peers")})
    return (f"Measured: {'; '.join(versions)}. Load average of the machine before each measurement: "
            f"{min(loads):.1f} to {max(loads):.1f}.")


def chart(measured):
    """Returns the chart of PSNR against the share of dense bytes, with all measured points."""
    panels = {}
    for volume, results in by_volume(measured).items():
        panels[volume] = {TITLES[method]: [(100 * row["bytes"] / result["dense_bytes"], row["psnr_db"])
                                           for kind in ("targets", "shares") for row in result[kind]
                                           if row["bytes"] and row["psnr_db"] is not None]
                          for method, result in results.items()}
    return error_chart(panels, [TITLES[method] for method in METHODS])
