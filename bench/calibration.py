#!/usr/bin/python3
"""What the tracker's claims of its own error are worth: `corner_error` and `centre_error` beside what is measured.

  bench/calibration.py TRACK_BAG [--sequence FOLDER]... [--data FOLDER] [options]

On sequences with ground truth (see README.md) what is measured is the error of the worst corner and of the region's centre. On films, whose truth
is not known, each region of regions.csv is measured twice, and what is measured is how far the two are apart:
  noise_1    as it is, and with normal noise of one grey level in each channel of each image
  noise_3    the same with three grey levels
  encoding   encoded anew by ffmpeg as H.264 (crf 23), and as MPEG-4 part 2 (quantiser 5)
  start      from the first image, and from the 25th on
  backward   from the first image, and from the last image that is TRACKING half of the region back to the first one
For the last two the region that is tracked the second time is the largest upright rectangle about the first one's centre that lies inside it, and
what is compared is where both take its corners from the image of the second start on. The claim on a difference is the root of the
sum of squares of the claims that it comes of: two, or three with that of the image of the second start. Images count where both say TRACKING.
A row per sequence, or region and way, for the worst corner and then for the centre:
  images   that count
  claim    px, root mean square
  rms      px, the same of what is measured
  ratio    root mean square of measured over claimed: 1 where the claims are true, more where they are too sure
  most     of an image
"""
import argparse
import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import tempfile

import cv2
import numpy as np

import footage  # beside this file

WAYS = ("noise_1", "noise_3", "encoding", "start", "backward")
OTHER_START = 25   # image
SMALLEST = 40      # px, of a region that is tracked
HALF = 0.5         # of the region is visible, where a second track starts
ENCODERS = {"h264": ("mp4", ["-c:v", "libx264", "-crf", "23", "-pix_fmt", "yuv420p"]), "mpeg4": ("avi", ["-c:v", "mpeg4", "-q:v", "5"])}


def noisy(pictures, sigma, seed=1):
    random = np.random.default_rng(seed)
    for image in pictures:
        yield np.rint(image + sigma * random.standard_normal(image.shape, np.float32)).clip(0, 255).astype(np.uint8)


def encode(pictures, rate, options, file):
    if not shutil.which("ffmpeg"):
        raise footage.Refused("ffmpeg is not installed")
    height, width = pictures[0].shape[:2]
    with subprocess.Popen(["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "bgr24", "-s", f"{width}x{height}", "-r", str(rate), "-i", "-",
                           *options, str(file)], stdin=subprocess.PIPE) as encoder:
        for image in pictures:
            encoder.stdin.write(image.tobytes())
    if encoder.returncode:
        raise SystemExit(f"ffmpeg ended with {encoder.returncode}")


def inside(homography, roi, image_shape):
    """The largest upright rectangle of whole pixels, shaped as the region is seen, about its centre and inside it; None where that is too small."""
    quad = cv2.perspectiveTransform(footage.corners(roi)[:, None], homography)[:, 0]
    centre, half = quad.mean(0), (quad.max(0) - quad.min(0)) / 2
    for factor in np.arange(1, 0.3, -0.02):
        low, high = np.ceil(centre - factor * half), np.floor(centre + factor * half)
        x, y, w, h = (int(v) for v in (*low, *(high - low + 1)))
        points = footage.corners((x, y, w, h))
        if min(w, h) < SMALLEST:
            return None
        if min(x, y) >= 0 and x + w <= image_shape[1] and y + h <= image_shape[0] and \
           all(cv2.pointPolygonTest(quad.astype(np.float32), (float(px), float(py)), True) >= -0.5 for px, py in points):
            return x, y, w, h
    return None


def samples(first, second, roi, *more_claims):
    """What is measured and what is claimed, of the images that count. `first` and `second`: (homographies, Track) that take the same points of `roi`
    to the same images; `more_claims`: pairs of corner_error and centre_error that both differ by."""
    (g, a), (h, b) = first, second
    points = footage.corners(roi)
    both = a.tracking & b.tracking
    result = {"images": int(both.sum())}
    for what, at in (("corner", points), ("centre", points.mean(0)[None])):
        claims = [getattr(t, what + "_error") for t in (a, b)] + [np.full(len(g), c[what == "centre"]) for c in more_claims]
        claimed = np.sqrt(sum(c ** 2 for c in claims))[both]
        measured = footage.apart(g, h, at).max(1)[both]
        sure = claimed > 0  # what has just been selected claims nothing
        result[what] = {"claimed": claimed[sure].tolist(), "measured": measured[sure].tolist()}
    return result


def part(track, numbers):
    return footage.Track(*(getattr(track, f)[numbers] for f in track.__dataclass_fields__))


def sequence_samples(program, folder, workspace):
    scene = json.loads((folder / "scene.json").read_text())
    table = np.genfromtxt(folder / "truth.csv", delimiter=",", names=True)
    truth = np.stack([table[f"g{i}{j}"] for i in range(3) for j in range(3)], -1).reshape(-1, 3, 3)
    track = footage.track(program, folder / "frames", scene["roi"], workspace / "track.csv")
    sure = footage.Track(np.ones(len(truth), bool), truth, np.zeros(len(truth)), np.zeros(len(truth)), np.ones(len(truth)))
    later = slice(1, None)  # the first image is the reference
    return samples((track.homography[later], part(track, later)), (truth[later], part(sure, later)), scene["roi"])


class Film:
    """A region's images as they are tracked in every way but one."""

    def __init__(self, program, region, limit, workspace):
        self.program, self.roi, self.workspace = program, region.roi, workspace
        self.rate = footage.rate_of(region.film)
        self.images = list(footage.images(region.film, region.first, limit))
        self.base = self.track_images(self.images, region.roi)

    def track_images(self, pictures, roi):
        folder = self.workspace / "images"
        footage.write_images(pictures, folder)
        try:
            return footage.track(self.program, folder, roi, self.workspace / "track.csv", ["--rate", self.rate])
        finally:
            shutil.rmtree(folder)

    def noise(self, sigma):
        other = self.track_images(noisy(self.images, sigma), self.roi)
        return samples((self.base.homography, self.base), (other.homography, other), self.roi)

    def encoding(self):
        tracks = []
        for name, (ending, options) in ENCODERS.items():
            file = self.workspace / f"{name}.{ending}"
            encode(self.images, self.rate, options, file)
            tracks.append(footage.track(self.program, file, self.roi, self.workspace / "track.csv"))
        n = min(len(t.tracking) for t in tracks)
        return samples(*((t.homography[:n], part(t, slice(n))) for t in tracks), self.roi)

    def from_image(self, at, numbers):
        """A second track from image `at` on, through the images of these numbers."""
        roi = inside(self.base.homography[at], self.roi, self.images[0].shape)
        if roi is None:
            raise footage.Refused(f"less than {SMALLEST} px of the region in image {at}")
        second = self.track_images((self.images[k] for k in numbers), roi)
        relative = self.base.homography[numbers] @ np.linalg.inv(self.base.homography[at])
        later = slice(1, None)
        return samples((relative[later], part(part(self.base, numbers), later)), (second.homography[later], part(second, later)), roi,
                       (self.base.corner_error[at], self.base.centre_error[at]))

    def clear(self):
        """Images in which a second track may start; the first is one of them."""
        return np.flatnonzero(self.base.tracking & (self.base.visible > HALF))

    def start(self):
        tracked = [k for k in self.clear() if k >= OTHER_START]
        if not tracked:
            raise footage.Refused(f"not TRACKING half of the region from image {OTHER_START} on")
        return self.from_image(tracked[0], np.arange(tracked[0], len(self.images)))

    def backward(self):
        last = self.clear()[-1]
        return self.from_image(last, np.arange(last, -1, -1))


def film_samples(a, region):
    results = []
    with tempfile.TemporaryDirectory() as folder:
        film = Film(a.track_bag, region, a.limit, pathlib.Path(folder))
        ways = {"noise_1": lambda: film.noise(1), "noise_3": lambda: film.noise(3), "encoding": film.encoding, "start": film.start, "backward": film.backward}
        for way in a.way or WAYS:
            try:
                result = ways[way]()
            except footage.Refused as refused:
                result = {"images": 0, "refused": str(refused)}
            results.append({"name": region.name, "way": way, **result})
    return results


def ratios(values):
    """Claim and measurement, root mean square; of their ratios the root mean square and the largest."""
    claimed, measured = np.array(values["claimed"]), np.array(values["measured"])
    if not len(claimed):
        return (np.nan,) * 4
    root = lambda v: float(np.sqrt(np.mean(v ** 2)))  # noqa: E731
    return root(claimed), root(measured), root(measured / claimed), float((measured / claimed).max())


def show(row):
    text = f"{row['name']:44s} {row['way']:9s} {row['images']:6d}"
    for what in ("corner", "centre"):
        if what in row:
            claim, rms, ratio, most = ratios(row[what])
            text += f"   {claim:6.3f} {rms:6.3f} {ratio:6.2f} {most:6.2f}"
    print(text + "  " + row.get("refused", ""), flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("track_bag", type=pathlib.Path, help="the program")
    p.add_argument("--sequence", action="append", type=pathlib.Path, default=[], help="folder with ground truth; may be repeated")
    p.add_argument("--data", type=pathlib.Path, help="folder of the films")
    p.add_argument("--regions", type=pathlib.Path, default=footage.REGIONS, help="table film,roi,from")
    p.add_argument("--only", action="append", default=[], help="regions whose name contains this; may be repeated")
    p.add_argument("--way", action="append", choices=WAYS, help="this one only; may be repeated")
    p.add_argument("--limit", type=int, default=250, help="so many images of each film")
    p.add_argument("--jobs", type=int, default=1, help="films at once")
    p.add_argument("--json", type=pathlib.Path, help="write everything there")
    a = p.parse_args()
    print(f"{'':44s} {'':9s} {'images':>6s}" + 2 * f"   {'claim':>6s} {'rms':>6s} {'ratio':>6s} {'most':>6s}", flush=True)
    rows = []
    for folder in a.sequence:
        with tempfile.TemporaryDirectory() as workspace:
            rows.append({"name": folder.name.rsplit("-", 1)[0], "way": "truth", **sequence_samples(a.track_bag, folder, pathlib.Path(workspace))})
        show(rows[-1])
    if a.data:
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for results in pool.map(lambda r: film_samples(a, r), footage.read_regions(a.regions, a.data, a.only)):
                rows += results
                for row in results:
                    show(row)
    if a.json:
        a.json.write_text(json.dumps(rows))


if __name__ == "__main__":
    main()
