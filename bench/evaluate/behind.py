"""Where others are ahead, by how much at most: figures of the other experiments, each the worst of its kind."""

from markdown import command, percent, table, whole


def behind_text(measured):
    lines = [line for find in (_equal_bytes, _plateau, _bounds, _pictures, _small, _reading) for line in find(measured)]
    return table(["behind", "at its worst", "where"], lines) + "\n\n" + command("bench/evaluate.sh --report")


def _by_share(result, method):
    return {row["share"]: row for row in result["rows"] if row["method"] == method and row["bytes_got"]}


def _equal_bytes(measured):
    gaps = []
    for result in measured.results("errors"):
        theirs = _by_share(result, "zfp")
        for share, ours in _by_share(result, "auto").items():
            if share in theirs and not ours["lossless"] and not theirs[share]["lossless"]:
                gaps.append((theirs[share]["psnr_db"] - ours["psnr_db"], f"{result['volume']} at {share} % of dense"))
    gap, where = max(gaps, default=(0, ""))
    return [["ZFP's fixed rate, PSNR at equal bytes", f"{gap:.0f} dB", where]] if gap > 0 else []


def _plateau(measured):
    """The widest span of sizes over which more bytes bring nothing, short of lossless."""
    spans = []
    for result in measured.results("errors"):
        for share, first in _by_share(result, "auto").items():
            same = [s for s, row in _by_share(result, "auto").items() if row["mse"] == first["mse"] and s >= share]
            if not first["lossless"] and len(same) > 1:
                lossless = 100 * result["lossless_bytes"]["auto"] / result["dense_bytes"]
                spans.append((max(same) - share, f"{first['psnr_db']:.0f} dB from {share} % of dense up to lossless at "
                              f"{lossless:.0f} %", result["volume"]))
    return [["itself: more bytes, no less error", *max(spans)[1:]]] if spans else []


def _bounds(measured):
    ratios = [(row["weir_bytes"] / row["zfp_bytes"],
               f"{result['volume']}, {percent(row['weir_bytes'], result['dense_bytes'])} of dense against "
               f"{percent(row['zfp_bytes'], result['dense_bytes'])}, bound {row['tolerance']:g} of the range")
              for result in measured.results("zfp") for row in result["rows"]]
    ratio, where = max(ratios, default=(0, ""))
    return [["ZFP's fixed accuracy, bytes for a bound", f"{ratio:.1f} times", where]] if ratio > 1 else []


def _pictures(measured):
    rows = {(row["scene"], row["method"], row["rate"]): row for row in measured.results("pictures")}
    gaps = []
    for (scene, method, rate), ours in rows.items():
        theirs = rows.get((scene, "zfp", rate))
        if method == "auto" and theirs and ours["flip_mean"] is not None and theirs["flip_mean"] is not None:
            gaps.append((ours["flip_mean"] - theirs["flip_mean"],
                         f"{ours['flip_mean']:.3f} against {theirs['flip_mean']:.3f}", f"{scene} at 1:{rate}"))
    worst = max(gaps, default=(0,))
    return [["ZFP's fixed rate, mean FLIP at equal bytes", *worst[1:]]] if worst[0] > 0 else []


def _small(measured):
    rows = measured.results("worst_case")
    if not rows:
        return []
    worst = max(rows, key=lambda row: row["bytes"] / row["dense_bytes"])
    return [["dense, bytes of lossless noise", f"{worst['bytes'] / worst['dense_bytes']:.1f} times",
             f"{worst['edge']}^3, {whole(worst['bytes'])} bytes"]]


def _reading(measured):
    """Of volumes from 512^3 on, where starting up is no part of it."""
    lines = []
    for cache in ("cold", "warm"):
        rows = [row for row in measured.results("speed") if row["edge"] >= 512 and row["cache"] == cache]
        if rows:
            worst = max(rows, key=lambda row: row["seconds"] / row["read_twice_s"])
            lines.append([f"reading the file twice, {cache}", f"{worst['seconds'] / worst['read_twice_s']:.1f} times",
                          f"{worst['edge']}^3, {worst['encoding']}, {worst['threads']} threads"])
    return lines
