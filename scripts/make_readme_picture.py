#!/usr/bin/env python3
"""Draws docs/images/result.png from a run on a simulated recording.

usage: scripts/make_readme_picture.py REC RUN PNG
       scripts/make_readme_picture.py data/demo build/demo docs/images/result.png

Left, an image of the left camera with what was found in it; right, the measured motion, and its distance
from the truth inside the 2σ band that the program reports. Needs matplotlib (pip or python3-matplotlib).
"""
import csv
import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

INK = "#22272e"
GREY = "#8a929c"
ROD_COLOURS = ["#ff9f1c", "#2ec4b6", "#e56bd0", "#9bc53d"]
AXIS_COLOURS = {"x": "#c8553d", "y": "#3a7d44", "z": "#2f6db5"}


def read_rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def column(rows, name):
    """The column as numbers; an empty cell, a quantity without a value, becomes NaN."""
    return np.array([float(row[name]) if row[name] else math.nan for row in rows])


def quaternions(rows):
    return np.stack([column(rows, name) for name in ("qw", "qx", "qy", "qz")], axis=1)


def positions_mm(rows):
    return np.stack([column(rows, f"t{axis}_mm") for axis in "xyz"], axis=1)


def rotation_vectors_deg(q_to, q_from):
    """World-frame rotation vectors of q_to · q_from⁻¹, row by row."""
    w, x, y, z = q_to.T
    a, b, c, d = q_from.T[0], -q_from.T[1], -q_from.T[2], -q_from.T[3]
    scalar = w * a - x * b - y * c - z * d
    vector = np.stack([w * b + x * a + y * d - z * c,
                       w * c - x * d + y * a + z * b,
                       w * d + x * c - y * b + z * a], axis=1)
    sine = np.linalg.norm(vector, axis=1)
    angle = 2 * np.arctan2(sine, np.abs(scalar))
    factor = np.where(sine > 0, angle / np.where(sine > 0, sine, 1), 2)
    return np.degrees(vector * (factor * np.where(scalar < 0, -1, 1))[:, None])


def read_motion(recording, run):
    """Measured poses with an answer, beside the truth of the same frames; σ from the covariance."""
    measured = [row for row in read_rows(run / "poses.csv") if row["status"] == "ok"]
    truth_by_frame = {row["frame"]: row for row in read_rows(recording / "truth/poses.csv")}
    truth = [truth_by_frame[row["frame"]] for row in measured]
    q, q_true = quaternions(measured), quaternions(truth)
    t, t_true = positions_mm(measured), positions_mm(truth)
    sigma = np.sqrt(np.stack([column(measured, f"cov_{i}{i}") for i in range(6)], axis=1))
    time_ns = column(measured, "timestamp_ns")
    start = np.repeat(q_true[:1], len(q), axis=0)
    return {
        "time_s": (time_ns - time_ns[0]) * 1e-9,
        "moved_mm": (t - t_true[0], t_true - t_true[0]),
        "turned_deg": (rotation_vectors_deg(q, start), rotation_vectors_deg(q_true, start)),
        "position_error_um": ((t - t_true) * 1e3, sigma[:, 3:] * 1e3),
        "rotation_error_mdeg": (rotation_vectors_deg(q, q_true) * 1e3,
                                np.degrees(sigma[:, :3]) * 1e3),
    }


def rods_of(balls):
    """Rows of balls.csv that the left camera saw, by rod and then ball."""
    rods = {}
    for row in balls:
        if row["u_left_px"]:
            rods.setdefault(row["rod"], {}).setdefault(row["ball"], []).append(row)
    return rods


def draw_rod(axes, name, balls, frame, colour):
    for path in balls.values():
        axes.plot(column(path, "u_left_px"), column(path, "v_left_px"), "-", color=colour, lw=0.9,
                  alpha=0.55)
    now = [row for path in balls.values() for row in path if row["frame"] == frame]
    u, v = column(now, "u_left_px"), column(now, "v_left_px")
    axes.plot(u, v, "-", color=colour, lw=1.6)
    axes.plot(u, v, "+", color=INK, ms=5, mew=0.9)
    axes.annotate(f"rod {name}", (u[0], v[0]), xytext=(-12, 0), textcoords="offset points",
                  color=colour, fontsize=11, fontweight="bold", ha="right", va="center")


def draw_image(axes, recording, run):
    images = sorted((recording / "cam0").glob("*.png"))
    chosen = images[len(images) // 2]
    frame = str(int(chosen.stem))
    image = plt.imread(chosen)
    axes.imshow(image, cmap="gray", vmin=0, vmax=0.8, interpolation="nearest")
    balls = read_rows(run / "balls.csv")
    for (name, rod), colour in zip(sorted(rods_of(balls).items()), ROD_COLOURS):
        draw_rod(axes, name, rod, frame, colour)
    for row in read_rows(run / "detections.csv"):
        if row["frame"] != frame or row["camera"] != "cam0" or not row["diameter_px"]:
            continue
        axes.add_patch(plt.Circle((float(row["outline_u_px"]), float(row["outline_v_px"])),
                                  float(row["diameter_px"]) / 2, fill=False, color="#ff3b30", lw=1))
    seen = [row for row in balls if row["u_left_px"]]
    u, v = column(seen, "u_left_px"), column(seen, "v_left_px")
    centre_u, centre_v = (u.min() + u.max()) / 2, (v.min() + v.max()) / 2
    half = 0.5 * max(np.ptp(u), np.ptp(v)) + 32
    axes.set_xlim(centre_u - half, centre_u + half)
    axes.set_ylim(centre_v + half, centre_v - half)
    axes.set_facecolor("black")
    axes.set_xticks([])
    axes.set_yticks([])
    sigma_px = math.sqrt(np.median(column(seen, "cov_uu_left")))
    axes.set_title(f"Left camera, pair {int(frame) + 1} of {len(images)}", loc="left")
    axes.set_xlabel(f"outline and centre of each ball (σ ≈ {sigma_px:.4f} px), rods, paths", labelpad=6)


def draw_motion(axes, time_s, measured, truth, title):
    for i, (axis, colour) in enumerate(AXIS_COLOURS.items()):
        axes.plot(time_s, truth[:, i], "-", color=colour, lw=1.2, alpha=0.6)
        axes.plot(time_s, measured[:, i], "o", color=colour, ms=3.6)
        axes.annotate(axis, (time_s[-1], measured[-1, i]), xytext=(6, 0),
                      textcoords="offset points", color=colour, va="center", fontweight="bold")
    axes.set_title(title, loc="left")


def draw_error(axes, time_s, error, sigma, axis):
    colour = AXIS_COLOURS[axis]
    axes.fill_between(time_s, -2 * sigma, 2 * sigma, color=colour, alpha=0.18, lw=0)
    axes.axhline(0, color=GREY, lw=0.7)
    axes.plot(time_s, error, "o", color=colour, ms=3.6)
    axes.text(1.015, 0.5, axis, transform=axes.transAxes, color=colour, va="center",
              fontweight="bold")


def draw_figure(recording, run):
    motion = read_motion(recording, run)
    plt.rcParams.update({"font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 10.5,
                         "axes.edgecolor": GREY, "axes.labelcolor": INK, "text.color": INK,
                         "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False,
                         "axes.spines.right": False, "axes.titlecolor": INK})
    figure = plt.figure(figsize=(13, 5.6), dpi=110)
    left, right = figure.add_gridspec(1, 2, width_ratios=[1, 1.5], left=0.012, right=0.978, top=0.94,
                                      bottom=0.09, wspace=0.12)
    draw_image(figure.add_subplot(left), recording, run)
    grid = right.subgridspec(4, 2, height_ratios=[2.6, 1, 1, 1], hspace=0.32, wspace=0.22)
    columns = [("moved_mm", "position_error_um", "Position [mm]", "Measured − true [µm]; band: ±2σ"),
               ("turned_deg", "rotation_error_mdeg", "Rotation vector [°]",
                "Measured − true [0.001°]; band: ±2σ")]
    for c, (path, error, path_title, error_title) in enumerate(columns):
        top = figure.add_subplot(grid[0, c])
        draw_motion(top, motion["time_s"], *motion[path], path_title + ": dots measured, lines true")
        top.tick_params(labelbottom=False)
        values, sigmas = motion[error]
        for row, axis in enumerate("xyz"):
            axes = figure.add_subplot(grid[1 + row, c], sharex=top)
            draw_error(axes, motion["time_s"], values[:, row], sigmas[:, row], axis)
            axes.set_ylim(-1.15 * np.max(np.abs([values, 2 * sigmas])),
                          1.15 * np.max(np.abs([values, 2 * sigmas])))
            axes.tick_params(labelbottom=row == 2)
            if row == 0:
                axes.set_title(error_title, loc="left")
        axes.set_xlabel("time [s]")
    return figure


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    recording, run, picture = map(Path, sys.argv[1:])
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw_figure(recording, run).savefig(picture, facecolor="white")


if __name__ == "__main__":
    main()
