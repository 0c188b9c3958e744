#!/usr/bin/env python3
"""Writes the figures of the accuracy study into the tables of docs/accuracy.md.

usage: scripts/accuracy_tables.py CSV_DIR docs/accuracy.md

What stands between `<!-- begin NAME -->` and `<!-- end NAME -->` is replaced; a table whose CSV file is
absent stays as it is. Prints the bars of the project that do not hold; the exit code is 0 all the same.
"""
import math
import re
import sys
from pathlib import Path

from accuracy_bars import bars, knee_slope, knees
from accuracy_data import METHODS, bias, read_rows, select, speed_slope
from center_tables import center_parts, failed_center_bars


def figure(value, form):
    return "–" if math.isnan(value) else format(value, form)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def ratio_cell(row):
    """Ratio to the bound, NEES/dof and share found, short."""
    if row["found_share"] < 0.001:
        return "none found"
    found = "" if row["found_share"] > 0.995 else f"; {100 * row['found_share']:.0f} % found"
    return f"{row['ratio']:.3f}; {figure(row['nees_dof'], '.2f')}{found}"


def grid_table(rows):
    grid = select(rows, sweep="grid", method="ml")
    snrs = sorted({row["snr_db"] for row in grid}, reverse=True)
    body = []
    for diameter in sorted({row["diameter_px"] for row in grid}):
        cells = [ratio_cell(select(grid, diameter_px=diameter, snr_db=snr)[0]) for snr in snrs]
        body.append([f"{diameter:g}"] + cells)
    return table(["diameter px"] + [f"{snr:g} dB" for snr in snrs], body)


def sweep_table(rows, key, label):
    """RMSE in 1/1000 px of all methods; for the own detectors NEES/dof; the bound."""
    body = []
    for value in dict.fromkeys(row[key] for row in rows):
        here = select(rows, **{key: value})
        cells = [f"{value:g}", f"{1e3 * here[0]['bound_px']:.1f}"]
        for row in here:
            if row["found_share"] < 0.001:
                cells.append("–")
                continue
            nees = "" if math.isnan(row["nees_dof"]) else f" ({row['nees_dof']:.2f})"
            missed = "" if row["found_share"] > 0.995 else f" [{100 * row['found_share']:.0f} %]"
            cells.append(f"{1e3 * row['rmse_px']:.1f}{nees}{missed}")
        body.append(cells)
    names = [METHODS[row["method"]][0] for row in select(rows, **{key: rows[0][key]})]
    return table([label, "bound"] + names, body)


def phase_table(rows):
    body = []
    for method in METHODS:
        own = [row for row in select(rows, sweep="phase", method=method) if row["found_share"] > 0]
        if not own:
            continue
        worst = max(own, key=bias)
        body.append([METHODS[method][0], f"{1e3 * bias(worst):.2f}",
                     f"{1e3 * worst['bias_sigma_px']:.2f}",
                     f"{1e3 * max(row['rmse_px'] for row in own):.1f}"])
    return table(["method", "largest bias, 1/1000 px", "its standard error",
                  "largest RMSE, 1/1000 px"], body)


def histogram_table(rows):
    body = []
    for method, (name, *_) in METHODS.items():
        own = select(rows, method=method)
        total = sum(row["balls"] for row in own)
        cells = [name, f"{total:.0f}"]
        for share in (0.5, 0.95, 0.999):
            below, edge = 0, math.nan
            for row in own:
                below += row["balls"]
                if total and below >= share * total:
                    edge = row["error_to_px"]
                    break
            cells.append(figure(edge, ".2g"))
        body.append(cells)
    return table(["method", "balls found", "50 % within px", "95 %", "99.9 %"], body)


def deviation_table(rows):
    levels = sorted({row["ball_level"] for row in rows}, reverse=True)
    body = []
    for speed in sorted({row["speed_mm_s"] for row in rows}):
        cells = [f"{speed:g}"]
        for level in levels:
            here = select(rows, speed_mm_s=speed, ball_level=level)
            medians = [1e3 * row["median_mm"] for row in here if row["measured"] > 0]
            measured = sum(row["measured"] for row in here)
            text = f"{min(medians):.0f}–{max(medians):.0f}" if medians else "–"
            cells.append(f"{text} ({measured:.0f})")
        body.append(cells)
    return table(["speed mm/s"] + [f"{100 * level:g} % of full scale" for level in levels], body)


def short_exposure_table(rows):
    body = []
    for exposure in sorted({row["exposure_ms"] for row in select(rows, series="constant_light")}):
        cell = select(rows, series="constant_light", exposure_ms=exposure)
        slope, sigma = speed_slope(cell)
        body.append([f"{exposure:g}"] + [f"{1e3 * row['rmse_along_mm']:.2f}" for row in cell] +
                    [f"{1e3 * cell[0]['bound_along_mm']:.2f}–{1e3 * cell[-1]['bound_along_mm']:.2f}",
                     f"{100 * slope:+.1f} ± {100 * sigma:.1f}"])
    speeds = sorted({row["speed_mm_s"] for row in select(rows, series="constant_light")})
    return table(["exposure ms"] + [f"{speed:g} mm/s" for speed in speeds] +
                 ["bound", "slope, % per 10 mm/s"], body)


def knee_table(rows):
    found = knees(rows)
    body = [[f"{exposure:g}", f"{knee['measured']:.0f} ± {knee['sigma']:.0f}",
             f"{knee['predicted']:.0f}", f"{knee['measured'] / knee['predicted']:.2f}"]
            for exposure, knee in found.items()]
    slope, sigma = knee_slope(found)
    text = (f"\n\nSlope of log knee against log exposure: {slope:.2f} ± {sigma:.2f} "
            "(−1: the knee moves as 1/exposure).")
    return table(["exposure ms", "knee, measured mm/s", "predicted", "ratio"], body) + text


def edge_table(rows, column, form):
    operators = list(dict.fromkeys(row["operator"] for row in rows))
    body = []
    for light, noise in dict.fromkeys((row["light_dn"], row["noise_dn"]) for row in rows):
        here = select(rows, light_dn=light, noise_dn=noise)
        body.append([f"{light:g}", f"{noise:g}"] +
                    [format(select(here, operator=name)[0][column], form) for name in operators])
    return table(["illumination DN", "noise σ DN"] + operators, body)


def bars_table(rows):
    return table(["what, method `ml`", "bar", "worst measured", "holds"],
                 [[name, bar, figure(value, ".4g"), "yes" if holds else "**no**"]
                  for name, bar, value, holds in rows])


def replace(text, name, content):
    pattern = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.S)
    if not pattern.search(text):
        sys.exit(f"accuracy_tables.py: no markers for '{name}'")
    return pattern.sub(lambda match: match[1] + "\n" + content + "\n\n" + match[2], text)


def load(folder, name):
    return read_rows(folder / name) if (folder / name).exists() else []


def main():
    folder, page = Path(sys.argv[1]), Path(sys.argv[2])
    text = page.read_text(encoding="utf-8")
    rows, exposure = load(folder, "accuracy.csv"), load(folder, "exposure.csv")
    parts = {}
    if rows:
        parts["grid"] = grid_table(rows)
        for sweep, key, label in (("snr", "snr_db", "SNR dB"), ("diameter", "diameter_px", "diameter px"),
                                  ("hidden", "hidden_fraction", "hidden share")):
            parts[sweep] = sweep_table(select(rows, sweep=sweep), key, label)
        parts["smear"] = sweep_table(select(rows, sweep="smear", snr_db=40), "smear_diameters",
                                     "smear, diameters")
        parts["phase"] = phase_table(rows)
        measured = bars(rows, exposure)
        fewest = {name: min(row["balls"] for row in rows if (row["sweep"] == "phase") == phase)
                  for name, phase in (("condition", False), ("phase", True))}
        parts["bars"] = bars_table(measured) + "\n\nThese tables: at least " + " and ".join(
            f"{count:.0f} balls a {name}" for name, count in fewest.items()) + "."
        for name, bar, value, holds in measured:
            if not holds:
                print(f"does not hold: {name}: {value:.4g}, bar {bar}")
    if exposure:
        parts["short_exposure"] = short_exposure_table(exposure)
        parts["knee"] = knee_table(exposure)
    makers = {"histogram": histogram_table, "deviation": deviation_table,
              "edge_snr": lambda edges: edge_table(edges, "snr_db", ".1f"),
              "edge_localisation": lambda edges: edge_table(edges, "rms_px", ".3f")}
    for name, make in makers.items():
        own = load(folder, name + ".csv")
        if own:
            parts[name] = make(own)
    centers = load(folder, "centers.csv")
    parts.update(center_parts(centers))
    for failed in failed_center_bars(centers):
        print(f"does not hold: {failed}")
    for name, content in parts.items():
        text = replace(text, name, content)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main()
