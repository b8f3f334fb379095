#!/usr/bin/env python3
"""Writes NAME.bin for each NAME.obj here: points of the exact limit surface with their derivatives, in float64.

Refines with `cc.py`, the reference implementation of Catmull-Clark in Python that shares no code with this crate, LEVELS
times, then takes the limit masks of the vertices. Usage: make.py FOLDER_OF_CC_PY NAME...
"""
import struct
import sys
import numpy as np

sys.path.insert(0, sys.argv[1])
from cc import Mesh, limit, refine_param  # noqa: E402

# Tags of finite sharpness have worn off after so many, and the samples are vertices.
LEVELS = 4


def read(path):
    positions, faces, creases, corners = [], [], [], []
    for line in open(path):
        match line.split():
            case ["v", *xyz]:
                positions.append([float(x) for x in xyz[:3]])
            case ["f", *ends]:
                faces.append([int(end.split("/")[0]) - 1 for end in ends])
            case ["t", "crease", _, a, b, sharpness]:
                creases.append((int(a), int(b), float(sharpness)))
            case ["t", "corner", _, vertex, sharpness]:
                corners.append((int(vertex), float(sharpness)))
    mesh = Mesh(positions, faces)
    for a, b, sharpness in creases:
        mesh.set_crease(a, b, sharpness)
    for vertex, sharpness in corners:
        mesh.vs[vertex] = sharpness
    return mesh


class Surface:
    """The limit points of the refined mesh, and the derivative towards each neighbour."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.positions, self.t1, self.t2 = limit(mesh)
        self.rings = {}

    def ring(self, vertex):
        if vertex not in self.rings:
            half_edges, _ = self.mesh.ring(vertex)
            ends = [self.mesh.vert[self.mesh.nxt[h]] for h in half_edges]
            if self.mesh.bnd_v[vertex]:
                ends.append(self.mesh.vert[self.mesh.prv[half_edges[-1]]])
            self.rings[vertex] = (len(half_edges), {int(end): i for i, end in enumerate(ends)})
        return self.rings[vertex]

    def towards(self, vertex, neighbour):
        faces, places = self.ring(vertex)
        place, t1, t2 = places[int(neighbour)], self.t1[vertex], self.t2[vertex]
        if not self.mesh.bnd_v[vertex]:
            angle = 2 * np.pi * place / faces
        elif faces == 1:
            return (t1, t2)[place]
        else:
            angle = np.pi * place / faces
        return np.cos(angle) * t1 + np.sin(angle) * t2


def record(surface, side, face, sub, size, regular, grid):
    """`grid[i, j]` are vertices, at u = i / steps, v = j / steps."""
    steps = grid.shape[0] - 1
    out = [struct.pack("<4i", face, sub, size, regular)]
    for j in range(0, steps + 1, steps // (side - 1)):
        for i in range(0, steps + 1, steps // (side - 1)):
            def derivative(di, dj):
                sign = 1 if i + di <= steps and j + dj <= steps else -1
                neighbour = grid[i + sign * di, j + sign * dj]
                return sign * steps * surface.towards(grid[i, j], neighbour)
            fields = [surface.positions[grid[i, j]], derivative(1, 0), derivative(0, 1)]
            out.append(struct.pack("<9d", *np.concatenate(fields)))
    return b"".join(out)


def main(name):
    mesh = read(name + ".obj")
    fine, grids = refine_param(mesh, LEVELS)
    assert not (fine.es[~fine.bnd_e] > 0).any(), "tags of finite sharpness only, below LEVELS"
    surface = Surface(fine)
    # A part of a face is half as long as a quad.
    side = 5 if (mesh.fsz == 4).all() else 3
    tagged = np.zeros(mesh.nV, bool)
    tagged[mesh.ev[(mesh.es > 0) & ~mesh.bnd_e].ravel()] = True
    wanted = np.where(mesh.bnd_v, np.minimum(mesh.val_f, 2), 4)
    # Quads around, too: a regular face is bicubic.
    of_quads = np.bincount(mesh.vert[mesh.fsz[mesh.face] == 4], minlength=mesh.nV) == mesh.val_f
    plain = (mesh.val_f == wanted) & of_quads & ~tagged & (mesh.vs == 0)
    records = []
    for face in range(mesh.nF):
        size = int(mesh.fsz[face])
        parts = [(-1, grids[face])] if size == 4 else list(enumerate(grids[face]))
        regular = size == 4 and bool(plain[mesh.faces[face]].all())
        records += [record(surface, side, face, sub, size, regular, grid) for sub, grid in parts]
    header = struct.pack("<8s14i", b"OSDLIM01", 0, 2, mesh.nV, mesh.nF, len(records), side, 0, 0, 1, *[0] * 5)
    vertices = []
    for v in range(mesh.nV):
        normal = np.cross(surface.t1[v], surface.t2[v])
        values = [*surface.positions[v], *(normal / np.linalg.norm(normal)), 0, 0]
        vertices.append(struct.pack("<2i8d", 1, int(mesh.val_f[v]), *values))
    with open(name + ".bin", "wb") as file:
        file.write(header + b"".join(records + vertices))


for name in sys.argv[2:]:
    main(name)
