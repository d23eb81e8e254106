#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes station.oem, cargo.oem, cargo.aem and arm.csv of this folder: a made-up approach, two bodies, nothing flown.

The station is on a circle 408 km high. The cargo vehicle is ahead of it: three hops between points of the station's circle
400, 120, 40 and 14 m ahead, each two impulses and an arc of two bodies in 30, 25 and 20 min, then 25 min at rest on
the circle. The cargo vehicle keeps the station's axes (x aft, y starboard, z to the Earth). The arm goes from its
rest to 1 m before the grapple fixture.

usage: make_mission.py [FOLDER]
"""
import datetime
import math
import pathlib
import sys

GM = 398600.4418e9  # m^3/s^2, WGS 84
A = 6371e3 + 408e3
START = datetime.datetime(2026, 3, 1, 12, 0, 0)
STEP = 60
MINUTES = 100
HOPS = ((0, 400.0), (30, 120.0), (55, 40.0), (75, 14.0))  # min, m ahead
INCLINATION, NODE, ARGUMENT = 51.6, 341.0, 326.0  # deg; by them the Sun is ahead 78 min after the start

ARM = ("shoulder-yaw", "shoulder-pitch", "elbow-pitch", "wrist-pitch", "wrist-yaw", "wrist-roll")
ARM_ROWS = ((0, (0, 0, 0, 0, 0, 0)), (40, (0, 0, 0, 0, 0, 0)), (55, (180, -75, 60, 15, 0, 0)),
            (75, (180, -38.1, 115.8, -77.7, 0, 0)), (100, (180, -38.1, 115.8, -77.7, 0, 0)))


def add(a, b, k=1.0):
    return tuple(x + k * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def scaled(a, k):
    return tuple(k * x for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1.0 / math.sqrt(dot(a, a)))


def circle(seconds, ahead=0.0):
    """Position and velocity on the station's circle, `ahead` metres along it."""
    node, i = math.radians(NODE), math.radians(INCLINATION)
    p = (math.cos(node), math.sin(node), 0.0)
    q = (-math.sin(node) * math.cos(i), math.cos(node) * math.cos(i), math.sin(i))
    rate = math.sqrt(GM / A ** 3)
    u = math.radians(ARGUMENT) + rate * seconds + ahead / A
    r = add(scaled(p, A * math.cos(u)), q, A * math.sin(u))
    v = add(scaled(p, -A * rate * math.sin(u)), q, A * rate * math.cos(u))
    return r, v


def propagate(r, v, seconds):
    """Two bodies by Lagrange's f and g over the difference of the eccentric anomaly."""
    length = math.sqrt(dot(r, r))
    a = 1.0 / (2.0 / length - dot(v, v) / GM)
    n, sigma = math.sqrt(GM / a ** 3), dot(r, v) / math.sqrt(GM)
    e = n * seconds
    for _ in range(50):
        value = e - (1.0 - length / a) * math.sin(e) + sigma / math.sqrt(a) * (1.0 - math.cos(e)) - n * seconds
        e -= value / (1.0 - (1.0 - length / a) * math.cos(e) + sigma / math.sqrt(a) * math.sin(e))
    f = 1.0 - a / length * (1.0 - math.cos(e))
    g = seconds + math.sqrt(a ** 3 / GM) * (math.sin(e) - e)
    there = add(scaled(r, f), v, g)
    far = math.sqrt(dot(there, there))
    df = -math.sqrt(GM * a) / (length * far) * math.sin(e)
    dg = 1.0 - a / far * (1.0 - math.cos(e))
    return there, add(scaled(r, df), v, dg)


def solve(m, b):
    """Three linear equations by Cramer's rule; m: columns."""
    det = dot(m[0], cross(m[1], m[2]))
    return (dot(b, cross(m[1], m[2])) / det, dot(m[0], cross(b, m[2])) / det, dot(m[0], cross(m[1], b)) / det)


def hop(r, v, target, seconds):
    """The velocity at r, near v, by which two bodies come to `target`."""
    for _ in range(20):
        there = propagate(r, v, seconds)[0]
        h = 1e-3
        columns = [scaled(add(propagate(r, add(v, tuple(h if k == c else 0.0 for k in range(3))), seconds)[0], there,
                              -1.0), 1.0 / h) for c in range(3)]
        v = add(v, solve(columns, add(target, there, -1.0)))
    return v


def date(seconds):
    return (START + datetime.timedelta(seconds=seconds)).isoformat(timespec="milliseconds")


def segment(name, states):
    head = ["META_START", f"OBJECT_NAME = {name}", "OBJECT_ID = 0000-000A", "CENTER_NAME = EARTH",
            "REF_FRAME = EME2000", "TIME_SYSTEM = UTC", f"START_TIME = {date(states[0][0])}",
            f"STOP_TIME = {date(states[-1][0])}", "INTERPOLATION = HERMITE", "INTERPOLATION_DEGREE = 7", "META_STOP",
            "COMMENT An arc of two bodies, not a flown orbit."]
    rows = [date(t) + "".join(f" {x / 1e3:.9f}" for x in r) + "".join(f" {x / 1e3:.12f}" for x in v)
            for t, (r, v) in states]
    return head + rows


def oem(segments):
    head = ["CCSDS_OEM_VERS = 2.0", f"CREATION_DATE = {date(0)}", "ORIGINATOR = make_mission.py", ""]
    return "\n".join(head + [line for one in segments for line in one + [""]])


def quaternion(columns):
    """Scalar last, of the rotation whose columns are the axes (Shepperd 1978, scalar or largest first)."""
    m = [[columns[c][r] for c in range(3)] for r in range(3)]
    trace = m[0][0] + m[1][1] + m[2][2]
    best = max(range(4), key=lambda k: trace if k == 3 else m[k][k])
    q = [0.0] * 4
    if best == 3:
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1.0 + trace]
    else:
        i, j, k = best, (best + 1) % 3, (best + 2) % 3
        q[i] = 1.0 + m[i][i] - m[j][j] - m[k][k]
        q[j], q[k], q[3] = m[i][j] + m[j][i], m[i][k] + m[k][i], m[k][j] - m[j][k]
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def aem():
    head = ["CCSDS_AEM_VERS = 2.0", f"CREATION_DATE = {date(0)}", "ORIGINATOR = make_mission.py", "", "META_START",
            "OBJECT_NAME = CARGO", "OBJECT_ID = 0000-000B", "CENTER_NAME = EARTH", "REF_FRAME_A = SC_BODY_1",
            "REF_FRAME_B = EME2000", "TIME_SYSTEM = UTC", f"START_TIME = {date(0)}",
            f"STOP_TIME = {date(60 * MINUTES)}", "ATTITUDE_TYPE = QUATERNION", "META_STOP",
            "COMMENT Along the station's axes, not a flown attitude.", "DATA_START"]
    rows, last = [], None
    for t in range(0, 60 * MINUTES + 1, STEP):
        r, v = circle(t)
        axes = (scaled(unit(v), -1.0), unit(cross(r, v)), scaled(unit(r), -1.0))
        # From the body to EME2000 by the standard's sense, v_A = q v_B q*: the turn from EME2000 to the body.
        q = quaternion([tuple(axes[c][k] for c in range(3)) for k in range(3)])
        if last and sum(x * y for x, y in zip(q, last)) < 0.0:
            q = [-x for x in q]
        last = q
        rows.append(date(t) + "".join(f" {x:.12f}" for x in q))
    return "\n".join(head + rows + ["DATA_STOP", ""])


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    times = range(0, 60 * MINUTES + 1, STEP)
    (folder / "station.oem").write_text(oem([segment("STATION", [(t, circle(t)) for t in times])]), encoding="utf-8")
    arcs = []
    ends = [minutes for minutes, _ in HOPS[1:]] + [MINUTES]
    for (begin, ahead), end, arrival in zip(HOPS, ends, [ahead for _, ahead in HOPS[1:]] + [None]):
        r, v = circle(60 * begin, ahead)
        if arrival is not None:
            v = hop(r, v, circle(60 * end, arrival)[0], 60.0 * (end - begin))
        arcs.append(segment("CARGO", [(t, propagate(r, v, t - 60.0 * begin))
                                      for t in range(60 * begin, 60 * end + 1, STEP)]))
    (folder / "cargo.oem").write_text(oem(arcs), encoding="utf-8")
    (folder / "cargo.aem").write_text(aem(), encoding="utf-8")
    lines = ["# angles of the arm, deg; straight between rows", "utc, " + ", ".join(ARM)]
    lines += [date(60 * minutes) + "".join(f", {x:g}" for x in angles) for minutes, angles in ARM_ROWS]
    (folder / "arm.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
