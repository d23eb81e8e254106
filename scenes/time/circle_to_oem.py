#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a CCSDS OEM (EME2000, UTC) of a circle about the Earth: two bodies, no oblateness, no drag.

usage: circle_to_oem.py -o FILE.oem --start 1992-08-02T12:00:00 --hours 3 --altitude 425 --inclination 28.5
       [--node 0] [--argument 0] [--step 60]

altitude: km over a sphere of 6371 km; node: right ascension of the ascending node, degrees; argument: of latitude at
the start, degrees. It is for tests and examples: a real orbit's node turns by some 7 degrees a day.
"""
import argparse
import datetime
import math
import pathlib

GM_KM3_S2 = 398600.4418  # WGS 84
RADIUS_KM = 6371.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--start", required=True)
    parser.add_argument("--hours", type=float, required=True)
    parser.add_argument("--altitude", type=float, required=True)
    parser.add_argument("--inclination", type=float, required=True)
    for name, value in (("--node", 0.0), ("--argument", 0.0), ("--step", 60.0)):
        parser.add_argument(name, type=float, default=value)
    options = parser.parse_args()
    start = datetime.datetime.strptime(options.start, "%Y-%m-%dT%H:%M:%S")
    a = RADIUS_KM + options.altitude
    rate = math.sqrt(GM_KM3_S2 / a ** 3)
    node, i = math.radians(options.node), math.radians(options.inclination)
    p = (math.cos(node), math.sin(node), 0.0)
    q = (-math.sin(node) * math.cos(i), math.cos(node) * math.cos(i), math.sin(i))
    rows = []
    for k in range(int(options.hours * 3600.0 / options.step + 1e-9) + 1):
        u = math.radians(options.argument) + rate * k * options.step
        date = (start + datetime.timedelta(seconds=k * options.step)).isoformat(timespec="microseconds")
        position = [a * (math.cos(u) * p[n] + math.sin(u) * q[n]) for n in range(3)]
        velocity = [a * rate * (-math.sin(u) * p[n] + math.cos(u) * q[n]) for n in range(3)]
        rows.append(date + "".join(f" {x:.6f}" for x in position) + "".join(f" {x:.9f}" for x in velocity))
    head = ["CCSDS_OEM_VERS = 2.0", f"CREATION_DATE = {options.start}", "ORIGINATOR = circle_to_oem.py", "",
            "META_START", "OBJECT_NAME = CIRCLE", "OBJECT_ID = 0000-000A", "CENTER_NAME = EARTH",
            "REF_FRAME = EME2000", "TIME_SYSTEM = UTC", f"START_TIME = {rows[0].split()[0]}",
            f"STOP_TIME = {rows[-1].split()[0]}", "INTERPOLATION = HERMITE", "INTERPOLATION_DEGREE = 7",
            "META_STOP", "", "COMMENT A circle of two bodies, not a flown orbit."]
    pathlib.Path(options.output).write_text("\n".join(head + rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
