#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a CCSDS OEM (TEME, UTC) from a two-line element set by SGP4.

usage: tle_to_oem.py TLE.txt -o FILE.oem --start 2026-03-01T12:00:00 --stop 2026-03-01T14:00:00 [--step 60]

Needs python3-sgp4. The first element set of the file is taken. SGP4 is good to some kilometres near the set's
epoch and loses 1 to 3 km a day: a set more than a week from the wanted time is refused unless --old is given.
"""
import argparse
import datetime
import pathlib
import sys

from sgp4.api import SGP4_ERRORS, Satrec, jday


def utc(text):
    for form in ("%Y-%m-%dT%H:%M:%S", "%Y-%jT%H:%M:%S", "%Y-%m-%dT%H:%M:%S.%f"):
        try:
            return datetime.datetime.strptime(text.removesuffix("Z"), form)
        except ValueError:
            pass
    raise argparse.ArgumentTypeError(f'"{text}" is no UTC such as 2026-03-01T12:00:00 or 2026-060T12:00:00')


def read_elements(path):
    """The name and the satellite of the first element set."""
    lines = [line.rstrip() for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines()]
    for k in range(len(lines) - 1):
        if lines[k].startswith("1 ") and lines[k + 1].startswith("2 "):
            for line in lines[k:k + 2]:
                digits = sum(int(c) if c.isdigit() else c == "-" for c in line[:68])
                if len(line) != 69 or not line[68].isdigit() or digits % 10 != int(line[68]):
                    sys.exit(f'{path}: "{line}": the checksum is wrong, or the line has not 69 characters')
            name = lines[k - 1].removeprefix("0 ").strip() if k > 0 else ""
            return name or lines[k][2:7], Satrec.twoline2rv(lines[k], lines[k + 1])
    sys.exit(f"{path}: has no two lines that begin with 1 and 2")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tle")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--start", type=utc, required=True)
    parser.add_argument("--stop", type=utc, required=True)
    parser.add_argument("--step", type=float, default=60.0, help="s")
    parser.add_argument("--old", action="store_true", help="also elements more than a week old")
    options = parser.parse_args()
    if options.step <= 0.0 or options.stop <= options.start:
        sys.exit("the step must be above 0 s, and stop after start")
    name, satellite = read_elements(options.tle)
    year, month, day, hour, minute, second = (options.start.year, options.start.month, options.start.day,
                                              options.start.hour, options.start.minute, options.start.second)
    age = sum(jday(year, month, day, hour, minute, second)) - satellite.jdsatepoch - satellite.jdsatepochF
    if abs(age) > 7.0 and not options.old:
        sys.exit(f"the elements are {abs(age):.1f} days {'older' if age > 0 else 'younger'} than the start: "
                 "take others, or say --old")
    rows = []
    count = int((options.stop - options.start).total_seconds() / options.step + 1e-9) + 1
    for k in range(count):
        t = options.start + datetime.timedelta(seconds=k * options.step)
        whole, fraction = jday(t.year, t.month, t.day, t.hour, t.minute, t.second + t.microsecond / 1e6)
        error, position, velocity = satellite.sgp4(whole, fraction)
        if error:
            sys.exit(f"{t.isoformat()}: SGP4: {SGP4_ERRORS[error]}")
        rows.append(t.isoformat(timespec="microseconds") + "".join(f" {x:.6f}" for x in position)
                    + "".join(f" {x:.9f}" for x in velocity))
    designator = f"{satellite.intldesg[:2]}-{satellite.intldesg[2:]}".strip() or "unknown"
    century = "19" if designator[:2] > "56" else "20"
    head = ["CCSDS_OEM_VERS = 2.0", f"CREATION_DATE = {datetime.datetime.utcnow().isoformat(timespec='seconds')}",
            "ORIGINATOR = tle_to_oem.py", "", "META_START", f"OBJECT_NAME = {name}",
            f"OBJECT_ID = {century}{designator}", "CENTER_NAME = EARTH", "REF_FRAME = TEME", "TIME_SYSTEM = UTC",
            f"START_TIME = {rows[0].split()[0]}", f"STOP_TIME = {rows[-1].split()[0]}", "INTERPOLATION = HERMITE",
            "INTERPOLATION_DEGREE = 7", "META_STOP", "", "COMMENT SGP4 from the elements:",
            f"COMMENT epoch JD {satellite.jdsatepoch + satellite.jdsatepochF:.6f}"]
    pathlib.Path(options.output).write_text("\n".join(head + rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
