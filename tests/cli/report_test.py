# SPDX-License-Identifier: Apache-2.0
"""report: the page drawn from a study.json, its contents, its permissions, and errors."""
import html.parser
import json
import os
import re
import shutil
import unittest

import program
import report_sample
import study_table

SAMPLE = program.TOP / "tests" / "data" / "report"
HAS_SCRIPT = os.environ.get("EARTHSHINE_REPORT_SCRIPT") == "ON"
EVIL = "</script><img src=x onerror=alert(1)>\"'&"
# Elements whose end tag is optional.
OPTIONAL = {"p", "li", "td", "th", "tr", "dt", "dd", "option"}
VOID = {"meta", "img", "br", "col", "input", "link"}


class Page(html.parser.HTMLParser):
    """Collects the elements and the text without style and script; checks that all elements are
    closed."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.faults, self.open, self.words, self.blocks = [], [], [], [], {}
        self.feed(text)
        self.faults += [f"<{name}> is not closed" for name in self.open if name not in OPTIONAL]
        self.text = " ".join("".join(self.words).split())

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag != "i":  # the rest of a word in the matrix
            self.words.append(" ")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        while self.open and self.open[-1] != tag and self.open[-1] in OPTIONAL:
            self.open.pop()
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] in ("style", "script"):
            kind = next(a for t, a in reversed(self.elements) if t == self.open[-1]).get("type", "")
            self.blocks[f"{self.open[-1]} {kind}".strip()] = data
        else:
            self.words.append(data)

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


class Report(program.Case):
    def study(self, results=None, *arguments):
        """Writes a study's folder, draws its report, returns the page's text."""
        folder = self.folder / "study"
        shutil.copytree(SAMPLE, folder, dirs_exist_ok=True)
        if results is not None:
            (folder / "study.json").write_text(json.dumps(study_table.closed(results)), encoding="utf-8")
        self.done("report", "study", *arguments)
        return (folder / "report.html").read_text(encoding="utf-8")

    def refused_study(self, results, *parts):
        folder = self.folder / "bad"
        folder.mkdir(exist_ok=True)
        text = results if isinstance(results, str) else json.dumps(study_table.closed(results))
        (folder / "study.json").write_text(text, encoding="utf-8")
        self.says(self.refused("report", "bad"), *parts)
        self.assertFalse((folder / "report.html").exists())


class Content(Report):
    def test_the_sample_is_what_its_script_makes(self):
        self.assertEqual(json.loads((SAMPLE / "study.json").read_text(encoding="utf-8")), study_table.closed(report_sample.study()))

    def test_everything_is_there_without_a_script(self):
        page = Page(self.study(None, "--plain"))
        self.assertEqual(page.faults, [])
        self.assertEqual(page.all("script"), [])
        for part in ("short", "notes", "answers", "summary", "targets", "pictures", "figures", "setup", "provenance"):
            self.assertIn({"id": part, "aria-labelledby": f"{part}-title"}, page.all("section"))
            self.assertIn({"href": f"#{part}"}, page.all("a"))
        study = report_sample.study()
        for text in (study["name"], "The plain report", "scene_digest 5d3e0f1a2b4c6978", "is not simulated",
                     study["answers"][0]["text"], "Camera B by night, clean and CCTV", "the tail stands in front",
                     "288 results", "bay lamps on", "Eclipse: 135° to 225°. Penumbra: 120°, 240°."):
            self.assertIn(text, page.text)
        # Three pictures, one of them with two exposures; each is embedded once for any number of
        # pairs.
        self.assertEqual(len(page.all("img")), 3 + 1 + 2 * len(study["thumbnails"]))
        self.assertTrue(all(image["alt"] for image in page.all("img")))
        rows = [row for row in page.all("tr") if re.fullmatch(r"r\d+", row.get("id", ""))]
        self.assertEqual(len(rows), len(study["results"]))
        cells = [cell for cell in page.all("td") if "data-r" in cell]
        self.assertEqual(len(cells), len(study["results"]))

    def test_headings_tables_and_landmarks(self):
        page = Page(self.study(None, "--plain"))
        self.assertEqual(page.all("html"), [{"lang": "en"}])
        levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch("h[1-6]", tag)]
        self.assertEqual(levels[0], 1)
        self.assertTrue(all(after - before <= 1 for before, after in zip(levels, levels[1:])))
        self.assertEqual(levels.count(1), 1)
        for landmark in ("header", "nav", "main"):
            self.assertEqual(len(page.all(landmark)), 1)
        self.assertEqual(len(page.all("table")), len(page.all("caption")))
        self.assertTrue(all("scope" in head for head in page.all("th")))
        self.assertEqual(next(a for t, a in page.elements if t == "a")["class"], "skip")

    def test_nothing_is_loaded_and_nothing_foreign_runs(self):
        text = self.study()
        page = Page(text)
        policy = next(m["content"] for m in page.all("meta") if "http-equiv" in m)
        self.says(policy, "default-src 'none'", "img-src data:", "base-uri 'none'", "form-action 'none'")
        self.assertNotIn("unsafe-inline'; base", policy)
        for tag, attributes in page.elements:
            self.assertNotIn(tag, ("link", "iframe", "object", "embed", "base"))
            self.assertFalse([name for name in attributes if name.startswith("on")])
            for name in ("src", "href", "srcset", "action", "poster"):
                self.assertRegex(attributes.get(name, "#"), r"^(#|data:image/png;base64,)")
        self.assertNotRegex(page.blocks["style"], r"url\(|@import")
        self.assertLess(len(re.sub(r"data:image/png;base64,[^\"]*", "", text)), 2_000_000)

    @unittest.skipUnless(HAS_SCRIPT, "built without the script")
    def test_the_script_is_named_in_the_policy_and_its_data_is_json(self):
        import base64
        import hashlib
        text = self.study()
        page = Page(text)
        self.assertEqual(page.faults, [])
        digest = base64.b64encode(hashlib.sha256(page.blocks["script"].encode()).digest()).decode()
        self.assertIn(f"script-src 'sha256-{digest}'", text)
        data = json.loads(page.blocks["script application/json"])
        self.assertEqual(len(data["timelines"]), 2 * 3 * 2)  # cameras, targets, lamp settings
        self.assertEqual(data["timelines"][0]["x"][:2], [0, 15])
        self.says(page.text, "@observablehq/plot", "img-comparison-slider", "(ISC)", "(MIT)")

    @unittest.skipIf(HAS_SCRIPT, "built with the script")
    def test_without_node_the_plain_page_is_written_and_said_to_be(self):
        shutil.copytree(SAMPLE, self.folder / "study")
        run = self.run_program("report", "study")
        self.assertEqual((run.returncode, run.stderr.count("note:")), (0, 1))
        self.says(run.stderr, "without Node.js", "plain")
        self.assertEqual(self.run_program("report", "study", "-q").stderr, "")

    def test_same_bytes_again(self):
        self.assertEqual(self.study(), self.study())


class Safety(Report):
    def evil_study(self):
        """Each text of the sample that a user may choose is replaced by markup."""
        text = json.dumps(report_sample.study(positions=6))
        for word in ("tss", "bay lamps on", "STS-46 payload bay", "is not simulated", "by the Earth", "5d3e0f1a2b4c6978",
                     "tone-mapped", "size", "GCC", "the tail stands", "c0"):
            text = text.replace(word, word + json.dumps(EVIL)[1:-1])
        return json.loads(text)

    def test_no_text_breaks_out(self):
        plain, evil = Page(self.study(report_sample.study(positions=6))), Page(self.study(self.evil_study()))
        self.assertEqual(evil.faults, [])
        self.assertEqual([tag for tag, _ in evil.elements], [tag for tag, _ in plain.elements])
        self.assertEqual([sorted(a) for _, a in evil.elements], [sorted(a) for _, a in plain.elements])
        self.assertIn(EVIL, evil.text)

    def test_a_name_that_turns_the_direction_of_writing_is_isolated(self):
        # UAX #9: U+2069 ends the text that U+2068 begins, with the overrides in it; a U+2069 in the
        # name must not end it.
        text = json.dumps(report_sample.study(positions=4))
        plain = self.study(json.loads(text))
        self.assertNotIn("\u2068", plain)
        for camera, target in (("\u202eB", "flag"), ("a\u2067b", "flag"), ("B", "\u05d0\u05d1")):
            study = json.loads(text.replace('"B"', json.dumps(camera)).replace('"eureca"', json.dumps(target)))
            page = self.study(study)
            name = camera if camera != "B" else target
            shown = page.split('<script type="application/json"')[0]
            texts = [text for text in re.split('[<>"]', shown) if name in text]
            self.assertGreater(len(texts), 2)
            for piece in texts:
                self.assertEqual(re.search("[\u0590-\u08ff\u202a-\u202e\u2066-\u2069]", piece).group(), "\u2068", piece)
                self.assertEqual(len(re.findall("[\u2067\u2068]", piece)), piece.count("\u2069"), piece)
        study = json.loads(text)
        study["name"] = "x\u202epay\u2069load"
        self.assertIn("<h1>\u2068x\u202epay\ufffdload\u2069</h1>", self.study(study))

    def test_broken_text_and_control_characters(self):
        study = report_sample.study(positions=4)
        study["name"] = "a\u0000b\u001bc\ud800"
        folder = self.folder / "study"
        shutil.copytree(SAMPLE, folder)
        (folder / "study.json").write_bytes(json.dumps(study_table.closed(study)).replace("\\ud800", "x").encode().replace(b"STS-46 payload", b"\xff\xc0\xaf"))
        run = self.run_program("report", "study")
        self.assertIn(run.returncode, (0, 2))  # a parser may refuse bytes that are not text
        if run.returncode == 0:
            (folder / "report.html").read_bytes().decode("utf-8")

    def test_pictures_are_inside_the_folder_and_png(self):
        study = report_sample.study(positions=4)
        self.write("secret.png", (SAMPLE / "pictures" / "day-b.png").read_bytes())
        for file, part in (("../secret.png", "not inside"), ("/etc/passwd", "not inside"), ("", "not inside"),
                           ("none.png", "none.png"), ("study.json", "not a PNG")):
            study["figures"] = [{"file": file, "caption": "x"}]
            study["pairs"] = []
            self.refused_study(study, part)


class Studies(Report):
    def test_nothing_to_see_is_said(self):
        empty = {"format": 2, "study": "visibility", "name": "nothing", "version": "0", "scenes": [], "cameras": [],
                 "targets": [], "conditions": [], "results": []}
        self.says(Page(self.study(empty)).text, "no camera", "0 results")
        full = report_sample.study(positions=4)
        self.says(Page(self.study(full | {"targets": [], "results": []})).text, "no object as a target")
        self.says(Page(self.study(full | {"conditions": [], "results": [], "thumbnails": []})).text, "no condition")
        self.says(Page(self.study(full | {"results": []})).text, "no result yet")
        blind = full | {"results": [report_sample.out_of_view(r["condition"], r["camera"], r["target"])
                                    for r in full["results"]]}
        text = Page(self.study(blind)).text
        self.says(text, "No camera has a target in view")
        self.assertNotRegex(text, r"(?i)\bnan\b|\bnull\b")

    def test_stopped_early_is_said_at_the_top(self):
        study = report_sample.study(positions=4)
        self.assertNotIn("Not complete", self.study(study))
        study["complete"] = False
        study["results"] = study["results"][:7]
        page = Page(self.study(study))
        self.says(page.text, "Not complete.", "no result")
        self.assertLess(page.text.index("Not complete."), page.text.index("Summary"))

    def test_conditions_without_a_position_stand_in_one_matrix(self):
        study = report_sample.study(positions=1)
        for condition in study["conditions"]:
            condition |= {"position_deg": None, "time_s": None, "phase": None, "sun_share": None}
        page = Page(self.study(study))
        self.assertEqual(len([t for t in page.all("table") if "matrix" in t.get("class", "")]), 1)
        self.assertEqual([a for a in page.all("figure") if a.get("class") == "timeline"], [])

    def test_a_large_study_stays_small_enough_to_open(self):
        study = report_sample.study(positions=90, cameras=4, targets=5, lamps=3)
        self.assertEqual(len(study["results"]), 5400)
        text = self.study(study)
        page = Page(text)
        self.assertEqual(page.faults, [])
        self.assertLess(len(re.sub(r"data:image/png;base64,[^\"]*", "", text).encode()), 2_000_000)
        self.assertEqual(len([cell for cell in page.all("td") if "data-r" in cell]), 5400)
        self.says(page.text, "the columns that decide")

    def test_figures_that_do_not_exist_are_dashes(self):
        study = report_sample.study(positions=4)
        for entry in study["results"]:
            entry |= {"luminance": None, "signal": None, "monitor": None, "eye": None, "probability": None}
        page = Page(self.study(study))
        self.assertIn("–", page.text)
        self.assertNotRegex(page.text, r"(?i)\bnan\b|\bnull\b")


class Reading(Report):
    """Information for a planner on the page."""

    def page(self, results=None):
        return Page(self.study(results, "--plain"))

    def test_the_first_lines_state_the_orbit(self):
        text = self.study(None, "--plain")
        page = Page(text)
        self.says(page.text, "0° noon, 90° the evening terminator below, 180° midnight, 270° the morning terminator",
                  "altitude 400 km, one turn in 92.2 min", "6°. The Earth hides the Sun at 121° to 239°",
                  "the bay faces the Earth, nose forward")
        self.assertLess(page.text.index("the bay faces the Earth"), page.text.index("Best cameras"))
        # The Sun is at the left, the motion counterclockwise: on a circle of 62 about (180, 108)
        # noon is at (118, 108) and 90 deg at (180, 170), y downward. An axis of length 26 toward
        # the Earth points right at noon and up at 90 deg.
        self.says(text, 'class="bay" d="M118.0 108.0l26.0 0.0"', 'class="bay" d="M180.0 170.0l0.0 -26.0"')
        self.assertEqual(text.count('class="bay"'), 4)
        study = report_sample.study(positions=4)
        study["scenes"][0]["orbit"] |= {"attitude": "inertial", "inertial_as": "bay-to-sun", "inertial_at_deg": 90, "umbra_deg": [],
                                        "bay": [{"position_deg": 0, "zenith": 0, "forward": 0, "normal": 1}]}
        text = self.study(study, "--plain")
        self.says(Page(text).text, "fixed among the stars, as at 90°, where the bay faces the Sun", "never hides all of the Sun")
        self.says(text, '<circle class="bay" cx="118.0" cy="108.0"')  # toward the reader
        del study["scenes"][0]["orbit"]
        self.assertNotIn("<svg", self.study(study, "--plain"))

    def test_the_figure_that_decides_stands_beside_the_reason(self):
        def shown(verdict, weber=0.5, threshold=0.1, snr_d=9.0, cycles=0.0, visible=0.9):
            study = report_sample.study(positions=1, cameras=1, targets=1, lamps=1)
            entry, = study["results"]
            entry["monitor"] |= {"weber": weber, "threshold": threshold}
            entry["signal"] |= {"snr_d": snr_d}
            study["results"] = [entry | {"verdict": verdict, "johnson_cycles": cycles, "visible_fraction": visible, "why": "dim"}]
            return self.page(study).text
        self.says(shown("not-seen", weber=-0.23, threshold=0.34), "contrast on the monitor 0.23, threshold 0.34")
        # Enough digits to distinguish it from its threshold.
        self.says(shown("not-seen", weber=0.0652, threshold=0.0654), "contrast on the monitor 0.0652, threshold 0.0654")
        self.says(shown("not-seen", snr_d=1.4), "signal to noise 1.4, threshold 2.8")
        # The smaller ratio: 0.5 of the threshold of contrast, 0.4 of the threshold of noise.
        self.says(shown("not-seen", weber=0.05, snr_d=1.12), "signal to noise 1.1, threshold 2.8")
        # Johnson: 1 cycle for detection, 4 for recognition, 6.4 for identification.
        for verdict, needed in (("doubtful", "1"), ("detected", "4"), ("recognised", "6.4")):
            self.says(shown(verdict, cycles=0.7), f"cycles across it 0.7, needed {needed}")
        self.says(shown("hidden", visible=0.02), "2 % of it visible, 10 % needed")

    def test_an_answer_names_camera_and_condition(self):
        text = self.page().text
        # 255 to 465 deg passes noon: angles are in [0, 360).
        self.says(text, "camera B", "detected at 255° to 105°, 200° to 210°",
                  "this camera needs 12 % of these lamps at 180°, where it is darkest")
        study = report_sample.study(positions=4)
        study["answers"][0]["arcs_deg"] = [[-243, 63], [0, 360]]
        self.says(self.page(study).text, "detected at the whole orbit")
        study["answers"][0]["arcs_deg"] = [[-243, 63]]
        self.says(self.page(study).text, "detected at 117° to 63°")

    def test_hidden_is_not_out_of_view(self):
        text = self.page().text
        self.says(text, "Camera C, eureca, lamps: off Outside the camera’s view.",
                  "Camera C, grapple-fixture, lamps: off In the camera’s view, but hidden at every position.")
        self.assertNotIn("Never in view", text)
        study = report_sample.study(positions=4)
        for entry in study["results"]:
            if entry["camera"] == "C" and entry["target"] == "eureca" and entry["condition"] == "c0":
                entry["verdict"] = "hidden"
        self.says(self.page(study).text, "Hidden at 0°; outside the camera’s view at 90° to 270°.")
        # What is left of a hidden target may well be detected: that is not the target.
        for entry in study["results"]:
            if entry["camera"] == "B" and entry["target"] == "eureca":
                entry["verdict"] = "hidden"
        text = self.page(study).text
        self.says(text, "Camera B, eureca, lamps: off In the camera’s view, but hidden at every position.")
        self.assertNotIn("Camera B, eureca, lamps: off Likely", text)

    def test_scenes_are_called_by_their_names(self):
        study = report_sample.two_scenes(report_sample.study(positions=4))
        text = self.study(study, "--plain")
        page = Page(text)
        self.says(page.text, "2 scenes, 2 cameras, 3 targets", "STS-46 payload bay, lamps: off", "open doors, lamps: off")
        self.assertNotRegex(page.text, r"\bs[01]\b")
        self.says(page.text, "render STS-46 payload bay B")
        self.assertEqual({a["data-scene"] for _, a in page.elements if "data-scene" in a}, {"STS-46 payload bay", "open doors"})
        self.assertEqual(text.count("<svg"), 1)  # one orbit
        study["scenes"][1]["name"] = study["scenes"][0]["name"]
        study["scenes"][1]["path"] = "doors/open.toml"
        self.says(self.page(study).text, "STS-46 payload bay (day-earthshine.toml)", "STS-46 payload bay (open.toml)")

    def test_each_picture_states_its_exposure(self):
        # White of EV 0 at ISO 100 is 78 / 65 = 1.2 cd/m^2: 9600 is 2^12.97 times, 4800 half of it.
        self.says(self.page().text, "EV 13.0, white at 9600 cd/m²", "EV 12.0, white at 4800 cd/m²", "EV 0.0, white at 1.2 cd/m²")


class Refusals(Report):
    def test_what_is_no_study(self):
        self.says(self.refused("report", "nowhere"), "nowhere/study.json", "cannot be read", 'no folder "nowhere"')
        self.refused_study("{\"format\": 1,", "study.json", "not JSON")
        self.refused_study("{\"format\": 1, \"x\": 1e400}", "study.json", "too large")
        self.refused_study("", "not JSON")
        self.refused_study([1, 2], "not the result of a study")
        self.refused_study({"study": "compare"}, "not the result of a study")
        self.refused_study({"format": 1, "study": "visibility"}, "format is 1", "reads 2", "Run the study again")
        self.refused_study({"format": 2, "study": "compare"}, "compare", "visibility")
        self.refused_study({"format": 2, "study": "visibility"}, "scenes is missing")

    def test_the_place_of_a_fault_is_named(self):
        def broken(part, key, value):
            study = report_sample.study(positions=4)
            study[part][3][key] = value
            return study
        self.refused_study(broken("results", "verdict", "perhaps"), "results.rows[3].verdict", "perhaps", "not-seen")
        self.refused_study(broken("results", "camera", "Z"), "results.rows[3].camera", "Z", "cameras")
        self.refused_study(broken("results", "condition", "c99"), "results.rows[3].condition", "c99")
        self.refused_study(broken("results", "target", 7), "results.rows[3].target is a number", "a text")
        self.refused_study(broken("results", "pixels", "many"), "results.rows[3].pixels is a text")
        self.refused_study(broken("results", "signal", 1), "results.rows[3].signal is a number")
        self.refused_study(broken("conditions", "phase", "dusk"), "conditions[3].phase", "dusk")
        short = study_table.closed(report_sample.study(positions=4))
        short["results"]["rows"][3] = short["results"]["rows"][3][:5]
        self.refused_study(short, "results.rows[3]", "no row", "cells")
        short["results"] = {"columns": ["signal", "signal.mean"], "rows": [[1, 2]]}
        self.refused_study(short, "results.columns", "signal.mean", "twice")
        doubled = report_sample.study(positions=4)
        doubled["results"].append(doubled["results"][0])
        self.refused_study(doubled, "once more")

    def test_usage(self):
        self.says(self.refused("report"), "DIR is required")
        self.says(self.done("report", "--help"), "study.json", "--plain")


if __name__ == "__main__":
    unittest.main()
