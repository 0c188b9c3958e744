"""Plots of the exposure study: error of a translation, and deviation of moving balls."""
import math

from accuracy_data import fit_knee, select
from accuracy_figures import MARKERS, SERIES, panels, plain_ticks, save


def draw_deviation(rows, path):
    """A panel a light level; at every speed a box for each ball."""
    levels = sorted({row["ball_level"] for row in rows}, reverse=True)
    figure, axes = panels(len(levels), width=11)
    for axis, level in zip(axes, levels):
        speeds = sorted({row["speed_mm_s"] for row in rows})
        boxes, places, colours = [], [], []
        for i, speed in enumerate(speeds):
            for row in select(rows, ball_level=level, speed_mm_s=speed):
                k = int(5 * row["rod"] + row["ball"])
                if row["measured"] == 0:
                    continue
                boxes.append({"whislo": 1e3 * row["q05_mm"], "q1": 1e3 * row["q25_mm"],
                              "med": 1e3 * row["median_mm"], "q3": 1e3 * row["q75_mm"],
                              "whishi": 1e3 * row["q95_mm"], "fliers": []})
                places.append(i + 0.08 * (k - 4.5))
                colours.append(SERIES[0] if row["rod"] == 0 else SERIES[1])
        drawn = axis.bxp(boxes, positions=places, widths=0.06, showfliers=False, patch_artist=True,
                         medianprops={"color": "k"}, whiskerprops={"lw": 0.7},
                         capprops={"lw": 0}, boxprops={"lw": 0.4})
        for patch, colour in zip(drawn["boxes"], colours):
            patch.set_facecolor(colour)
        axis.set_xticks(range(len(speeds)), [f"{speed:g}" for speed in speeds])
        axis.set(xlabel="speed [mm/s], exposure 16 ms", yscale="log")
        axis.set_title(f"ball at {100 * level:g} % of full scale", fontsize=10)
    low = min(axis.get_ylim()[0] for axis in axes)
    high = max(axis.get_ylim()[1] for axis in axes)
    for axis in axes:
        axis.set_ylim(low, high)
    axes[0].set_ylabel("distance of a ball from its true place [µm]")
    save(figure, path)


def draw_exposure(rows, path):
    figure, (left, middle, right) = panels(3, width=12.5)
    short_rows = select(rows, series="constant_light")
    for i, exposure in enumerate(sorted({row["exposure_ms"] for row in short_rows})):
        cell = select(short_rows, exposure_ms=exposure)
        draw_errors(left, cell, f"{exposure:g} ms", i)
    left.set(xlabel="speed [mm/s]", title="same lamp", ylim=(0, None),
             ylabel="error of the translation, along the motion [µm]")
    long_rows = select(rows, series="equal_photons")
    knees = []
    for i, exposure in enumerate(sorted({row["exposure_ms"] for row in long_rows})):
        cell = sorted(select(long_rows, exposure_ms=exposure), key=lambda row: row["speed_mm_s"])
        draw_errors(middle, cell, f"{exposure:g} ms", i)
        knee = fit_knee(cell, long_rows)
        knees.append((exposure, knee))
        middle.plot(knee["measured"], 1e3 * math.sqrt(2) * knee["level"], marker="*", ms=13,
                    color=SERIES[i], mec="k", zorder=5)
    middle.set(xscale="log", yscale="log", xlabel="speed [mm/s]",
               title="same photons (lines: bound; stars: knees)")
    exposures = [exposure for exposure, _ in knees]
    right.errorbar(exposures, [knee["measured"] for _, knee in knees],
                   [knee["sigma"] for _, knee in knees], fmt="o", color=SERIES[0], capsize=3,
                   label="measured")
    right.plot(exposures, [knee["predicted"] for _, knee in knees], "k--",
               label="predicted from the bound")
    right.set(xscale="log", yscale="log", xlabel="exposure [ms]", ylabel="knee [mm/s]",
              title="knee against exposure")
    right.set_xticks(exposures, [f"{exposure:g}" for exposure in exposures])
    right.minorticks_off()
    plain_ticks(middle.yaxis, (1.5, 2, 2.5, 3, 4, 5))
    plain_ticks(middle.xaxis, (10, 20, 50, 100, 200, 500, 1000))
    plain_ticks(right.yaxis, (50, 100, 200, 500, 1000))
    for axis in (left, middle, right):
        axis.legend(fontsize=7)
    save(figure, path)


def draw_errors(axis, cell, label, i):
    x = [row["speed_mm_s"] for row in cell]
    y = [1e3 * row["rmse_along_mm"] for row in cell]
    error = [v / math.sqrt(2 * max(r["repetitions"] - r["lost"], 1)) for v, r in zip(y, cell)]
    axis.errorbar(x, y, error, fmt=MARKERS[i], color=SERIES[i], markersize=4, label=label)
    axis.plot(x, [1e3 * row["bound_along_mm"] for row in cell], color=SERIES[i], lw=1)
