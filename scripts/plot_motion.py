#!/usr/bin/env python3
"""Plots the motion of a RUN: angular velocity, path of the spin centre, and how well it is known.

usage: scripts/plot_motion.py RUN OUT.png [--truth REC/truth/poses.csv]
"""
import argparse
import csv
import json
import math
import pathlib

from accuracy_figures import SERIES, panels, save

NAMES = "xyz"
MOST_SIGMAS = 2  # a band of 95 %


def read(path):
    """The columns of a CSV file as lists; an empty cell is NaN."""
    with open(path, encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))

    def number(text):
        try:
            return float(text)
        except ValueError:
            return math.nan

    return {name: [number(row[name]) for row in rows] for name in rows[0]}


def seconds(table):
    return [1e-9 * (t - table["timestamp_ns"][0]) for t in table["timestamp_ns"]]


def draw(axis, time, value, u, color, label):
    """A series with its band of ± 2 σ."""
    axis.plot(time, value, color=color, label=label, linewidth=1.2, marker=".", markersize=3)
    axis.fill_between(time, [v - MOST_SIGMAS * s for v, s in zip(value, u)],
                      [v + MOST_SIGMAS * s for v, s in zip(value, u)],
                      color=color, alpha=0.25, linewidth=0)


def draw_turning(axis, time, motion, truth):
    for k, name in enumerate(NAMES):
        draw(axis, time, motion[f"w{name}_rad_s"], motion[f"u_w{name}"], SERIES[k], f"$\\omega_{name}$")
        if truth:
            axis.plot(seconds(truth), truth[f"w{name}_rad_s"], color="black", linewidth=0.6,
                      linestyle=":", label="truth" if k == 0 else None)
    axis.set(xlabel="time [s]", ylabel="angular velocity [rad/s]", title="rotation")
    axis.legend(fontsize=8)


def draw_path(axis, time, motion):
    for k, name in enumerate(NAMES):
        draw(axis, time, motion[f"center_{name}_mm"], motion[f"u_center_{name}"], SERIES[k], name)
    axis.set(xlabel="time [s]", ylabel="place in the world [mm]", title="spin centre")
    axis.legend(fontsize=8)


def draw_error(axis, time, motion, truth):
    """What ± says of the centre, and with a truth how far off it is."""
    for k, name in enumerate(NAMES):
        u = motion[f"u_center_{name}"]
        zero = [0 if math.isfinite(s) else math.nan for s in u]
        error = zero
        if truth:
            error = [a - b for a, b in zip(motion[f"center_{name}_mm"], truth[f"center_{name}_mm"])]
        draw(axis, time, error, u, SERIES[k], name)
    axis.axhline(0, color="black", linewidth=0.6, linestyle=":")
    axis.set(xlabel="time [s]", ylabel="[mm]",
             title="spin centre − truth, ± 2 σ" if truth else "spin centre, ± 2 σ")
    axis.legend(fontsize=8)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--truth", type=pathlib.Path)
    arguments = parser.parse_args()
    motion = read(arguments.run / "motion.csv")
    truth = read(arguments.truth) if arguments.truth else None
    spin = json.loads((arguments.run / "motion.json").read_text(encoding="utf-8"))["spin_center"]
    time = seconds(motion)
    figure, axes = panels(3 if spin["in_body_mm"] else 1, width=12, height=3.8)
    if not spin["in_body_mm"]:
        draw_turning(axes, time, motion, truth)
    else:
        draw_turning(axes[0], time, motion, truth)
        draw_path(axes[1], time, motion)
        draw_error(axes[2], time, motion, truth)
    save(figure, arguments.out)


if __name__ == "__main__":
    main()
