"""What a table of track_bag comes to: shares, episodes, times, and the states over time."""
import math
import pathlib
import statistics

from session.facts import Session, read_csv

MOST_CHANGES = 400  # of the states over time; where there are more, the shortest are joined with what was before


def quantile(values, share):
    """Nearest rank; None of no values."""
    finite = sorted(value for value in values if math.isfinite(value))
    return finite[max(math.ceil(share * len(finite)) - 1, 0)] if finite else None


def joined(changes, end, most=MOST_CHANGES):
    """At most so many (time, state)."""
    while len(changes) > most:
        lasts = [(changes[k + 1][0] if k + 1 < len(changes) else end) - changes[k][0] for k in range(len(changes))]
        bound = sorted(lasts[1:])[len(changes) - most - 1]
        kept = [changes[0]]
        kept += [change for change, last in zip(changes[1:], lasts[1:]) if last > bound and change[1] != kept[-1][1]]
        changes = kept
    return changes


def summarise(table):
    session = Session()
    read_csv(session, pathlib.Path(table), lambda stamp: None)
    times, states, visible, corner, processing = session.tracking.columns[:5]
    count, begin, end = len(times), session.begin, session.end
    episodes = session.episodes()
    lost = [((stop if stop is not None else end) - start, stop) for kind, start, stop, _ in episodes if kind == "lost"]
    tracked = [k for k in range(count) if states[k] == 1]
    return {
        "images": count, "begin": begin, "seconds": end - begin, "tracking_images": len(tracked),
        "tracking_share": len(tracked) / count,
        "covered": sum(kind == "covered" for kind, *_ in episodes), "lost": len(lost),
        "found": sum(stop is not None for _, stop in lost), "longest_lost": max((length for length, _ in lost), default=0.0),
        "lost_at_end": any(stop is None for _, stop in lost),
        "visible": statistics.fmean(visible[k] for k in tracked) if tracked else None,
        "corner_error": quantile([corner[k] for k in tracked], 0.5), "corner_error_99": quantile([corner[k] for k in tracked], 0.99),
        "ms": milli(quantile(processing, 0.5)), "ms_99": milli(quantile(processing, 0.99)),
        "changes": joined([(round(time - begin, 3), state) for time, state, _ in session.tracker.rows], end - begin),
    }


def of_joints(joints):
    """Of a line that was tracked in pieces."""
    return {"joints": len(joints), "cuts": sum("cut" in joint for joint in joints),
            "joint_px": max((joint["apart"] for joint in joints if "cut" not in joint), default=None)}


def milli(seconds):
    return None if seconds is None else round(1e3 * seconds, 3)
