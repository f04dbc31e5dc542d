"""The results of a recording beside those that were computed from its images later."""
import numpy as np

TRACKING = 1


def newest_by_stamp(series):
    """Stamps that are known, rising, and the row of the newest result of each."""
    stamps = np.array(series.columns[6])
    known = np.flatnonzero(np.isfinite(stamps))
    last_first = known[::-1]
    values, first = np.unique(stamps[last_first], return_index=True)
    return values, last_first[first]


class Comparison:
    """Both are series as Session.tracking. Results belong together when their images have the same stamp."""

    def __init__(self, recorded, again):
        stamps, rows = newest_by_stamp(recorded)
        other_stamps, other_rows = newest_by_stamp(again)
        _, here, there = np.intersect1d(stamps, other_stamps, assume_unique=True, return_indices=True)
        a, b = np.array(recorded.columns)[:, rows[here]], np.array(again.columns)[:, other_rows[there]]
        tracked, tracked_again = a[1] == TRACKING, b[1] == TRACKING
        both = tracked & tracked_again
        self.images = len(here)
        self.only_recorded, self.only_again = int(np.sum(tracked & ~both)), int(np.sum(tracked_again & ~both))
        x, y = a[7:15:2, both] - b[7:15:2, both], a[8:15:2, both] - b[8:15:2, both]
        distances = np.hypot(x, y).max(axis=0) if np.any(both) else np.empty(0)
        # As rows for a diagram: time of the recording in s, distance of the worst corner in px.
        self.columns = [a[0, both], distances]

    def __len__(self):
        return len(self.columns[0])

    def percentiles(self):
        """Median, 95 %, 99 % and the largest distance, px; None when no image was tracked by both."""
        distances = self.columns[1][np.isfinite(self.columns[1])]
        return (*np.percentile(distances, (50, 95, 99)), distances.max()) if len(distances) else None
