"""The bars of the project on the accuracy, and what was measured of each."""
import math

from accuracy_data import bias, fit_knee, line_fit, select, speed_slope

BAR_BIAS_PX = 0.003
Z_999 = 3.29  # two-sided 99.9 % of a normal number
WORST_Z = 5


def knees(rows):
    long_rows = select(rows, series="equal_photons")
    return {exposure: fit_knee(select(long_rows, exposure_ms=exposure), long_rows)
            for exposure in sorted({row["exposure_ms"] for row in long_rows})}


def knee_slope(found):
    return line_fit([math.log(exposure) for exposure in found],
                    [math.log(knee["measured"]) for knee in found.values()],
                    [knee["sigma"] / knee["measured"] for knee in found.values()])


def bars(rows, exposure):
    """The bars with what was measured: name, bar, measured, holds."""
    result = []
    ml = select(rows, method="ml")

    def worst(name, own, largest_ratio):
        ratio = max(own, key=lambda row: row["ratio"] if row["found_share"] > 0 else math.inf)
        result.append([name + ": RMSE / bound", f"≤ {largest_ratio}", ratio["ratio"],
                       ratio["ratio"] <= largest_ratio])
        found = min(row["found_share"] for row in own)
        result.append([name + ": share found", "≥ 0.995", found, found >= 0.995])
        far = max(own, key=lambda row: abs(row["nees_dof"] - 1))["nees_dof"]
        result.append([name + ": NEES/dof", "0.95–1.05", far, 0.95 <= far <= 1.05])
        z = max(row["worst_z"] for row in own)
        result.append([name + ": largest error / σ of one axis", f"< {WORST_Z}", z, z < WORST_Z])
        above = max(bias(row) - Z_999 * row["bias_sigma_px"] for row in own)
        result.append([name + ": bias beyond its 99.9 % interval, px", f"≤ {BAR_BIAS_PX}",
                       max(above, 0.0), above <= BAR_BIAS_PX])

    grid = select(ml, sweep="grid")
    worst("isolated, 6–30 px, 15–40 dB", [row for row in grid if row["snr_db"] >= 15], 1.05)
    worst("isolated, 6–30 px, 10 dB", select(grid, snr_db=10), 1.15)
    worst("smeared, to 2 diameters", select(ml, sweep="smear"), 1.15)
    worst("all phases, 6 px", select(ml, sweep="phase"), 1.05)
    if exposure:
        result += exposure_bars(exposure)
    return result


def exposure_bars(rows):
    short = select(rows, series="constant_light")
    slopes = [speed_slope(select(short, exposure_ms=t)) for t in {r["exposure_ms"] for r in short}]
    steepest = max(abs(slope / sigma) for slope, sigma in slopes)
    found = knees(rows)
    farthest = max((knee["measured"] / knee["predicted"] for knee in found.values()),
                   key=lambda ratio: abs(math.log(ratio)))
    slope, _ = knee_slope(found)
    return [["10–80 mm/s, 4–16 ms: slope of the error, σ", "≤ 2", steepest, steepest <= 2],
            ["knee, measured / predicted", "0.8–1.2", farthest, 0.8 <= farthest <= 1.2],
            ["knee against exposure, log-log slope", "−1 ± 0.1", slope, abs(slope + 1) <= 0.1]]
