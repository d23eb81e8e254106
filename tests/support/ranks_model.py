#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The table of docs/log/scaling.md: seconds of `solve` and `render` on R ranks of one thread, from
measurements with one rank.

usage: ranks_model.py [BYTES-PER-SECOND [SECONDS-PER-MESSAGE]]
"""
import dataclasses
import math
import sys

BANDS = 16  # bands of rows for sums of columns (radiosity/factors/column_sums.h)
RANKS = (1, 2, 4, 8, 16, 64, 256, 1024, 4096)


# Seconds of one thread, from a profile of `solve` with 493083 patches (docs/log/scaling.md): of one
# entry in a pass of column sums, and of one patch in files and tables.
SUM_S, PATCH_S = 1.54e-9, 5.9e-6


@dataclasses.dataclass
class Case:
    name: str
    patches: int
    entries: int
    sweeps: int       # of the balance
    filled: bool      # hits are filled in: the entries are exchanged once more
    seconds: float    # of one rank
    columns: int = 6  # of the linear solve: 3 per light group
    products: int = 54

    @property
    def sums(self):
        """Column sums: the rows of a band are added one after another."""
        return SUM_S * self.entries * self.sweeps

    @property
    def alone(self):
        return self.patches * PATCH_S


def exchange(case, ranks, bytes_per_s, message_s):
    """Seconds: bytes received by a rank, and sequential messages. A gather runs in a ring, an
    all-to-all sends to each rank."""
    if ranks == 1:
        return 0.0
    others = ranks - 1
    entries = (8 + (12 if case.filled else 0)) * case.entries / ranks
    # Results of rows; the vector in each sweep; row scales at the end; the vector of each product,
    # in groups of four columns; four floats per patch and column of the solution. Sums are in
    # chunks of 64 patches.
    to_all = case.patches * (64 + 32 * case.sweeps + 8 + 32 * math.ceil(case.columns / 4) * case.products + 16 * case.columns
                             + 8 / 64 * (2 * case.sweeps + 5 / 2 * case.products))
    sums = case.patches * 8 * case.sweeps * max(1.0, BANDS / ranks, ranks / BANDS)  # sequential
                                                                                    # within a band
    messages = (16 * 2 * others  # rows to their ranks
                + case.sweeps * (2 + 2) * others + case.sweeps * max(0, ranks / BANDS - 1)
                + case.products * (1 + 1.5) * others  # the vector; sums three times in two products
                + 10 * ranks * math.log2(ranks))  # loops after which each rank broadcasts in turn
    return (entries + to_all + sums) / bytes_per_s + messages * message_s


def seconds(case, ranks, bytes_per_s, message_s):
    shared = case.seconds - case.sums - case.alone
    return (shared / ranks + case.sums / min(ranks, BANDS) + case.alone
            + exchange(case, ranks, bytes_per_s, message_s))


# Bytes per pixel in all loops: gather-point results of the solution (100) and of paths (70), sums
# of samples (80).
PIXEL_BYTES = 250
LOOPS = 5  # over tiles: of gather points twice, of lobes, of camera samples twice


@dataclasses.dataclass
class Picture:
    name: str
    pixels: int
    tiles: int      # of 8 x 8 pixels, taken by a rank one at a time
    seconds: float  # of one rank
    alone: float    # 2 t(2) - t(1) of the measurement: reading, sharing between points, files,
                    # waiting

    def on(self, ranks, bytes_per_s, message_s):
        """Seconds in all, and seconds of communication."""
        if ranks == 1:
            return self.seconds, 0.0
        shared = self.seconds - self.alone
        # Each rank takes tiles from rank 0's counter until none is left. Then each broadcasts the
        # number and the data of its tiles. The mean wait is half a tile.
        messages = LOOPS * (self.tiles + ranks + 2 * ranks * math.log2(ranks))
        exchanged = PIXEL_BYTES * self.pixels / bytes_per_s + messages * message_s
        return shared / min(ranks, self.tiles) + 0.5 * shared / self.tiles + self.alone + exchanged, exchanged


CASES = (
    Case("201942 patches, 1024 rays each", 201942, 44966388, 89, False, 66.5),
    Case("493083 patches, 1024 rays each", 493083, 125384913, 92, False, 195.0),
    Case("992560 patches, 256 rays each", 992560, 77648879, 111, False, 176.6),
)


PICTURE = Picture("render 384 x 384, 128 gather rays", 384 * 384, 48 * 48, 28.9, 2.1)


def main():
    network = [float(word) for word in sys.argv[1:]] + [12.5e9, 2e-6][len(sys.argv) - 1:]
    names = [case.name for case in CASES] + [PICTURE.name]
    print("| ranks |" + "".join(f" {name} | of it exchange | efficiency |" for name in names))
    print("| --- |" + " --- | --- | --- |" * len(names))
    for ranks in RANKS:
        row = f"| {ranks} |"
        taken = [(seconds(case, ranks, *network), exchange(case, ranks, *network), seconds(case, 1, *network)) for case in CASES]
        taken.append((*PICTURE.on(ranks, *network), PICTURE.seconds))
        for all_of_it, exchanged, of_one in taken:
            row += f" {all_of_it:.3g} s | {exchanged:.2g} s | {of_one / all_of_it / ranks:.2g} |"
        print(row)


if __name__ == "__main__":
    main()
