"""Regions of real films: where they are marked, their images, and track_bag over them. Of light.py, real.py and calibration.py."""
import csv
import dataclasses
import pathlib
import subprocess

import cv2
import numpy as np

TRACKING = 1
FILMS = (".mp4", ".avi", ".mkv", ".mov")
REGIONS = pathlib.Path(__file__).with_name("regions.csv")


@dataclasses.dataclass
class Region:
    film: pathlib.Path
    roi: tuple  # x, y, width, height, px
    first: int  # image in which it lies there

    @property
    def roi_text(self):
        return ",".join(str(v) for v in self.roi)

    @property
    def name(self):
        return f"{self.film.stem} {self.roi_text}"


def roi_of(text):
    values = tuple(int(v) for v in text.split(","))
    if len(values) != 4:
        raise SystemExit(f"region {text}: expected x,y,width,height")
    return values


def read_regions(table, folder, only=()):
    """The rows film,roi,from of a table whose films lie in the folder; `only`: those whose name contains one of these."""
    with open(table, encoding="utf-8") as lines:
        regions = [Region(folder / r["film"], roi_of(r["roi"]), int(r["from"] or 0)) for r in csv.DictReader(lines)]
    regions = [r for r in regions if not only or any(o in r.name for o in only)]
    for r in regions:
        if not r.film.exists():
            raise SystemExit(f"{r.film}: no such film; {table} names it")
    if not regions:
        raise SystemExit(f"{table}: no region{' called ' + ', '.join(only) if only else ''}")
    return regions


def write_regions(table, regions):
    """A table for read_regions."""
    with open(table, "w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(("film", "roi", "from"))
        writer.writerows((r.film.name, r.roi_text, r.first) for r in regions)


def random_regions(folder, seed, limit):
    """Regions that nobody chose, without end: each film of the folder in turn, from an image on that has `limit` images after it if the film
    is that long; sides from 40 px (or a sixth of the image, if that is more) to a half of the image, all ratios alike."""
    films = sorted(f for f in pathlib.Path(folder).iterdir() if f.suffix in FILMS)
    if not films:
        raise SystemExit(f"{folder}: no film ({', '.join(FILMS)})")
    sizes = [size_of(film) for film in films]
    draw = np.random.default_rng(seed)
    while True:
        for film, (width, height, count) in zip(films, sizes):
            shorter = min(width, height)
            w, h = (int(np.exp(draw.uniform(*np.log([max(40.0, shorter / 6), side / 2])))) for side in (width, height))
            x, y = int(draw.integers(width - w + 1)), int(draw.integers(height - h + 1))
            yield Region(film, (x, y, w, h), int(draw.integers(max(1, count - limit))))


def size_of(film):
    """Width and height, px, and the number of images."""
    source = cv2.VideoCapture(str(film))
    width, height, count = (int(source.get(p)) for p in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT, cv2.CAP_PROP_FRAME_COUNT))
    if width < 80 or height < 80 or count < 1:
        raise SystemExit(f"{film}: {count} images of {width} x {height} px, expected images of at least 80 x 80 px")
    return width, height, count


def rate_of(film):
    """Images per second."""
    rate = cv2.VideoCapture(str(film)).get(cv2.CAP_PROP_FPS)
    return rate if np.isfinite(rate) and rate > 0 else 25.0


def images(film, first=0, limit=None):
    source = cv2.VideoCapture(str(film))
    if not source.isOpened():
        raise SystemExit(f"{film} cannot be read")
    number = 0
    while limit is None or number < first + limit:
        ok, image = source.read()
        if not ok:
            return
        if number >= first:
            yield image
        number += 1


def write_images(pictures, folder):
    """Without a loss: a folder of images."""
    folder.mkdir()
    for k, image in enumerate(pictures):
        cv2.imwrite(str(folder / f"{k:05d}.bmp"), image)


@dataclasses.dataclass
class Track:
    tracking: np.ndarray      # per image
    homography: np.ndarray    # reference to the image, px
    corner_error: np.ndarray  # px, as claimed
    centre_error: np.ndarray
    visible: np.ndarray       # share of the region


class Refused(Exception):
    pass


def read_track(table):
    with open(table, encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    column = lambda name: np.array([float(r[name]) for r in rows])  # noqa: E731
    homography = np.stack([column(f"g{i}{j}") for i in range(3) for j in range(3)], -1).reshape(-1, 3, 3)
    return Track(column("state") == TRACKING, homography, column("corner_error"), column("centre_error"), column("visible_fraction"))


def track(program, source, roi, table, options=()):
    """Throws Refused, with what the program says, when it does not track."""
    run = subprocess.run([str(program), str(source), "--roi", ",".join(str(v) for v in roi), "--csv", str(table), *map(str, options)],
                         capture_output=True, text=True, check=False)
    if run.returncode:
        raise Refused(f"{pathlib.Path(program).name} ended with {run.returncode}: {run.stderr.strip()}")
    return read_track(table)


def corners(roi):
    """Centres of the corner pixels."""
    x, y, w, h = roi
    return np.array([[x, y], [x + w - 1, y], [x + w - 1, y + h - 1], [x, y + h - 1]], float)


def apart(a, b, points):
    """px, per image and point: how far apart the homographies `a` and `b` take it; infinite through infinity."""
    p = np.concatenate([points, np.ones((len(points), 1))], 1).T
    first, second = a @ p, b @ p
    with np.errstate(divide="ignore", invalid="ignore"):
        d = np.linalg.norm(first[..., :2, :] / first[..., 2:, :] - second[..., :2, :] / second[..., 2:, :], axis=-2)
    return np.where((first[..., 2, :] > 0) & (second[..., 2, :] > 0), d, np.inf)
