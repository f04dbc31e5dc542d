"""What bench/ asks the published metrics about: the points of a region, and which of them can be seen."""
import json
import sys

import cv2
import numpy as np
import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "bench"))
from reporting import published  # noqa: E402: bench/ has to be found first

ROI = (10.0, 20.0, 28.0, 42.0)  # areas of 2 x 3 px, the first one's centres 10, 11 and 20 to 22


def shift(x, y):
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])


def test_points_are_the_centres_of_the_areas_row_by_row():
    points = published.region_points(ROI)
    assert points.shape == (196, 2) and [points[k].tolist() for k in (0, 1, 14, 195)] == [[10.5, 21.0], [12.5, 21.0], [10.5, 24.0], [36.5, 60.0]]
    assert published.corners(ROI).tolist() == [[10, 20], [37, 20], [37, 61], [10, 61]]


def test_visible_points_lie_in_the_image_and_in_areas_of_which_less_than_half_is_covered():
    points = np.array([(0.0, 0.0), (50.0, 10.0), (50.0, 10.0), (99.0, 49.0)])
    assert published.visible(points, 0.0, (100, 50)).tolist() == [True] * 4
    assert published.visible(points, [0.49, 0.5, 1.0, 0.0], (100, 50)).tolist() == [True, False, False, True]
    assert published.visible(points + (0.5, 0.0), 0.0, (100, 50)).tolist() == [True, True, True, False]
    assert published.visible(points - (0.0, 0.5), 0.0, (100, 50)).tolist() == [False, True, True, True]


def test_a_tracker_is_judged_by_the_folder_of_its_sequence(tmp_path):
    """Three images, moved by 10 px each; in the last one the region's left half is covered."""
    (tmp_path / "frames").mkdir()
    for image in range(3):
        cv2.imwrite(str(tmp_path / "frames" / f"{image:04d}.png"), np.zeros((100, 200, 3), np.uint8))
    (tmp_path / "scene.json").write_text(json.dumps({"roi": ROI}), encoding="utf-8")
    truth = [shift(10.0 * image, 0.0).ravel() for image in range(3)]
    (tmp_path / "truth.csv").write_text("names\n" + "".join(f"{k},{','.join(map(str, g))},0\n" for k, g in enumerate(truth)), encoding="utf-8")
    covered = [[0] * 196, [0] * 196, ([1] * 7 + [0] * 7) * 14]
    (tmp_path / "areas.csv").write_text("names\n" + "".join(f"{k},{','.join(map(str, row))}\n" for k, row in enumerate(covered)), encoding="utf-8")
    judge = published.Truth(tmp_path).judge
    perfect = judge({"g": np.concatenate(truth).tolist(), "claims": [1, 1, 1]})
    assert perfect["average_jaccard"] == pytest.approx(294 / 392)  # 98 points are claimed that are covered
    assert perfect["average_accuracy"] == perfect["precision_5"] == 1.0 and perfect["alignment_median"] == 0.0
    off = judge({"g": np.concatenate([truth[0], shift(13.0, 4.0).ravel(), [None] * 9]).tolist(), "claims": [1, 1, 0]})  # 5 px, and nothing
    assert off["average_accuracy"] == pytest.approx(196 / 294 * 3 / 5) and off["average_jaccard"] == pytest.approx((2 * 0 + 3 * 196 / 294) / 5)
    assert off["precision_5"] == off["precision_15"] == 0.5
