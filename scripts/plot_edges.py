"""Plots of CSV files that other programs make: edge operators, cost against size."""
import math

from accuracy_data import line_fit, select
from accuracy_figures import MARKERS, SERIES, panels, save


def draw_edges(rows, column, label, path):
    """A panel a light level, a line an operator, against the noise."""
    lights = sorted({row["light_dn"] for row in rows}, reverse=True)
    figure, axes = panels(len(lights), width=11)
    for axis, light in zip(axes, lights):
        for i, operator in enumerate(dict.fromkeys(row["operator"] for row in rows)):
            own = select(rows, light_dn=light, operator=operator)
            axis.plot([row["noise_dn"] for row in own], [row[column] for row in own],
                      color=SERIES[i % len(SERIES)], marker=MARKERS[i % len(SERIES)], markersize=4, label=operator,
                      linestyle="-" if "wavelet" in operator else "--")
        axis.set(xlabel="noise σ [DN]", ylabel=label if light == lights[0] else None)
        axis.set_title(f"illumination {light:g} DN, reflectances 0.10 and 0.15", fontsize=9)
        axis.sharey(axes[0])
    axes[0].legend(fontsize=7, framealpha=0.6)
    save(figure, path)


def slope(x, y):
    """Log-log slope of all points alike."""
    return line_fit([math.log(v) for v in x], [math.log(v) for v in y], [1.0] * len(x))[0]


def draw_scaling(rows, path):
    """Median time against pixels and against balls, log-log, with the slope in the legend.

    Odd frames (white, noise) have kinds of their own and are left out. Pixels: slope above one
    megapixel only.
    """
    figure, axes = panels(2)
    for row in rows:
        row["megapixels"] = 1e-6 * row["width_px"] * row["height_px"]
    for axis, x in zip(axes, ("megapixels", "balls")):
        for i, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
            own = [row for row in select(rows, method=method)
                   if row["balls"] > 0 and (row["kind"] == "balls") == (x == "balls")]
            if not own:
                continue
            style = {"color": SERIES[i], "marker": MARKERS[i]}
            fitted = [row for row in own if x == "balls" or row["megapixels"] > 1]
            steep = slope([row[x] for row in fitted], [row["median_ms"] for row in fitted])
            axis.plot([row[x] for row in own], [row["median_ms"] for row in own],
                      label=f"{method}, slope {steep:.2f}", **style)
        axis.set(xscale="log", yscale="log", xlabel=x, ylabel="median time of a whole search [ms]")
        axis.legend(fontsize=7)
    axes[0].set_title("balls in proportion; slope above one megapixel", fontsize=9)
    axes[1].set_title("1280 × 1024", fontsize=9)
    save(figure, path)
