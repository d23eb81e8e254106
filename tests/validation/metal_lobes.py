#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Phong lobes of glTF metals: the table of scenes/reflect/ggx_lobes.cpp, and errors of albedos.

usage: metal_lobes.py

For each roughness r, with a = r^2 and facets that reflect all light: a diffuse part d, a peak p and
an exponent n with three conditions. Uniform light over the hemisphere is reflected as by GGX (glTF
2.0, B.3, single scattering),
  d + p M(n) = G,
with M of the symmetric lobe, cos^n alpha / max(cos in, cos out). The peak along the normal is that
of GGX, d + p = 1 / (4 a^2). The tail is that of GGX: light along the normal, seen 60 degrees off
it.

Rough metals are brighter off the normal than along it, which no lobe about the mirror direction can
represent: if the tail is above the peak, p is 0 and d = G. No light is created: for light along the
normal, d + 2 p / (n + 2) <= 1.
"""
import math

STEPS = [0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9,
         0.95, 1.0]
ANGLES = (0, 20, 40, 60, 70, 80)
LEAST = 4.0  # exponent; wider lobes have a visible edge at the horizon


def midpoints(count):
    return [(k + 0.5) / count for k in range(count)]


def ggx_albedo(a, angle):
    """Integral of f cos over the directions out, by the facet normals h: D G1 G1 (i h) / cos_i dh.
    """
    ci, si = math.cos(angle), math.sin(angle)
    a2 = a * a

    def g1(c):
        return 2 * c / (c + math.sqrt(a2 + (1 - a2) * c * c))
    total = 0.0
    turns = [math.cos(math.pi * x) for x in midpoints(48)]
    for x in midpoints(160):
        u = x * math.pi / 2
        t = a * math.tan(u)
        ch = 1 / math.sqrt(1 + t * t)
        sh = t * ch
        step = a / math.cos(u) ** 2 / (1 + t * t) * math.pi / 2 / 160
        d = a2 / (math.pi * (ch * ch * (a2 - 1) + 1) ** 2)
        part = 0.0
        for turn in turns:
            ih = si * sh * turn + ci * ch
            co = 2 * ih * ch - ci
            if ih > 0 and co > 0:
                part += g1(co) * ih
        total += part / len(turns) * 2 * math.pi * d * g1(ci) / ci * sh * step
    return total


def lobe_albedo(n, angle):
    """The same for cos^n alpha / max(cos in, cos out) / pi."""
    ci, si = math.cos(angle), math.sin(angle)
    turns = [math.cos(math.pi * x) for x in midpoints(32)]
    total = 0.0
    for x in midpoints(64):
        ca = x ** (1 / (n + 1))
        sa = math.sqrt(1 - ca * ca)
        for turn in turns:
            co = ca * ci - sa * si * turn
            if co > 0:
                total += co / max(ci, co)
    return 2 / (n + 1) * total / (64 * len(turns))


def even_light(albedo):
    """Mean over light from the whole hemisphere."""
    return sum(albedo(math.acos(math.sqrt(1 - x))) for x in midpoints(16)) / 16


def ggx_tail(a):
    """pi f of light along the normal, seen 60 degrees off it."""
    a2 = a * a
    bulge = math.cos(math.radians(30)) ** 2 * (a2 - 1) + 1
    return a2 / bulge ** 2 / (2 * (0.5 + math.sqrt(a2 + (1 - a2) * 0.25)))


def lobe(r):
    """(d, p, n)."""
    a = r * r
    whole = even_light(lambda angle: ggx_albedo(a, angle))
    peak, tail = 1 / (4 * a * a), ggx_tail(a)
    if tail >= peak:
        return whole, 0.0, LEAST

    def parts(n):
        p = (peak - tail) / (1 - 0.5 ** n)
        return peak - p, p
    low, high = math.log(LEAST), math.log(1e6)
    for _ in range(30):
        n = math.exp(0.5 * (low + high))
        d, p = parts(n)
        too_much = d + p * even_light(lambda angle: lobe_albedo(n, angle)) > whole or d + 2 * p / (n + 2) > 1
        low, high = (math.log(n), high) if too_much else (low, math.log(n))
    d, p = parts(n)
    # If the least exponent gives too much or too little light, the diffuse part is adjusted.
    if n < LEAST * 1.001:
        d = whole - p * even_light(lambda angle: lobe_albedo(n, angle))
    return d, p, n


def main():
    print("| roughness | d | p | n | " + " | ".join(f"{angle}°" for angle in ANGLES) + " |")
    for r in STEPS:
        d, p, n = lobe(r)
        ratios = []
        for angle in ANGLES:
            x = math.radians(angle)
            ratios.append((d + p * lobe_albedo(n, x)) / ggx_albedo(r * r, x))
        print(f"{{{r}, {d:.6g}, {p:.6g}, {n:.6g}}}, | " + " | ".join(f"{x:.3f}" for x in ratios), flush=True)


if __name__ == "__main__":
    main()
