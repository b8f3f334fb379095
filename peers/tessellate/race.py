#!/usr/bin/env python3
"""Races tessellations of ours against OpenSubdiv's Bfr and Embree: in turns, depth 2 to 6, two threads each.

usage: race.py MESH.obj .. [--rounds 5]

Prints milliseconds in which positions and normals are made anew for vertices that moved: the median of all rounds of the medians of
each, with the least of them in brackets; then how many times as long the others take in the same round: the median of all rounds, and
the least and the most. Needs
`cargo build --release --example tessellate_times`, and `tessellate` beside this file.
"""
import argparse
import os
import subprocess
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parents[1] / "target"))


def lines(*command):
    environment = {**os.environ, "RAYON_NUM_THREADS": "2"}
    text = subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout
    return [line.split() for line in text.splitlines() if line.split()[:1] and line.split()[0].isdigit()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="+")
    parser.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()
    print(f"{os.getloadavg()[0]:.1f} programs at work before")
    for mesh in args.mesh:
        rows = {}
        for _ in range(args.rounds):
            for depth, points, _, moved, *_ in lines(TARGET / "release/examples/tessellate_times", mesh):
                row = rows.setdefault(depth, {"points": points, "ours": [], "bfr": [], "embree": [], "commit": []})
                row["ours"].append(float(moved))
            for words in lines(HERE / "tessellate", mesh, "--times", "7"):
                row = rows[words[0]]
                for name, place in [("bfr", 3), ("embree", 6), ("commit", 8)]:
                    row[name].append(float(words[place]))
        print(f"{mesh}\ndepth   vertices  ours              bfr               embree            commit  bfr / ours        embree / ours")
        for depth, row in rows.items():
            cells = "".join(f"{median(row[name]):8.2f} ({min(row[name]):7.2f})" for name in ("ours", "bfr", "embree"))
            ratios = ""
            for name in ("bfr", "embree"):
                times = [theirs / ours for theirs, ours in zip(row[name], row["ours"])]
                ratios += f"  {median(times):5.1f} ({min(times):4.1f} - {max(times):4.1f})"
            print(f"{depth:>5}{row['points']:>11}{cells}{median(row['commit']):8.2f}{ratios}", flush=True)
    print(f"{os.getloadavg()[0]:.1f} programs at work after")


if __name__ == "__main__":
    main()
