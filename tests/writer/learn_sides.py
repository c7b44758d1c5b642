#!/usr/bin/env python3
"""Learns the table of sides (models/writer/sides.txt) from rows of `measure_writer sides`.

usage: learn_sides.py ROWS OUT [--least 150]
One model a class of strokes with at least so many rows, and one a segment for all others: a perceptron with one hidden
layer and a linear by-pass onto the principal components of the sides. Deterministic. Needs numpy; minutes on a core."""
import argparse, collections
import numpy as np

PER_STROKE, PER_SEGMENT, KNOTS = 28, 6, 16   # as in src/writer/gesture/side_features.cpp and sides.h
RANK, CLIP, SAMPLES, DECAY = 12, 4.0, 1500000, 3e-5

a = argparse.ArgumentParser(); a.add_argument('rows'); a.add_argument('out'); a.add_argument('--least', type=int, default=150)
a.add_argument('--samples', type=int, default=SAMPLES)
o = a.parse_args()
classes, parts = collections.defaultdict(list), collections.defaultdict(list)
for line in open(o.rows):
    left, right = line.split('|'); w = left.split(); name, n = w[1], len(w[1])
    f, y = np.array(w[2:], float), np.array(right.split(), float)
    classes[name].append((f, y))
    for i, code in enumerate(name):
        own = np.concatenate([f[:PER_STROKE], f[PER_STROKE + PER_SEGMENT*i:PER_STROKE + PER_SEGMENT*(i+1)]])
        parts[('' if i == 0 else '-') + code + ('' if i == n-1 else '-')].append(
            (own, np.concatenate([y[2*KNOTS*i:2*KNOTS*(i+1)], y[2*KNOTS*n:]])))
rng = np.random.RandomState(1)

def train(rows):
    F, Y = np.array([r[0] for r in rows]), np.array([r[1] for r in rows])
    mean_x, scale_x, mean_y = F.mean(0), F.std(0) + 1e-3, Y.mean(0)
    A = np.clip((F - mean_x)/scale_x, -CLIP, CLIP); A -= 0
    _, S, V = np.linalg.svd(Y - mean_y, full_matrices=False)
    r = min(RANK, len(S)); B = V[:r].T*(S[0]/np.sqrt(len(Y))); T = (Y - mean_y)@V[:r].T/(S[0]/np.sqrt(len(Y)))
    n, H = A.shape[1], int(np.clip(len(Y)/60, 6, 48))
    P = [rng.randn(n, H)/np.sqrt(n), np.zeros(H), rng.randn(H, r)*.1/np.sqrt(H), np.zeros(r), np.zeros((n, r))]
    m, v = [np.zeros_like(p) for p in P], [np.zeros_like(p) for p in P]
    t, epochs = 0, max(10, min(400, int(o.samples/len(Y)))); index = np.arange(len(Y)); decay = DECAY*max(1, 3000/len(Y))
    for e in range(epochs):
        rng.shuffle(index); rate = .005*(1 - e/epochs)**1.2 + 1e-5
        for k in range(0, len(index), 128):
            i = index[k:k+128]; x = A[i]; h = np.tanh(x@P[0] + P[1]); g = (h@P[2] + x@P[4] + P[3] - T[i])/len(i)
            back = (g@P[2].T)*(1 - h*h); G = [x.T@back, back.sum(0), h.T@g, g.sum(0), x.T@g]; t += 1
            for q in range(5):
                if q % 2 == 0: G[q] = G[q] + decay*P[q]
                m[q] = .9*m[q] + .1*G[q]; v[q] = .999*v[q] + .001*G[q]**2
                P[q] = P[q] - rate*(m[q]/(1 - .9**t))/(np.sqrt(v[q]/(1 - .999**t)) + 1e-8)
    h = np.tanh(A@P[0] + P[1]); O = mean_y + (h@P[2] + A@P[4] + P[3])@B.T
    return (mean_x, scale_x, mean_y, B, P, H, r), np.abs(Y - mean_y).mean(), np.abs(Y - O).mean()

def row(v): return ' '.join('%d' % round(x*1000) for x in np.ravel(v)) + '\n'
with open(o.out, 'w') as out:
    out.write('# Sides of strokes by class: see src/writer/README.md. Whole numbers are thousandths.\n')
    keys = [(c, d) for c, d in sorted(classes.items(), key=lambda t: (-len(t[1]), t[0])) if len(d) >= o.least]
    names = {c for c, _ in keys}
    for code in 'HTULPSN':
        for k in (code, '-' + code, code + '-', '-' + code + '-'):
            if k in names: continue
            d = parts.get(k, [])
            if len(d) < 60: d = d + [x for kk in sorted(parts) if code in kk for x in parts[kk]][:3000]
            keys.append((k, d))
    for key, d in keys:
        if len(d) > 30000: d = d[::len(d)//20000]
        (mx, sx, my, B, P, H, r), before, after = train(d)
        print('%-8s rows %6d  mean error %.2f of %.2f units, hidden %d' % (key, len(d), after, before, H), flush=True)
        out.write('%s %d %d %d %d\n' % (key, len(mx), len(my), H, r))
        for v in (mx, sx, my, B.T, P[0].T, P[1], P[2].T, P[3], P[4].T): out.write(row(v))
