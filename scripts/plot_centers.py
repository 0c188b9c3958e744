"""Plots of the study of centres and axes of rotation (centers.csv)."""
from accuracy_data import select
from accuracy_figures import MARKERS, SERIES, panels, plain_ticks, save

TITLES = {
    ("ball", "center_mm"): "centre, the other segment rests",
    ("ball_both_moving", "center_mm"): "centre, both segments move",
    ("hinge", "axis_deg"): "axis of a hinge, direction",
    ("hinge", "axis_mm"): "axis of a hinge, place",
}


def draw_centers(rows, path):
    """RMSE of all methods against the range of motion; a panel a scene and quantity."""
    shown = [key for key in TITLES if select(rows, scene=key[0], quantity=key[1])]
    figure, axes = panels(len(shown), width=4 * len(shown))
    for axis, (scene, quantity) in zip(axes if len(shown) > 1 else [axes], shown):
        of_scene = select(rows, scene=scene, quantity=quantity)
        # Ours first: of one colour everywhere. Its variants, "stereomotion, …", lie on its line.
        shown_rows = [row for row in sorted(of_scene, key=lambda row: row["baseline"])
                      if not row["method"].startswith("stereomotion,")]
        for i, method in enumerate(dict.fromkeys(row["method"] for row in shown_rows)):
            own = select(of_scene, method=method)
            axis.plot([row["range_deg"] for row in own], [row["rmse"] for row in own],
                      color=SERIES[i % len(SERIES)], marker=MARKERS[i % len(SERIES)], markersize=4,
                      linestyle="--" if own[0]["baseline"] else "-", label=method)
        unit = "°" if quantity == "axis_deg" else "mm"
        axis.set(xscale="log", yscale="log", xlabel="range of motion [°]", ylabel=f"RMSE [{unit}]")
        axis.set_title(TITLES[scene, quantity], fontsize=9)
        plain_ticks(axis.xaxis, sorted({row["range_deg"] for row in of_scene}))
        axis.legend(fontsize=6.5, framealpha=0.6)
    save(figure, path)
