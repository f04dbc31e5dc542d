"""Nanoseconds per pixel of the inner loops, beside the limits of the machine."""
import json

from .document import number
from .measuring import Job


def jobs(a):
    program = a.programs / "bench_kernels"
    if not program.exists():  # Google Benchmark was not there
        return []
    seconds = 0.05 if a.quick else 0.5
    return [Job(a.out / "kernels.json", [program, "--benchmark_out=RESULT", "--benchmark_out_format=json",
                                         f"--benchmark_min_time={seconds}"], timed=True)]


def machine(report, runs):
    """Writes the machine's limits; returns multiply-adds per second, and bytes per second by kB touched."""
    def rates(name):
        return {int(n.split("/")[2]): b["bytes_per_second"] for n, b in runs.items() if n.startswith(f"machine/{name}")}

    triad, copy = rates("triad"), rates("copy")
    peak = max(b["flops_per_second"] for n, b in runs.items() if n.startswith("machine/multiply_add"))
    report.table(["machine", "value"], [["multiply-add, float", f"{peak / 1e9:.0f} Gflop/s"]] + [
        [f"copy / triad on {kb} kB", f"{copy[kb] / 1e9:.0f} / {triad[kb] / 1e9:.0f} GB/s"] for kb in sorted(triad)])
    return peak, triad


def limits(b, side, peak, triad):
    """What memory and arithmetic allow, and how near the kernel comes; empty for what has no count of its own."""
    if "bytes_per_px" not in b:
        return ["", "", ""]
    working_set = side ** 2 * b["bytes_per_px"] / 1024
    rate = triad[min((kb for kb in triad if kb >= working_set), default=max(triad))]
    memory, arithmetic = 1e9 * b["bytes_per_px"] / rate, 1e9 * b["flops_per_px"] / peak
    return [number(memory, 2), number(arithmetic, 2), f"{100 * max(memory, arithmetic) / b['ns_per_px']:.0f} %"]


def write(report, a):
    work = jobs(a)
    if not work:
        report.text("## Kernels", "Not measured: bench_kernels was not built, for want of Google Benchmark.")
        return
    runs = {b["name"]: b for b in json.loads(work[0].result.read_text())["benchmarks"]}
    report.text("## Kernels", "Processor time per pixel of the ROI, on one thread (for the pyramid: of the region it is built of), next to "
                "what the machine allows: the longer of moving the bytes at the speed of a triad on as much memory, and of doing the "
                "arithmetic in nothing but multiply-adds. Bytes and operations are counted from the source, once per patch that is read "
                "or written; divisions, roots and gathers count as one operation, so the limit is not to be reached.")
    peak, triad = machine(report, runs)
    rows = []
    for name, b in runs.items():
        if name.startswith("peer/remap_image/"):
            rows.append(["cv::remap, whole image", "x".join(name.split("/")[2:4]), number(b["ns_per_px"], 2), "", "", "",
                         number(b["cpu_time"] / 1e3, 2) + " ms"])
        if not name.startswith("kernel/"):
            continue
        _, kernel, side = name.split("/")
        rows.append([kernel, f"{side}²", number(b["ns_per_px"], 2), *limits(b, int(side), peak, triad),
                     number(b["cpu_time"] / 1e3, 2) + " ms" if kernel.startswith("track") else ""])
    report.table(["kernel", "ROI", "ns/px", "memory's limit", "arithmetic's limit", "of the limit", "per image"], rows)
