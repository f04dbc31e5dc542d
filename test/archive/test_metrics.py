"""The published metrics: worked out by hand, and properties that each must have."""
import math

import numpy as np
import pytest
from archive import layouts_pot, layouts_stir, layouts_surgt, metrics, metrics_surgt

IN_SIGHT = (True, False, [0, 0, 10, 10])
HIDDEN = (False, False, None)
DIFFICULT = (True, True, [0, 0, 10, 10])
ON, OFF = [0, 0, 10, 10], [500, 500, 10, 10]


def translation(x, y):
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])


def test_points_move_and_go_through_infinity():
    assert np.allclose(metrics.moved(2.5 * translation(3, 4), [(0, 0), (100, 50)]), [(3, 4), (103, 54)])
    through = np.array([[1, 0, 0], [0, 1, 0], [-0.01, 0, 1.0]])
    assert np.array_equal(metrics.distances(metrics.moved(through, [(0, 0), (100, 0), (200, 0)]), [(0, 0), (100, 0), (200, 0)]), [0, np.inf, np.inf])
    assert metrics.moved(np.stack([translation(1, 0), translation(2, 0)]), [(0, 0)]).tolist() == [[[1, 0]], [[2, 0]]]


@pytest.mark.parametrize("distance, visible, claimed, jaccard, accuracy, claimed_accuracy", [
    ([0.0, 1.99], [1, 1], [1, 1], 1, 1, 1),           # a perfect tracker
    ([10.0], [1], [1], 0.4, 0.4, 0.4),                # within 16 and 32 px of 2, 4, 8, 16, 32
    ([32.0], [1], [1], 0, 0, 0),                      # a point at the threshold is not within it
    ([0.0, 100.0], [1, 1], [1, 1], 1 / 3, 0.5, 0.5),  # 1 right of 2 visible ones and 1 wrong claim
    ([0.0, 0.0], [1, 0], [1, 1], 0.5, 1, 1),          # a claim of a hidden point is wrong wherever it is
    ([0.0, 0.0, 0.0, 0.0], [1, 0, 1, 0], [0, 0, 1, 1], 1 / 3, 1, 0.5),  # what is not claimed is missed, and not wrong
    ([np.inf, np.inf], [1, 1], [1, 1], 0, 0, 0),
    ([1.0], [0], [0], None, None, None)])
def test_jaccard_and_accuracy_of_points(distance, visible, claimed, jaccard, accuracy, claimed_accuracy):
    found = metrics.average_jaccard(distance, visible, claimed), metrics.average_accuracy(distance, visible), metrics.average_accuracy(distance, visible, claimed)
    assert found == tuple(None if v is None else pytest.approx(v) for v in (jaccard, accuracy, claimed_accuracy))


def test_alignment_error_and_precision():
    corners = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 50.0)])
    assert metrics.alignment_error(corners + (3, 4), corners) == pytest.approx(5.0)
    assert metrics.alignment_error(corners * (1.04, 1.0), corners) == pytest.approx(math.sqrt(8.0))  # two corners by 4 px, two stay
    assert metrics.alignment_error(np.full((4, 2), np.inf), corners) == np.inf
    assert metrics.within([1.0, 5.0, 5.01, 16.0, np.inf], 5.0) == 0.4  # the limit is within, as in POT's and STIR's tools
    assert metrics.within([], 5.0) is None


def test_homography_discrepancy():
    truth = np.array([[1.1, 0.02, 5.0], [0.01, 0.95, -3.0], [1e-5, 2e-5, 1.0]])
    assert metrics.homography_discrepancy(3.0 * truth, truth) == pytest.approx(0.0, abs=1e-9)  # whatever the scale
    assert metrics.homography_discrepancy(truth, translation(3, 4) @ truth) == pytest.approx(5.0)
    assert metrics.homography_discrepancy(np.zeros((3, 3)), truth) == np.inf


def test_overlap_of_boxes():
    assert metrics_surgt.overlap((0, 0, 2, 2), (5, 5, 2, 2)) == metrics_surgt.overlap((0, 0, 2, 2), (2, 2, 2, 2)) == 0.0
    assert metrics_surgt.overlap((5, 5, 10, 10), (5, 5, 10, 10)) == 1.0
    assert metrics_surgt.overlap((0, 0, 2, 2), (1, 1, 2, 2)) == pytest.approx(1 / 7)
    assert metrics_surgt.overlap((0, 0, 2, 2), (1, 0, 2, 2)) == pytest.approx(1 / 3)


def judged(truth, told):
    """`told`: a box or None for each image behind the first, of which the last one goes on."""
    told = dict(zip(range(1, len(truth)), told + [told[-1]] * len(truth)))
    return metrics_surgt.judge(truth, 0, {image: box for image, box in told.items() if box is not None})


def test_a_perfect_tracker_of_surgt():
    run = judged([IN_SIGHT] * 30, [ON])
    assert metrics_surgt.metrics([run]) == {"accuracy": 1.0, "robustness": 1.0, "error 2D [px]": 0.0, "starts": 1, "failures": 0}
    assert run["sequence"] == [1.0] * 29 and metrics_surgt.expected_average_overlap([[run["sequence"]]], (5, 20)) == 1.0


def test_a_tracker_that_is_off_by_a_known_shift():
    run = judged([IN_SIGHT] * 21, [[3, 4, 10, 10]])  # 7 x 6 px of 200 - 42
    found = metrics_surgt.metrics([run])
    assert found["accuracy"] == pytest.approx(42 / 158) and found["error 2D [px]"] == pytest.approx(5.0) and found["robustness"] == 1.0


def test_an_overlap_at_the_limit_is_a_miss():
    common = 20 / 1.1  # px², of two boxes of 100: common / (200 - common) = 0.1
    shift = 10 - common / 10
    assert metrics_surgt.overlap(ON, [shift, 0, 10, 10]) == pytest.approx(0.1)
    assert judged([IN_SIGHT] * 5, [[shift + 1e-9, 0, 10, 10]])["right"] == 0
    assert judged([IN_SIGHT] * 5, [[shift - 1e-3, 0, 10, 10]])["right"] == 4


def test_ten_misses_are_no_failure_and_eleven_are():
    survived = judged([IN_SIGHT] * 31, [ON] * 5 + [OFF] * 10 + [ON])
    assert survived["failed"] is None and (survived["right"], survived["seen"], survived["overlaps"]) == (20, 30, 30)
    assert metrics_surgt.metrics([survived])["accuracy"] == pytest.approx(20 / 30)
    failed = judged([IN_SIGHT] * 31, [ON] * 5 + [OFF] * 11 + [ON])
    assert failed["failed"] == 16  # the eleventh miss; what comes after is missed though it is right
    assert failed["sequence"] == [1.0] * 5 + [0.0] * 25
    found = metrics_surgt.metrics([failed])
    assert found["accuracy"] == 1.0 and found["robustness"] == pytest.approx(5 / 30) and found["failures"] == 1  # its misses do not lower accuracy


def test_no_answer_is_a_miss_that_no_overlap_is_counted_of():
    run = judged([IN_SIGHT] * 11, [ON] * 4 + [None] * 2 + [ON])
    assert (run["right"], run["seen"], run["overlaps"], run["failed"]) == (8, 10, 8, None)
    assert metrics_surgt.metrics([run])["accuracy"] == 1.0 and run["sequence"][4:6] == [0.0, 0.0]


def test_misses_go_on_over_images_that_do_not_count():
    truth = [IN_SIGHT] * 6 + [HIDDEN] * 3 + [DIFFICULT] * 3 + [IN_SIGHT] * 10
    assert judged(truth, [None])["failed"] == 17  # 5 before, 6 behind


def test_boxes_where_nothing_is_to_be_seen_lower_robustness():
    truth = [IN_SIGHT] * 11 + [HIDDEN] * 4 + [DIFFICULT] * 3 + [IN_SIGHT] * 6 + [HIDDEN] * 2
    run = judged(truth, [ON])
    assert (run["right"], run["seen"], run["excessive"]) == (16, 16, 6)
    assert metrics_surgt.metrics([run])["robustness"] == pytest.approx(16 / 22)
    assert run["sequence"] == [1.0] * 10 + [None] * 7 + [1.0] * 6  # until the last image that counts
    silent = judged(truth, [ON] * 10 + [None] * 7 + [ON] * 6 + [None])
    assert metrics_surgt.metrics([silent])["robustness"] == 1.0
    labelled = [(False, False, [0, 0, 10, 10]) if image == HIDDEN else image for image in truth]
    assert judged(labelled, [ON])["excessive"] == 0  # a box that is known though it is hidden


def test_starts_are_weighted_by_their_images():
    runs = [judged([IN_SIGHT] * 11, [ON]), judged([IN_SIGHT] * 31, [[0, 5, 10, 10]])]  # 10 images of 1, 30 of 1/3
    assert metrics_surgt.metrics(runs)["accuracy"] == pytest.approx((10 + 30 / 3) / 40)


def test_expected_average_overlap():
    """By hand: starts of a target are joined first, then targets, image by image; what does not count is left out."""
    eao = metrics_surgt.expected_average_overlap
    assert metrics_surgt.mean_sequence([[0.721, 0.5, 0.0, None], [0.0, 0.0, 0.0, 0.7215]]) == [0.3605, 0.25, 0.0, 0.7215]
    assert eao([[[1.0, 1.0, 1.0]]], (0, 3)) == 1.0 and eao([[[1.0, None, 1.0]]], (0, 3)) == 1.0
    assert eao([[[1.0]], [[0.0]]], (0, 1)) == 0.5
    # One target of three starts that are right, one of a single start that is wrong: each has half the weight.
    assert eao([[[1.0] * 4, [1.0] * 4, [1.0] * 4], [[0.0] * 4]], (0, 4)) == 0.5
    assert eao([[[1.0, 0.5, 0.0, 0.0]]], (1, 3)) == 0.25  # images 1 and 2
    assert eao([[[1.0, 1.0]]], (5, 9)) is None and eao([], (0, 0)) is None
    # Lengths 10, 10, 40: mean 20, deviation 14.1
    assert metrics_surgt.usual_lengths([[[1.0] * 10, [1.0] * 10], [[1.0] * 40]]) == (6, 34)


def test_surgt_over_all_cases():
    perfect, failing = [judged([IN_SIGHT] * 31, told) for told in ([ON], [ON] * 5 + [OFF])]
    rows = [(case, {"name": "SurgT lengths=0:30", "target": 0, **run}) for case, run in (("a", perfect), ("a", perfect), ("b", failing))]
    whole = layouts_surgt.of_all(rows)
    assert whole["expected average overlap"] == pytest.approx((5 * 1.0 + 25 * 0.5) / 30)
    assert whole["robustness"] == pytest.approx((30 + 30 + 5) / 90) and whole["accuracy"] == 1.0 and whole["failures"] == 1


def test_stir_by_hand():
    truth = layouts_stir.Truth((10, 10), [(13, 14), (100, 100)])  # 5 px away
    still = truth.score(None)
    assert still == {"name": "STIR", "distance": None, "claimed": False, "unmoved": 5.0}
    found = layouts_stir.of_case([{"distance": d, "claimed": c, "unmoved": 5.0} for d, c in ((0.0, True), (4.0, True), (10.0, False), (None, False))])
    assert [found[f"accuracy at {limit} px"] for limit in (4, 8, 16, 32, 64)] == [0.5, 0.5, 0.75, 0.75, 0.75]
    assert found["average accuracy, 4 to 64 px"] == pytest.approx(0.65) and found["average accuracy of no motion"] == pytest.approx(0.8)
    assert found["average accuracy, 2 to 32 px"] == pytest.approx((0.25 + 0.25 + 0.5 + 0.75 + 0.75) / 5)
    # Of 4 visible points: under 2 px one is right and one claim wrong, 1 / 5; likewise under 4 px; then 2 / 4
    assert found["average Jaccard, 2 to 32 px"] == pytest.approx((2 * 0.2 + 3 * 0.5) / 5)


def test_the_largest_upright_rectangle():
    assert layouts_pot.largest_rectangle(np.array([(10.0, 5.0), (50.0, 5.0), (50.0, 25.0), (10.0, 25.0)])) == (10, 5, 41, 21)
    assert layouts_pot.largest_rectangle(np.array([(0.0, 20.0), (20.0, 0.0), (40.0, 20.0), (20.0, 40.0)])) == (10, 10, 21, 21)  # half of the diamond
    assert layouts_pot.largest_rectangle(np.array([(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)])) is None
    rng = np.random.RandomState(3)
    for _ in range(50):
        quad = np.array([(0, 0), (100, 0), (100, 80), (0, 80)]) + rng.uniform(-30, 30, (4, 2))
        x, y, width, height = layouts_pot.largest_rectangle(quad)
        for corner in ((x, y), (x + width - 1, y), (x + width - 1, y + height - 1), (x, y + height - 1)):
            sides = [(b - a)[0] * (corner[1] - a[1]) - (b - a)[1] * (corner[0] - a[0]) for a, b in zip(quad, np.roll(quad, -1, axis=0))]
            assert min(sides) >= -1e-6, (quad, corner)


def test_pot_by_hand():
    found = layouts_pot.of_case([{"errors": [1.0, 5.0, 10.0, None], "discrepancies": [0.0, 10.0, 31.0, None], "claims": [True, True, False, False]}])
    assert found["precision at 5 px"] == 0.5 and found["precision at 15 px"] == 0.75
    assert found["claimed precision at 15 px"] == 0.5 and found["success at 10"] == 0.5 and found["success at 30"] == 0.5
    assert found["alignment error, median [px]"] == 7.5 and (found["images"], found["claimed"]) == (4, 2)
