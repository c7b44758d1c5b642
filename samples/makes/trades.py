#!/usr/bin/env python3
"""Writes strokes of trades, each with its tool. usage: trades.py FOLDER (samples/strokes)"""

import math
import pathlib
import sys

from hand import Stroke, care, write

LEFT, RIGHT = 0.5, -0.5  # parts of a tuft's width


def double_loaded(first, second):
    """One half of the width in each of two inks."""
    return (care("rinse") + care("dip", first) + care("wipe", amount=0.97, side=LEFT) + care("dip", second, side=LEFT))


def one_stroke():
    """Petals and leaves, each by one press of a brush with an ink in each half of its width."""
    place = {"origin": "0 0 40", "right": "1 0 0", "down": "0 -1 0", "mapping": "project"}
    petals, leaves, commas = [], [], []
    # From the rim of the flower to its heart: pressed down, drawn in, lifted onto the edge.
    for k in range(6):
        turn = 60 * k + 8
        s = Stroke("petal", double_loaded("cinnabar", "titanium-white"))
        s.curve([(-27, 0, 0, 90), (-26, 0, 0.35, 90), (-23, 0, 0.56, 90), (-18, 0, 0.5, 86), (-12, 0, 0.3, 60),
                 (-7, 0, 0.14, 25), (-3.5, 0, 0.06, 6), (0, 0, 0, 0)], 18)
        petals.append(s.moved(turn))
    # From the stem to the point: set down near the edge, turned to the broad side as it is pressed, and back onto the
    # edge while it slides and is lifted.
    for x, y, turn, size in ((43, 18, 20, 1.0), (23, 41, 62, 0.9), (-43, -17, 200, 1.0), (-23, -41, 243, 0.85),
                             (-43, 7, 172, 0.8), (44, -5, -9, 0.8)):
        s = Stroke("leaf", double_loaded("indigo", "gamboge"))
        s.curve([(-13, 0, 0, 8), (-11, 0.3, 0.22, 24), (-8, 0.9, 0.42, 52), (-3, 1.7, 0.55, 78), (4, 2, 0.48, 80),
                 (11, 1.6, 0.28, 50), (18, 0.4, 0.1, 18), (24, -0.8, 0, 0)], 20)
        leaves.append(s.moved(turn, size, x, y))
    for k in range(6):
        s = Stroke("comma", double_loaded("cinnabar", "titanium-white"))
        s.curve([(-4, 0, 0, 90), (-3.8, 0, 0.35, 90), (-2.5, 0, 0.5, 90), (-0.5, 0, 0.42, 75), (2, 0.1, 0.28, 40),
                 (5, 0.3, 0.16, 8), (8.5, 0.6, 0.05, 0), (10, 0.8, 0, 0)], 10)
        a = math.radians(60 * k + 38)
        commas.append(s.moved(60 * k + 38, 1, 26 * math.cos(a), 26 * math.sin(a)))
    return [({"brush": "flat-12*0.8", "ink": "indigo", **place}, leaves),
            ({"brush": "filbert-12", "ink": "cinnabar", **place}, petals),
            ({"brush": "filbert-12*0.45", "ink": "cinnabar", **place}, commas),
            ({"brush": "liner-3", "ink": "gamboge", **place}, [
                Stroke("stamen").curve([(0, 0, 0, 0), (0.4, 0, 0.25, 0), (0.4, 0.2, 0, 0)], 6).moved(0, 1, x, y)
                for x, y in ((0, 0), (2, 1), (-2, 1.2), (0.4, -2.2), (1.6, -1.6), (-1.8, -1), (0, 2.6))])]


def bamboo():
    """Stalks in pieces by the broad side of a flat, darker at one side; leaves by its edge, pressed and lifted."""
    place = {"origin": "0 0 0", "right": "1 0 0", "down": "0 -1 0", "mapping": "project"}
    stalks, leaves, joints = [], [], []
    loaded = (care("rinse") + care("dip", "samples/inks/indigo-wash.toml") + care("wipe", amount=0.7, side=-0.35) +
              care("dip", "carbon", side=-0.35, amount=0.55))
    for foot, lean, ends in ((-40, 6, (80, 44, 4, -40, -80)), (14, -7, (80, 54, 22, -18, -58, -80))):
        def at(y, foot=foot, lean=lean):
            return foot + lean * (80 - y) / 160
        for low, high in zip(ends, ends[1:]):
            s = Stroke("stalk", loaded)
            s.curve([(at(low), low - 3, 0, 0), (at(low), low - 3.4, 0.42, 0), (at(low), low - 6, 0.3, 0),
                     (at(high), high + 7, 0.3, 0), (at(high), high + 3, 0.42, 0), (at(high), high + 2.6, 0, 0)], 60)
            stalks.append(s)
            if low < 80:
                joints.append(Stroke("joint").curve([(at(low) - 6.4, low + 1.5, 0, 0), (at(low) - 5.6, low + 0.3, 0.22, 0),
                                                     (at(low), low + 0.8, 0.12, 0), (at(low) + 5.6, low + 0.3, 0.22, 0),
                                                     (at(low) + 6.4, low + 1.5, 0, 0)], 30))
    for x, y, turns in ((-32, -42, (28, 62, 96)), (18, -20, (8, 40, 74)), (16, -60, (20, 58, 95)),
                        (-42, 2, (150, 118, 84)), (-34, 42, (22, 58)), (16, 20, (14, 52, 88)), (4, -20, (166, 128))):
        for turn in turns:
            size = 1 + 0.15 * math.sin(turn)
            s = Stroke("leaf", care("rinse") + care("dip", "carbon"))
            s.curve([(1, 0, 0, 0), (6, -0.4, 0.12, 8), (12, -0.4, 0.5, 24), (17, 0.2, 0.5, 20), (25, 1.4, 0.2, 6),
                     (33, 2.8, 0.03, 0), (35, 3.2, 0, 0)], 45)
            leaves.append(s.moved(turn, size, x, y))
    return [({"brush": "flat-12", "ink": "samples/inks/indigo-wash.toml", **place}, stalks),
            ({"brush": "rigger-3", "ink": "carbon", **place}, joints),
            ({"brush": "flat-12*0.8", "ink": "carbon", **place}, leaves)]


def grass():
    """Grass by flicks of a fan that is nearly dry, upwards, lifted at their end; the farther ones first."""
    place = {"origin": "0 0 0", "right": "1 0 0", "down": "0 -1 0", "mapping": "project"}
    strokes = []
    for row, (y, ink, dry) in enumerate(((26, "samples/inks/green-wash.toml", 0.72), (44, "gamboge", 0.78),
                                         (62, "indigo", 0.76))):
        for k in range(7):
            x = -70 + 22 * k + 8 * (row % 2) + 3 * math.sin(5 * k + row)
            bend = 16 * math.sin(2.1 * k + row)
            up = 1 + 0.3 * math.sin(3.7 * k + 2 * row)
            s = Stroke("grass", care("rinse") + care("dip", ink) + care("wipe", amount=dry))
            s.curve([(0, 8, 0, 0), (0, 4, 0.12, 0), (0, -2, 0.26, 0), (0.1 * bend, -12 * up, 0.24, -0.3 * bend),
                     (0.4 * bend, -24 * up, 0.14, -0.7 * bend), (0.9 * bend, -36 * up, 0, -1.2 * bend)], 150)
            strokes.append(s.moved(0, 1, x, y))
    return [({"brush": "fan-30", "ink": "indigo", **place}, strokes)]


STRIPE = [(470, 170), (430, 181), (400, 187), (345, 193), (285, 188), (225, 181), (150, 177), (50, 178), (-50, 180), (-150, 185),
          (-250, 193), (-345, 200), (-420, 196), (-480, 184), (-530, 168)]


def sword():
    """A pinstripe a metre long over both arches, and a scroll on the door."""
    place = {"origin": "0 -240 0", "right": "1 0 0", "down": "0 0 -1", "mapping": "project"}

    def blade(points, press, speed):
        """The blade goes along the path."""
        keys = []
        for i, (x, y) in enumerate(points):
            a, b = points[max(0, i - 1)], points[min(len(points) - 1, i + 1)]
            roll = -math.degrees(math.atan2(b[1] - a[1], b[0] - a[0]))
            while keys and roll - keys[-1][3] > 180:
                roll -= 360
            while keys and roll - keys[-1][3] < -180:
                roll += 360
            p = press(i / (len(points) - 1)) if callable(press) else press
            keys.append((x, y, p, roll))
        return Stroke("sword").curve(keys, speed)

    stripe = blade([(x, -z) for x, z in STRIPE], lambda f: 0 if f in (0, 1) else 0.2, 160)
    stripe.label = "pinstripe"
    strokes = [stripe]

    def spiral(x, y, size, turns, start, way):
        out = []
        for i in range(28):
            f = i / 27
            a = math.radians(start) + way * 2 * math.pi * turns * f
            r = size * (1 - 0.82 * f)
            out.append((x + r * math.cos(a), y + r * math.sin(a)))
        return out

    for way in (1, -1):
        scroll = blade(spiral(-10 + 46 * way, -140, 22, 1.15, 90, way), lambda f: 0 if f in (0, 1) else 0.1 + 0.2 * (1 - f), 60)
        scroll.label = "scroll"
        strokes.append(scroll)
        # Drops that fall away from the scroll's foot, the longest in the middle.
        for k, size in enumerate((1.0, 0.7, 0.45)):
            drop = Stroke("teardrop").curve([(0, 0, 0, 0), (1, 0, 0.62, 0), (4, 0, 0.5, 0), (14, 0, 0.22, 0), (26, 0, 0, 0)],
                                            40)
            strokes.append(drop.moved(90 - way * 16 * k, size, -10 + way * (4 + 9 * k), -122 - 2 * k))
    return [({"brush": "sword-8", "ink": "titanium-white", **place}, strokes)]


def main():
    folder = pathlib.Path(sys.argv[1])
    for name, title, groups in (("one-stroke", "Petals and leaves by one press", one_stroke()),
                                ("flat-bamboo", "Bamboo by a flat", bamboo()), ("fan-grass", "Grass by a fan", grass()),
                                ("car-sword", "A pinstripe and a scroll by a sword", sword())):
        write(folder / f"{name}.inkml", title, groups)


if __name__ == "__main__":
    main()
