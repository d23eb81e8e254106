# SPDX-License-Identifier: Apache-2.0
"""Missions for users: scripts that write trajectories, inspect, a study along time, and errors."""
import csv
import datetime
import json
import math
import subprocess
import sys
import unittest

import exr
import program
from tiny_bay import BAY

SCRIPTS = program.TOP / "scenes" / "time"
CIRCLE = ("--start", "2026-03-01T12:00:00", "--hours", "3", "--altitude", "425", "--inclination", "28.5", "--node", "300")
TIME = '[time]\nstart = "2026-03-01T12:00:00"\nstop = "2026-060T13:30:00"\nstep = 900\n'
MISSION = BAY.replace("altitude_km = 425\n", 'trajectory = "circle.oem"\n') + TIME
# The International Space Station on 2008 September 20.
TLE = """ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
"""


class Missions(program.Case):
    def setUp(self):
        super().setUp()
        self.script("circle_to_oem.py", "-o", "circle.oem", *CIRCLE)
        self.write("bay.toml", MISSION)

    def script(self, name, *arguments, python=sys.executable):
        return subprocess.run([python, SCRIPTS / name, *arguments], cwd=self.folder, check=True, timeout=60,
                              capture_output=True, text=True)

    def test_inspect_shows_where_it_is(self):
        facts = self.json("inspect", "bay.toml")["mission"]
        self.assertEqual((facts["frame"], facts["time_system"], facts["moments"]), ("EME2000", "UTC", 7))
        # At the node, on the equator; 425 km above 6371 km is 417.863 km above the equator of WGS
        # 84.
        self.assertAlmostEqual(facts["latitude_deg"], 0.0, delta=0.2)  # precession since 2000
        self.assertAlmostEqual(facts["height_m"], 417863, delta=200)
        # Greenwich mean sidereal time is 18.697375 h + 24.0657098244 h * 9556 days since J2000 =
        # 22.6205 h, or 339.307 deg; along the equator precession has moved the node by 46.1" a year
        # in 26.16 years.
        self.assertAlmostEqual(facts["longitude_deg"], 300 - 339.307 + 46.1 * 26.16 / 3600, delta=0.02)
        period = 2 * math.pi * math.sqrt(6796e3 ** 3 / 3.986004418e14)
        self.assertAlmostEqual(facts["period_s"], period, delta=0.01)
        self.assertEqual(len(facts["eclipses"]), 1)
        self.says(self.done("inspect", "bay.toml"), "trajectory: ", "EME2000", "TAI - UTC = 37 s", "beta", "eclipse: penumbra")

    def test_a_study_goes_along_time(self):
        study = self.json("study", "orbit", "bay.toml", "-o", "out", "--size", "12x12", "--camera", "B")
        conditions = study["conditions"]
        self.assertEqual([c["utc"] for c in conditions],
                         [f"2026-03-01T{12 + k // 4}:{15 * (k % 4):02}:00Z" for k in range(7)])
        self.assertEqual([c["time_s"] for c in conditions], [900 * k for k in range(7)])
        # Equal steps of a circle, increasing beyond one revolution.
        step = 900 / (2 * math.pi * math.sqrt(6796e3 ** 3 / 3.986004418e14)) * 360
        for k, condition in enumerate(conditions):
            self.assertAlmostEqual(condition["position_deg"], conditions[0]["position_deg"] + step * k, delta=0.1)
        self.assertIn("eclipse", {c["phase"] for c in conditions})
        with open(self.folder / "out" / "results.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(rows[0]["utc"], "2026-03-01T12:00:00Z")
        self.assertIn("2026-03-01T12:15:00Z", (self.folder / "out" / "report.html").read_text(encoding="utf-8"))

    def test_an_eclipse_across_segments_that_share_a_moment_is_one(self):
        times = lambda: [{name: datetime.datetime.fromisoformat(at[:-1]).timestamp() for name, at in eclipse.items()}
                         for eclipse in self.json("inspect", "bay.toml")["mission"]["eclipses"]]
        whole = times()
        self.assertEqual(len(whole), 1)
        middle = datetime.datetime.fromtimestamp((whole[0]["umbra_begin"] + whole[0]["umbra_end"]) / 2)
        lines = (self.folder / "circle.oem").read_text(encoding="utf-8").splitlines()
        meta = lines[lines.index("META_START"):lines.index("META_STOP") + 1]
        k = next(k for k, line in enumerate(lines) if line.startswith(middle.isoformat()[:16]))
        shared = lines[k].split()[0]
        first = [f"STOP_TIME = {shared}" if line.startswith("STOP_TIME") else line for line in lines[:k + 1]]
        second = [f"START_TIME = {shared}" if line.startswith("START_TIME") else line for line in meta]
        self.write("circle.oem", "\n".join(first + second + lines[k:]) + "\n")
        parts = times()
        self.assertEqual(len(parts), 1)
        for name, at in whole[0].items():  # both bisect to 1 ms
            self.assertAlmostEqual(parts[0][name], at, delta=0.005, msg=name)

    def test_positions_of_an_ellipse_grow_by_a_revolution_in_each_period(self):
        """e = 0.6 from the perigee on, in the x-y plane: r = a (cos E - e, (1 - e^2)^(1/2) sin E), E - e sin E = n t."""
        mu, a, e = 398600.4418, 17000.0, 0.6
        n = math.sqrt(mu / a**3)
        period = 2 * math.pi / n
        lines = ["CCSDS_OEM_VERS = 2.0", "CREATION_DATE = 2026-01-01T00:00:00", "ORIGINATOR = TEST", "META_START",
                 "OBJECT_NAME = A", "OBJECT_ID = 2026-001A", "CENTER_NAME = EARTH", "REF_FRAME = GCRF", "TIME_SYSTEM = UTC",
                 "START_TIME = 2026-03-01T00:00:00", "STOP_TIME = 2026-03-01T23:59:00", "META_STOP"]
        for k in range(24 * 60):
            anomaly = n * 60 * k
            for _ in range(40):
                anomaly -= (anomaly - e * math.sin(anomaly) - n * 60 * k) / (1 - e * math.cos(anomaly))
            speed = n * a / (1 - e * math.cos(anomaly))
            across = math.sqrt(1 - e * e)
            lines.append(f"2026-03-01T{k // 60:02}:{k % 60:02}:00 {a * (math.cos(anomaly) - e):.9f} {a * across * math.sin(anomaly):.9f} "
                         f"0 {-speed * math.sin(anomaly):.12f} {speed * across * math.cos(anomaly):.12f} 0")
        self.write("circle.oem", "\n".join(lines) + "\n")
        self.write("bay.toml", MISSION.replace("T12:00:00", "T00:00:00").replace("060T13:30:00", "060T23:59:00").replace(
            "step = 900", f"step = {period / 3:.3f}"))
        facts = self.json("inspect", "bay.toml")["mission"]
        self.assertAlmostEqual(facts["period_s"], period, delta=0.01)
        positions = [c["position_deg"] for c in self.json(
            "study", "orbit", "bay.toml", "-o", "out", "--size", "8x8", "--camera", "B")["conditions"]]
        self.assertEqual(len(positions), 12)
        # The Sun goes 1 deg a day, 0.3 deg in a period.
        for k in range(9):
            self.assertAlmostEqual(positions[k + 3] - positions[k], 360, delta=0.5)
        self.assertEqual(positions, sorted(positions))

    def test_a_study_file_has_its_own_time(self):
        self.write("study.toml", 'format = 1\nscene = "bay.toml"\ncameras = ["B"]\nsize = "12x12"\nwanted = ["box>=0.01"]\n'
                   '[time]\nstart = "2026-03-01T12:10:00"\nstop = "2026-03-01T12:12:00"\nstep = 60\n'
                   '[[picture]]\nname = "one"\ncamera = "B"\ntime = "2026-03-01T12:11:00"\n')
        study = self.json("study", "run", "study.toml", "-o", "out")
        self.assertEqual([c["utc"] for c in study["conditions"]], [f"2026-03-01T12:1{k}:00Z" for k in range(3)])
        self.assertIn("2026-03-01T12:10:00Z to 2026-03-01T12:12:00Z", study["answers"][0]["text"])
        self.write("study.toml", 'format = 1\nscene = "bay.toml"\n[orbit]\npositions = 4\n')
        self.says(self.refused("study", "run", "study.toml", "-o", "no"), "study.toml:3", "trajectory", "[time]")

    def test_the_moon_of_a_study_is_that_of_its_moment(self):
        """A plate that the Moon alone lights: a study of one moment gives what the scene gives at that moment."""
        self.write("moonlit.toml", 'format = 1\n[time]\nstart = "2026-03-01T12:00:00"\n[orbit]\ntrajectory = "circle.oem"\n'
                   '[moon]\n[[material]]\nname = "grey"\ndiffuse = 0.5\n[[object]]\nname = "plate"\nshape = "box"\n'
                   'min = [-1, -1, 0]\nmax = [1, 1, 0.1]\nmaterial = "grey"\ntarget = true\n[[camera]]\nname = "C"\n'
                   'position = [0, 0, -5]\nlook_at = [0, 0, 0]\nup = [1, 0, 0]\nfov_deg = 20\nresolution = [12, 12]\n')
        found = {}
        for moment in ("2026-03-01T12:00:00", "2026-03-01T13:00:00"):
            self.write("one.toml", f'format = 1\nscene = "moonlit.toml"\n[time]\nstart = "{moment}"\n')
            here = self.json("study", "visibility", "moonlit.toml", "--set", f"time.moment={moment}", "-o", "v" + moment[12])
            there = self.json("study", "run", "one.toml", "-o", "r" + moment[12])
            column = here["results"]["columns"].index("luminance")
            found[moment] = here["results"]["rows"][0][column]
            self.assertEqual(there["results"]["rows"][0][column], found[moment], moment)
        self.assertNotEqual(*found.values())

    def test_a_study_solves_anew_for_each_pose(self):
        # The box on a joint: at rest until 12:11, turned by 12:12.
        self.write("bay.toml", MISSION.replace('name = "box"\n', 'name = "box"\njoint = "door"\n') +
                   '[[joint]]\nname = "door"\npivot = [0, 0, 0]\naxis = [0, 0, 1]\nangle_deg = "door.csv"\n')
        self.write("door.csv", "utc, door\n2026-03-01T12:00:00, 10\n2026-03-01T12:11:00, 10\n2026-03-01T12:12:00, 20\n")
        self.write("study.toml", 'format = 1\nscene = "bay.toml"\ncameras = ["B"]\nsize = "12x12"\nwanted = ["box>=0.01"]\n'
                   '[time]\nstart = "2026-03-01T12:10:00"\nstop = "2026-03-01T12:12:00"\nstep = 60\n'
                   '[[picture]]\nname = "last"\ncamera = "B"\ntime = "2026-03-01T12:12:00"\n')
        study = self.json("study", "run", "study.toml", "-o", "out")
        self.assertEqual([(c["utc"][11:16], c["pose"]) for c in study["conditions"]],
                         [("12:10", "door 10 deg"), ("12:11", "door 10 deg"), ("12:12", "door 20 deg")])
        self.assertEqual((len(study["scenes"]), len(study["cameras"])), (1, 1))
        self.assertEqual(len([c for c in study["costs"] if c["stage"].startswith("solve")]), 2)
        self.assertIn("door 20 deg", (self.folder / "out" / "report.html").read_text(encoding="utf-8"))
        # The last moment is what a render of that moment and a joint with that number show.
        at = ("render", "bay.toml", "--camera", "B", "--size", "12x12", "--quiet")
        self.done(*at, "--set", "time.moment=2026-03-01T12:12:00", "-o", "a.exr")
        self.done(*at, "--set", "time.moment=2026-03-01T12:12:00", "--set", "joint.door.angle_deg=20", "-o", "b.exr")
        self.assertEqual(exr.read(self.folder / "a.exr")[3], exr.read(self.folder / "b.exr")[3])
        self.says(self.refused("inspect", "bay.toml", "--set", "time.moment=2026-03-01T12:20:00"),
                  "door.csv:4", "ends at 2026-03-01T12:12:00Z", "allowed are moments")

    def test_an_array_follows_the_sun_along_a_circle(self):
        """Bay to space, x is aft: at the position p after noon the Sun stands p deg from z toward x, and a turn by p about
        y takes z there."""
        self.write("bay.toml", BAY.replace('name = "box"\n', 'name = "box"\njoint = "array"\n') +
                   '[[joint]]\nname = "array"\npivot = [0, 0, 0.3]\naxis = [0, 1, 0]\nfollows = "sun"\nnormal = [0, 0, 1]\n')
        self.write("study.toml", 'format = 1\nscene = "bay.toml"\ncameras = ["B"]\nsize = "12x12"\ntargets = ["box"]\n'
                   '[orbit]\npositions_deg = [0, 40, 320]\n')
        study = self.json("study", "run", "study.toml", "-o", "out")
        self.assertEqual([(c["position_deg"], c["pose"]) for c in study["conditions"]],
                         [(0, "array 0 deg"), (40, "array 40 deg"), (320, "array -40 deg")])
        column = study["results"]["columns"].index("pixels")
        seen = {}
        for angle in (40, -40):
            still = BAY.replace('name = "box"\n', 'name = "box"\njoint = "array"\n') + (
                f'[[joint]]\nname = "array"\npivot = [0, 0, 0.3]\naxis = [0, 1, 0]\nangle_deg = {angle}\n')
            self.write("still.toml", still)
            self.write("there.toml", 'format = 1\nscene = "still.toml"\ncameras = ["B"]\nsize = "12x12"\ntargets = ["box"]\n'
                       f'[orbit]\npositions_deg = [{angle % 360}]\n')
            there = self.json("study", "run", "there.toml", "-o", f"there{angle}")
            seen[angle] = there["results"]["rows"][0][column]
        self.assertEqual([row[column] for row in study["results"]["rows"]][1:], [seen[40], seen[-40]])

    def test_a_camera_inside_a_body_at_one_pose_is_skipped_there(self):
        """The box swings over the camera D from 12:11 on; A looks at it from outside all the time."""
        camera = '[[camera]]\nname = "D"\nposition = [0, 1, 0.3]\nlook_at = [0, 0, 0.3]\nup = [0, 0, 1]\nfov_deg = 50\nresolution = [12, 12]\n'
        self.write("bay.toml", MISSION.replace('name = "box"\n', 'name = "box"\njoint = "slide"\n') + camera +
                   '[[track]]\nname = "slide"\nposes = "slide.csv"\n')
        self.write("slide.csv", "utc, x, y, z\n2026-03-01T12:00:00, 0, 0, 0\n2026-03-01T12:10:00, 0, 0, 0\n2026-03-01T12:11:00, 0, 1, 0\n")
        study = ('format = 1\nscene = "bay.toml"\ncameras = ["B", "D"]\nsize = "12x12"\n[time]\nstart = "2026-03-01T12:10:00"\n'
                 'stop = "2026-03-01T12:11:00"\nstep = 60\n[[picture]]\nname = "late"\ncamera = "D"\ntime = "2026-03-01T12:11:00"\n')
        for cameras in ('["B", "D"]', '["D"]'):
            self.write("study.toml", study.replace('["B", "D"]', cameras))
            run = self.run_program("study", "run", "study.toml", "-o", "out", "--json")
            self.assertEqual(run.returncode, 3, run.stderr)
            self.says(run.stderr, "skipped at 2026-03-01T12:11:00Z: ", 'camera "D"', '"box"',
                      'skipped: [[picture]] "late": camera "D" is inside a body at 2026-03-01T12:11:00Z',
                      "cameras inside a body were skipped: D at 2026-03-01T12:11:00Z")
            found = json.loads(run.stdout)
            self.says(json.dumps(found), 'is inside a body at 2026-03-01T12:11:00Z and was skipped')
            names = [camera["name"] for camera in found["cameras"]]
            with open(self.folder / "out" / "results.csv", encoding="utf-8") as file:
                seen = {(row["camera"], row["utc"][11:16]) for row in csv.DictReader(file)}
            self.assertEqual(seen, {(c, t) for c in names for t in ("12:10", "12:11")} - {("D", "12:11")})
        # At every pose: an error, as of render.
        self.write("study.toml", study.replace('["B", "D"]', '["D"]').replace("12:10:00", "12:10:59").replace("step = 60", "step = 0.5"))
        self.says(self.refused("study", "run", "study.toml", "-o", "no"), 'camera "D"', '"box"')

    def test_what_cannot_be_is_refused(self):
        self.says(self.refused("study", "orbit", "bay.toml", "--positions", "4", "-o", "no"), "trajectory", "[time]")
        self.says(self.refused("inspect", "bay.toml", "--set", "time.start=2026-03-02T12:00:00", "--set",
                               "time.stop=2026-03-02T13:00:00"),
                  "circle.oem", "no state at 2026-03-02T12:00:00Z", "2026-03-01T12:00:00Z to 2026-03-01T15:00:00Z")
        text = (self.folder / "circle.oem").read_text(encoding="utf-8")
        self.write("circle.oem", text[:-60])
        self.says(self.refused("inspect", "bay.toml"), "circle.oem:", "numbers behind its date")
        self.write("circle.oem", text.replace("EME2000", "MOON_ME"))
        self.says(self.refused("inspect", "bay.toml"), "circle.oem:9", "MOON_ME", "EME2000", "TEME")

    def test_two_line_elements_become_a_trajectory(self):
        python = next((p for p in (sys.executable, "/usr/bin/python3")
                       if subprocess.run([p, "-c", "import sgp4"], capture_output=True, check=False).returncode == 0), None)
        if python is None:
            self.skipTest("python3-sgp4 is not installed")
        self.write("iss.tle", TLE)
        self.script("tle_to_oem.py", "iss.tle", "-o", "circle.oem", "--start", "2008-09-20T12:25:40", "--stop",
                    "2008-264T14:25:40", python=python)
        facts = self.json("inspect", "bay.toml", "--set", "time.start=2008-09-20T12:25:40", "--set",
                          "time.stop=2008-09-20T14:25:40")["mission"]
        self.assertEqual((facts["object"], facts["frame"], facts["tai_minus_utc_s"]), ("ISS (ZARYA)", "TEME", 33))
        # Latitude asin(sin i sin u) with the argument of latitude u = 130.536 + 325.029 deg at the
        # epoch, which is the start: 51.6416 deg and 95.565 deg give 51.3 deg; the geodetic latitude
        # is 0.19 deg more.
        self.assertAlmostEqual(facts["latitude_deg"], 51.5, delta=0.2)
        # SGP4 is evaluated at microseconds, and the dates have them.
        self.script("tle_to_oem.py", "iss.tle", "-o", "fine.oem", "--start", "2008-09-20T12:25:40", "--stop",
                    "2008-09-20T12:25:42", "--step", "0.3333333", python=python)
        dates = [line.split()[0] for line in (self.folder / "fine.oem").read_text(encoding="utf-8").splitlines()
                 if line.startswith("2008")]
        self.assertEqual(dates[:3], [f"2008-09-20T12:25:40.{fraction}" for fraction in ("000000", "333333", "666667")])
        old = subprocess.run([python, SCRIPTS / "tle_to_oem.py", "iss.tle", "-o", "x.oem", "--start", "2026-03-01T12:00:00",
                              "--stop", "2026-03-01T13:00:00"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(old.returncode, 1)
        self.assertIn("days older", old.stderr)


if __name__ == "__main__":
    unittest.main()
