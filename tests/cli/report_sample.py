# SPDX-License-Identifier: Apache-2.0
"""A study.json in the format of a visibility study, of any size, for tests of the report.

usage: report_sample.py OUT.json    writes tests/data/report/study.json

Its figures follow simple laws (a Sun that rises over the bay, lamps of two settings, an eclipse),
so that the page looks realistic; none is a result of the program.
"""
import json
import math
import sys

import study_table

LAMPS = {"off": 0.0, "bay lamps on": 1.0, "dimmed": 0.3}
CAMERAS = ["B", "C", "A", "D"]
WAYS = ["liner", "eureca-arrays", "forward-bulkhead", "aft-bulkhead", "eureca-deck", "tss-deployer", "sills", "arm"]
TARGETS = ["tss", "eureca", "grapple-fixture", "keel-trunnion", "door-edge"]
PERIOD_S = 5530.0
ECLIPSE = (121.0, 239.0)  # degrees of the orbit without the Sun
ORBIT = {"altitude_km": 400, "beta_deg": 6, "period_s": PERIOD_S, "position_deg": 0, "attitude": "bay-to-earth",
         "umbra_deg": [list(ECLIPSE)], "penumbra_deg": [[117, 243]],
         "bay": [{"position_deg": place, "zenith": -1, "forward": 0, "normal": 0} for place in (0, 90, 180, 270)]}


def rounded(value, digits=4):
    return None if value is None else float(f"{value:.{digits}g}")


def sun_share(position):
    """Visible share of the Sun's disc, linear over 4 degrees at both ends of the eclipse."""
    inside = min(position - ECLIPSE[0], ECLIPSE[1] - position)
    return min(1.0, max(0.0, 0.5 - inside / 4.0))


def phase(share):
    return "day" if share == 1 else "eclipse" if share == 0 else "penumbra"


def chances(cycles, cnr):
    """Johnson's curve with 1, 4 and 6.4 cycles, reduced by noise."""
    def one(needed):
        ratio = cycles / needed
        power = ratio ** (2.7 + 0.7 * ratio)
        return power / (1 + power) * (1 - math.exp(-max(cnr, 0) / 3))
    return {"detect": rounded(one(1), 3), "recognise": rounded(one(4), 3), "identify": rounded(one(6.4), 3)}


def verdict_of(probability):
    for verdict, key in (("identified", "identify"), ("recognised", "recognise"), ("detected", "detect")):
        if probability[key] >= 0.5:
            return verdict
    return "doubtful" if probability["detect"] >= 0.1 else "not-seen"


def out_of_view(condition, camera, target):
    return {"condition": condition, "camera": camera, "target": target, "verdict": "out-of-view",
            "probability": None, "pixels": 0, "visible_fraction": None, "cut_by_frame": False,
            "lit_fraction": None, "lit_by": {}, "light_by": {}, "angle_deg": None, "tv_lines": None,
            "luminance": None, "surround": None, "weber": None, "signal": None, "monitor": None, "eye": None,
            "finished_by": "error",
            "johnson_cycles": None, "saturated": None, "crushed": None, "luminance_error": None,
            "why": f"{target} is outside what camera {camera} sees",
            "reasons": [{"cause": "out-of-view", "by": None, "share": None, "probability_without": None,
                         "text": "no ray through the picture meets it"}]}


def reasons_of(target, sun, lamp, cnr, saturated, visible):
    found = []
    if visible < 0.5:
        found.append({"cause": "hidden", "by": "tail", "share": rounded(1 - visible, 3), "probability_without": 0.95,
                      "text": f"the tail stands in front of {100 * (1 - visible):.0f} % of it"})
    if sun == 0 and lamp == 0:
        found.append({"cause": "unlit", "by": None, "share": None, "probability_without": 0.97,
                      "text": "neither Sun nor lamp; what light there is comes from the night side of the Earth"})
    if saturated > 0.05:
        found.append({"cause": "saturated", "by": "sun", "share": rounded(saturated, 3), "probability_without": 0.9,
                      "text": f"{100 * saturated:.0f} % of it is at white"})
    if cnr < 5:
        found.append({"cause": "noise", "by": None, "share": None, "probability_without": rounded(0.6 + cnr / 20, 3),
                      "text": f"contrast to noise {cnr:.1f}; 5 are wanted"})
    return found


def result(condition, position, lamps, camera, target):
    c, t = CAMERAS.index(camera), TARGETS.index(target)
    if c == 1 and t == 1:
        return out_of_view(condition, camera, target)
    if c == 1 and t == 2:
        return out_of_view(condition, camera, target) | {
            "verdict": "hidden", "visible_fraction": 0, "why": "hidden by arm (100 % of it)",
            "reasons": [{"cause": "hidden", "by": "arm", "share": 1, "probability_without": None,
                         "text": "hidden by arm (100 % of it)"}]}
    sun, lamp = sun_share(position), LAMPS[lamps]
    height = max(0.0, round(math.cos(math.radians(position - 20 * t)), 6))
    by = {"sun": 9000 * sun * height / (1 + t), "earth": 160 * sun * (0.3 + 0.7 * height) + (0.3 if t == 0 else 0.004),
          "bay-lamps": 11.0 * lamp / (1 + 0.5 * t)}
    luminance = sum(by.values())
    visible = [0.93, 0.41, 0.77, 0.6, 0.85][t]
    saturated = min(0.6, luminance / 40000)
    weber = 0.9 - 0.35 * c + 0.2 * math.sin(math.radians(position))
    cnr = 14 * luminance / (luminance + 3) * abs(weber)
    cycles = [12.0, 7.0, 5.0, 3.0, 2.0][t] * (1 - 0.2 * c)
    probability = chances(cycles, cnr)
    verdict = verdict_of(probability)
    if t == 2 and 300 <= position <= 330:
        verdict, probability, visible = "hidden", {"detect": 0.0, "recognise": 0.0, "identify": 0.0}, 0.0
    reasons = [] if verdict == "identified" else reasons_of(target, sun, lamp, cnr, saturated, visible)
    why = reasons[0]["text"] if reasons else ("" if verdict == "identified" else "it is small in the picture")
    lit = {name: value > 0 for name, value in (("sun", sun * height), ("bay-lamps", lamp))}
    return {"condition": condition, "camera": camera, "target": target, "verdict": verdict,
            "probability": probability, "pixels": int(2400 * visible / (1 + t)), "visible_fraction": visible,
            "cut_by_frame": t == 1, "lit_fraction": rounded(0.7 if any(lit.values()) else 0.0),
            "lit_by": {name: 0.6 if name == "sun" else 0.5 for name, on in lit.items() if on},
            "light_by": {name: rounded(value) for name, value in by.items() if value > 0},
            "light_from": {"earth": 0.5}, "light_by_way_of": {name: 0.04 for name in WAYS},
            "angle_deg": rounded(cycles / 4), "tv_lines": rounded(2 * cycles), "luminance": rounded(luminance),
            "surround": rounded(luminance / (1 + weber)), "weber": rounded(weber),
            "signal": {"mean": rounded(min(1, luminance / 400)), "surround": rounded(min(1, luminance / 700)),
                       "weber": rounded(0.8 * weber), "snr": rounded(2.5 * cnr), "cnr": rounded(cnr),
                       "rose": rounded(20 * cnr), "dprime": rounded(22 * cnr)} if c == 0 else None,
            "monitor": {"luminance": rounded(min(90, luminance)), "surround": rounded(min(60, luminance / 2)),
                        "weber": rounded(0.7 * weber), "threshold": 0.06} if c == 0 else None,
            "eye": {"threshold": 0.012, "weber": rounded(weber), "probability": chances(3 * cycles, 3 * cnr),
                    "cycles": rounded(3 * cycles)},
            "johnson_cycles": rounded(cycles), "saturated": rounded(saturated), "crushed": 0.0,
            "luminance_error": 0.02, "finished_by": "error", "why": why, "reasons": reasons}


def study(positions=24, cameras=2, targets=3, lamps=2):
    """A study as a value. Its pictures are in tests/data/report."""
    cameras, targets, lamps = CAMERAS[:cameras], TARGETS[:targets], list(LAMPS)[:lamps]
    places = [round(360 * k / positions, 3) for k in range(positions)]
    conditions = {}
    for setting in lamps:
        for place in places:
            share = sun_share(place)
            conditions[f"c{len(conditions)}"] = {
                "id": f"c{len(conditions)}", "scene": "s0", "name": f"orbit {place:g} deg, lamps {setting}",
                "lamps": setting, "position_deg": place, "time_s": round(place / 360 * PERIOD_S),
                "sun_share": rounded(share), "phase": phase(share), "factors": {"bay-lamps": LAMPS[setting]},
                "earth_error": 0.004}
    results = [result(name, condition["position_deg"], condition["lamps"], camera, target)
               for name, condition in conditions.items() for camera in cameras for target in targets]
    return {
        "format": 2, "study": "visibility", "name": "STS-46, day and night", "version": "0.1.0", "complete": True,
        "scenes": [{"id": "s0", "name": "STS-46 payload bay", "path": "scenes/library/sts46/day-earthshine.toml",
                    "orbit": ORBIT}],
        "cameras": [{"scene": "s0", "name": camera, "columns": 512, "rows": 512, "fov_deg": 40,
                     "cctv": "sit-monochrome" if k == 0 else None, "iris": "average" if k == 0 else None,
                     "relative_noise": 0.021, "error_text": "within 5 % of the exact light, as the picture states itself",
                     "render_seconds": 4.2} for k, camera in enumerate(cameras)],
        "targets": targets, "conditions": list(conditions.values()), "results": results,
        "answers": [
            {"wanted": "tss>=0.9", "target": "tss", "least": 0.9, "found": True, "camera": "B", "iris": "peak",
             "lamps": "bay lamps on", "least_factor": 0.12, "darkest_deg": 180, "arcs_deg": [[255.0, 465.0], [200.0, 210.0]],
             "text": "Camera B detects tss with at least 0.9 over 220 of 360 degrees with the bay lamps at 0.12 or more."},
            {"wanted": "eureca>=0.99", "target": "eureca", "least": 0.99, "found": False, "camera": None, "iris": None,
             "lamps": None, "least_factor": None, "arcs_deg": [],
             "text": "No camera, iris or lamp setting detects eureca with 0.99; camera B comes nearest with 0.97."}],
        "pairs": [
            {"title": "Camera B, day and night", "left": {"file": "pictures/day-b.png", "caption": "day, lit by the Earth"},
             "right": {"file": "pictures/night-b.png", "caption": "night, bay lamps on"}},
            {"title": "Camera B by night, clean and CCTV", "left": {"file": "pictures/night-b.png", "caption": "clean"},
             "right": {"file": "pictures/night-b-cctv.png", "caption": "on the CCTV monitor"}}],
        "figures": [{"file": "pictures/day-b.png", "caption": "Camera B by day, tone-mapped", "clean": True, "white_cd_m2": 9600,
                     "same_file": "pictures/night-b.png", "same_white_cd_m2": 4800}],
        "thumbnails": [
            {"condition": name, "camera": cameras[0], "file": "pictures/night-b.png",
             "monitor_file": "pictures/night-b-cctv.png", "white_cd_m2": 1.2}
            for name, condition in conditions.items() if condition["position_deg"] in (0, 180) or positions <= 12],
        "settings": {"positions": positions, "size": "512x512", "iris": "average", "wanted": "tss>=0.9, eureca>=0.99"},
        "provenance": {"program": "earthshine 0.1.0", "compiler": "GCC 12.2", "seed": 1,
                       "libraries": {"embree": "3.13.5", "Eigen": "3.4.0"}, "scene_digest": "5d3e0f1a2b4c6978"},
        "costs": [{"stage": "solve s0", "seconds": 4.1, "rays": 980000},
                  {"stage": "render s0 B", "seconds": 4.2, "rays": 12400000},
                  {"stage": "degrade", "seconds": 1.3, "rays": None}],
        "notes": ["Targets stand still; what a crew would search for is where the scene has it.",
                  "The room light on the monitor's glass is not simulated."]}


def two_scenes(study):
    """The results again in another scene, with cameras of the same names."""
    study["scenes"].append(study["scenes"][0] | {"id": "s1", "name": "open doors"})
    study["cameras"] += [camera | {"scene": "s1"} for camera in study["cameras"]]
    again = {condition["id"]: condition | {"id": "d" + condition["id"], "scene": "s1"} for condition in study["conditions"]}
    study["results"] += [entry | {"condition": again[entry["condition"]]["id"]} for entry in study["results"]]
    study["conditions"] += again.values()
    return study


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        json.dump(study_table.closed(study()), out, ensure_ascii=False, separators=(",", ":"))
        out.write("\n")
