# SPDX-License-Identifier: Apache-2.0
"""The payloads: EURECA, TSS on its pallet, an experiment bridge. Tags as in orbiter.py.

No bay station of a payload was found; the order and the stations below are estimates that keep the bay lamps free:
EURECA forward, TSS amidships, the bridge aft.
"""
import math

import fittings
from mesh_kit import (Body, add, area_vector, beam, box, centroid, cylinder, dot, mul, prism, solid, station, sub,
                      turned, unit)

EURECA_X = 6.85   # centre, m, estimate
TSS_X = 11.95     # estimate
BRIDGE_X = 16.5   # estimate
TRUNNION_RADIUS = 0.0413  # 3.25 in longeron trunnion [B]
LATCH_Y, LATCH_Z = station(0.0, 94.0, fittings.LATCH_HEIGHT)[1:]
BOOM_LENGTH = 12.0        # m, TSS deployer boom [B]


def trunnion_places(centre, reach):
    """Four places: forward and aft of a payload's centre, starboard and port; (x, side)."""
    return [(centre + s * reach, side) for s in (1, -1) for side in (1, -1)]


def trunnions(group, prefix, stations_x, from_y):
    """Longeron trunnions with their scuff plates; (x, side)."""
    bodies = []
    for x, side in stations_x:
        y0, y1 = side * from_y, side * (LATCH_Y + 0.1)
        bodies.append(solid(f"{prefix} trunnion {x} {side}", group, "trunnion",
                            cylinder((x, y0, LATCH_Z), (x, y1, LATCH_Z), TRUNNION_RADIUS, 10)))
        bodies.append(solid(f"{prefix} trunnion shield {x} {side}", group, "yellow-paint",
                            cylinder((x, side * (from_y - 0.02), LATCH_Z), (x, side * (from_y + 0.05), LATCH_Z),
                                     0.13, 10)))
    return bodies


def keel_trunnion(group, prefix, x, from_z):
    tip = station(0.0, 0.0, fittings.KEEL_LATCH)[2] + 0.04
    return [solid(f"{prefix} keel trunnion", group, "trunnion", cylinder((x, 0.0, from_z), (x, 0.0, tip), 0.038, 10))]


# ---- EURECA -----------------------------------------------------------------------------------------------------
# 2.3 m along the bay x 4.2 m across (4.6 over trunnions) x 2.6 m deep, step on the top deck [S, from photographs]
EURECA_SECTION = ((-1.0, -2.03), (1.0, -2.03), (2.1, -0.85), (2.1, 0.22), (-2.1, 0.22), (-2.1, -0.85))
EURECA_DECK = 0.58  # top of the upper deck, 2.6 m above the bottom
EURECA_HALF = 1.15


def eureca():
    bodies = eureca_structure() + eureca_top() + eureca_arrays() + grapple_fixture()
    bodies += trunnions("EurecaTrunnions", "eureca", trunnion_places(EURECA_X, 0.75), 2.08)
    bodies += keel_trunnion("EurecaTrunnions", "eureca", EURECA_X, -2.0)
    return bodies


def eureca_structure():
    """Lower body: a prism cut into blanket panels, two Freon radiators on its shoulders."""
    x0, x1 = EURECA_X - EURECA_HALF, EURECA_X + EURECA_HALF
    shoulders = (0.0, 1.18, -1.1), (0.0, -1.18, -1.1)  # ways the two slanting faces look, roughly

    def material(_, points):
        way = unit(area_vector(points))
        if abs(way[0]) > 0.5:
            return "kapton"
        middle = abs(centroid(points)[0] - EURECA_X) < 0.8
        return "white-paint" if middle and any(dot(way, unit(s)) > 0.99 for s in shoulders) else "eureca-blanket"

    return [solid("eureca body", "Eureca", material, prism(EURECA_SECTION, x0, x1, 5))]


def eureca_top():
    """Upper deck with its step and bevel, instrument boxes, antennas."""
    x0, x1 = EURECA_X - EURECA_HALF + 0.06, EURECA_X + EURECA_HALF - 0.06
    top = EURECA_DECK
    deck = ((-1.5, 0.17), (1.75, 0.17), (1.75, top - 0.18), (1.5, top), (-1.5, top))
    bodies = [solid("eureca deck", "Eureca", "eureca-blanket", prism(deck, x0, x1, 5)),
              solid("eureca side deck", "EurecaDeck", "eureca-blanket",
                    box((EURECA_X - 1.0, -2.05, 0.19), (EURECA_X + 1.0, -1.55, 0.32), (3, 1, 1)))]

    def item(what, material, x, y, height, cuts=(1, 1, 1)):
        lo, hi = (EURECA_X + x[0], y[0], top - 0.02), (EURECA_X + x[1], y[1], top + height)
        bodies.append(solid(f"eureca {what}", "EurecaDeck", material, box(lo, hi, cuts)))

    item("furnace", "white-paint", (-0.95, -0.3), (0.55, 1.35), 0.22, (2, 2, 1))
    item("furnace lid", "aluminium", (-0.85, -0.4), (0.7, 1.2), 0.26)
    item("solar instruments", "black-paint", (0.35, 0.95), (0.85, 1.4), 0.30)
    item("sun port", "lens-glass", (0.45, 0.62), (0.98, 1.25), 0.32)
    item("radiator", "osr", (-0.95, -0.1), (-1.35, -0.2), 0.03, (2, 3, 1))
    item("x-ray telescope", "kapton", (0.15, 0.98), (0.1, 0.75), 0.35, (2, 2, 1))
    item("dust collector", "gold-foil", (0.2, 0.9), (-0.55, -0.05), 0.10)
    item("exposure tray", "z93", (0.2, 0.95), (-1.4, -0.7), 0.06, (2, 2, 1))
    item("electronics", "black-paint", (-0.7, -0.25), (-0.08, 0.42), 0.12)
    for k, (dx, y) in enumerate(((0.0, -1.42), (0.05, 1.44))):
        low = (EURECA_X + dx, y, top - 0.04)
        bodies.append(solid(f"eureca antenna {k}", "EurecaDeck", "white-paint",
                            cylinder(low, add(low, (0, 0, 0.42)), 0.05, 8)))
    for k, (dx, dy) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
        low = (EURECA_X + dx * 1.06, dy * 1.85, 0.12)
        bodies.append(solid(f"eureca thruster {k}", "EurecaDeck", "aluminium",
                            turned(low, (0, 0, 1), ((0.0, 0.06), (0.2, 0.06), (0.3, 0.1)), 8)))
    for dx, side in trunnion_places(EURECA_X, 0.75):
        y = sorted((side * 1.88, side * 2.09))
        bodies.append(solid(f"eureca trunnion post {dx} {side}", "EurecaDeck", "aluminium",
                            box((dx - 0.1, y[0], 0.16), (dx + 0.1, y[1], 0.48))))
    return bodies


def slab_of_panels(x0, x1):
    """A stack of five panels as one box, its edges cut per panel."""
    return box((x0, -1.7, -1.23), (x1, 1.7, 0.17), (5, 2, 1))


def eureca_arrays():
    """Two wings of five 1.4 x 3.4 m panels, folded on the forward and aft faces, cells outward [S]."""
    bodies = []
    for sign in (1, -1):
        x = sorted((EURECA_X + sign * (EURECA_HALF + 0.03), EURECA_X + sign * (EURECA_HALF + 0.27)))
        cells = EURECA_X + sign * (EURECA_HALF + 0.27)

        def material(_, points, cells=cells):
            if all(abs(p[0] - cells) < 1e-9 for p in points):
                return "solar-cell"
            flat = max(p[0] for p in points) - min(p[0] for p in points) < 1e-9
            layer = round((min(p[0] for p in points) - x[0]) / 0.048)
            return "kapton" if flat or layer % 2 else "aluminium"  # backs and the edges of the stack

        stack = slab_of_panels(x[0], x[1])
        bodies.append(solid(f"eureca array {sign}", "EurecaArrays", material, stack))
        for y in (-1.2, 0.0, 1.2):  # hold-downs
            x = sorted((EURECA_X + sign * (EURECA_HALF - 0.05), EURECA_X + sign * (EURECA_HALF + 0.31)))
            bodies.append(solid(f"eureca hold-down {sign} {y}", "EurecaArrays", "aluminium",
                                box((x[0], y - 0.05, 0.08), (x[1], y + 0.05, 0.21))))
    return bodies


def grapple_fixture():
    """Flight-releasable grapple fixture on the upper deck: plate, cone, pin and sight target. Sizes [B]."""
    seat = (EURECA_X - 0.05, -1.72, 0.3)
    up = (0.0, 0.0, 1.0)
    bodies = [
        solid("grapple plate", "GrappleFixture", "black-paint", cylinder(seat, add(seat, (0, 0, 0.06)), 0.28, 14)),
        solid("grapple pin", "GrappleFixture", "aluminium",
              turned(add(seat, (0, 0, 0.05)), up, ((0, 0.1), (0.03, 0.1), (0.1, 0.02), (0.36, 0.02), (0.38, 0.035),
                                                   (0.4, 0.035)), 8)),
        solid("grapple target", "GrappleFixture", "white-paint",
              cylinder(add(seat, (0.2, 0, 0.055)), add(seat, (0.2, 0, 0.07)), 0.06, 10))]
    for k in range(3):
        t = 2 * math.pi * k / 3
        arm = (0.2 * math.cos(t), 0.2 * math.sin(t), 0.08)
        bodies.append(solid(f"grapple cam {k}", "GrappleFixture", "white-paint",
                            beam(add(seat, (arm[0] / 2, arm[1] / 2, 0.075)), add(seat, arm), 0.04)))
    return bodies


# ---- TSS ---------------------------------------------------------------------------------------------------------
# Spacelab pallet 2.9 m long, U of 4.35 m [B]; (y, z) of its outer and inner faces: estimates inside the envelope
PALLET_OUTER = ((2.175, 0.30), (2.175, -0.55), (1.88, -1.22), (1.10, -1.97))
PALLET_INNER = ((2.02, 0.30), (2.02, -0.50), (1.75, -1.12), (1.02, -1.82))
PALLET_HALF = 1.45
SATELLITE_RADIUS = 0.8   # 1.6 m sphere [S]
RING_TOP = 0.06          # m, top of the deployer's ring, estimate
STOWED_Z = RING_TOP + 0.08 + SATELLITE_RADIUS


def pallet():
    outer = [(y, z) for y, z in PALLET_OUTER] + [(-y, z) for y, z in reversed(PALLET_OUTER)]
    inner = [(y, z) for y, z in PALLET_INNER] + [(-y, z) for y, z in reversed(PALLET_INNER)]
    body = Body("pallet")
    xs = [TSS_X - PALLET_HALF + 2 * PALLET_HALF * k / 4 for k in range(5)]
    for a, b in zip(xs, xs[1:]):
        for i in range(len(outer) - 1):
            (ya, za), (yb, zb) = inner[i], inner[i + 1]
            hub = (0.0, -(ya + yb) / 2, 0.5 - (za + zb) / 2)
            body.face("Pallet", "pallet-paint", [(a, ya, za), (b, ya, za), (b, yb, zb), (a, yb, zb)], hub)
            (ya, za), (yb, zb) = outer[i], outer[i + 1]
            hub = (0.0, (ya + yb) / 2, (za + zb) / 2 - 0.5)
            body.face("Pallet", "pallet-blanket", [(a, ya, za), (b, ya, za), (b, yb, zb), (a, yb, zb)], hub)
        for end in (0, -1):
            body.face("Pallet", "aluminium", [(a, *outer[end]), (b, *outer[end]), (b, *inner[end]), (a, *inner[end])],
                      (0, 0, 1))
    for x, out in ((xs[0], (-1, 0, 0)), (xs[-1], (1, 0, 0))):
        for i in range(len(outer) - 1):
            quad = [(x, *outer[i]), (x, *outer[i + 1]), (x, *inner[i + 1]), (x, *inner[i])]
            body.face("Pallet", "pallet-paint", quad, out)
    bodies = [body]
    for x in (TSS_X - 0.75, TSS_X + 0.75):  # frames that stiffen the U
        bodies.append(solid(f"pallet floor beam {x}", "Pallet", "pallet-paint",
                            box((x - 0.06, -1.0, -1.85), (x + 0.06, 1.0, -1.7), (1, 4, 1))))
    ends = trunnion_places(TSS_X, 1.05)
    for x, side in ends:
        y = sorted((side * 1.9, side * 2.16))
        bodies.append(solid(f"pallet bracket {x} {side}", "Pallet", "pallet-paint",
                            box((x - 0.14, y[0], 0.2), (x + 0.14, y[1], 0.47))))
    bodies += trunnions("TssTrunnions", "tss", ends, 2.14)
    bodies += keel_trunnion("TssTrunnions", "tss", TSS_X, -1.9)
    return bodies


def deployer():
    """Boom canister, reel, support structure and boxes, all in multilayer insulation [B]; shapes are estimates."""
    bodies = []
    up = (0.0, 0.0, 1.0)
    low = (TSS_X, 0.0, -1.78)

    def item(what, material, faces):
        bodies.append(solid(f"deployer {what}", "Deployer", material, faces))

    item("canister", "mli-silver", cylinder(low, (TSS_X, 0.0, -0.28), 0.34, 16, cuts=4))
    item("cradle", "mli-white", turned((TSS_X, 0.0, -0.34), up, ((0.0, 0.36), (0.1, 0.52), (0.3, 0.52)), 16))
    item("ring", "copper", cylinder((TSS_X, 0.0, -0.05), (TSS_X, 0.0, RING_TOP), 0.44, 16))
    for k in range(6):  # struts from the pallet floor to the cradle
        t = 2 * math.pi * (k + 0.5) / 6
        foot = (TSS_X + 1.15 * math.cos(t), 1.15 * math.sin(t), -1.6)
        head = (TSS_X + 0.46 * math.cos(t), 0.46 * math.sin(t), -0.15)
        item(f"strut {k}", "aluminium", cylinder(foot, head, 0.04, 6))
    item("reel", "mli-white", cylinder((TSS_X - 1.0, 0.75, -1.2), (TSS_X - 1.0, 1.5, -1.2), 0.42, 16))
    item("reel motor", "kapton", box((TSS_X - 1.2, 0.55, -1.35), (TSS_X - 0.8, 0.76, -1.0)))
    item("reel base", "mli-white", box((TSS_X - 1.35, 0.7, -1.8), (TSS_X - 0.65, 1.1, -1.45), (2, 1, 1)))
    item("data box", "white-paint", box((TSS_X - 1.3, -1.5, -1.5), (TSS_X - 0.6, -0.65, -0.95), (2, 2, 2)))
    item("data box base", "mli-white", box((TSS_X - 1.25, -1.2, -1.8), (TSS_X - 0.65, -0.75, -1.45)))
    item("power box", "mli-silver", box((TSS_X + 0.65, -1.5, -1.4), (TSS_X + 1.35, -0.75, -0.9), (2, 2, 1)))
    item("power box base", "mli-white", box((TSS_X + 0.7, -1.3, -1.85), (TSS_X + 1.3, -0.8, -1.35)))
    item("motor box", "black-paint", box((TSS_X + 0.75, 0.8, -1.55), (TSS_X + 1.3, 1.4, -1.05), (1, 1, 1)))
    item("motor box base", "mli-white", box((TSS_X + 0.8, 0.85, -1.85), (TSS_X + 1.25, 1.3, -1.5)))
    for side in (1, -1):
        item(f"side panel {side}", "mli-white", box((TSS_X - 1.2, min(side * 1.9, side * 2.0), -0.4),
                                                     (TSS_X + 1.2, max(side * 1.9, side * 2.0), 0.1), (4, 1, 1)))
        item(f"cable tray {side}", "kapton", box((TSS_X - 1.3, min(side * 1.92, side * 2.03), -0.56),
                                                  (TSS_X + 1.3, max(side * 1.92, side * 2.03), -0.46), (4, 1, 1)))
    return bodies


def satellite(group, lift):
    """The 1.6 m sphere with dark seams between 8 gores, ring, antenna and folded instrument booms."""
    centre = (TSS_X, 0.0, STOWED_Z + lift)
    body = Body(f"{group} sphere")
    seam = math.radians(2.6)
    meridians = []  # (start, end, is a seam)
    for k in range(8):
        start = 2 * math.pi * k / 8 + math.pi / 16
        meridians.append((start - seam / 2, start + seam / 2, True))
        width = (2 * math.pi / 8 - seam) / 8
        meridians += [(start + seam / 2 + width * j, start + seam / 2 + width * (j + 1), False) for j in range(8)]
    belt = math.radians(1.5)
    parallels = [-90 + 5.625 * k for k in range(33)]
    bands = []
    for a, b in zip(parallels, parallels[1:]):
        lo = math.radians(a) + (belt if a == 0 else 0.0)
        hi = math.radians(b) - (belt if b == 0 else 0.0)
        bands.append((lo, hi, False))
        if b == 0:
            bands.append((-belt, belt, True))

    def point(lat, lon):
        if abs(abs(lat) - math.pi / 2) < 1e-9:
            return add(centre, (0.0, 0.0, math.copysign(SATELLITE_RADIUS, lat)))
        return add(centre, mul((math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)),
                               SATELLITE_RADIUS))

    for lo, hi, belt_seam in bands:
        for start, end, gore_seam in meridians:
            quad = [point(lo, start), point(lo, end % (2 * math.pi)), point(hi, end % (2 * math.pi)), point(hi, start)]
            quad = [p for k, p in enumerate(quad) if p != quad[k - 1]]
            body.face(group, "tss-seam" if belt_seam or gore_seam else "tss-paint", quad, sub(quad[0], centre))
    bodies = [body]

    def item(what, material, faces):
        bodies.append(solid(f"{group} {what}", group, material, faces))

    base = add(centre, (0.0, 0.0, -SATELLITE_RADIUS))
    item("interface ring", "copper", cylinder(add(base, (0, 0, -0.07)), add(base, (0, 0, 0.16)), 0.36, 16))
    top = add(centre, (0.0, 0.0, SATELLITE_RADIUS))
    item("antenna", "white-paint", cylinder(add(top, (0, 0, -0.03)), add(top, (0, 0, 0.22)), 0.04, 8))
    for side in (1, -1):  # two instrument booms, folded
        root = add(centre, (side * 0.77, 0.0, 0.1))
        item(f"boom housing {side}", "aluminium", beam(add(root, (0, -0.16, 0)), add(root, (0, 0.16, 0)), 0.1, 0.16))
        item(f"boom tip {side}", "black-paint",
             cylinder(add(root, (side * 0.02, 0, 0)), add(root, (side * 0.2, 0, 0)), 0.05, 8))
    return bodies


def boom(group):
    """Extended lattice: three longerons, battens and diagonals every metre. Width is an estimate."""
    bodies = []
    low, high = RING_TOP - 0.08, RING_TOP + BOOM_LENGTH - 0.16
    bays = 12
    radius = 0.2

    def corner(k, level):
        t = 2 * math.pi * k / 3
        return (TSS_X + radius * math.cos(t), radius * math.sin(t), low + (high - low) * level / bays)

    def bar(what, a, b, thick):
        bodies.append(solid(f"{group} {what}", group, "boom-composite", cylinder(a, b, thick, 4)))

    for k in range(3):
        for level in range(0, bays, 4):
            bar(f"longeron {k} {level}", corner(k, level), corner(k, level + 4), 0.018)
        for level in range(bays):
            bar(f"batten {k} {level}", corner(k, level), corner(k + 1, level), 0.012)
            bar(f"diagonal {k} {level}", corner(k, level), corner(k + 1, level + 1), 0.01)
    bodies.append(solid(f"{group} head", group, "copper",
                        cylinder((TSS_X, 0.0, high - 0.02), (TSS_X, 0.0, RING_TOP + BOOM_LENGTH), 0.44, 16)))
    return bodies


# ---- experiment bridge ---------------------------------------------------------------------------------------------
def bridge_truss():
    """Bridge across the bay (MPESS class): a truss with trays and boxes. All sizes are estimates."""
    bodies = []
    half, top, bottom, reach = 0.45, 0.12, -0.85, 2.05
    nodes = [-reach + 2 * reach * k / 6 for k in range(7)]

    def bar(what, a, b, width=0.09):
        bodies.append(solid(f"bridge {what}", "Bridge", "aluminium", beam(a, b, width)))

    for s in (1, -1):
        x = BRIDGE_X + s * half
        bar(f"top chord {s}", (x, -reach, top), (x, reach, top), 0.12)
        bar(f"bottom chord {s}", (x, nodes[1], bottom), (x, nodes[5], bottom), 0.12)
        bar(f"port end {s}", (x, -reach, top), (x, nodes[1], bottom))
        bar(f"starboard end {s}", (x, reach, top), (x, nodes[5], bottom))
        for k in range(1, 6):
            bar(f"post {s} {k}", (x, nodes[k], bottom), (x, nodes[k], top))
        for k in range(1, 5):
            low, high = (nodes[k], nodes[k + 1]) if k % 2 else (nodes[k + 1], nodes[k])
            bar(f"diagonal {s} {k}", (x, low, bottom), (x, high, top), 0.07)
    for k, y in enumerate(nodes):
        bar(f"top tie {k}", (BRIDGE_X - half, y, top), (BRIDGE_X + half, y, top), 0.08)
        if 1 <= k <= 5:
            bar(f"bottom tie {k}", (BRIDGE_X - half, y, bottom), (BRIDGE_X + half, y, bottom), 0.08)
    return bodies


def experiment_bridge():
    bodies = bridge_truss()

    def item(what, group, material, lo, hi, cuts=(1, 1, 1)):
        bodies.append(solid(f"bridge {what}", group, material,
                            box(add((BRIDGE_X, 0, 0), lo), add((BRIDGE_X, 0, 0), hi), cuts)))

    item("deck", "Bridge", "white-paint", (-0.5, -2.0, 0.16), (0.5, 2.0, 0.2), (2, 8, 1))
    item("tray 1", "Experiments", "black-paint", (-0.42, -1.85, 0.19), (0.42, -1.05, 0.34), (2, 2, 1))
    item("tray 2", "Experiments", "white-paint", (-0.42, -0.95, 0.19), (0.42, -0.2, 0.34), (2, 2, 1))
    item("mass spectrometer", "Experiments", "mli-silver", (-0.3, 0.0, 0.19), (0.35, 0.55, 0.72), (1, 1, 1))
    item("electronics", "Experiments", "white-paint", (-0.4, 0.75, 0.19), (0.4, 1.3, 0.5), (2, 1, 1))
    item("tank", "Experiments", "kapton", (-0.38, 1.42, 0.19), (0.38, 1.9, 0.55), (2, 1, 1))
    # sample plates on the trays: bright, dark, coloured, in a row
    coupons = ("osr", "white-paint", "black-paint", "kapton", "gold-foil", "aluminium", "copper", "z93")
    for k, material in enumerate(coupons):
        row, column = divmod(k, 4)
        x, y = -0.2 + 0.4 * row, -1.75 + 0.2 * column
        item(f"coupon {k}", "Experiments", material, (x - 0.14, y - 0.07, 0.335), (x + 0.14, y + 0.07, 0.35))
    for k, material in enumerate(("kapton", "z93", "gold-foil", "solar-cell", "osr", "black-paint")):
        row, column = divmod(k, 3)
        x, y = -0.2 + 0.4 * row, -0.8 + 0.22 * column
        item(f"sample {k}", "Experiments", material, (x - 0.15, y - 0.08, 0.335), (x + 0.15, y + 0.08, 0.35))
    dish = (BRIDGE_X + 0.02, 0.28, 0.71)
    bodies.append(solid("bridge inlet", "Experiments", "black-paint",
                        cylinder(dish, add(dish, (0, 0, 0.16)), 0.13, 12)))
    for s in (1, -1):
        bodies.append(solid(f"bridge keel leg {s}", "Bridge", "aluminium",
                            beam((BRIDGE_X + s * 0.4, 0.0, -0.85), (BRIDGE_X, 0.0, -2.1), 0.1)))
    ends = [(BRIDGE_X, side) for side in (1, -1)]
    for x, side in ends:
        y = sorted((side * 1.95, side * 2.12))
        bodies.append(solid(f"bridge end box {side}", "Bridge", "aluminium",
                            box((x - 0.3, y[0], -0.02), (x + 0.3, y[1], 0.48))))
    bodies += trunnions("BridgeTrunnions", "bridge", ends, 2.1)
    bodies += keel_trunnion("BridgeTrunnions", "bridge", BRIDGE_X, -2.05)
    return bodies


def latch_places():
    """Where the payloads rest: longeron latches (x, side) and keel latches x."""
    longeron = trunnion_places(EURECA_X, 0.75) + trunnion_places(TSS_X, 1.05)
    longeron += [(BRIDGE_X, side) for side in (1, -1)]
    return longeron, [EURECA_X, TSS_X, BRIDGE_X]


def latches():
    longeron, keel = latch_places()
    return fittings.longeron_latches(longeron) + fittings.keel_latches(keel)
