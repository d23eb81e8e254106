# SPDX-License-Identifier: Apache-2.0
"""The orbiter around the bay: trough, bulkheads, hull, doors with radiators, pods, tail, windows.

Figures are orbiter stations in inches, with the tag of README.md beside them: [S] seen in a source,
[D] derived from such figures, [B] background knowledge, or "estimate".
"""
import math

from mesh_kit import Body, add, box, bridge, cylinder, loft, ring_fill, solid, station

FORWARD = 576.0  # forward edge of the liner = aft face of the forward bulkhead [S]
FRAMES = (636.0, 693.0, 750.0, 807.0, 863.0, 919.0, 979.5, 1040.0, 1090.33, 1140.67, 1191.0)  # ring frames [S]
STEP = 1249.0    # forward wall of bay 13's raised floor, itself a ring frame [S]
AFT = 1307.0     # aft bulkhead [S]
RIB_HALF_WIDTH = 1.5  # estimate
RIB_HEIGHT = 1.5      # estimate: the liner hides the foot of the frames

LINER = ((94.0, 406.0), (94.0, 393.8), (92.4, 381.6), (89.2, 369.7), (87.1, 364.6), (67.8, 334.9), (62.1, 329.2),
         (52.3, 321.7), (41.7, 315.5), (30.3, 310.8), (18.4, 307.6), (6.2, 306.0))  # (Yo, Zo), starboard half [S]
FLOOR_FROM = 5      # LINER[5] = (67.8, 334.9): bay 13's floor is at that height [S]
SILL = ((94.0, 409.0), (102.0, 409.0), (103.5, 418.5), (105.8, 419.0))  # longeron sill, estimate between
                    # liner edge Zo 406, latch centre Yo 94 Zo 414 and door hinge Yo 106.3 Zo 420 [S]
KEEL_SIDE = ((105.8, 300.0), (98.0, 284.0), (34.0, 276.0))  # outer hull below the hinge, estimate

HINGE = (106.3, 420.0)   # door hinge line [S]
CROWN = 500.0            # top of the closed doors: the latch axis is at Zo 496.3 [S], crown [D]
ARC_RADIUS = (HINGE[0] ** 2 + (CROWN - HINGE[1]) ** 2) / (2.0 * (CROWN - HINGE[1]))  # through hinge and crown [D]
ARC_CENTRE = CROWN - ARC_RADIUS
DOOR_OPEN_DEG = 175.5    # [D] 175.4 from the linkage, [B] 175.5


def mirrored(half):
    """Starboard half, top to bottom -> whole outline from starboard top to port top."""
    return list(half) + [(-y, z) for y, z in reversed(half)]


def rib_outline():
    """The liner's outline brought in by the height of a rib; its top stays at the liner's edge."""
    points = []
    for y, z in LINER:
        scale = 1.0 - RIB_HEIGHT / math.hypot(y, z - 400.0)
        points.append((y * scale, z if z >= 406.0 else 400.0 + (z - 400.0) * scale))
    return mirrored(points)


def floor_outline():
    """Bay 13: the same walls, and a floor cut where the liner's points are, so that the step fits them."""
    level = LINER[FLOOR_FROM][1]
    return mirrored([(y, max(z, level)) for y, z in LINER])


def arc_point(angle_deg):
    """On the closed doors' outer surface, by the angle from the crown toward starboard."""
    t = math.radians(angle_deg)
    return (ARC_RADIUS * math.sin(t), ARC_CENTRE + ARC_RADIUS * math.cos(t))


def crown_outline():
    """Fuselage above the sills, from port to starboard, without the sill edges themselves."""
    return [arc_point(a) for a in range(-66, 67, 12)]


def hull_outline():
    """Outer hull from the starboard sill edge around below to the port one."""
    return mirrored((SILL[-1],) + KEEL_SIDE)


def at(xo, outline):
    return [station(xo, y, z) for y, z in outline]


# ---- the closed body: cabin stub, trough, aft fuselage ----------------------------------------------------------
def fuselage():
    body = Body("fuselage")
    trough(body)
    sills_and_hull(body)
    forward_part(body)
    aft_part(body)
    return body


def axis_above(points):
    """From a face of the trough toward the bay's axis a little above the sills."""
    y = sum(p[1] for p in points) / len(points)
    z = sum(p[2] for p in points) / len(points)
    return (0.0, -y, 0.4 - z)


def trough(body):
    smooth = mirrored(LINER)
    rib = rib_outline()
    edges = [FORWARD]
    for frame in FRAMES:
        edges += [frame - RIB_HALF_WIDTH, frame + RIB_HALF_WIDTH]
    edges.append(STEP)
    for x0, x1 in zip(edges[0::2], edges[1::2]):
        for quad in bridge(at(x0, smooth), at(x1, smooth), closed=False):
            body.face("Liner", "beta-cloth", quad, axis_above(quad))
    for frame in FRAMES:
        x0, x1 = frame - RIB_HALF_WIDTH, frame + RIB_HALF_WIDTH
        for quad in bridge(at(x0, rib), at(x1, rib), closed=False):
            body.face("Frames", "frame-paint", quad, axis_above(quad))
        for x, out in ((x0, (-1, 0, 0)), (x1, (1, 0, 0))):
            for quad in bridge(at(x, smooth), at(x, rib), closed=False):
                body.face("Frames", "frame-paint", quad, out)
        for end in (0, -1):  # the rib's upper ends, level with the liner's edge
            quad = [station(x, *outline[end]) for x, outline in ((x0, rib), (x1, rib), (x1, smooth), (x0, smooth))]
            body.face("Frames", "frame-paint", quad, (0, 0, 1))
    raised_floor(body, smooth)


def raised_floor(body, smooth):
    floor = floor_outline()
    for quad in bridge(at(STEP, floor), at(AFT, floor), closed=False):
        body.face("Floor13", "beta-cloth", quad, axis_above(quad))
    for i in range(FLOOR_FROM, len(floor) - 1 - FLOOR_FROM):
        wall = at(STEP, [smooth[i], smooth[i + 1], floor[i + 1], floor[i]])
        wall = [p for k, p in enumerate(wall) if p != wall[k - 1]]
        body.face("Floor13", "beta-cloth", wall, (-1, 0, 0))


def sills_and_hull(body):
    """Sills and outer hull are cut once per bay; a strip under the sill takes up the ribs' extra points."""
    bays = [FORWARD] + [f + RIB_HALF_WIDTH for f in FRAMES] + [STEP, AFT]
    for side in (1, -1):
        top, edge = (side * LINER[0][0], LINER[0][1]), [(side * y, z) for y, z in SILL]
        inboard = (0, -side, 0)
        for k, (x0, x1) in enumerate(zip(bays, bays[1:])):
            upper0, upper1 = station(x0, *edge[0]), station(x1, *edge[0])
            lower0, lower1 = station(x0, *top), station(x1, *top)
            if k < len(FRAMES):
                before_rib = station(FRAMES[k] - RIB_HALF_WIDTH, *top)
                body.face("Sills", "sill-paint", [lower0, before_rib, upper1, upper0], inboard)
                body.face("Sills", "sill-paint", [before_rib, lower1, upper1], inboard)
            else:
                body.face("Sills", "sill-paint", [lower0, lower1, upper1, upper0], inboard)
            for a, b, out in zip(edge, edge[1:], ((0, 0, 1), (0, -side, 0), (0, 0, 1))):
                body.face("Sills", "sill-paint",
                          [station(x0, *a), station(x1, *a), station(x1, *b), station(x0, *b)], out)
    outline = hull_outline()
    for x0, x1 in zip(bays, bays[1:]):
        for quad in bridge(at(x0, outline), at(x1, outline), closed=False):
            z = sum(p[2] for p in quad) / 4
            out = (0.0, sum(p[1] for p in quad), min(z, 0.0))
            body.face("Hull", "white-tile" if z > -2.0 else "black-tile", quad, out)


def section(inside):
    """Closed outline: `inside` the trough, the sills and the crown, counter-clockwise seen from +x."""
    port_sill = [(-y, z) for y, z in SILL]
    return inside[::-1] + list(SILL) + crown_outline()[::-1] + port_sill[::-1]


BULKHEAD_EYE = 428.0  # Zo from which all of a bulkhead's outline is seen


def bulkhead(body, xo, inside, group, material, out):
    centre = station(xo, 0.0, BULKHEAD_EYE)
    for face in ring_fill(at(xo, section(inside)), centre, ((0.82, 1), (0.55, 2), (0.28, 2))):
        body.face(group, material, face, out)


def outer_skin(body, group, stations, end_out):
    """The whole outer section drawn along the stations and closed at the last one."""
    outline = hull_outline()[::-1] + crown_outline()[::-1]
    rings = [at(x, outline) for x in stations]
    for a, b in zip(rings, rings[1:]):
        for quad in bridge(a, b):
            y, z = (sum(p[i] for p in quad) / len(quad) for i in (1, 2))
            body.face(group, "white-tile" if z > -2.0 else "black-tile", quad, (0.0, y, z))
    for face in ring_fill(rings[-1], station(stations[-1], 0.0, 395.0), ((0.55, 2),)):
        body.face(group, "white-tile", face, end_out)


def forward_part(body):
    bulkhead(body, FORWARD, mirrored(LINER), "FwdBulkhead", "bulkhead-blanket", (1, 0, 0))
    outer_skin(body, "Cabin", (FORWARD, 550.0, 515.0), (-1, 0, 0))


def aft_part(body):
    bulkhead(body, AFT, floor_outline(), "AftBulkhead", "bulkhead-blanket", (-1, 0, 0))
    outer_skin(body, "AftFuselage", (AFT, 1350.0, 1400.0), (1, 0, 0))


# ---- doors ------------------------------------------------------------------------------------------------------
DOOR_LENGTH = (582.8, 1306.2)      # 60 ft doors [S]
DOOR_THICKNESS = 3.5               # structure under the radiators, estimate
PANEL_THICKNESS = 1.6              # estimate
PANEL_LENGTH = 177.0               # four panels of ~15 ft per door [B] in 723 in
PANEL_ARC = 126.0                  # ~10.5 ft [B]
DOOR_FIRST, DOOR_LAST = 71.5, 0.35  # deg from the crown: hinge edge and centre-line edge, estimate


def door_lines():
    """Where a door's surface is cut: stations along it and angles across, each with 'is a panel' flags."""
    gap = (DOOR_LENGTH[1] - DOOR_LENGTH[0] - 4 * PANEL_LENGTH) / 5.0
    stations, panel_x = [DOOR_LENGTH[0]], []
    for _ in range(4):
        start = stations[-1] + gap
        stations += [start] + [start + PANEL_LENGTH * k / 3 for k in (1, 2, 3)]
        panel_x += [False, True, True, True]
    stations.append(DOOR_LENGTH[1])
    panel_x.append(False)
    span = math.degrees(PANEL_ARC / ARC_RADIUS)
    start = DOOR_FIRST - (DOOR_FIRST - DOOR_LAST - span) * 0.55
    angles = [DOOR_FIRST] + [start - span * k / 10 for k in range(11)] + [DOOR_LAST]
    panel_a = [False] + [True] * 10 + [False]
    return stations, panel_x, angles, panel_a


def open_door_point(xo, angle_deg, depth, side):
    """A point `depth` inches inside the closed door's outer surface, after the door has swung open."""
    t = math.radians(angle_deg)
    y = (ARC_RADIUS - depth) * math.sin(t) - HINGE[0]
    z = ARC_CENTRE + (ARC_RADIUS - depth) * math.cos(t) - HINGE[1]
    swing = math.radians(-DOOR_OPEN_DEG)
    y, z = (y * math.cos(swing) - z * math.sin(swing), y * math.sin(swing) + z * math.cos(swing))
    return station(xo, side * (HINGE[0] + y), HINGE[1] + z)


def door(side):
    """One closed body: outer skin, rim, inner structure, and four raised radiator panels."""
    name = "Starboard" if side > 0 else "Port"
    body = Body(f"{name} door")
    stations, panel_x, angles, panel_a = door_lines()
    nx, na = len(panel_x), len(panel_a)

    def raised(i, j):
        return 0 <= i < nx and 0 <= j < na and panel_x[i] and panel_a[j]

    def depth(i, j):
        return DOOR_THICKNESS + (PANEL_THICKNESS if raised(i, j) else 0.0)

    def point(i, j, d):
        return open_door_point(stations[i], angles[j], d, side)

    def put(group, material, points, inner_way):
        if side < 0:
            points = points[::-1]
        body.face(group, material, points if inner_way else points[::-1])

    inner, outer = f"Radiators{name}", f"Door{name}"
    for i in range(nx):
        for j in range(na):
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            d = depth(i, j)
            group, material = (inner, "radiator") if raised(i, j) else (outer, "door-structure")
            put(group, material, [point(a, b, d) for a, b in corners], True)
            put(outer, "white-blanket", [point(a, b, 0.0) for a, b in corners], False)
            # upright faces: from this cell down to its neighbour, or to the outer skin at the rim
            for (a, b), (di, dj) in zip(((0, 1), (1, 2), (2, 3), (3, 0)), ((0, -1), (1, 0), (0, 1), (-1, 0))):
                rim = not (0 <= i + di < nx and 0 <= j + dj < na)
                low = 0.0 if rim else depth(i + di, j + dj)
                if low >= d:
                    continue
                p, q = corners[a], corners[b]
                quad = [point(*p, low), point(*q, low), point(*q, d), point(*p, d)]
                put(outer if rim else inner, "door-structure" if rim else "panel-edge", quad, True)
    return body


def hinges():
    """Thirteen hinges a side [S], as blocks that join sill and door. Sizes are estimates."""
    bodies = []
    for side, name in ((1, "Starboard"), (-1, "Port")):
        for k in range(13):
            xo = DOOR_LENGTH[0] + (k + 0.5) * (DOOR_LENGTH[1] - DOOR_LENGTH[0]) / 13
            lo, hi = station(xo - 3, side * 104.2, 416.5), station(xo + 3, side * 108.4, 421.5)
            lo, hi = (lo[0], min(lo[1], hi[1]), lo[2]), (hi[0], max(lo[1], hi[1]), hi[2])
            bodies.append(solid(f"hinge {name} {k}", "Hinges", "aluminium", box(lo, hi)))
    return bodies


# ---- windows, hatch, pods, tail ------------------------------------------------------------------------------------
def cabin_wall():
    """The two aft windows of the flight deck, the airlock hatch and handrails on the forward bulkhead."""
    bodies = []
    for side in (1, -1):
        # aft windows about 14.5 x 11 in [B]; place estimated on both sides of the flood at Zo 481.9 [S]
        window = Body(f"aft window {side}")
        y = 16.0 * side
        frame = box(station(FORWARD - 1, y - 9.5, 465.0), station(FORWARD + 2.0, y + 9.5, 480.0))
        window.add("WindowFrames", "black-paint", frame)
        bodies.append(window)
        bodies.append(solid(f"aft pane {side}", "Windows", "window-glass",
                            box(station(FORWARD + 1, y - 7.25, 467.0), station(FORWARD + 2.3, y + 7.25, 478.0))))
        bodies.append(solid(f"handrail {side}", "Handrails", "yellow-paint",
                            box(station(FORWARD + 3, 30.0 * side - 0.7, 372.0),
                                station(FORWARD + 4.4, 30.0 * side + 0.7, 402.0))))
    hatch = station(FORWARD - 1, 0.0, 362.0)  # airlock hatch, 40 in across [B], height estimated
    bodies.append(solid("hatch ring", "Hatch", "aluminium", cylinder(hatch, add(hatch, (0.09, 0, 0)), 0.56, 16)))
    bodies.append(solid("hatch", "Hatch", "white-paint",
                        cylinder(add(hatch, (0.05, 0, 0)), add(hatch, (0.12, 0, 0)), 0.48, 16)))
    return bodies


POD_SECTIONS = (  # Xo, scale of the section, Yo and Zo of its centre: estimates
    (1309.0, 0.0, 78.0, 452.0), (1312.0, 0.26, 77.0, 454.0), (1320.0, 0.5, 75.5, 457.5), (1334.0, 0.74, 73.5, 462.0),
    (1354.0, 0.92, 72.0, 466.0), (1378.0, 1.0, 71.0, 468.0), (1400.0, 1.0, 71.0, 468.0))
POD_HALF_WIDTH, POD_HALF_HEIGHT = 50.0, 36.0  # pods 8.4 ft wide forward [B]; height estimated


def pods():
    """Fronts of the OMS pods, rising out of the shoulders of the aft fuselage; cut off at Xo 1400."""
    bodies = []
    for side in (1, -1):
        body = Body(f"OMS pod {side}")
        rings = []
        for xo, scale, y, z in POD_SECTIONS:
            angles = [2 * math.pi * (k + 0.5) / 14 for k in range(14)]
            wide, high = POD_HALF_WIDTH * scale, POD_HALF_HEIGHT * scale
            ring = [station(xo, side * y + wide * math.cos(t), z + high * math.sin(t)) for t in angles]
            rings.append(ring if scale > 0.0 else ring[:1])
        body.add("OmsPods", lambda i, _: "black-tile" if i < 14 else "white-blanket", loft(rings))
        bodies.append(body)
    return bodies


TAIL_ROOT = (1316.0, 490.0)  # leading edge where it enters the fuselage, estimate
TAIL_SPAN, TAIL_TIP_CHORD, TAIL_ROOT_CHORD = 320.0, 108.5, 268.5  # [B], the root a little below the skin
TAIL_LEVELS = 4
TAIL_THICKNESS = ((0.0, 0.6), (18.0, 6.0), (60.0, 8.0), (108.5, 8.0), (268.5, 1.0))  # (behind leading edge, half)


def tail_half_thickness(behind):
    for (a, ha), (b, hb) in zip(TAIL_THICKNESS, TAIL_THICKNESS[1:]):
        if behind <= b:
            return ha + (hb - ha) * (behind - a) / (b - a)
    return TAIL_THICKNESS[-1][1]


def tail():
    """Vertical tail, leading edge swept 45 deg [B], cut along lines parallel to it: parallelograms all the way."""
    taper = (TAIL_ROOT_CHORD - TAIL_TIP_CHORD) / TAIL_LEVELS
    lines = [0.0, 18.0, 60.0] + [TAIL_TIP_CHORD + taper * k for k in range(TAIL_LEVELS + 1)]
    body = Body("tail")

    def point(level, line, side):
        rise = TAIL_SPAN * level / TAIL_LEVELS
        behind = lines[line]
        return station(TAIL_ROOT[0] + rise + behind, side * tail_half_thickness(behind), TAIL_ROOT[1] + rise)

    for level in range(TAIL_LEVELS):
        last_below = len(lines) - 1 - level  # the trailing edge's line at the foot of this level
        for side in (1, -1):
            for line in range(last_below):
                quad = [point(level, line, side), point(level, line + 1, side),
                        point(level + 1, line + 1, side), point(level + 1, line, side)]
                if line == last_below - 1:
                    del quad[2]
                body.face("Tail", "white-tile" if line == 0 else "white-blanket", quad, (0, side, 0))
        edges = ((0, 0, (-1, 0, 1)), (last_below, last_below - 1, (1, 0, 0)))
        for low, high, out in edges:
            body.face("Tail", "white-tile" if low == 0 else "white-blanket",
                      [point(level, low, -1), point(level, low, 1), point(level + 1, high, 1),
                       point(level + 1, high, -1)], out)
    for level, out in ((0, (0, 0, -1)), (TAIL_LEVELS, (0, 0, 1))):
        for line in range(len(lines) - 1 - level):
            body.face("Tail", "white-blanket", [point(level, line, -1), point(level, line + 1, -1),
                                                point(level, line + 1, 1), point(level, line, 1)], out)
    return [body]


def bodies():
    return [fuselage()] + cabin_wall() + pods() + tail()


def door_bodies():
    return [door(1), door(-1)] + hinges()
