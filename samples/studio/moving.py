"""moving.py OUT CROP SIZE FRAME...: one moving PNG of FRAMEs, each cropped and scaled by ImageMagick.

Frames after the first hold only the rectangle that changed. Colours are rounded to 6 bits, which
keeps the dither of the window's background from counting as change.
"""
import struct
import subprocess
import sys
import zlib

DELAY_MS, LAST_MS = 110, 1800


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def read(path, crop, size, width):
    raw = subprocess.run(["convert", path, "-crop", crop, "+repage", "-resize", f"{size}!", "-depth", "8", "rgb:-"],
                         check=True, capture_output=True).stdout
    raw = bytes(min(255, (v + 2) & 0xFC) for v in raw)
    return [raw[at:at + 3 * width] for at in range(0, len(raw), 3 * width)]


def changed(rows, before):
    """x0, y0, x1, y1 of what differs; one pixel where nothing does."""
    ys = [y for y, (a, b) in enumerate(zip(rows, before)) if a != b] or [0]
    xs = [i // 3 for y in ys for i, (a, b) in enumerate(zip(rows[y], before[y])) if a != b] or [0]
    return min(xs), ys[0], max(xs) + 1, ys[-1] + 1


def packed(rows):
    """The smallest of the rows unfiltered, less the pixel to the left, and less the row above."""
    zero = bytes(len(rows[0]))
    above = [zero] + rows[:-1]
    filtered = [rows,
                [bytes((a - b) & 255 for a, b in zip(r, bytes(3) + r)) for r in rows],
                [bytes((a - b) & 255 for a, b in zip(r, u)) for r, u in zip(rows, above)]]
    return min((zlib.compress(b"".join(bytes([f]) + r for r in part), 9) for f, part in enumerate(filtered)), key=len)


out, crop, size, *frames = sys.argv[1:]
width, height = map(int, size.split("x"))
png = [b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
       chunk(b"acTL", struct.pack(">II", len(frames), 0))]
number, before = 0, None
for k, frame in enumerate(frames):
    rows = read(frame, crop, size, width)
    x0, y0, x1, y1 = changed(rows, before) if before else (0, 0, width, height)
    delay = LAST_MS if k == len(frames) - 1 else DELAY_MS
    png.append(chunk(b"fcTL", struct.pack(">IIIIIHHBB", number, x1 - x0, y1 - y0, x0, y0, delay, 1000, 0, 0)))
    number += 1
    data = packed([r[3 * x0:3 * x1] for r in rows[y0:y1]])
    if k == 0:
        png.append(chunk(b"IDAT", data))
    else:
        png.append(chunk(b"fdAT", struct.pack(">I", number) + data))
        number += 1
    before = rows
png.append(chunk(b"IEND", b""))
with open(out, "wb") as f:
    f.write(b"".join(png))
