"""What jobs are given, and what an archive is said to cost."""
import re

import pytest
from archive import cost
from conftest import call

ROW = {"width": "1920", "height": "1080", "images": "180000", "pieces": "1"}


def test_longer_and_larger_recordings_are_given_more():
    for larger in ({"images": "360000"}, {"width": "3840"}):
        assert cost.minutes({**ROW, **larger}) > cost.minutes(ROW) and cost.megabytes({**ROW, **larger}) >= cost.megabytes(ROW)
    assert cost.minutes({**ROW, "images": "0"}) > cost.minutes(ROW), "a length that is not known is taken for long"


def test_a_piece_is_given_less_than_the_whole_but_its_decoding():
    pieces = {**ROW, "pieces": "12"}
    assert cost.minutes(pieces) < cost.minutes_of_piece(pieces) < cost.minutes(ROW)
    assert cost.minutes_of_piece(pieces) > cost.given(cost.decoding(ROW))


def test_more_cores_are_faster_until_reading_is_the_limit():
    said = call("archive/cost.py", "1000", "1920x1080", "25", "--cores", "2,4,100000", "--megabits", "8", "--storage", "100")
    assert "9e+07 images, 3600 GB; read at 100 MB/s in 10.0 h" in said
    two, four, many = (float(hours) for hours in re.findall(r"cores: ([\d.]+) h", said)[:3])
    assert two == pytest.approx(2 * four, abs=0.1) and many == 10.0 and said.count("as long as reading takes") == 2


@pytest.mark.parametrize("arguments", [("0", "1920x1080", "25"), ("1", "1920", "25"), ("1", "1920x1080", "fast"), ("1", "1920x1080", "25", "--cores", "2,"),
                                       ("1", "1920x1080", "25", "--storage", "inf")])
def test_numbers_that_are_none_are_refused(arguments):
    assert "expected" in call("archive/cost.py", *arguments, status=2)
