"""The section on where other compressors are ahead: the worst figure of each kind in the other experiments."""

import math

from experiment import size_text
from experiments.few_bytes import gap_db
from markdown import command, decibel, percent, table, whole
from peer_tables import OTHERS, TITLES, by_volume

OURS = ("auto", "packed")
RIVALS = ("zfp", "auto")
LARGE_BYTES = 1 << 24  # dense bytes; below, most of the time is the start of the program
LARGE_EDGE = 512  # like LARGE_BYTES, for files that are read at the speed of memory


def behind_text(measured):
    finders = (_peers_bytes, _peers_error, _peers_time, _rates, _accuracy, _plateau, _above_lossless, _bounds, _lossless,
               _derived, _pictures, _noise, _reading, _time, _commands)
    lines = [line for find in finders for line in find(measured)]
    return table(["ours", "is behind", "at its worst", "where"], lines) + "\n\n" + command("bench/evaluate.sh --report")


def _pairs(rivals):
    return [(ours, rival) for ours in OURS for rival in rivals if rival != ours]


def _gap_line(ours, title, gaps):
    """Returns the row of the worst of (dB behind, ours, theirs, where), if any is behind. `title` tells of cases
    without a file of ours."""
    behind = [gap for gap in gaps if gap[0] > 0 and gap[1]["bytes"]]
    if not behind:
        return []
    gap, own, theirs, where = max(behind, key=lambda found: found[0])
    figures = f"{decibel(own)} dB against " + ("lossless" if theirs["lossless"] else f"{decibel(theirs)} dB")
    return [[ours, title, figures if math.isinf(gap) else f"{gap:.0f} dB, {figures}", where]]


def _peers_pairs(measured):
    """Yields (ours, its result, peer's title, its result) for each volume."""
    for results in by_volume(measured).values():
        for ours in OURS:
            for peer in OTHERS:
                if ours in results and peer in results:
                    yield ours, results[ours], TITLES[peer], results[peer]


def _peers_bytes(measured):
    found = {}
    for ours, own, peer, theirs in _peers_pairs(measured):
        for mine, other in zip(own["targets"], theirs["targets"]):
            if mine["bytes"] and other["bytes"]:  # weir has a file for each of these errors
                where = (f"{own['volume']} at {mine['target_db']} dB, {percent(mine['bytes'], own['dense_bytes'])} of dense "
                         f"against {percent(other['bytes'], own['dense_bytes'])}")
                found.setdefault((ours, peer), []).append((mine["bytes"] / other["bytes"], where))
    return [line for (ours, peer), ratios in found.items()
            for line in _times_line(ours, f"{peer}, bytes for a PSNR{_how_often(ratios, 1)}", ratios)]


def _peers_error(measured):
    found = {}
    for ours, own, peer, theirs in _peers_pairs(measured):
        for mine, other in zip(own["shares"], theirs["shares"]):
            if other["bytes"]:
                gap = -gap_db(mine, other)
                found.setdefault((ours, peer), []).append((gap, mine, other,
                                                           f"{own['volume']} at {mine['share']} % of dense"))
    return [line for (ours, peer), gaps in found.items()
            for line in _gap_line(ours, f"{peer}, PSNR at equal bytes{_how_often(gaps, 0)}{_without(_missing(gaps))}", gaps)]


def _peers_time(measured):
    """Compares volumes so large that the program's start does not count, with all threads."""
    found = {}
    for ours, own, peer, theirs in _peers_pairs(measured):
        for key, way in (("compress_s", "compression"), ("decompress_s", "decompression")):
            if own["dense_bytes"] >= LARGE_BYTES and own["speeds"] and theirs["speeds"]:
                mine, other = own["speeds"][-1], theirs["speeds"][-1]
                where = f"{own['volume']}, {mine[key]:.2f} s against {other[key]:.2f} s, {mine['threads']} threads"
                found.setdefault((ours, peer, way), []).append((mine[key] / other[key], where))
    return [line for (ours, peer, way), ratios in found.items()
            for line in _times_line(ours, f"{peer}, seconds of {way}{_how_often(ratios, 1)}", ratios)]


def _how_often(found, even):
    return f", in {sum(first[0] > even for first in found)} of {len(found)}"


def _missing(gaps):
    """Returns for how many of `gaps`, (dB behind, ours, theirs, where), there is no file of ours."""
    return sum(1 for _, own, _, _ in gaps if not own["bytes"])


def _without(missing):
    """Returns the part of a title that tells in how many cases ours has no file, as the smallest tree is larger."""
    return f" (in {missing} there is no file so small)" if missing else ""


def _rates(measured):
    """Compares errors at equal bytes if the other compressor has a file."""
    lines = []
    for ours, rival in _pairs(RIVALS):
        gaps = [(-gap_db(own, theirs), own, theirs, where)
                for where, own, theirs in _equal_bytes(measured, ours, rival) if theirs["bytes"]]
        lines += _gap_line(ours, f"{_rate_title(rival)}, PSNR at equal bytes{_without(_missing(gaps))}", gaps)
    return lines


def _rate_title(rival):
    return {"zfp": "ZFP's fixed rate"}.get(rival, rival)


def _equal_bytes(measured, ours, rival):
    """Yields (where, ours, theirs) of everything that is measured at equal bytes."""
    for result in measured.results("errors"):
        by = {(row["method"], row["share"]): {**row, "bytes": row["bytes_got"]} for row in result["rows"]}
        for (method, share), own in by.items():
            if method == ours and (rival, share) in by:
                yield f"{result['volume']} at {share} % of dense", own, by[(rival, share)]
    for result in measured.results("few_bytes"):
        for row in result["rows"]:
            yield f"{result['volume']} at {row['share']} % of dense", row[ours], row[rival]


def _accuracy(measured):
    gaps = []
    for result in measured.results("few_bytes"):
        for row in result["rows"]:
            own, theirs = row["packed_there"], row["accuracy"]
            if own["bytes"] and theirs["bytes"]:
                where = f"{result['volume']} at {percent(own['bytes'], result['dense_bytes'])} of dense"
                gaps.append((-gap_db(own, theirs), own, theirs, where))
    return _gap_line("packed", "ZFP's fixed accuracy, PSNR at equal bytes", gaps)


def _plateau(measured):
    """Finds the widest span of sizes, below lossless, over which more bytes do not reduce the error."""
    lines = []
    for ours in OURS:
        spans = []
        for result in measured.results("errors"):
            rows = {row["share"]: row for row in result["rows"] if row["method"] == ours and row["bytes_got"]}
            for share, first in rows.items():
                same = [s for s, row in rows.items() if row["mse"] == first["mse"] and s >= share]
                if not first["lossless"] and len(same) > 1:
                    lossless = percent(result["lossless_bytes"][ours], result["dense_bytes"], 0)
                    spans.append((max(same) - share, f"{first['psnr_db']:.0f} dB from {share} to {max(same)} % of "
                                  f"dense, lossless at {lossless}", result["volume"]))
        lines += [[ours, "itself: more bytes, no less error", *max(spans)[1:]]] if spans else []
    return lines


def _above_lossless(measured):
    """Finds files with an error although a lossless file takes fewer bytes."""
    lines = []
    for ours in OURS:
        found = [(row["bytes_got"] / result["lossless_bytes"][ours],
                  f"{decibel(row)} dB at {row['share']} % of dense, lossless at "
                  f"{percent(result['lossless_bytes'][ours], result['dense_bytes'])}", result["volume"])
                 for result in measured.results("errors") for row in result["rows"]
                 if row["method"] == ours and row["bytes_got"] and not row["lossless"]]
        worst = max(found, default=(0,))
        lines += [[ours, "itself: an error in more bytes than lossless takes", *worst[1:]]] if worst[0] > 1 else []
    return lines


def _times_line(ours, title, found):
    """Returns the largest of (ratio, where) whose ratio is above 1."""
    ratio, where = max(found, default=(0, ""))
    if ratio <= 1:
        return []
    how = "the other has none" if math.isinf(ratio) else f"{ratio:.1f} times" if ratio >= 1.05 else f"{ratio:.3f} times"
    return [[ours, title, how, where]]


def _bounds(measured):
    lines = []
    for ours, rival in _pairs(RIVALS):
        found = [(row[f"{ours}_bytes"] / row[f"{rival}_bytes"],
                  f"{result['volume']}, {percent(row[f'{ours}_bytes'], result['dense_bytes'])} of dense against "
                  f"{percent(row[f'{rival}_bytes'], result['dense_bytes'])}, bound {row['tolerance']:g} of the range")
                 for result in measured.results("zfp") for row in result["rows"]]
        title = "ZFP's fixed accuracy" if rival == "zfp" else rival
        lines += _times_line(ours, f"{title}, bytes for a bound", found)
    return lines


def _lossless(measured):
    lines = []
    for ours in OURS:
        found = [(row[f"{ours}_bytes"] / row["xz_bytes"],
                  f"{row['volume']}, {percent(row[f'{ours}_bytes'], row['dense_bytes'], 2)} of dense against "
                  f"{percent(row['xz_bytes'], row['dense_bytes'], 2)}") for row in measured.results("lossless")]
        lines += _times_line(ours, "`xz -9`, bytes without loss", found)
    return lines


def _derived(measured):
    """Compares errors of derived quantities at equal bytes, each as a multiple of the other's error."""
    kinds = {"median of the error": lambda row: row["quantile_0.5"],
             "99.9 % quantile of the error": lambda row: row["quantile_0.999"],
             "largest error": lambda row: row["max_abs"],
             "error of the gradient": lambda row: row["gradient_relative_rms"],
             "1 - SSIM": lambda row: 1 - row["ssim"],
             "shortest wavelength that is right": lambda row: row["wavelength"] or 0}
    lines = []
    for ours, rival in _pairs(RIVALS):
        for title, of in kinds.items():
            found, missing = [], 0
            for result in measured.results("derived"):
                rows = {(row["method"], row["share"]): row for row in result.get("rows", [])}
                missing += sum(1 for method, share in rows if method == rival and (ours, share) not in rows)
                for (method, share), own in rows.items():
                    theirs = rows.get((rival, share))
                    if method == ours and theirs and of(own) > of(theirs):
                        ratio = of(own) / of(theirs) if of(theirs) > 0 else math.inf
                        found.append((ratio, f"{result['volume']} at {share} % of dense"))
            lines += _times_line(ours, f"{_rate_title(rival)}, {title} at equal bytes{_without(missing)}", found)
    return lines


def _pictures(measured):
    rows = {(row["scene"], row["method"], row["rate"]): row for row in measured.results("pictures")}
    lines = []
    for ours, rival in _pairs(RIVALS):
        gaps, missing = [], 0
        for (scene, method, rate), own in rows.items():
            theirs = rows.get((scene, rival, rate))
            if method != ours or not theirs or theirs["flip_mean"] is None:
                continue
            if own["flip_mean"] is None:
                missing += 1
                continue
            gaps.append((own["flip_mean"] - theirs["flip_mean"],
                         f"{own['flip_mean']:.4f} against {theirs['flip_mean']:.4f}", f"{scene} at 1:{rate}"))
        worst = max(gaps, default=(0,))
        title = f"{_rate_title(rival)}, mean FLIP at equal bytes{_without(missing)}"
        lines += [[ours, title, *worst[1:]]] if worst[0] > 0 else []
    return lines


def _noise(measured):
    lines = []
    for ours in OURS:
        found = [(row["bytes"] / row["dense_bytes"], f"{row['edge']}^3, {whole(row['bytes'])} bytes")
                 for row in measured.results("worst_case") if row["encoding"] == ours]
        lines += _times_line(ours, "dense, bytes of lossless noise", found)
    return lines


def _reading(measured):
    """Compares volumes of 512^3 voxels or more, for which the program's start does not count."""
    found = {}
    for row in measured.results("speed"):
        if row["edge"] >= LARGE_EDGE:
            where = f"cloud {row['edge']}^3 to an eighth, {row['threads']} threads"
            found.setdefault((row["encoding"], row["cache"]), []).append((row["seconds"] / row["read_twice_s"], where))
    for row in measured.results("two_passes"):
        if row["edge"] >= LARGE_EDGE:
            where = f"{row['kind']} {row['edge']}^3 at rate {row['rate']}, {row['threads']} threads"
            cache = {"disk": "warm", "memory": "in memory"}[row["place"]]
            found.setdefault((row["encoding"], cache), []).append((row["seconds"] / row["read_twice_s"], where))
    return [line for (encoding, cache), ratios in found.items()
            for line in _times_line(encoding, f"reading the file twice, {cache}", ratios)]


def _time(measured):
    """Compares packed files with leaves of the same volume and size."""
    seconds = {}  # (where, encoding) -> seconds of a conversion
    for row in measured.results("two_passes"):
        where = f"{row['kind']} {row['edge']}^3 at rate {row['rate']}, {row['threads']} threads"
        cache = {"disk": "warm", "memory": "in memory"}[row["place"]]
        seconds[(f"{where}, {cache}", row["encoding"])] = row["seconds"]
    for row in measured.results("speed"):
        if row["edge"] >= LARGE_EDGE:
            where = f"cloud {row['edge']}^3 to an eighth, {row['threads']} threads, {row['cache']}"
            seconds[(where, row["encoding"])] = row["seconds"]
    for row in measured.results("headline"):
        seconds[(f"{size_text(row['extent'])} to an eighth, cold", row["encoding"])] = row["seconds"]
    lines = []
    for leaves in ("auto", "fpn", "float"):
        found = [(packed / seconds[(where, leaves)], f"{where}, {packed:.2f} s against {seconds[(where, leaves)]:.2f} s")
                 for (where, encoding), packed in seconds.items() if encoding == "packed" and (where, leaves) in seconds]
        lines += _times_line("packed", f"{leaves}, seconds of a conversion", found)
    return lines


def _commands(measured):
    """Compares what follows the large conversion: the packed file against the leaves."""
    lines = []
    for name in ("verify", "compare", "render"):
        by = {}
        for row in measured.results("headline"):
            by.setdefault(size_text(row["extent"]), {})[row["encoding"]] = row[f"{name}_s"]
        found = [(rows["packed"] / rows["auto"], f"{extent}, {rows['packed']:.1f} s against {rows['auto']:.1f} s")
                 for extent, rows in by.items() if {"packed", "auto"} <= rows.keys()]
        lines += _times_line("packed", f"auto, seconds of weir {name}", found)
    return lines
