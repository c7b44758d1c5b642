#!/usr/bin/env python3
"""Writes a square sheet (OBJ) and the strokes that show a make of brush (InkML), for samples/makes/sheet.sh.

usage: sheet.py BRUSH LENGTH_MM WIDTH_MM BROAD FOLDER

LENGTH_MM: of the hair. WIDTH_MM: of the mark. BROAD: 1 for a ferrule with a broad side, else 0.
"""

import math
import pathlib
import sys

RATE = 100  # samples a second


class Stroke:
    """Points of a hand's path, mm on the sheet, y down; pressure 0 to 1; roll in degrees."""

    def __init__(self, label, before=""):
        self.label, self.before, self.points, self.time = label, before, [], 0.0

    def go(self, keys, speed):
        """Goes from key to key (x, y, pressure, roll), linear between them, at `speed` mm a second."""
        for a, b in zip(keys, keys[1:]):
            length = max(math.dist(a[:2], b[:2]), 0.1 * speed)
            steps = max(1, round(length / speed * RATE))
            for i in range(steps if b is not keys[-1] else steps + 1):
                f = i / steps
                self.points.append([p + f * (q - p) for p, q in zip(a, b)] + [self.time])
                self.time += 1000 / RATE
        return self

    def text(self):
        points = ", ".join("{0:.3f} {1:.3f} {2:.4f} {4:.0f} 0 0 {3:.2f}".format(*p) for p in self.points)
        return (f'    <trace contextRef="#rolled">\n      <annotation type="tuft:label">{self.label}</annotation>\n'
                f"{self.before}{points}\n    </trace>\n")


def line(x0, y0, x1, y1, roll, press=0.5, land=0.12):
    """Keys of a straight stroke that lands and leaves within the part `land` of it."""
    def at(f):
        return x0 + f * (x1 - x0), y0 + f * (y1 - y0)
    return [(*at(0), 0, roll), (*at(land), press, roll), (*at(1 - land), press, roll), (*at(1), 0, roll)]


def wave(x0, x1, y, height, broad, roll_of=None, press=0.5):
    """Keys of one period of a sine wave; the ferrule stays, or `roll_of` gives its roll by the direction."""
    keys, n = [], 48
    for i in range(n + 1):
        f = i / n
        p = press * min(1, f / 0.12, (1 - f) / 0.12)
        slope = -height * 2 * math.pi / (x1 - x0) * math.cos(2 * math.pi * f)
        roll = roll_of(math.atan2(slope, 1)) if roll_of else 90.0 * broad
        keys.append((x0 + f * (x1 - x0), y - height * math.sin(2 * math.pi * f), p, roll))
    return keys


def strokes(cell, width, broad):
    """The strokes of one make, on 4 by 2 cells, with the origin at the upper left corner of the first one."""
    across = 90.0 if broad else 0.0  # the broad side across a stroke to the right
    speed = 0.8 * cell
    wipe = '      <annotation type="tuft:wipe" amount="{}"/>\n'
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
    out.append(Stroke("straight").go(line(x - half, y - 0.2 * cell, x + half, y - 0.2 * cell, across), speed))
    out.append(Stroke("straight, diagonal").go(line(x - half, y + 0.35 * cell, x + half, y + 0.05 * cell, across), speed))
    x, y = centre(2, 0)
    out.append(Stroke("edge, to the right").go(line(x - half, y - 0.25 * cell, x + half, y - 0.25 * cell, 0, 0.35), speed))
    out.append(Stroke("edge, down").go(line(x - 0.15 * cell, y - 0.12 * cell, x - 0.15 * cell, y + half, across, 0.35), speed))
    out.append(Stroke("broad, down").go(line(x + 0.2 * cell, y - 0.12 * cell, x + 0.2 * cell, y + half, 0, 0.5), speed))
    x, y = centre(3, 0)
    turn = [(x + 0.27 * cell * math.sin(t), y - 0.27 * cell * math.cos(t), 0.5 * min(1, t / 0.6, (4.5 - t) / 0.6), across)
            for t in [4.5 * i / 60 for i in range(61)]]
    out.append(Stroke("turn").go(turn, 0.6 * speed))
    x, y = centre(0, 1)
    follow = (lambda w: 90 - math.degrees(w)) if broad else None
    out.append(Stroke("S").go(wave(x - half, x + half, y - 0.2 * cell, 0.13 * cell, broad), speed))
    out.append(Stroke("S, following").go(wave(x - half, x + half, y + 0.22 * cell, 0.13 * cell, broad, follow), speed))
    x, y = centre(1, 1)
    press = [(x - half + 2 * half * f, y - 0.22 * cell, 0.02 + 0.88 * math.sin(2 * math.pi * f) ** 2 if 0.02 < f < 0.98 else 0,
              across) for f in [i / 60 for i in range(61)]]
    out.append(Stroke("press and lift").go(press, speed))
    press = [(px, py + 0.47 * cell, p, 0) for px, py, p, _ in press]
    out.append(Stroke("press and lift, edge" if broad else "press and lift again").go(press, speed))
    x, y = centre(2, 1)
    for i, amount in enumerate((0.6, 0.75, 0.88)):
        at = y + (i - 1) * 0.3 * cell
        out.append(Stroke(f"dry {amount}", wipe.format(amount)).go(line(x - half, at, x + half, at, across), 1.5 * speed))
    x, y = centre(3, 1)
    out.append(Stroke("leaning").go(line(x - half, y - 0.2 * cell, x + half, y - 0.2 * cell, across, 0.25), speed))
    out.append(Stroke("reversed").go([(x - half, y + 0.2 * cell, 0, across), (x - 0.8 * half, y + 0.2 * cell, 0.4, across),
                                      (x + half, y + 0.2 * cell, 0.4, across), (x - 0.3 * half, y + 0.25 * cell, 0.4, across),
                                      (x - half, y + 0.25 * cell, 0, across)], speed))
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
    channels = "".join(f'      <channel name="{name}" type="decimal" {unit}/>\n' for name, unit in (
        ("X", 'units="mm"'), ("Y", 'units="mm"'), ("P", 'min="0" max="1"'), ("T", 'units="ms"'), ("OTx", 'units="deg"'),
        ("OTy", 'units="deg"'), ("OR", 'units="deg"')))
    with open(folder / f"{brush}.inkml", "w") as f:
        f.write('<?xml version="1.0" encoding="UTF-8"?>\n<ink xmlns="http://www.w3.org/2003/InkML">\n'
                f'  <definitions>\n    <traceFormat xml:id="rolled-format">\n{channels}    </traceFormat>\n'
                '    <context xml:id="rolled" traceFormatRef="#rolled-format"/>\n  </definitions>\n  <traceGroup>\n'
                f'    <annotation type="tuft:brush">{brush}</annotation>\n'
                '    <annotation type="tuft:origin">0 0 0</annotation>\n    <annotation type="tuft:right">1 0 0</annotation>\n'
                '    <annotation type="tuft:down">0 -1 0</annotation>\n    <annotation type="tuft:mapping">project</annotation>\n')
        for stroke in strokes(cell, width, broad):
            f.write(stroke.text())
        f.write("  </traceGroup>\n</ink>\n")


main()
