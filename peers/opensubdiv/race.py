#!/usr/bin/env python3
"""Races `subdiv bench` against OpenSubdiv on one mesh: in turns, factor by factor, several rounds.

usage: race.py MESH.obj [--size 1024] [--rounds 5] [--frames 13] [--factors 4,8,16,32] [--json FILE]

Prints, for each row of ours, how many times as long OpenSubdiv takes: the median of the rounds, the least and the most of them.
Its frames are of control points that are there already; ours make them.
"""
import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
SUBDIV = HERE.parents[1] / "target/release/subdiv"
OPENSUBDIV = HERE / "opensubdiv"
ROWS = (
    "--schemes gregory --constructions two-stage,cached --paths tessellation,instanced,bilinear "
    "--cull back,frustum --cull-by compute"
)


def run(command):
    if not command[0].exists():
        sys.exit(f"{command[0]}: there is no such program: build it, as peers/README.md says")
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def theirs(text):
    """Every `name=number` of the lines that say what was measured, by `line.name`."""
    figures = {}
    for line in text.splitlines():
        kind, *words = line.split()
        path = next((f".{word[5:]}" for word in words if word.startswith("path=")), "")
        for name, number in re.findall(r"(\w+)=([\d.]+)(?= |$)", line):
            figures[f"{kind}{path}.{name}"] = float(number)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--frames", type=int, default=13)
    parser.add_argument("--factors", default="4,8,16,32")
    parser.add_argument("--json", type=Path, help="where to write everything that was measured")
    args = parser.parse_args()
    measured = []
    for round_number in range(args.rounds):
        for factor in args.factors.split(","):
            common = [args.mesh, "--factors", factor, "--frames", str(args.frames), "--size"]
            peer = theirs(run([OPENSUBDIV, *common, str(args.size)]))
            size = f"{args.size}x{args.size}"
            own = json.loads(run([SUBDIV, "bench", *common, size, "--single-sided", "--json", *ROWS.split()]))
            measured.append({"factor": int(factor), "peer": peer, "rows": own["rows"]})
            print(f"round {round_number + 1}, factor {factor}", file=sys.stderr)
    if args.json:
        args.json.write_text(json.dumps(measured))
    for factor in dict.fromkeys(turn["factor"] for turn in measured):
        turns = [turn for turn in measured if turn["factor"] == factor]
        peer = {name: median(turn["peer"][name] for turn in turns) for name in turns[0]["peer"]}
        print(
            f"N = {factor}: OpenSubdiv geometry {peer['osd.geometry_ms']:.2f} ms, with pixels {peer['osd.pixels_ms']:.2f}; "
            f"control points {peer['points.cpu.total_ms']:.2f}; set-up {peer['setup.total_ms']:.1f}; "
            f"tables {peer['bytes.tables_total'] / 1024:.0f} KiB"
        )
        for rows in zip(*(turn["rows"] for turn in turns)):
            ratios = []
            for key, ms in [("geometry_ms", "osd.geometry_ms"), ("gpu_ms", "osd.pixels_ms")]:
                of = [turn["peer"][ms] / row[key]["median"] for turn, row in zip(turns, rows)]
                ratios.append(f"{median(of):.2f} ({min(of):.2f} to {max(of):.2f})")
            row = rows[0]
            name = f"{row['construction']} {row['path']}, culling {row['cull']}"
            tables = median(row["tables_ms"] for row in rows)
            print(
                f"  {name:56} geometry x {ratios[0]}  pixels x {ratios[1]}  tables {tables:.2f} ms,"
                f" {row['bytes']['total'] / 1024:.0f} KiB"
            )


if __name__ == "__main__":
    main()
