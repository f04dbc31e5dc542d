"""The metrics that are published for trackers of points (TAP-Vid, STIR) and of planes (POT), from distances in px; bench/ uses them, too.

A distance is infinite, and near nothing, where a homography takes its point through infinity. A share of nothing is None.
"""
import numpy as np

POINT_THRESHOLDS = (2.0, 4.0, 8.0, 16.0, 32.0)  # px of the image as it is; TAP-Vid scales it to 256 x 256, and has 1 to 16 px
STIR_THRESHOLDS = (4.0, 8.0, 16.0, 32.0, 64.0)  # px, of STIRMetrics
ALIGNMENT_LIMITS = (5.0, 15.0)  # px, of POT and WOFT
SQUARE = np.array([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)])  # of POT's homography discrepancy


def moved(g, points):
    """Where homographies (..., 3, 3), determinant 1, take points (n, 2): (..., n, 2), infinite where they go through infinity."""
    points = np.asarray(points, float)
    homogeneous = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ np.swapaxes(np.asarray(g, float), -1, -2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(homogeneous[..., 2:] > 0.0, homogeneous[..., :2] / homogeneous[..., 2:], np.inf)


def distances(points, truth):
    """Between points (..., 2), px."""
    with np.errstate(invalid="ignore"):
        distance = np.linalg.norm(np.asarray(points, float) - np.asarray(truth, float), axis=-1)
    return np.where(np.isnan(distance), np.inf, distance)


def share(part, whole):
    return float(part) / float(whole) if whole > 0 else None


def average_jaccard(distance, visible, claimed, thresholds=POINT_THRESHOLDS):
    """TAP-Vid's: points that are visible, claimed and nearer than the threshold, over the visible points and those that are claimed though
    they are not visible or not so near; mean over the thresholds."""
    distance, visible, claimed = np.broadcast_arrays(distance, np.asarray(visible, bool), np.asarray(claimed, bool))
    right = [visible & (distance < threshold) for threshold in thresholds]
    shares = [share((near & claimed).sum(), visible.sum() + (claimed & ~near).sum()) for near in right]
    return None if None in shares else float(np.mean(shares))


def average_accuracy(distance, visible, claimed=True, thresholds=POINT_THRESHOLDS):
    """TAP-Vid's: the share of visible points that are nearer than the threshold, whatever is claimed; mean over the thresholds. With
    `claimed`, a point that is not claimed counts as wrong."""
    distance, visible, claimed = np.broadcast_arrays(distance, np.asarray(visible, bool), np.asarray(claimed, bool))
    shares = [share((visible & claimed & (distance < threshold)).sum(), visible.sum()) for threshold in thresholds]
    return None if None in shares else float(np.mean(shares))


def alignment_error(corners, truth):
    """POT's: root mean square distance of the four points (..., 4, 2), px."""
    return np.sqrt(np.mean(distances(corners, truth) ** 2, axis=-1))


def within(errors, limit):
    """The share of errors up to the limit: precision of POT, accuracy of STIR."""
    errors = np.asarray(errors, float)
    return share((errors <= limit).sum(), errors.size)


def homography_discrepancy(g, truth):
    """POT's: how far truth g^-1 moves the corners of a square of side 2 about the origin, mean; infinite where it is not defined."""
    if not abs(np.linalg.det(g)) > 0.0:
        return np.inf
    between = np.asarray(truth, float) @ np.linalg.inv(g)
    return float(np.mean(distances(moved(between / np.cbrt(np.linalg.det(between)), SQUARE), SQUARE)))
