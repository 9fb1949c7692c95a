# SPDX-License-Identifier: MIT
"""Meshes of the atlas that no scene's grid or tube can say, as text of OBJ files with every digit."""

import math

CELLS = 16  # along each side of the square metre that all of them begin with


def grid(cells=CELLS, width=1.0, corner=(-0.5, 0.0, -0.5), step=None, rows=None):
    """Vertices row by row and counter-clockwise triangles of a square horizontal grid with alternating diagonals.
    `step`: the place of a column as a share of the width; even without it. `rows`: the places of the rows likewise."""
    step = step or (lambda column: column / cells)
    rows = rows or [row / cells for row in range(cells + 1)]
    vertices = [(corner[0] + width * step(c), corner[1], corner[2] + width * row)
                for row in rows for c in range(cells + 1)]
    triangles = []
    for r in range(len(rows) - 1):
        for c in range(cells):
            a = r * (cells + 1) + c
            b, d, e = a + 1, a + cells + 1, a + cells + 2
            triangles += [(a, d, e), (a, e, b)] if (r + c) % 2 == 0 else [(a, d, b), (b, d, e)]
    return vertices, triangles


def needles(aspect):
    """Every second column of cells is `aspect` times as long as wide; pins at vertices 0 and 16 as on the grid."""
    wide = 2.0 / (CELLS * (1.0 + 1.0 / aspect))

    def step(column):
        return wide * (column // 2 * (1.0 + 1.0 / aspect) + column % 2)

    return grid(step=step)


BELT_ROWS = 3  # of cells: two rows of vertices have no other triangles, and weigh as little


def belts(height, places):
    """The grid with a belt of rows `height` times as high as an edge is long in front of each row of cells in `places`."""
    heights = []
    for row in range(CELLS + 1):
        heights += places.count(row) * BELT_ROWS * [height] + [1.0]
    heights.pop()
    whole = sum(heights)
    return grid(rows=[sum(heights[:row]) / whole for row in range(len(heights) + 1)])


def split(share, height):
    """The grid, where a `share` of the triangles, spread evenly, is cut in three by a vertex `height` times as high over
    the middle of an edge as it is long."""
    vertices, triangles = grid()
    cut = []
    for number, (a, b, c) in enumerate(triangles):
        if math.floor((number + 1) * share) == math.floor(number * share):
            cut.append((a, b, c))
            continue
        (ax, _, az), (bx, _, bz), (cx, _, cz) = vertices[a], vertices[b], vertices[c]
        middle = [0.5 * (p + q) for p, q in zip(vertices[a], vertices[b])]
        square_length = (bx - ax) ** 2 + (bz - az) ** 2
        towards = height * square_length / abs((bx - ax) * (cz - az) - (bz - az) * (cx - ax))
        vertices.append(tuple(m + towards * (p - m) for m, p in zip(middle, vertices[c])))
        new = len(vertices) - 1
        cut += [(a, b, new), (b, c, new), (c, a, new)]
    return vertices, cut


def far_away(distance):
    """The grid, moved along all three axes."""
    vertices, triangles = grid()
    return [tuple(x + distance for x in vertex) for vertex in vertices], triangles


def fins():
    """The grid with a fin hanging from every second inner row of edges: four triangles at each of these edges."""
    vertices, triangles = grid()
    drop = 1.0 / CELLS
    for r in range(2, CELLS, 2):
        for side in (-1.0, 1.0):
            first = len(vertices)
            vertices += [(vertices[r * (CELLS + 1) + c][0], -drop, vertices[r * (CELLS + 1) + c][2] + 0.5 * side * drop)
                         for c in range(CELLS + 1)]
            for c in range(CELLS):
                a, b = r * (CELLS + 1) + c, r * (CELLS + 1) + c + 1
                triangles += [(a, first + c, b), (b, first + c, first + c + 1)]
    return vertices, triangles


def components(count):
    """`count` patches of 2 × 2 cells, a metre apart; the first vertex of each is 9 times its number."""
    side = math.isqrt(count - 1) + 1
    vertices, triangles = [], []
    for patch in range(count):
        own, faces = grid(2, 0.125, (float(patch % side), 0.0, float(patch // side)))
        triangles += [tuple(len(vertices) + v for v in face) for face in faces]
        vertices += own
    return vertices, triangles


def obj_text(mesh):
    vertices, triangles = mesh
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join(
        f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
