#!/usr/bin/env python3
"""Writes a square sheet (OBJ) and the strokes that show a make of brush (InkML), for samples/makes/sheet.sh.

usage: sheet.py BRUSH LENGTH_MM WIDTH_MM BROAD FOLDER

LENGTH_MM: of the hair. WIDTH_MM: of the mark. BROAD: 1 for a ferrule with a broad side, 2 for a blade, which is
led along it, else 0.
"""

import math
import pathlib
import sys

from hand import Stroke, care, write

def line(x0, y0, x1, y1, roll, press=0.5, land=0):
    """Keys of a straight stroke that lands and leaves within `land`, mm, or an eighth of it."""
    part = min(0.4, max(0.12, land / math.dist((x0, y0), (x1, y1))))
    def at(f):
        return x0 + f * (x1 - x0), y0 + f * (y1 - y0)
    return [(*at(0), 0, roll), (*at(part), press, roll), (*at(1 - part), press, roll), (*at(1), 0, roll)]


def wave(x0, x1, y, height, broad, roll_of=None, press=0.5):
    """Keys of one period of a sine wave; the ferrule stays, or `roll_of` gives its roll by the direction."""
    keys, n = [], 48
    for i in range(n + 1):
        f = i / n
        p = press * min(1, f / 0.12, (1 - f) / 0.12)
        slope = -height * 2 * math.pi / (x1 - x0) * math.cos(2 * math.pi * f)
        roll = roll_of(math.atan2(slope, 1)) if roll_of else 90.0 * (broad == 1)
        keys.append((x0 + f * (x1 - x0), y - height * math.sin(2 * math.pi * f), p, roll))
    return keys


def strokes(cell, length, broad):
    """The strokes of one make, on 4 by 2 cells, with the origin at the upper left corner of the first one.

    A round tuft is pressed down over a quarter of its hair: that much of it comes to trail, and a hand that presses
    sooner pushes it against its point, which draws a head wider than the stroke and a neck behind it."""
    across = 90.0 if broad == 1 else 0.0  # the broad side across a stroke to the right; a blade along it
    other = 90.0 if broad == 2 else 0.0
    speed = 0.8 * cell
    out = []

    def centre(column, row):
        return (column + 0.5) * cell, (row + 0.5) * cell

    x, y = centre(0, 0)
    out.append(Stroke("dot").go([(x - 0.2 * cell, y, 0, across), (x - 0.2 * cell, y, 0.35, across),
                                 (x - 0.2 * cell, y, 0, across)], 0.5 * cell))
    out.append(Stroke("dot, pressed").go([(x + 0.2 * cell, y, 0, across), (x + 0.2 * cell, y, 0.9, across),
                                          (x + 0.2 * cell, y, 0, across)], 0.5 * cell))
    x, y = centre(1, 0)
    half = 0.36 * cell
    land = 0 if broad else 0.25 * length
    out.append(Stroke("straight").go(line(x - half, y, x + half, y, across, land=land), speed))
    x, y = centre(2, 0)
    out.append(Stroke("edge").go(line(x - half, y - 0.25 * cell, x + half, y - 0.25 * cell, other, 0.35, land), speed))
    out.append(Stroke("broad, down").go(line(x, y - 0.12 * cell, x, y + half, across - 90 * (broad > 0), 0.5, land), speed))
    x, y = centre(3, 0)
    turn = [(x + 0.27 * cell * math.sin(t), y - 0.27 * cell * math.cos(t), 0.5 * min(1, t / 0.6, (4.5 - t) / 0.6), across)
            for t in [4.5 * i / 60 for i in range(61)]]
    out.append(Stroke("turn").go(turn, 0.6 * speed))
    x, y = centre(0, 1)
    follow = (lambda w: across - math.degrees(w)) if broad else None
    out.append(Stroke("S, following").go(wave(x - half, x + half, y, 0.13 * cell, broad, follow), speed))
    x, y = centre(1, 1)
    press = [(x - half + 2 * half * f, y, 0.02 + 0.88 * math.sin(2 * math.pi * f) ** 2 if 0.02 < f < 0.98 else 0,
              across) for f in [i / 60 for i in range(61)]]
    out.append(Stroke("press and lift").go(press, speed))
    x, y = centre(2, 1)
    for i, amount in enumerate((0.6, 0.88)):
        at = y + (i - 0.5) * 0.4 * cell
        out.append(Stroke(f"dry {amount}", care("wipe", amount=amount)).go(line(x - half, at, x + half, at, across, land=land), 1.5 * speed))
    x, y = centre(3, 1)
    out.append(Stroke("there and back").go([(x - half, y, 0, across), (x - 0.8 * half, y, 0.4, across),
                                            (x + half, y, 0.4, across), (x - 0.3 * half, y + 0.25 * cell, 0.4, across),
                                            (x - half, y + 0.35 * cell, 0, across)], speed))
    if broad == 2:  # a stripe is drawn by the point of a blade
        for stroke in out:
            for point in stroke.points:
                point[2] *= 0.35
    return out


def main():
    brush, length, width, broad, folder = sys.argv[1], *map(float, sys.argv[2:4]), int(sys.argv[4]), sys.argv[5]
    cell = max(5 * width if width < 40 else 3.6 * width, 1.5 * length)
    margin = 0.25 * cell
    folder = pathlib.Path(folder)
    n = 16
    points = [(4.5 * cell * i / n - margin, margin - 2.5 * cell * j / n, i / n, 1 - 5 / 9 * j / n) for j in range(n + 1) for i in range(n + 1)]
    with open(folder / f"{brush}.obj", "w") as f:
        for x, y, _, _ in points:
            f.write(f"v {x} {y} 0\n")
        for _, _, u, v in points:
            f.write(f"vt {u} {v}\n")
        for j in range(n):
            for i in range(n):
                a, b = j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1
                f.write(f"f {a}/{a} {b}/{b} {b + 1}/{b + 1}\nf {a}/{a} {b + 1}/{b + 1} {a + 1}/{a + 1}\n")
    write(folder / f"{brush}.inkml", brush, [({"brush": brush, "origin": "0 0 0", "right": "1 0 0", "down": "0 -1 0",
                                               "mapping": "project"}, strokes(cell, length, broad))])


main()
