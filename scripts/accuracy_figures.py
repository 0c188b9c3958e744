"""What the plots of the accuracy study have in common."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402

SERIES = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#777777", "#000000"]
MARKERS = "os^vDPX*"


def save(figure, path):
    figure.savefig(path, dpi=100, pil_kwargs={"optimize": True})
    plt.close(figure)
    print(path)


def panels(count, width=9.6, height=4.2):
    figure, axes = plt.subplots(1, count, figsize=(width, height), constrained_layout=True)
    for axis in (axes if count > 1 else [axes]):
        axis.grid(alpha=0.3)
    return figure, axes


def plain_ticks(axis, ticks):
    """Numbers as they are read, on a logarithmic axis of less than two decades."""
    low, high = axis.get_view_interval()
    shown = [tick for tick in ticks if low <= tick <= high]
    axis.set_ticks(shown, [f"{tick:g}" for tick in shown])
    axis.set_minor_locator(matplotlib.ticker.NullLocator())
