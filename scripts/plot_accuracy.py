#!/usr/bin/env python3
"""Draws the plots of docs/accuracy.md from the CSV files of the accuracy study.

usage: scripts/plot_accuracy.py CSV_DIR PLOT_DIR

A plot whose CSV file is absent is left out, and said so. Needs matplotlib (Debian: python3-matplotlib).
"""
import math
import sys
from pathlib import Path

from accuracy_data import METHODS, OWN, bias, read_rows, select
from accuracy_figures import panels, save
from plot_centers import draw_centers
from plot_edges import draw_edges, draw_scaling
from plot_exposure import draw_deviation, draw_exposure

BAR_PX = 0.003  # the bar on the bias


def draw_sweep(rows, key, label, title, path, bias_label):
    """RMSE with the bound, and bias, of every method against one quantity."""
    figure, (left, right) = panels(2)
    for method, (name, colour, marker, dash) in METHODS.items():
        own = [row for row in select(rows, method=method) if row["found_share"] > 0.5]
        x = [row[key] for row in own]
        style = {"color": colour, "marker": marker, "linestyle": dash, "markersize": 4}
        left.plot(x, [row["rmse_px"] for row in own], label=name, **style)
        right.plot(x, [bias(row) for row in own], **style)
    one = select(rows, method="ml")
    x = [row[key] for row in one]
    left.plot(x, [row["bound_px"] for row in one], "k:", lw=2, label="Cramér–Rao bound")
    right.plot(x, [3.29 * row["bound_px"] / math.sqrt(row["balls"]) for row in one], "k:", lw=2,
               label="99.9 % of a zero bias, at the bound")
    right.axhline(BAR_PX, color="k", lw=0.8, label="0.003 px")
    for axis, text in ((left, "RMSE per axis [px]"), (right, bias_label)):
        axis.set(yscale="log", xlabel=label, ylabel=text)
    left.set_title(title, fontsize=10)
    left.legend(fontsize=7, framealpha=0.6)
    right.legend(fontsize=7, framealpha=0.6)
    save(figure, path)


def draw_sweeps(rows, folder):
    across = "larger |bias| of both axes [px]"
    draw_sweep(select(rows, sweep="snr"), "snr_db", "SNR [dB]", "diameter 9 px",
               folder / "snr.png", across)
    draw_sweep(select(rows, sweep="diameter"), "diameter_px", "diameter [px]", "SNR 30 dB",
               folder / "diameter.png", across)
    draw_sweep(select(rows, sweep="smear", snr_db=40), "smear_diameters", "smear [diameters]",
               "diameter 9 px, SNR 40 dB", folder / "smear.png", "|bias| along the smear [px]")
    draw_sweep(select(rows, sweep="hidden"), "hidden_fraction", "hidden share of the area",
               "diameter 12 px, SNR 40 dB", folder / "hidden.png",
               "|bias| towards the hidden side [px]")


def draw_phase(rows, path):
    """Bias in u against the phase in u, mean over the phases in v."""
    figure, (left, right) = panels(2)
    rows = select(rows, sweep="phase")
    for method, (name, colour, marker, dash) in METHODS.items():
        own = select(rows, method=method)
        phases = sorted({row["phase_u"] for row in own})
        mean = []
        for phase in phases:
            column = [row["bias_u_px"] for row in select(own, phase_u=phase)]
            mean.append(1e3 * sum(column) / len(column))
        for axis in (left, right) if method in OWN else (left,):
            axis.plot(phases + [1], mean + mean[:1], color=colour, marker=marker, linestyle=dash,
                      markersize=4, label=name)
    left.set_yscale("symlog", linthresh=1)
    right.set_title("the same, without the baselines; diameter 6 px, SNR 40 dB", fontsize=9)
    right.axhspan(-1e3 * BAR_PX, 1e3 * BAR_PX, color="k", alpha=0.08, label="± 0.003 px")
    for axis in (left, right):
        axis.set(xlabel="subpixel phase in u [px], 0 = centre of a pixel",
                 ylabel="bias in u [1/1000 px]")
    left.legend(fontsize=7, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1))
    right.legend(fontsize=7)
    save(figure, path)


def draw_histogram(rows, path):
    figure, axis = panels(1, width=7.2)
    for method, (name, colour, _, dash) in METHODS.items():
        own = select(rows, method=method)
        total = max(sum(row["balls"] for row in own), 1)
        edges = [own[0]["error_from_px"]] + [row["error_to_px"] for row in own]
        axis.stairs([100 * row["balls"] / total for row in own], edges, color=colour, label=name,
                    lw=1.8, linestyle=dash)
    axis.set(xscale="log", xlim=(3e-4, 3), xlabel="distance from the truth [px]",
             ylabel="share of the balls [%] a class (20 a decade)")
    axis.set_title("positioning errors, diameter 9 px, SNR 30 dB", fontsize=10)
    axis.legend(fontsize=7)
    save(figure, path)


def main():
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    target.mkdir(parents=True, exist_ok=True)
    plots = {
        "accuracy.csv": lambda rows: (draw_sweeps(rows, target),
                                      draw_phase(rows, target / "phase.png")),
        "histogram.csv": lambda rows: draw_histogram(rows, target / "histogram.png"),
        "deviation.csv": lambda rows: draw_deviation(rows, target / "deviation.png"),
        "exposure.csv": lambda rows: draw_exposure(rows, target / "exposure.png"),
        "edge_snr.csv": lambda rows: draw_edges(rows, "snr_db", "signal-to-noise ratio [dB]",
                                                target / "edge_snr.png"),
        "edge_localisation.csv": lambda rows: draw_edges(
            rows, "rms_px", "RMS distance from the edge [px]", target / "edge_localisation.png"),
        "centers.csv": lambda rows: draw_centers(rows, target / "centers.png"),
        "scaling.csv": lambda rows: draw_scaling(rows, target / "scaling.png"),
    }
    for name, draw in plots.items():
        if (source / name).exists():
            draw(read_rows(source / name))
        else:
            print(f"plot_accuracy.py: {source / name} is absent, its plots are left out",
                  file=sys.stderr)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main()
