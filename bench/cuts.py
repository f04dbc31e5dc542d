#!/usr/bin/env python3
"""What describe_recording --cuts finds: of films that are made with known cuts, of what is easily taken for a cut, and of films as they are.

  bench/cuts.py --data FOLDER --films 6 --seed 1

FOLDER has the films of regions.csv. Needs ffmpeg. Films are made of 2 to 4 s of other films, 320 x 256, drawn by lot, H.264 at 25 Hz:

  other film      hard cuts between shots of different films
  same film       hard cuts to a shot of the same film, 2 s and more away, later or earlier: often the same place
  mixture         hard cuts with one image that is half of both, as a change of the rate leaves it
  dark            0.2 to 2 s of black between shots; fade: within 0.4 s to black and out of it
  dissolve        one shot over 0.4 s into the other
  none            without a cut: jerks of a camera over a still picture, blurred by the exposure; flashes of 1 to 8 images; smoke that hides up
                  to all; a shaft that crosses, up to half as wide as the image; all drawn into or from the films

Precision is the share of the cuts told that are cuts, recall that of the cuts that are told, within two images. Of the films as they are, each
cut that is told is printed, to be looked at; --pictures writes the image before and that behind it. Processor s: of describe_recording alone.
"""
import argparse
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
from archive import programs  # noqa: E402: what is in the package has to be found first

RATE, SIZE = 25.0, (320, 256)
SHOTS = 8  # of a film
NONE = ("jerks", "flashes", "smoke", "shaft")
KINDS = ("other film", "same film", "mixture", "dark", "fade", "dissolve")
NEAR = 2.0 / RATE  # s


def read(film, start, count):
    """Images from `start` on, as large as those of the films that are made."""
    video = cv2.VideoCapture(str(film))
    video.set(cv2.CAP_PROP_POS_FRAMES, start)
    images = []
    while len(images) < count:
        more, image = video.read()
        if not more:
            break
        scale = max(SIZE[0] / image.shape[1], SIZE[1] / image.shape[0])
        image = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC)
        y, x = (image.shape[0] - SIZE[1]) // 2, (image.shape[1] - SIZE[0]) // 2
        images.append(np.ascontiguousarray(image[y:y + SIZE[1], x:x + SIZE[0]]))
    return images


def mixed(a, b, share):
    return cv2.addWeighted(a, 1.0 - share, b, share, 0.0)


def between(kind, old, new, random):
    """What is between two shots, by its kind; of a dissolve and a fade the ends of the shots are used up."""
    black = np.zeros_like(old[0])
    if kind == "mixture":
        return [mixed(old[-1], new[0], 0.5)]
    if kind == "dark":
        return [black] * random.randint(5, 50)
    if kind == "fade":
        out = [mixed(old.pop(-10 + k), black, (k + 1) / 10) for k in range(10)]
        return out + [mixed(black, new.pop(0), (k + 1) / 10) for k in range(10)]
    if kind == "dissolve":
        return [mixed(old.pop(-10 + k), new.pop(0), (k + 1) / 11) for k in range(10)]
    return []


class Films:
    def __init__(self, data, random):
        self.random = random
        self.lengths = {path: int(cv2.VideoCapture(str(path)).get(cv2.CAP_PROP_FRAME_COUNT)) for path in sorted(data.glob("*.mp4"))}

    def shot(self, film=None, away_from=None):
        """Film, first image, images."""
        while True:
            chosen = film or self.random.choice(list(self.lengths))
            count = self.random.randint(50, 101)
            first = self.random.randint(0, max(self.lengths[chosen] - count, 1))
            if away_from is None or chosen != away_from[0] or not away_from[1] - 50 - count < first < away_from[1] + len(away_from[2]) + 50:
                images = read(chosen, first, count)
                if len(images) >= 30:
                    return chosen, first, images

    def edited(self, kind):
        """Images and the times of the cuts, as (end of a scene, beginning of the next)."""
        shots = [self.shot()]
        while len(shots) < SHOTS:
            if kind == "same film":
                film = shots[-1][0] if self.lengths[shots[-1][0]] > 400 else None
                shot = self.shot(film, shots[-1])
            else:
                shot = self.shot()
                if shot[0] == shots[-1][0]:
                    continue
            shots.append(shot)
        images, cuts = shots[0][2], []
        for _, _, new in shots[1:]:
            extra = between(kind, images, new, self.random)
            cuts.append((len(images) / RATE, (len(images) + len(extra)) / RATE))
            images += extra + new
        return images, cuts

    def jerks(self):
        still = cv2.resize(self.shot()[2][0], None, fx=3.0, fy=3.0, interpolation=cv2.INTER_CUBIC)
        place, images = np.array([SIZE[0], SIZE[1]], float), []
        for _ in range(12):
            angle, most, length = self.random.uniform(0, 2 * np.pi), self.random.uniform(0.02, 0.35) * SIZE[0], self.random.randint(4, 15)
            for k in range(length + self.random.randint(5, 25)):
                speed = most * np.clip(min((k + 1) / 3.0, (length - k) / 3.0), 0.0, 1.0) * np.array([np.cos(angle), np.sin(angle)])
                parts = [np.clip(place + speed * part / 8.0, 0, np.array(SIZE) * 2 - 1) for part in range(8)]
                images.append(np.mean([cv2.getRectSubPix(still, SIZE, tuple(map(float, p + np.array(SIZE) / 2))) for p in (parts if speed.any() else parts[:1])],
                                      axis=0).astype(np.uint8))
                place = np.clip(place + speed, 0, np.array(SIZE) * 2 - 1)
        return images

    def flashes(self):
        images = self.shot()[2]
        for first in range(20, len(images) - 12, 25):
            for k in range(first, first + self.random.randint(1, 9)):
                images[k] = cv2.convertScaleAbs(images[k], alpha=self.random.uniform(2, 5), beta=80)
        return images

    def smoke(self):
        images = self.shot()[2]
        rise, most = self.random.randint(5, 30), self.random.uniform(0.7, 1.0)
        for k in range(15, len(images)):
            veil = most * min((k - 14) / rise, (len(images) - k) / 15, 1.0)
            images[k] = mixed(images[k], np.full_like(images[k], 205), veil)
        return images

    def shaft(self):
        images = self.shot()[2]
        speed, width, lean = self.random.uniform(0.03, 0.4) * SIZE[0], int(self.random.uniform(0.15, 0.5) * SIZE[0]), self.random.randint(-100, 100)
        for k in range(10, len(images)):
            x = int((speed * (k - 10)) % (4 * SIZE[0])) - width
            for begin, end, colour in ((0.0, 1.0, (75, 75, 80)), (0.2, 0.3, (190, 190, 195)), (0.8, 0.9, (35, 35, 35))):
                corners = [(x + begin * width, 0), (x + end * width, 0), (x + end * width + lean, SIZE[1]), (x + begin * width + lean, SIZE[1])]
                cv2.fillPoly(images[k], [np.array(corners, np.int32)], colour, cv2.LINE_AA)
        return images


def write(path, images):
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "bgr24", "-s", f"{SIZE[0]}x{SIZE[1]}", "-r", str(RATE), "-i", "-",
               "-c:v", "libx264", "-preset", "veryfast", "-crf", "23", "-pix_fmt", "yuv420p", path]
    with subprocess.Popen(list(map(str, command)), stdin=subprocess.PIPE) as encoder:
        for image in images:
            encoder.stdin.write(image.tobytes())
        encoder.stdin.close()
    return path


def found_in(path):
    """Cuts as (end, beginning) in s; images, Hz, processor s."""
    process = subprocess.Popen([programs.program("describe_recording"), str(path), "--cuts"], stdout=subprocess.PIPE)
    told = json.loads(process.stdout.read())
    usage = os.wait4(process.pid, 0)[2]
    process.returncode = 0
    scenes = told["scenes"]
    return [(a["end"], b["start"]) for a, b in zip(scenes, scenes[1:])], told, usage.ru_utime + usage.ru_stime


def compare(found, cuts):
    """Cuts told that are cuts, cuts that are told."""
    near = [[abs(f[0] - c[0]) <= NEAR + 1e-6 or abs(f[1] - c[1]) <= NEAR + 1e-6 or c[0] <= f[0] <= c[1] for c in cuts] for f in found]
    return sum(map(any, near)), sum(any(row[k] for row in near) for k in range(len(cuts)))


def look_at(path, cuts, rate, folder):
    for k, cut in enumerate(cuts):
        video = cv2.VideoCapture(str(path))
        pair = []
        for time in (cut[0] - 0.5 / rate, cut[1] + 0.5 / rate):
            video.set(cv2.CAP_PROP_POS_FRAMES, round(time * rate))
            pair.append(video.read()[1])
        if all(image is not None for image in pair):
            cv2.imwrite(str(folder / f"{path.stem}_{k}.png"), np.hstack(pair))


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=pathlib.Path, required=True, help="folder with films")
    p.add_argument("--films", type=int, default=6, help="of each kind")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--kinds", default=",".join((*KINDS, *NONE)), help="which of them are made")
    p.add_argument("--pictures", type=pathlib.Path, help="folder for what is told of the films as they are")
    a = p.parse_args()
    films = Films(a.data, np.random.RandomState(a.seed))
    with tempfile.TemporaryDirectory(prefix="cuts_") as folder:
        path = pathlib.Path(folder) / "film.mp4"
        total = collections.Counter()
        for kind in filter(a.kinds.split(",").__contains__, KINDS):
            count = collections.Counter()
            for _ in range(a.films):
                images, cuts = films.edited(kind)
                found, _, _ = found_in(write(path, images))
                right, told = compare(found, cuts)
                count.update(cuts=len(cuts), found=len(found), right=right, told=told, images=len(images))
            print(f"{kind:>12}: {count['cuts']} cuts in {count['images']} images, {count['told']} told; {count['found'] - count['right']} told that are none", flush=True)
            total.update(count)
        for kind in filter(a.kinds.split(",").__contains__, NONE):
            count = collections.Counter()
            for _ in range(a.films):
                images = getattr(films, kind)()
                count.update(found=len(found_in(write(path, images))[0]), images=len(images))
            print(f"{kind:>12}: {count['found']} told in {count['images']} images without a cut", flush=True)
            total.update(count)
    print(f"all: precision {total['right']}/{total['found']}, recall {total['told']}/{total['cuts']}")
    for path in films.lengths:
        found, told, used = found_in(path)
        seconds = told["images"] / told["rate"]
        print(f"{path.name}: {told['width']}x{told['height']}, {told['images']} images; {1e3 * used / told['images']:.1f} ms of processor time an image, "
              f"{3600 * used / seconds:.0f} s an hour; cuts told: " + (", ".join(f"{first:.2f} s" for _, first in found) or "none"), flush=True)
        if a.pictures:
            look_at(path, found, told["rate"], a.pictures)


if __name__ == "__main__":
    main()
