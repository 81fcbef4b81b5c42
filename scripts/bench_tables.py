# SPDX-License-Identifier: BSD-3-Clause
"""The tables and the plot of docs/benchmarks.md from what csom-bench and csom-bench-memory wrote.

usage: python3 bench_tables.py FOLDER
"""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # the backend must be chosen before

REFERENCE_PEAK_MB = 232  # SEE-CSOM's published code on the same scans


def milliseconds(benchmark):
    value = benchmark.get("median_ms", benchmark["real_time"])
    unit = {"ms": 1, "us": 1e-3, "ns": 1e-6}[benchmark["time_unit"]]
    return value if "median_ms" in benchmark else value * unit


class Results:
    def __init__(self, folder):
        with open(folder / "csom-bench.json", encoding="utf-8") as file:
            document = json.load(file)
        self.scans = document["context"]["scans"]
        self.all = {b["name"].replace("/manual_time", ""): b for b in document["benchmarks"]}
        with open(folder / "memory.json", encoding="utf-8") as file:
            self.memory = json.load(file)
        with open(folder / "replay.json", encoding="utf-8") as file:
            self.replay = json.load(file)

    def ms(self, name):
        return milliseconds(self.all[name])

    def counter(self, name, counter):
        return self.all[name][counter]


def verdict(value, limit, at_least=False):
    return "met" if (value >= limit if at_least else value <= limit) else "missed"


def targets(r):
    """Rows: what, measured, target, verdict."""
    extended, radius = r.ms("insert/extended-block"), r.ms("insert/radius")
    octomap = r.ms("octomap")
    rows = []

    def row(what, value, shown, target, limit, at_least=False):
        rows.append((what, shown, target, verdict(value, limit, at_least)))

    floor = r.ms("floor/radius")
    default, with_free = r.ms("insert/default/none"), r.ms("insert/default/projective")
    row("default method: ratio to the floor", default / floor,
        f"{default:.1f} ms, {default / floor:.1f} × of {floor:.2f} ms", "≤ 8 ×", 8)
    row("default method: OctoMap, ratio to it", octomap / default, f"{octomap:.0f} ms, {octomap / default:.0f} ×",
        "≥ 80 ×", 80, True)
    row("default method, free space to 50 m: ratio to the floor", with_free / floor,
        f"{with_free:.1f} ms, {with_free / floor:.1f} ×", "≤ 15 ×", 15)
    two = with_free / r.ms("insert/default/projective/two-threads")
    row("default method, free space, two threads", two, f"{two:.2f} ×", "≥ 1.7 ×", 1.7, True)
    bytes_each = r.counter("insert/default/projective", "bytes_per_voxel")
    row("default method, free space: a known voxel", bytes_each, f"{bytes_each:.1f} bytes", "≤ 16 bytes", 16)
    late, latency = r.replay["late"], r.replay["latency_ms"]
    row("default method, free space, ten scans a second on two threads: late", late,
        f"{late} of {r.replay['scans']}; 99 % within {latency['p99']:.0f} ms", "0", 0)
    row("1 insertion, extended-block", extended, f"{extended:.1f} ms", "≤ 10 ms", 10)
    row("1 insertion, radius", radius, f"{radius:.1f} ms", "≤ 20 ms", 20)
    row("1 OctoMap, ratio to extended-block", octomap / extended, f"{octomap:.0f} ms, {octomap / extended:.0f} ×",
        "≥ 50 ×", 50, True)
    row("1 OctoMap, ratio to radius", octomap / radius, f"{octomap / radius:.0f} ×", "≥ 25 ×", 25, True)
    for kind, time in (("extended-block", extended), ("radius", radius)):
        floor = r.ms("floor/" + kind)
        row(f"2 ratio to the floor, {kind}", time / floor, f"{time / floor:.1f} × of {floor:.2f} ms", "≤ 3 ×", 3)
    for kind, time in (("extended-block", extended), ("radius", radius)):
        two = time / r.ms(f"insert/{kind}/two-threads")
        row(f"3 two threads, {kind}", two, f"{two:.2f} ×", "≥ 1.7 ×", 1.7, True)
    for kind in ("extended-block", "radius"):
        fine = r.ms(f"insert/{kind}/fine")
        row(f"4 voxels of 0.1 m, {kind}", fine, f"{fine:.1f} ms", "≤ 30 ms", 30)
    plain = r.ms("insert/free-space/none")
    for kind in ("sampled", "raycast"):
        added = r.ms("insert/free-space/" + kind) - plain
        row(f"5 free space to 50 m, {kind}, adds", added, f"{added:.0f} ms", "≤ 25 ms", 25)
    bytes_each = r.memory["map_bytes"] / r.memory["known_voxels"]
    row("6 memory of a known voxel", bytes_each, f"{bytes_each:.1f} bytes", "≤ 24 bytes", 24)
    peak = (r.memory["peak_kb"] - r.memory["idle_kb"]) / 1024
    row("6 peak of the process above idle", peak, f"{peak:.0f} MB", f"≤ {REFERENCE_PEAK_MB // 4} MB",
        REFERENCE_PEAK_MB / 4)
    voxels = r.counter("copy/constructor", "voxels")
    copy, stream = 1000 * r.ms("copy/constructor"), r.ms("copy/stream")
    row(f"7 copy of {voxels:,.0f} voxels, constructor", copy, f"{copy:.0f} µs", "≤ 100 µs", 100)
    row("7 the same by MRPT's streams", stream, f"{stream:.2f} ms", "≤ 5 ms", 5)
    point = 1e6 * r.ms("query/point")
    row("7 query of a point", point, f"{point:.0f} ns", "≤ 100 ns", 100)
    ray = r.counter("query/ray", "voxels_per_second") / 1e6
    row("7 ray casting", ray, f"{ray:.0f} M voxels/s", "≥ 2 M voxels/s", 2, True)
    visit = r.counter("query/visit", "voxels_per_second") / 1e6
    row("7 visiting every known voxel", visit, f"{visit:.0f} M voxels/s", "≥ 100 M voxels/s", 100, True)
    return rows


def stages(r):
    for name in ("insert/default/none", "insert/default/projective", "insert/radius", "insert/extended-block",
                 "insert/radius/fine", "insert/free-space/raycast", "insert/free-space/sampled"):
        b = r.all[name]
        yield (name.replace("insert/", ""), f"{r.ms(name):.1f}", f"{b['prepare_ms']:.1f}",
               f"{b['infer_ms']:.1f}", f"{b['commit_ms']:.1f}", f"{b['bytes_per_voxel']:.1f}")


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def plot_growth(r, folder):
    figure, axes = pyplot.subplots(figsize=(6.4, 4.2))
    for kind, label in (("wider", "the same density, larger scene"), ("denser", "the same scene, denser")):
        points = sorted((int(name.rsplit("/", 1)[1]), milliseconds(b)) for name, b in r.all.items()
                        if name.startswith(f"points/{kind}/"))
        axes.loglog(*zip(*points), marker="o", label=label)
    counts = [10**3, 10**6]
    axes.loglog(counts, [count / 5000 for count in counts], "--", color="gray", label="linear")
    axes.set_xlabel("points of the scan")
    axes.set_ylabel("insertion [ms]")
    axes.grid(True, alpha=0.3)
    axes.legend()
    figure.savefig(folder / "growth.png", dpi=100, bbox_inches="tight")


def main():
    folder = pathlib.Path(sys.argv[1])
    results = Results(folder)
    text = f"Scans: {results.scans}\n\n"
    text += markdown(("line", "measured", "target", ""), targets(results)) + "\n"
    text += markdown(("insertion [ms]", "total", "prepare", "infer", "commit", "bytes a voxel"), stages(results))
    (folder / "tables.md").write_text(text, encoding="utf-8")
    print(text)
    plot_growth(results, folder)


if __name__ == "__main__":
    main()
