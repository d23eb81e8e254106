# SPDX-License-Identifier: Apache-2.0
"""True errors, by two references whose chances are independent.

With a picture L and references R1, R2 of independent noise and the same mean R, the mean over pixels of (L - R1)(L - R2)
is that of (L - R)^2: what noise the references have is in one factor or the other, never in both.
"""
import array
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import exr  # noqa: E402

WEIGHTS = (0.2126, 0.7152, 0.0722)  # Rec. 709


def picture(path, layer=None):
    """(luminance, layer) of every pixel, from an EXR file."""
    _, _, _, channels = exr.read(path)
    light = array.array("d", (sum(w * v for w, v in zip(WEIGHTS, rgb))
                              for rgb in zip(channels["R"], channels["G"], channels["B"])))
    return light, channels[layer] if layer else None


class Truth:
    """error and bias: relative to `mean`; doubt: standard error of the error's square."""

    def __init__(self, error, doubt, bias, mean):
        self.error, self.doubt, self.bias, self.mean = error, doubt, bias, mean


def compare(values, first, second, weights=None, over="mean"):
    """The error of values, where first and second are two references of the same; weights sum to any number. over: what the
    error is relative to, their "mean" or "root mean square"."""
    if weights is None:
        weights = [1.0] * len(values)
    whole = sum(weights)
    if whole <= 0:
        return Truth(0.0, 0.0, 0.0, 0.0)
    rows = list(zip(values, first, second, weights))
    if over == "mean":
        mean = sum(w * (a + b) / 2 for _, a, b, w in rows) / whole
    else:
        mean = math.sqrt(max(0.0, sum(w * a * b for _, a, b, w in rows) / whole))
    if mean <= 0:
        return Truth(0.0, 0.0, 0.0, 0.0)
    products = [(v - a) * (v - b) / mean**2 for v, a, b, _ in rows]
    square = sum(p * row[3] for p, row in zip(products, rows)) / whole
    spread = sum(row[3]**2 * (p - square)**2 for p, row in zip(products, rows)) / whole**2
    bias = sum(w * (v - (a + b) / 2) for v, a, b, w in rows) / whole / mean
    return Truth(math.sqrt(max(0.0, square)), math.sqrt(spread), bias, mean)


class Solution:
    """A stored solution that can be asked for the radiosity at a point."""

    def __init__(self, path):
        import h5py
        import numpy as np
        self.np = np
        with h5py.File(path) as file:
            self.corners = file["corners"][:].astype(float)
            self.area = file["area"][:]
            self.light = file["radiosity"][:].astype(float).sum(axis=1) @ np.array(WEIGHTS)
            facets = file["facets"]
            self.leaves = facets["leaves"][:].astype(np.int64)
            self.first = [facets["first_front"][:].astype(np.int64), facets["first_back"][:].astype(np.int64)]

    def sides(self):
        """The facet's sides, as (facet, front or back, first patch, patches)."""
        for facet, count in enumerate(self.leaves):
            for side in (0, 1):
                if self.first[side][facet] != 2**32 - 1:
                    yield facet, side, int(self.first[side][facet]), int(count)

    def points(self, number, seed):
        """Random points, evenly over all surface: (facet, side) to an array of points."""
        np = self.np
        chance = np.random.Generator(np.random.PCG64(seed))
        steps = (np.arange(number) + chance.random(number)) / number  # one in each equal share of the surface
        whole = np.cumsum(self.area)
        patch = np.minimum(np.searchsorted(whole, steps * whole[-1]), len(whole) - 1)
        found = {}
        for facet, side, first, count in self.sides():
            mine = patch[(patch >= first) & (patch < first + count)]
            if len(mine):
                s, t = chance.random((2, len(mine), 1))
                a, b, c, d = self.corners[mine].transpose(1, 0, 2)
                # A quadrilateral's halves in proportion to their areas; of a triangle one is empty.
                left = np.linalg.norm(np.cross(b - a, c - a), axis=1, keepdims=True)
                right = np.linalg.norm(np.cross(c - a, d - a), axis=1, keepdims=True)
                other = chance.random((len(mine), 1)) * (left + right) > left
                s, corner = np.sqrt(s), np.where(other, d, b)
                found[facet, side] = (1 - s) * a + s * (1 - t) * corner + s * t * c
        return found

    def at(self, points):
        """Radiosity (luminance) at points(); NaN where a point lies on no patch, by rounding."""
        np = self.np
        found = []
        for (facet, side), places in points.items():
            first, count = int(self.first[side][facet]), int(self.leaves[facet])
            corners = self.corners[first:first + count]
            normal = np.cross(corners[0][1] - corners[0][0], corners[0][2] - corners[0][0])
            normal += np.cross(corners[0][2] - corners[0][0], corners[0][3] - corners[0][0])
            kept = [k for k in range(3) if k != np.argmax(np.abs(normal))]
            flat, spots = corners[:, :, kept], places[:, kept]
            low, high = flat.min(axis=1), flat.max(axis=1)
            value = np.full(len(spots), np.nan)
            for k, spot in enumerate(spots):
                near = np.flatnonzero(np.all((low <= spot) & (spot <= high), axis=1))
                if len(near) > 1:
                    near = near[inside(np, flat[near], spot)]
                if len(near):
                    value[k] = self.light[first + near[0]]
            found.append(value)
        return np.concatenate(found)


def inside(np, quads, spot):
    """Which of the convex quadrilaterals (n x 4 x 2) hold the spot."""
    along = np.roll(quads, -1, axis=1) - quads
    to = spot - quads
    turn = along[:, :, 0] * to[:, :, 1] - along[:, :, 1] * to[:, :, 0]
    return np.all(turn >= -1e-12, axis=1) | np.all(turn <= 1e-12, axis=1)


def compare_solutions(path, first, second, points=20000):
    """The error of the radiosity as a function of position: root mean square over all surface, over the root mean square."""
    solutions = [Solution(p) for p in (path, first, second)]
    where = solutions[1].points(points, 7)
    values = [s.at(where) for s in solutions]
    np = solutions[0].np
    good = ~np.isnan(values[0]) & ~np.isnan(values[1]) & ~np.isnan(values[2])
    return compare(*[v[good].tolist() for v in values], over="root mean square")
