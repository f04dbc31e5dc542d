"""A report in Markdown with its plots beside it, and how numbers look in it."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402: the backend comes first
import numpy as np  # noqa: E402

LOST = 5.0  # px: wrong by this much at the worst corner, or more, is lost; saying otherwise is a lie


class Report:
    def __init__(self, folder):
        self.folder = folder
        self.lines = []

    def text(self, *lines):
        self.lines += [*lines, ""]

    def table(self, head, rows):
        self.lines += ["| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows]] + [""]

    def figure(self, figure, name, caption):
        figure.tight_layout()
        figure.savefig(self.folder / f"{name}.png", dpi=110)
        plt.close(figure)
        self.text(f"![{caption}]({name}.png)", caption)

    def write(self):
        (self.folder / "report.md").write_text("\n".join(self.lines))


def number(x, digits=3):
    return "-" if x is None or not np.isfinite(x) else f"{x:.{digits}f}"


def short(x):
    return "-" if x is None or not np.isfinite(x) else f"{x:.3g}"


def percent(part, whole, digits=1):
    return "-" if not whole > 0 else f"{100 * part / whole:.{digits}f} %"
