"""Reads the CSV files of the accuracy study; shared by plot_accuracy.py and accuracy_tables.py."""
import csv
import math

# Colours of Okabe & Ito (2008), told apart by colour-blind eyes; markers and dashes tell again.
METHODS = {
    "ml": ("ml", "#0072B2", "o", "-"),
    "wavelet": ("wavelet", "#009E73", "s", "-"),
    "centroid": ("centroid", "#E69F00", "^", "-"),
    "moments": ("thresholded moments", "#CC79A7", "v", "--"),
    "simple_blob": ("SimpleBlobDetector", "#D55E00", "D", "--"),
    "canny_ellipse": ("Canny + fitEllipse", "#56B4E9", "P", "--"),
    "hough": ("HoughCircles", "#777777", "X", "--"),
}
OWN = ("ml", "wavelet", "centroid")


def read_rows(path):
    """The rows as dictionaries; numbers where they are numbers, NaN for an empty cell."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number(text):
    if text == "":
        return math.nan
    try:
        return float(text)
    except ValueError:
        return text


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def bias(row):
    """Bias of a row [px]: the larger of both axes; where directions vary, that along them."""
    if row["smear_diameters"] > 0 or row["hidden_fraction"] > 0:
        return abs(row["bias_along_px"])
    return max(abs(row["bias_u_px"]), abs(row["bias_v_px"]))


def knee_smear_px(rows):
    """Smear at which the bound's variance along the motion is twice that without smear."""
    points = sorted((row["smear_px"], row["bound_along_mm"]) for row in rows)
    still = min(bound for _, bound in points)
    for (s0, b0), (s1, b1) in zip(points, points[1:]):
        if b1 >= math.sqrt(2) * still:
            return s0 + (math.sqrt(2) * still - b0) / (b1 - b0) * (s1 - s0)
    return math.nan


def bound_shape(rows):
    """The bound against smear as a function: bound / bound without smear."""
    points = sorted((row["smear_px"], row["bound_along_mm"]) for row in rows)
    still = min(bound for _, bound in points)

    def shape(smear_px):
        if smear_px <= points[0][0]:
            return points[0][1] / still
        for (s0, b0), (s1, b1) in zip(points, points[1:]):
            if smear_px <= s1:
                return (b0 + (b1 - b0) * (smear_px - s0) / (s1 - s0)) / still
        return points[-1][1] / still * smear_px / points[-1][0]

    return shape


def fit_knee(rows, all_rows):
    """Fits error = a · shape(s · k) to one exposure's rows, least squares of the logarithms.

    `shape` is the bound's; a and k are free. Returns the measured knee [mm/s], its standard error
    (each error of n repetitions is uncertain by 1/√2n), the predicted knee, and a [mm].
    """
    shape = bound_shape(all_rows)
    rows = [row for row in rows if not math.isnan(row["rmse_along_mm"])]
    per_speed = sum(row["smear_px"] / row["speed_mm_s"] for row in rows) / len(rows)
    predicted = knee_smear_px(all_rows) / per_speed

    def fit(k):
        logs = [math.log(row["rmse_along_mm"] / shape(k * row["smear_px"])) for row in rows]
        weights = [2 * (row["repetitions"] - row["lost"]) for row in rows]
        mean = sum(w * x for w, x in zip(weights, logs)) / sum(weights)
        return sum(w * (x - mean) ** 2 for w, x in zip(weights, logs)), mean

    grid = [math.exp(i / 200) for i in range(-280, 281)]  # k from 1/4 to 4
    costs = [fit(k)[0] for k in grid]
    best = min(range(len(grid)), key=lambda i: costs[i])
    inside = [k for k, cost in zip(grid, costs) if cost <= costs[best] + 1]
    sigma = math.log(inside[-1] / inside[0]) / 2 * predicted / grid[best]
    return {"measured": predicted / grid[best], "sigma": sigma, "predicted": predicted,
            "level": math.exp(fit(grid[best])[1])}


def line_fit(x, y, sigma):
    """Slope of a weighted straight line and its standard error."""
    weights = [1 / s**2 for s in sigma]
    total = sum(weights)
    x_mean = sum(w * a for w, a in zip(weights, x)) / total
    y_mean = sum(w * b for w, b in zip(weights, y)) / total
    spread = sum(w * (a - x_mean) ** 2 for w, a in zip(weights, x))
    slope = sum(w * (a - x_mean) * (b - y_mean) for w, a, b in zip(weights, x, y)) / spread
    return slope, 1 / math.sqrt(spread)


def speed_slope(rows):
    """Relative change of the error per 10 mm/s and its standard error, over rows of one exposure."""
    mean = sum(row["rmse_along_mm"] for row in rows) / len(rows)
    sigma = [1 / math.sqrt(2 * (row["repetitions"] - row["lost"])) for row in rows]
    return line_fit([row["speed_mm_s"] / 10 for row in rows],
                    [row["rmse_along_mm"] / mean for row in rows], sigma)
