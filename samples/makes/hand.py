"""Strokes by hand for stroke files (InkML): paths in millimetres with pressure and roll, at 100 samples a second."""

import math

RATE = 100  # samples a second


class Stroke:
    """A path of the hand. Keys are (x, y, pressure, roll): mm, y down; 0 to 1; degrees."""

    def __init__(self, label, before=""):
        self.label, self.before, self.points, self.time = label, before, [], 0.0

    def go(self, keys, speed):
        """Goes from key to key on straight lines, at `speed` mm a second."""
        for a, b in zip(keys, keys[1:]):
            length = max(math.dist(a[:2], b[:2]), 0.1 * speed)
            steps = max(1, round(length / speed * RATE))
            for i in range(steps if b is not keys[-1] else steps + 1):
                f = i / steps
                self.points.append([p + f * (q - p) for p, q in zip(a, b)] + [self.time])
                self.time += 1000 / RATE
        return self

    def curve(self, keys, speed):
        """Goes on a centripetal Catmull-Rom curve through the keys (Barry and Goldman), at about `speed` mm a second."""
        ends = [tuple(2 * p - q for p, q in zip(keys[0], keys[1]))] + list(keys)
        ends.append(tuple(2 * p - q for p, q in zip(keys[-1], keys[-2])))
        dense = []
        for k in range(len(keys) - 1):
            p = ends[k:k + 4]
            t = [0.0]
            for a, b in zip(p, p[1:]):
                t.append(t[-1] + math.sqrt(max(math.dist(a[:2], b[:2]), 1e-3)))
            for i in range(40):
                dense.append(catmull_rom(p, t, t[1] + (t[2] - t[1]) * i / 40))
        dense.append(tuple(keys[-1]))
        along = [0.0]
        for a, b in zip(dense, dense[1:]):
            along.append(along[-1] + max(math.dist(a[:2], b[:2]), 1e-4))
        steps = max(2, round(along[-1] / speed * RATE))
        k = 0
        for i in range(steps + 1):
            f = i / steps
            at = along[-1] * (f + 0.35 / (2 * math.pi) * -math.sin(2 * math.pi * f))  # slower at both ends
            while k + 2 < len(along) and along[k + 1] < at:
                k += 1
            g = min(1, max(0, (at - along[k]) / (along[k + 1] - along[k])))
            x, y, press, roll = (p + g * (q - p) for p, q in zip(dense[k], dense[k + 1]))
            self.points.append([x, y, min(1, max(0, press)), roll, self.time])
            self.time += 1000 / RATE
        return self

    def moved(self, turn=0.0, scale=1.0, x=0.0, y=0.0):
        """Turns the stroke by `turn` degrees, clockwise as seen, and moves it."""
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        for p in self.points:
            p[0], p[1] = x + scale * (c * p[0] - s * p[1]), y + scale * (s * p[0] + c * p[1])
            p[3] -= turn
        return self

    def text(self):
        points = ", ".join("{0:.2f} {1:.2f} {2:.3f} {4:.0f} 0 0 {3:.1f}".format(*p) for p in self.points)
        return (f'    <trace contextRef="#rolled">\n      <annotation type="tuft:label">{self.label}</annotation>\n'
                f"{self.before}{points}\n    </trace>\n")


def catmull_rom(p, t, at):
    def mix(a, b, ta, tb):
        return tuple((tb - at) / (tb - ta) * x + (at - ta) / (tb - ta) * y for x, y in zip(a, b))
    a = [mix(p[k], p[k + 1], t[k], t[k + 1]) for k in range(3)]
    b = [mix(a[k], a[k + 1], t[k], t[k + 2]) for k in range(2)]
    return mix(b[0], b[1], t[1], t[2])


def care(kind, value="", **extent):
    """An annotation that acts on the brush before a trace."""
    extra = "".join(f' {key}="{amount}"' for key, amount in extent.items())
    return f'      <annotation type="tuft:{kind}"{extra}>{value}</annotation>\n'


def write(path, title, groups):
    """Writes a stroke file. A group is (annotations, strokes)."""
    channels = "".join(f'      <channel name="{name}" type="decimal" {unit}/>\n' for name, unit in (
        ("X", 'units="mm"'), ("Y", 'units="mm"'), ("P", 'min="0" max="1"'), ("T", 'units="ms"'), ("OTx", 'units="deg"'),
        ("OTy", 'units="deg"'), ("OR", 'units="deg"')))
    with open(path, "w", encoding="utf-8") as f:
        f.write('<?xml version="1.0" encoding="UTF-8"?>\n<ink xmlns="http://www.w3.org/2003/InkML">\n'
                f'  <annotation type="title">{title}</annotation>\n'
                f'  <definitions>\n    <traceFormat xml:id="rolled-format">\n{channels}    </traceFormat>\n'
                '    <context xml:id="rolled" traceFormatRef="#rolled-format"/>\n  </definitions>\n')
        for annotations, strokes in groups:
            f.write("  <traceGroup>\n")
            for key, value in annotations.items():
                f.write(f'    <annotation type="tuft:{key}">{value}</annotation>\n')
            for stroke in strokes:
                f.write(stroke.text())
            f.write("  </traceGroup>\n")
        f.write("</ink>\n")
