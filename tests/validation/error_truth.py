# SPDX-License-Identifier: Apache-2.0
"""True errors by two references with independent noise.

For a picture L and references R1, R2 of independent noise and the same mean R, the mean over pixels
of (L - R1)(L - R2) is the mean of (L - R)^2: the noise of a reference is in one factor only.
"""
import array
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import exr  # noqa: E402

WEIGHTS = (0.2126, 0.7152, 0.0722)  # Rec. 709


def picture(path, layer=None):
    """(luminance, layer) of every pixel of an EXR file."""
    _, _, _, channels = exr.read(path)
    light = array.array("d", (sum(w * v for w, v in zip(WEIGHTS, rgb))
                              for rgb in zip(channels["R"], channels["G"], channels["B"])))
    return light, channels[layer] if layer else None


def columns(path):
    return exr.read(path)[1]


class Truth:
    """error and bias: relative to `mean`. squared_error_std: standard error of the squared error, with the
    pixels as a sample of many. of_references: the part of this that is caused by the references'
    noise, the uncertainty for exactly these pixels."""

    def __init__(self, error, squared_error_std, of_references, bias, mean):
        self.error, self.squared_error_std, self.of_references, self.bias, self.mean = error, squared_error_std, of_references, bias, mean


BRIGHT = 4.0  # times the mean, for error_weight (raytrace/frame/frame.h)


def compare(values, first, second, counts=None, more=()):
    """Error of values against two or more references, over the values that count, relative to their
    mean. The program's weights apply: a value L brighter than 4 times the mean has w = 4 mean / L
    in both factors. L is the mean of the references, so that the tested values do not affect it. Of
    more than two references, the mean over all pairs: of k differences d,
    ((sum d)^2 - sum d^2) / (k (k - 1)). Errors common to neighbouring pixels of the references
    (patches) make of_references too small."""
    if counts is None:
        counts = [1.0] * len(values)
    k = 2 + len(more)
    rows = [(v, sum(all_of) / k, all_of) for v, c, *all_of in zip(values, counts, first, second, *more) if c]
    mean = sum(middle for _, middle, _ in rows) / len(rows) if rows else 0.0
    if mean <= 0:
        return Truth(0.0, 0.0, 0.0, 0.0, 0.0)
    factors = [(weight(middle, mean) / mean)**2 for _, middle, _ in rows]
    variances = [max(0.0, sum((v - one)**2 for one in all_of) - k * (v - middle)**2) / (k - 1) for v, middle, all_of in rows]
    products = [w * ((v - middle)**2 - variance / k) for w, variance, (v, middle, _) in zip(factors, variances, rows)]
    noise = sum(w**2 * variance_of_product([v - one for one in all_of]) for w, (v, _, all_of) in zip(factors, rows))
    # A single outlier gives zero variance. The minimum is the value of normal noise s,
    # 2 s^4 / (k (k - 1)); the mean of its estimate s^4 is 1 + 2 / (k - 1) times too large.
    noise = max(noise, sum(w**2 * variance**2 for w, variance in zip(factors, variances)) * 2 / (k * (k + 1)))
    square = sum(products) / len(rows)
    spread = sum((p - square)**2 for p in products) / len(rows)**2
    bias = sum(v - middle for v, middle, _ in rows) / len(rows) / mean
    return Truth(math.sqrt(max(0.0, square)), math.sqrt(spread), math.sqrt(max(0.0, noise)) / len(rows), bias, mean)


def variance_of_product(differences):
    """Unbiased variance of U, the mean product of two: U^2 minus the mean product of four, which is
    d^4 on average, by power sums. With fewer than four, which have no such product, 2 m^2 s^2, m
    their mean and s^2 their variance: for normal noise d^2 s^2 more than the value of a pair, so
    that it is rarely too small."""
    k = len(differences)
    p1, p2, p3, p4 = (sum(d**n for d in differences) for n in (1, 2, 3, 4))
    if k < 4:
        return 2 * (p1 / k)**2 * max(0.0, p2 - p1**2 / k) / (k - 1)
    product = (p1**2 - p2) / (k * (k - 1))
    return product**2 - (p1**4 - 6 * p1**2 * p2 + 3 * p2**2 + 8 * p1 * p3 - 6 * p4) / (k * (k - 1) * (k - 2) * (k - 3))


def weight(luminance, mean):
    return BRIGHT * mean / luminance if luminance > BRIGHT * mean else 1.0


def radiosities(reader, scene, solutions, points=16384):
    """Radiosity of each solution (arguments of tests/validation/surfaces.cpp) at the same points,
    uniform in area."""
    words = [word for one in solutions for word in ["--", *one]][1:]
    run = subprocess.run([reader, scene, str(points), *map(str, words)], capture_output=True, text=True)
    if run.returncode != 0:
        raise RuntimeError(run.stderr.strip())
    return list(zip(*(map(float, line.split()) for line in run.stdout.splitlines())))
