"""What the layouts of data sets have in common: errors, lines of a manifest, and what a tracker said."""
import csv

import numpy as np

TRACKING = "1"  # state in the table of track_bag


class BadTruth(Exception):
    """What of a data set's files is wrong: all of it, each with the file, the value and what was expected."""

    def __init__(self, problems):
        super().__init__("; ".join(problems))
        self.problems = problems


def attempt(problems, read, *arguments):
    """What `read` returns. When it raises BadTruth, None, and what is wrong goes to the problems."""
    try:
        return read(*arguments)
    except BadTruth as error:
        problems += error.problems
        return None


def check_images(path, count, facts, problems):
    """The images that the truth is of, against what the recording says of itself, if it does."""
    images = int(facts["images"] or 0) if facts else 0
    if images and images != count:
        problems.append(f"{path} is of {count} images, the recording has {images}, expected as many")


def settings_of(benchmark, name, keys):
    """Values by key of a line's `benchmark`, "NAME key=value key=value"."""
    words = [word.partition("=") for word in benchmark.split()[1:]]
    settings = {key: value for key, _, value in words}
    if sorted(key for key, _, _ in words) != sorted(keys) or not all(settings.values()):
        raise BadTruth([f"benchmark is '{benchmark}', expected {' '.join([name, *(f'{key}=...' for key in keys)])}"])
    return settings


def start_text(frame, facts):
    """`start` of a line that begins with this image: half an image earlier, whatever the file rounds."""
    return f"{(frame - 0.5) / float(facts['rate']):.6f}" if frame else ""


def case_of(place, folder):
    """`case` of what lies there, seen from the folder that was searched."""
    name = place.relative_to(folder).as_posix()
    return place.name if name == "." else name


def square_about(point, side, size):
    """`roi` of a line: a square about the point, moved into the image, no larger than that."""
    side = min(side, *size)
    corner = [min(max(int(value) - side // 2, 0), length - side) for value, length in zip(point, size)]
    return f"{corner[0]},{corner[1]},{side},{side}"


class Tracked:
    """What the tracker said: for each image whether it tracks, and G."""

    def __init__(self, images):
        self.images = images

    @classmethod
    def read(cls, table):
        with open(table, encoding="utf-8", newline="") as file:
            return cls({int(row["frame"]): (row["state"] == TRACKING, np.array([float(row[f"g{i}{j}"]) for i in range(3) for j in range(3)]).reshape(3, 3))
                        for row in csv.DictReader(file)})

    def expect_start(self, frame):
        first = min(self.images)
        if first != frame:
            raise BadTruth([f"tracking began with image {first}, the truth begins with image {frame}, expected the same"])

    def last(self):
        """Whether it tracks, and G, in the last image."""
        return self.images[max(self.images)]
