# SPDX-License-Identifier: Apache-2.0
"""Figures of the comparison: error of a picture against a reference, seconds to an error."""
import math
import struct


def read_pfm(path):
    """(width, height, luminance): rows from the top, cd/m2."""
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    if kind != b"PF":
        raise ValueError(f"{path}: not a colour PFM file")
    width, height = map(int, size.split())
    order = "<" if float(scale) < 0 else ">"
    values = struct.unpack(f"{order}{3 * width * height}f", data)
    rows = [values[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    rows.reverse()  # a PFM starts at the bottom
    flat = [value for row in rows for value in row]
    return width, height, luminance(flat[0::3], flat[1::3], flat[2::3])


def luminance(red, green, blue):
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(red, green, blue)]


def widened(pixels, width, height):
    """The pixels and the eight neighbours of each."""
    return {(x + dx) + width * (y + dy)
            for p in pixels for x, y in [(p % width, p // width)]
            for dx in (-1, 0, 1) for dy in (-1, 0, 1)
            if 0 <= x + dx < width and 0 <= y + dy < height}


def error_of(values, reference, reference_noise, left_out=frozenset()):
    """(error, bias) over the pixels that are not excluded.

    error: sqrt(mean (L - R)^2) / mean R, minus the reference's noise in quadrature; this noise is
    given as the same ratio and is independent of the picture's. bias: mean L / mean R - 1.
    """
    kept = [(v, r) for k, (v, r) in enumerate(zip(values, reference)) if k not in left_out]
    mean = sum(r for _, r in kept) / len(kept)
    squares = sum((v - r) ** 2 for v, r in kept) / len(kept) / mean**2
    bias = sum(v for v, _ in kept) / len(kept) / mean - 1.0
    return math.sqrt(max(0.0, squares - reference_noise**2)), bias


def seconds_to(series, wanted):
    """(seconds, how) to reach the error `wanted`; series: [(seconds, error, bias)].

    how: "measured" between two settings, by a straight line in log-log. "at most" if the cheapest
    setting is already better. "extrapolated" beyond the best setting, with error as seconds^(-1/2),
    which holds for noise only. "never" (seconds infinite) if the best setting's bias is larger than
    the wanted error. Settings that cost more without a smaller error are ignored.
    """
    best = []
    for row in sorted(series):
        if not best or row[1] < best[-1][1]:
            best.append(row)
    if best[0][1] <= wanted:
        return best[0][0], "at most"
    for (t0, e0, _), (t1, e1, _) in zip(best, best[1:]):
        if e1 <= wanted:
            share = math.log(e0 / wanted) / math.log(e0 / max(e1, 1e-9))
            return t0 * (t1 / t0) ** share, "measured"
    seconds, error, bias = best[-1]
    if abs(bias) > wanted:
        return math.inf, "never"
    return seconds * (error / wanted) ** 2, "extrapolated"
