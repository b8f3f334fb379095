#!/usr/bin/env python3
"""Adaptive surfaces beside OpenSubdiv's at equal accuracy on one mesh of quads: in turns, several rounds.

usage: adaptive.py MESH.obj [--levels 1,2,3] [--depths 1,2,3] [--size 1024] [--rounds 3] [--frames 9] [--factors 4,8,16,32]
                   [--single-crease LEVEL] [--json FILE]

Prints for each level of OpenSubdiv, and for each of our surfaces, how far it is from the limit surface at 14 by 14 points of each
face (distances over the diagonal, angles in degrees), the time of set-up, the time to refresh it once its control vertices moved, its
bytes, and the time of frames of moving vertices, geometry alone: OpenSubdiv's with its refresh, as ours have it. Ours are refreshed
and drawn in one frame: `refresh` is what frames of still vertices take less. With --single-crease, a further row has OpenSubdiv's
single-crease patches at that level, and level 2 around other features; its points are not known to its CPU, nor its accuracy so.
"""
import argparse
import json
import math
import sys
import tempfile
from pathlib import Path
from statistics import median

from race import OPENSUBDIV, SUBDIV, run, theirs

GRID = 14
ROWS = "--schemes gregory --constructions two-stage,cached --paths tessellation,instanced --motion moving,still --single-sided"


def of_subdiv(mesh, *arguments):
    faces = json.loads(run([SUBDIV, "sample", mesh, "--cpu", "--grid", str(GRID), "--json", *arguments]))["faces"]
    faces.sort(key=lambda face: face["face"])
    return [(p, n) for face in faces for p, n in zip(face["positions"], face["normals"])]


def of_opensubdiv(mesh, level):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "samples"
        run([OPENSUBDIV, mesh, "--level", str(level), "--samples", str(path), "--grid", str(GRID)])
        numbers = [[float(word) for word in line.split()] for line in path.read_text().splitlines()]
        return [(line[:3], line[3:]) for line in numbers]


def diagonal(mesh):
    vertices = [[float(word) for word in line.split()[1:4]] for line in mesh.read_text().splitlines() if line.startswith("v ")]
    return math.dist(*[[of(axis) for axis in zip(*vertices)] for of in (min, max)])


def errors(samples, limit, unit):
    """Root mean square and maximum of distances, and of angles."""
    assert len(samples) == len(limit), "samples of the same points"
    distances = [math.dist(p, q) / unit for (p, _), (q, _) in zip(samples, limit)]
    angles = []
    for (_, n), (_, m) in zip(samples, limit):
        length = math.hypot(*n) * math.hypot(*m)
        if length > 0:
            angles.append(math.degrees(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(n, m)) / length)))))
    return [x for values in (distances, angles) for x in (math.sqrt(sum(v * v for v in values) / len(values)), max(values))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--levels", default="1,2,3")
    parser.add_argument("--depths", default="1,2,3")
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--factors", default="4,8,16,32")
    parser.add_argument("--single-crease", type=int, metavar="LEVEL")
    parser.add_argument("--json", type=Path, help="where to write everything that was measured")
    args = parser.parse_args()
    levels, factors = args.levels.split(","), [int(factor) for factor in args.factors.split(",")]
    limit, unit = of_subdiv(args.mesh, "--scheme", "limit"), diagonal(args.mesh)
    accuracy = {f"OpenSubdiv {level}": errors(of_opensubdiv(args.mesh, level), limit, unit) for level in levels}
    for depth in args.depths.split(","):
        accuracy[f"adaptive {depth}"] = errors(of_subdiv(args.mesh, "--adaptive", depth), limit, unit)
    accuracy["one patch a face"] = errors(of_subdiv(args.mesh), limit, unit)
    peers = {f"OpenSubdiv {level}": ["--level", level] for level in levels}
    if args.single_crease is not None:
        name = f"OpenSubdiv {args.single_crease}, single crease"
        peers[name] = ["--level", str(args.single_crease), "--single-crease", "1", "--secondary", "2"]
    measured = {}
    for round_number in range(args.rounds):
        for factor in factors:
            common = [args.mesh, "--factors", str(factor), "--frames", str(args.frames), "--size"]
            for name, arguments in peers.items():
                peer = theirs(run([OPENSUBDIV, *common, str(args.size), *arguments]))
                points = peer["points.cpu.total_ms"]
                row = measured.setdefault(name, {"setup": [], "refresh": [], "bytes": peer["bytes.tables_total"]})
                row["setup"].append(peer["setup.total_ms"])
                row["refresh"].append(points)
                row.setdefault(factor, []).append(peer["osd.geometry_ms"] + points)
            size = f"{args.size}x{args.size}"
            own = json.loads(run([SUBDIV, "bench", *common, size, "--json", "--adaptive", args.depths, *ROWS.split()]))
            for moving in (row for row in own["rows"] if row["motion"] == "moving"):
                keys = ["construction", "path", "adaptive"]
                alike = lambda row: row["motion"] == "still" and all(row[key] == moving[key] for key in keys)
                still = next(row for row in own["rows"] if alike(row))
                surface = "one patch a face" if moving["adaptive"] is None else f"adaptive {moving['adaptive']}"
                name = f"{surface}, {moving['construction']} {moving['path']}"
                row = measured.setdefault(name, {"setup": [], "refresh": [], "bytes": moving["bytes"]["total"]})
                times = [each["geometry_ms"]["median"] for each in (moving, still)]
                row["setup"].append(moving["tables_ms"])
                row["refresh"].append(times[0] - times[1])
                row.setdefault(factor, []).append(times[0])
            print(f"round {round_number + 1}, factor {factor}", file=sys.stderr)
    if args.json:
        args.json.write_text(json.dumps({"accuracy": accuracy, "measured": measured}))
    heads = ["", "position rms", "max", "normal rms", "max", "set-up ms", "refresh ms", "KiB", *(f"N = {n}" for n in factors)]
    print(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    for name, row in measured.items():
        far = accuracy.get(name.split(",")[0]) if "single crease" not in name else None
        cells = [f"{far[0]:.1e}", f"{far[1]:.1e}", f"{far[2]:.2f}", f"{far[3]:.1f}"] if far else [""] * 4
        cells += [f"{median(row['setup']):.2f}", f"{median(row['refresh']):.2f}", f"{row['bytes'] / 1024:.0f}"]
        cells += [f"{median(row[factor]):.1f}" for factor in factors]
        print(f"| {name} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
