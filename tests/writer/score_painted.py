#!/usr/bin/env python3
"""Scores what `tuft write` paints against the outlines of hanzi-writer-data (npm; one JSON a character).

usage: score_painted.py DATA CHARACTERS --tuft TUFT [--write='--fit --brush goat-medium'] [--keep DIR] [--n N] [--sample N]
CHARACTERS: a file, such as held_out.txt, 200 characters that the table of sides was not learned from. --sample: N of
them at random, the same at every run, none of the first 60, which were looked at while the writer was made. Each character is written alone, 133 mm large, on the flat sheet; its base colour map is compared
with the filled outlines at one unit a pixel, best over the eight orientations of the map, scale and shift: a writer is
not marked down for where it wrote. Prints for each character and in the mean:
  IoU          intersection over union
  knuckles     per stroke: convex maxima of the curvature of the painted outline, above 1/25 unit after a Gaussian of
               6 units, that the model has not (none of half the size within 30 units)
  beyond       95th percentile of the distance of the painted outline from that of the model, units
  within       shares of the painted outline within 8 and within 14 units of the model's
  cpu          seconds of the whole command per stroke, model and painting included
and names the ten worst.
With --drawn FOLDER, the pictures of `measure_writer score --drawn` are scored as they lie, in place of paintings.
Needs numpy and Pillow."""
import argparse, json, os, random, resource, subprocess, sys, tempfile
import numpy as np
from PIL import Image

N = 1280          # pixels of the common raster, one unit each
MARGIN = 128
INK = 128         # grey level half way between paper and ink
SHEET, SIDE, TEXELS = 200.0, 133.0, 2048   # mm, mm, texels of the map

def outline(d):
    t = d.replace(',', ' ').split(); i = 0; cur = (0, 0); ring = []; rings = []
    while i < len(t):
        c = t[i]; i += 1
        n = {'M': 1, 'L': 1, 'Q': 2, 'C': 3, 'Z': 0}[c]
        p = [(float(t[i+2*k]), float(t[i+2*k+1])) for k in range(n)]; i += 2*n
        if c == 'M': ring = [p[0]]
        elif c == 'Z': rings.append(ring); ring = []
        else:
            q = [cur] + p
            for k in range(1, 9 if n > 1 else 2):
                u = k/8 if n > 1 else 1; r = list(q)
                while len(r) > 1: r = [((1-u)*a[0]+u*b[0], (1-u)*a[1]+u*b[1]) for a, b in zip(r, r[1:])]
                ring.append(r[0])
        if n: cur = p[-1]
    return rings + ([ring] if ring else [])

def filled(rings, n):
    """Pixels of an n × n raster whose centres lie in the rings (nonzero). ImageDraw.polygon also takes those that an edge touches:
    121 of a square of 10 × 10, and 1.4 % more than the area of a character."""
    turns = np.zeros((n, n + 1), np.int32)
    for ring in rings:
        for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1]):
            if y0 == y1: continue
            rows = np.arange(max(0, int(np.ceil(min(y0, y1) - .5))), min(n, int(np.ceil(max(y0, y1) - .5))))
            x = x0 + (rows + .5 - y0)/(y1 - y0)*(x1 - x0)
            np.add.at(turns, (rows, np.clip(np.ceil(x - .5), 0, n).astype(int)), 1 if y1 > y0 else -1)
    return np.cumsum(turns[:, :-1], 1) != 0

assert filled([[(10, 10), (20, 10), (20, 20), (10, 20)]], 40).sum() == 100

def truth(character):
    T = np.zeros((2*N, 2*N), bool)
    for d in character['strokes']: T |= filled([[(2*(x+MARGIN), 2*(900-y+MARGIN)) for x, y in ring] for ring in outline(d)], 2*N)
    return T.reshape(N, 2, N, 2).mean((1, 3)) >= .5

def best_match(T, image):
    """The painted raster in the frame of T, and its IoU."""
    F = np.conj(np.fft.rfft2(T.astype(float))); total = T.sum()
    ink = image < INK
    if not ink.any(): return None, 0
    ys, xs = np.where(ink); image = image[ys.min():ys.max()+1, xs.min():xs.max()+1]
    picture = Image.fromarray(image); ty, tx = np.where(T)
    def at(q, s, raster=False):
        w, h = max(1, round(picture.size[0]*s)), max(1, round(picture.size[1]*s))
        if w > N or h > N: return 0, None
        p = np.asarray(picture.resize((w, h), Image.BICUBIC)) < INK
        p = np.rot90(p, q % 4); p = p[:, ::-1] if q >= 4 else p
        R = np.zeros((N, N)); R[:p.shape[0], :p.shape[1]] = p
        c = np.fft.irfft2(np.fft.rfft2(R)*F, s=(N, N)); k = c.argmax(); both = c.flat[k]
        if raster: R = np.roll(R, (-(k//N), -(k % N)), (0, 1)) > .5
        return both/(total + p.sum() - both), R
    best = (0, 0, 1)
    for q in range(8):
        w, h = picture.size if q % 2 == 0 else picture.size[::-1]
        s = (np.ptp(tx)/w*np.ptp(ty)/h)**.5; best = max(best, (at(q, s)[0], q, s))
    for step in (.01, .003, .001):
        centre = best
        for k in (-3, -2, -1, 1, 2, 3): best = max(best, (at(centre[1], centre[2]*(1+k*step))[0], centre[1], centre[2]*(1+k*step)))
    iou, q, s = best; _, R = at(q, s, True); ry, rx = np.where(R)
    turned = np.rot90(image, q % 4); turned = Image.fromarray(np.ascontiguousarray(turned[:, ::-1] if q >= 4 else turned))
    white = Image.new('L', (turned.size[0] + 16, turned.size[1] + 16), 255); white.paste(turned, (8, 8))
    def moved(s, x, y):   # scale and shift in parts of a pixel
        p = np.asarray(white.transform((N, N), Image.AFFINE, (1/s, 0, 8 - x/s, 0, 1/s, 8 - y/s), Image.BICUBIC, fillcolor=255)) < INK
        return (p & T).sum()/(p | T).sum(), p
    at_best = (moved(s, rx.min(), ry.min())[0], s, float(rx.min()), float(ry.min()))
    for step in (.5, .25, .12):
        for _ in range(3):
            before = at_best
            for ds, dx, dy in ((0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0)):
                t = (before[1]*(1 + ds*step*.002), before[2] + dx*step, before[3] + dy*step)
                at_best = max(at_best, (moved(*t)[0],) + t)
            if at_best == before: break
    return moved(*at_best[1:])[1], max(iou, at_best[0])

def contours(mask):
    """Closed boundaries between pixels, each in order, as points."""
    m = np.pad(mask, 1); edges = {}
    for (dy, dx), a, b in (((0, 1), (0, 1), (1, 1)), ((0, -1), (1, 0), (0, 0)), ((1, 0), (1, 1), (1, 0)), ((-1, 0), (0, 0), (0, 1))):
        ys, xs = np.where(m & ~np.roll(m, (-dy, -dx), (0, 1)))
        for y, x in zip(ys.tolist(), xs.tolist()): edges.setdefault((y+a[0], x+a[1]), []).append((y+b[0], x+b[1]))
    out = []
    while edges:
        start = next(iter(edges)); line = [start]; at = start
        while at in edges:
            nxt = edges[at].pop()
            if not edges[at]: del edges[at]
            line.append(nxt); at = nxt
        if len(line) > 60: out.append(np.array(line[:-1], float))
    return out

def smooth_curvature(line, sigma=6.0):
    n = len(line); f = np.fft.fftfreq(n); g = np.exp(-2*(np.pi*f*sigma)**2)
    z = np.fft.ifft(np.fft.fft(line[:, 1] + 1j*line[:, 0])*g); d = np.fft.ifft(np.fft.fft(z)*2j*np.pi*f); dd = np.fft.ifft(np.fft.fft(d)*2j*np.pi*f)
    speed = np.abs(d) + 1e-9
    return z, np.imag(np.conj(d)*dd)/speed**3

def maxima(mask, least):
    out = []; points = []
    for line in contours(mask):
        z, k = smooth_curvature(line); points.append(z)   # ink lies on the same side of counters too
        top = (k > least) & (k >= np.roll(k, 1)) & (k > np.roll(k, -1))
        out += [(z[i], k[i]) for i in np.where(top)[0]]
    return out, np.concatenate(points) if points else np.zeros(0, complex)

def knuckles(painted, model):
    mine, edge = maxima(painted, 1/25); theirs, ideal = maxima(model, .5/25)
    n = sum(1 for z, k in mine if not any(abs(z-w) < 30 and q > .5*k for w, q in theirs))
    step = max(1, len(edge)//1500); far = [np.abs(ideal - z).min() for z in edge[::step]]
    far = np.array(far); return n, float(np.percentile(far, 95)), float((far < 8).mean()), float((far < 14).mean())

if __name__ == '__main__':
    a = argparse.ArgumentParser(); a.add_argument('data'); a.add_argument('characters'); a.add_argument('--tuft', default='tuft'); a.add_argument('--drawn', default='')
    a.add_argument('--write', default=''); a.add_argument('--keep', default=''); a.add_argument('--n', type=int, default=0); a.add_argument('--sample', type=int, default=0); a.add_argument('--sheet', default='models/sheet.ply')
    o = a.parse_args(); folder = o.keep or tempfile.mkdtemp(); os.makedirs(folder, exist_ok=True)
    text = [c for c in open(o.characters).read() if ord(c) > 0x2000]; rows = []
    if o.sample: text = random.Random(o.sample).sample(text[60:], o.sample)
    text = text[:o.n or None]
    os.environ['XDG_CACHE_HOME'] = tempfile.mkdtemp()   # nothing is in the cache
    for c in text:
        character = json.load(open(os.path.join(o.data, c + '.json'))); n = len(character['strokes']); out = os.path.join(folder, c)
        before = resource.getrusage(resource.RUSAGE_CHILDREN); cpu = 0
        for command in () if o.drawn else ([o.tuft, 'write', o.sheet, '--text', c, '--glyphs', o.data, '--size', str(SIDE), '--place', '0,0,0', '--atlas-size', str(TEXELS),
                         '--project', out + '.tuft', '--quiet'] + o.write.split(), [o.tuft, 'export', out + '.tuft', '-o', out + '-base-colour.png', '--map', 'base-colour', '--quiet']):
            ran = subprocess.run(command, capture_output=True, text=True)
            if ran.returncode: sys.exit('%s: %s' % (c, ran.stderr.strip()))
            if command[1] == 'write':
                after = resource.getrusage(resource.RUSAGE_CHILDREN); cpu = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)/n
        T = truth(character)
        if o.drawn: R = np.asarray(Image.open(os.path.join(o.drawn, c + '.pgm'))) < INK; iou = (R & T).sum()/(R | T).sum()
        else: os.remove(out + '.tuft'); R, iou = best_match(T, np.asarray(Image.open(out + '-base-colour.png').convert('L')))
        k, far, near, about = knuckles(R, T) if R is not None else (0, 999, 0, 0)
        rows.append((iou, k/n, far, cpu, n, near, about))
        print('%s strokes %2d IoU %.3f knuckles %.2f beyond %.1f within %.3f %.3f cpu %.3f' % (c, n, iou, k/n, far, near, about, cpu), flush=True)
    r = np.array(rows); w = r[:, 4]/r[:, 4].sum()
    print('%d characters: IoU mean %.4f, worst %.3f; knuckles %.2f a stroke; outline within %.1f units at 95 %%, %.3f of it within 8 and %.3f within 14; cpu %.3f s a stroke' % (
        len(r), r[:, 0].mean(), r[:, 0].min(), (r[:, 1]*w).sum(), (r[:, 2]*w).sum(), (r[:, 5]*w).sum(), (r[:, 6]*w).sum(), (r[:, 3]*w).sum()))
    print('worst:', ', '.join('%s %.3f' % (text[i], r[i, 0]) for i in r[:, 0].argsort()[:10]))
