# SPDX-License-Identifier: Apache-2.0
"""Calling the program: help, version, wrong calls and their exit codes."""
import unittest

import program

COMMANDS = ["render", "solve", "form-factors", "plan", "inspect", "degrade", "fit-phong", "study"]


class Help(program.Case):
    def test_help_lists_every_command(self):
        text = self.done("--help")
        self.says(text, "--version", "--threads", "--seed", *COMMANDS)

    def test_each_command_has_help(self):
        for command in COMMANDS:
            text = self.done(command, "--help")
            self.says(text, "General:", "-j, --threads", "--seed", "-q, --quiet")
        self.says(self.done("render", "-h"), "--camera", "--size", "--png", "--cctv", "--indirect",
                  "--distributed-lights", "--error", "--set", "--aov", "--per-light", "--timings",
                  "--json", "radiosity", "distributed")

    def test_help_fits_a_terminal_and_breaks_between_words(self):
        for command in [[], *([command] for command in COMMANDS), ["degrade", "certify"], ["study", "visibility"],
                        ["study", "orbit"], ["study", "accuracy"], ["study", "compare"], ["study", "run"]]:
            text = self.done(*command, "--help")
            self.assertLessEqual(max(map(len, text.splitlines())), 80, command)
            self.assertNotIn("\nOptions:", text)  # each option is in a group
            self.says(text, "Usage: earthshine " + "".join(word + " " for word in command) + "[OPTIONS]")
        # Words are not split: the lines of an entry, joined, are its sentence.
        self.says(" ".join(self.done("render", "--help").split()),
                  "--indirect HOW radiosity (default), distributed (many lights, no interreflection), none, paths (slow reference)")
        # One name with two meanings: output here, input there.
        self.assertRegex(self.done("render", "--help"), r"(?s)Output:.*--cctv FILE")

    def test_options_that_do_nothing_are_not_offered(self):
        self.says(self.refused("inspect", "box.toml", "--error", "0.1"), 'unknown option "--error"')
        self.says(self.done("report", "--help"), "[OPTIONS] DIR\n", "  DIR  ")

    def test_version(self):
        self.assertRegex(self.done("--version"), r"^earthshine \d+\.\d+\.\d+\n$")


class WrongCalls(program.Case):
    def setUp(self):
        super().setUp()
        self.write("box.toml", program.CLOSED_BOX)

    def test_no_command(self):
        self.says(self.refused(), "no command is named", "--help", *COMMANDS)
        self.says(self.refused("study"), "no study is named", "visibility, compare, accuracy, orbit, run")

    def test_options_that_do_not_go_together_or_alone_or_twice(self):
        call = ("render", "box.toml", "-o", "a.exr")
        self.says(self.refused(*call, "--crop", "0,0,2x2", "--only-pixel", "1,1"), "excludes", "Leave one of the two out")
        self.says(self.refused(*call, "--wait", "3"), "--wait requires --part", "Add it")
        self.says(self.refused(*call, "--error", "0.1", "--error", "0.2"), "--error is given more than once", "Write it once")

    def test_unknown_command_names_the_nearest(self):
        self.says(self.refused("rendr", "box.toml"), 'unknown command "rendr"', 'did you mean "render"?')

    def test_unknown_command_lists_all(self):
        self.says(self.refused("sketch", "box.toml"), 'unknown command "sketch"', *COMMANDS)

    def test_unknown_option_names_the_nearest(self):
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--camra", "A"),
                  'unknown option "--camra"', 'did you mean "--camera"?')
        self.says(self.refused("solve", "box.toml", "--seeds=3"), 'unknown option "--seeds"', '"--seed"')

    def test_unknown_option_names_one_of_the_same_meaning_or_lists_all(self):
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--samples", "64"), 'did you mean "--error"?')
        text = self.refused("render", "box.toml", "-o", "a.exr", "--sparkle")
        self.says(text, 'unknown option "--sparkle"', "--camera", "--png", "--indirect")
        self.assertNotIn("did you mean", text)

    def test_an_error_in_percent_is_recognised(self):
        for call in ("render", "solve"):
            self.says(self.refused(call, "box.toml", "-o", "a", "--error", "5"), "5 means 500 %; did you mean 0.05?")
            for slip in ("5%", "0,05"):
                self.says(self.refused(call, "box.toml", "-o", "a", "--error", slip), slip, "did you mean 0.05?")
        self.says(self.refused("render", "box.toml", "-o", "a", "--error", "500"), "above 0 and at most 1")

    def test_unknown_option_comes_before_missing_arguments(self):
        self.says(self.refused("render", "--pgn", "a.png"), '"--pgn"', '"--png"')

    def test_missing_arguments(self):
        self.says(self.refused("solve"), "SCENE")
        self.says(self.refused("render", "box.toml"), "--output")
        self.says(self.refused("render", "box.toml", "-o"), "--output")

    def test_too_many_arguments(self):
        self.says(self.refused("inspect", "box.toml", "other.toml"), "other.toml")

    def test_numbers_are_read_strictly(self):
        for option, value in [("-j", "-1"), ("-j", "two"), ("--threads", "1.5"), ("--threads", "99999"),
                              ("--seed", "-1"), ("--seed", "18446744073709551616"), ("--seed", "0x10"),
                              ("--seed", "")]:
            self.says(self.refused("inspect", "box.toml", option, value), "whole number")
        for size in ("512", "0x8", "8x", "x8", "8x8x8", "8X8", "-8x8", "99999x8"):
            self.says(self.refused("render", "box.toml", "-o", "a.exr", "--size", size), "--size")
        for error in ("small", "0", "-1", "0.1x", "nan"):
            self.says(self.refused("solve", "box.toml", "--error", error), f'--error: "{error}" is not a number above 0 and at most 1')
        self.refused("render", "box.toml", "-o", "a.exr", "--distributed-lights", "0")

    def test_unknown_words_of_options(self):
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--indirect", "radiosty"), "distributed")
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--aov", "depth,colour"), '"colour"', "albedo")
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--camera", "B"), '"B"', "inside")
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--camera", "inside,"), 'no camera ""', "inside")
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--wait", "5"), "--wait", "--part")

    def test_empty_words_are_not_taken_for_silence(self):
        render = ("render", "box.toml", "-o", "a.exr")
        for option, call in (("--png", render), ("--cctv", render), ("--range", render), ("--report", render), ("--over", render),
                             ("--solution", render), ("--camera", render), ("--distributed-over", render), ("--set", render),
                             ("--output", ("solve", "box.toml")), ("--glb", ("solve", "box.toml")), ("--output", ("study", "orbit", "box.toml")),
                             *((option, ("degrade", "a.exr", "-o", "a.png")) for option in
                               ("--stages", "--twin", "--scene", "--preset", "--cctv", "--camera", "--off", "--describe")),
                             ("--output", ("degrade", "certify", "sit-monochrome")), ("--png", ("relight", "a.exr"))):
            self.says(self.refused(*call, option, ""), option + ": is an empty word", "leave it out")
        for call in (("inspect",), ("degrade", "-o", "a.png"), ("merge",), ("report",), ("study", "run", "-o", "d"),
                     ("study", "orbit", "box.toml", "-o", "d", "--at")):
            self.says(self.refused(*call, ""), "is an empty word")

    def test_options_that_need_another(self):
        for command in (["render", "box.toml", "-o", "a.exr"], ["plan", "box.toml"]):
            self.says(self.refused(*command, "--distributed-over", "sky"), "--distributed-over", "--indirect distributed")
            run = self.run_program(*command, "--distributed-lights", "8")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.says(run.stderr, "note: --distributed-lights has no effect: --indirect radiosity")
        run = self.run_program("solve", "box.toml", "--time-limit", "3")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "note: --time-limit has no effect: no error is asked for")
        self.says(self.refused("form-factors", "box.toml", "--method", "exact", "--raw"), "--raw")
        run = self.run_program("render", "box.toml", "-o", "a.exr", "--png", "a.png", "--exposure", "own", "--curve", "clip")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "note: --curve has no effect: --exposure own")
        self.says(self.refused("degrade", "a.exr", "-o", "a.png", "--list"), "--list", "takes no IN, --output")
        self.says(self.refused("degrade", "--list", "--describe", "sit-monochrome"), "--list", "takes no --describe")
        self.says(self.refused("degrade", "--describe", "sit-monochrome", "--off", "lag"), "--describe", "takes no --off")
        self.says(self.refused("degrade", "a.exr", "-o", "a.json", "certify", "sit-monochrome"), "certify", "takes no IN, --output")
        self.done("degrade", "--list", "--json", "-q", "--seed", "3")

    def test_what_is_wrong_with_a_value_is_said(self):
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--time-limit", "1e300"), "up to 10000000")
        self.says(self.refused("render", "box.toml", "-o", "a.exr", "--crop", "20,0,8x8"), "--crop", "24 x 16")
        self.says(self.refused("merge", "nowhere"), "nowhere: is not there", "--part")

    def test_override_without_value_or_unknown(self):
        for override in ("quality", "quality.gather_rays", "quality.gather=3", "=3", "quality.error=x"):
            self.refused("inspect", "box.toml", "--set", override)

    def test_options_may_stand_anywhere(self):
        plain = self.done("solve", "box.toml", "--json", "--seed", "7", "-j", "1")
        self.assertIn('"patches"', plain)
        for order in (["-j1", "solve", "--json", "box.toml"], ["solve", "-q", "--json", "--seed=7", "box.toml"],
                      ["solve", "--set", "quality.patch_edge=1", "box.toml", "--json"],
                      ["--quiet", "--seed", "18446744073709551615", "solve", "box.toml", "--json"]):
            self.assertIn('"patches"', self.done(*order))


if __name__ == "__main__":
    unittest.main()
