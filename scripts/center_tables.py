"""Tables of the study of centres and axes of rotation (centers.csv) for docs/accuracy.md."""
import math

from accuracy_data import select

SCENES = ("ball", "ball_per_marker", "ball_both_moving", "ball_both_mirrored", "hinge")
BAR = 1.01  # our RMSE over the best baseline's, at most
BETTER_AT_DEG = 20  # where it must be below 1


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def figure(value, form=".3g"):
    return "–" if math.isnan(value) else format(value, form)


def verdict(row):
    """Whether our RMSE is at most 1 % above the best baseline's, at 99.9 %; at 20°: below it."""
    bar = 1 if row["range_deg"] == BETTER_AT_DEG else BAR
    if math.isnan(row["ratio_upper"]) or row["ratio_lower"] > bar:
        return "**no**"
    return "yes" if row["ratio_upper"] <= bar else "open"


def error_table(rows):
    """RMSE (median) of every method, a line a range; of our own the ratio to the best baseline."""
    methods = list(dict.fromkeys(row["method"] for row in rows))
    own = next(row["method"] for row in rows if not row["baseline"])
    body = []
    for value in sorted({row["range_deg"] for row in rows}):
        here = select(rows, range_deg=value)
        cells = [f"{value:g}°"]
        for method in methods:
            row = select(here, method=method)[0]
            cells.append(f"{figure(row['rmse'])} ({figure(row['median'])})")
        row = select(here, method=own)[0]
        cells += [f"{figure(row['ratio'], '.3f')} ({figure(row['ratio_lower'], '.3f')}–"
                  f"{figure(row['ratio_upper'], '.3f')})", verdict(row),
                  figure(row["nees_dof"], ".2f"), f"{row['trials']:.0f}"]
        body.append(cells)
    own_columns = ["ratio to the best other", "bar", "NEES/dof", "trials"]
    return markdown(["range"] + methods + own_columns, body)


def center_parts(rows):
    """The contents of the page's markers, by name."""
    parts = {}
    for scene in SCENES:
        of_scene = select(rows, scene=scene)
        for quantity in dict.fromkeys(row["quantity"] for row in of_scene):
            name = scene if quantity == "center_mm" else f"{scene}_{quantity}"
            parts[f"centers_{name}"] = error_table(select(of_scene, quantity=quantity))
    return parts


def failed_center_bars(rows):
    """What is not shown to hold at 99.9 %; our first method counts."""
    failed = []
    for row in rows:
        if not row["baseline"] and row["method"] == "stereomotion":
            if verdict(row) != "yes":
                failed.append(f"{row['scene']} {row['range_deg']:g}° {row['quantity']}: ratio "
                              f"{figure(row['ratio'], '.3f')}, at 99.9 % up to "
                              f"{figure(row['ratio_upper'], '.3f')}")
    return failed
