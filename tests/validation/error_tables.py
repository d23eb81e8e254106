# SPDX-License-Identifier: Apache-2.0
"""Results of error_bounds.py as tables: how often bounds held, and how often wanted errors were
reached."""
import dataclasses
import math

import error_scenes
import error_truth

SHARE, MEDIAN = 0.9, 3.0  # required
# Below this true error, noise of the references and rounding dominate, and a ratio has no meaning.
LEAST = 1e-3
UNSURE = 0.2  # limit of (standard error of the true error) / max(error, bound)


@dataclasses.dataclass
class Row:
    kind: str  # picture or solve
    scene: str
    asked: str
    patches: int
    estimate: float
    bound: float
    parts: dict
    truth: error_truth.Truth

    @property
    def within(self):
        return self.truth.error <= self.bound or self.truth.error < LEAST

    @property
    def ratio(self):
        return self.bound / self.truth.error if self.truth.error >= LEAST else math.nan

    @property
    def unsure(self):
        return unsure(self.truth)

    @property
    def is_decisive(self):
        """Whether the references are accurate enough to test a single bound. Not for solutions: the
        noise of all points of a patch is equal."""
        return self.kind == "solve" or relative_uncertainty(self.truth, self.bound) <= UNSURE

    @property
    def by_error(self):
        """Whether the setting is a wanted error."""
        return self.asked.startswith(("error", "picture"))

    @property
    def wanted(self):
        """The wanted error without further settings; else None."""
        words = error_scenes.ASKED[self.asked]
        return float(words[1]) if len(words) == 2 and words[0] == "--error" else None


def unsure(truth):
    """Standard error of the true error by the noise of the references, from that of its square."""
    root = math.sqrt(truth.of_references)
    return min(root, truth.of_references / (2 * truth.error)) if truth.error > 0 else root


def relative_uncertainty(truth, bound):
    """The same, relative to the larger of the true error and its bound."""
    return unsure(truth) / max(bound, truth.error, LEAST)


def median(values):
    values = sorted(values)
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else (values[middle - 1] + values[middle]) / 2


def percent(value):
    return f"{100 * value:.2g} %"


def table(rows):
    print("| scene | asked for | patches | estimate | bound 95 % | its parts | true error | bound / true |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for row in rows:
        parts = ", ".join(f"{key.replace('_', ' ')} {percent(value)}" for key, value in row.parts.items()
                          if value > 0.2 * row.estimate)  # 96 % of the square or more
        mark = ("" if row.within else " **outside**") + ("" if row.is_decisive else " (?)")
        unsure_by = "" if row.kind == "solve" else f" ± {percent(row.unsure)}"
        ratio = f"{row.ratio:.2f}" if row.truth.error >= LEAST else ""
        print(f"| {row.scene} | {row.asked} | {row.patches} | {percent(row.estimate)} | {percent(row.bound)} | {parts} | "
              f"{percent(row.truth.error)}{unsure_by} | {ratio}{mark} |")


def summary(kind, rows):
    """Prints how often the bound held. Returns whether that is often enough."""
    share = sum(row.within for row in rows) / max(1, len(rows))
    unsure = math.sqrt(share * (1 - share) / max(1, len(rows)))
    ratios = [row.ratio for row in rows if not math.isnan(row.ratio)]
    middle = median(ratios) if ratios else math.nan
    good = share >= SHARE and not middle > MEDIAN
    print(f"| {kind} | {sum(row.within for row in rows)} of {len(rows)} | {100 * share:.0f} ± {100 * unsure:.0f} % | "
          f"{middle:.2f} | {min(ratios, default=math.nan):.2f} to {max(ratios, default=math.nan):.1f} | "
          f"{'yes' if good else 'no'} |")
    return good


def summaries(rows):
    print(f"\n| | true error within the bound | share (asked: {100 * SHARE:.0f} %) | bound / true, median (asked: at most "
          f"{MEDIAN:.0f}) | of all | holds |")
    print("| --- | --- | --- | --- | --- | --- |")
    good = [summary(title, [r for r in rows if r.kind == kind])
            for kind, title in (("picture", "pictures"), ("solve", "radiosities")) if any(r.kind == kind for r in rows)]
    for kind, title in (("picture", "pictures"), ("solve", "radiosities")):
        for by_error, how in ((True, "by `error`"), (False, "by knobs")):
            mine = [r for r in rows if r.kind == kind and r.by_error == by_error]
            if mine:
                summary(f"{title}, {how}", mine)
    good.append(summary("all", rows))
    return all(good)


def reached(rows):
    """Prints how often --error E gave at most E."""
    print("\n| asked for | true error of pictures no larger | in all | largest | of radiosities | in all | largest |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for wanted in sorted({row.wanted for row in rows if row.wanted}, reverse=True):
        cells = [percent(wanted)]
        for kind in ("picture", "solve"):
            of_kind = [row.truth.error for row in rows if row.kind == kind and row.wanted == wanted]
            cells += [str(sum(error <= wanted for error in of_kind)), str(len(of_kind)), percent(max(of_kind)) if of_kind else ""]
        print(f"| {' | '.join(cells)} |")


def write(rows):
    """Prints all tables. Returns whether all rows together meet the requirements."""
    good = summaries(rows)
    reached(rows)
    sure = [row for row in rows if row.is_decisive]
    print(f"\n{len(rows) - len(sure)} of {len(rows)} rows are marked (?): the references' own noise leaves their true errors unsure. "
          f"Without them:")
    summaries(sure)
    reached(sure)
    for kind, title in (("picture", "Pictures"), ("solve", "Radiosities")):
        mine = [row for row in rows if row.kind == kind]
        if mine:
            print(f"\n{title}:\n")
            table(mine)
    return good
