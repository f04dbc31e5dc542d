#!/usr/bin/python3
"""Changes the light of a recording, tracks what comes of it, and compares that with the recording as it is.

  bench/light.py TRACK_BAG VIDEO x,y,w,h [--only NAME] [--judge PROGRAM] [--params FILE]

From image FROM on each pixel is gain * value + offset per channel, rounded and clipped, as a camera would. Prints a row per change:
  track     images that say TRACKING, of those that do so in the recording as it is
  first     the first of these that does not, - where there is none
  differ    px, how far the region's worst corner lies from where it is in the recording as it is: median, and the most
  wrong...  with --judge: what PROGRAM VIDEO CSV --roi x,y,w,h says, which prints its verdict as a line of JSON
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

import footage  # beside this file

FROM = 20   # image, where the change begins
LONG = 50   # images of a ramp, from start to end
JUDGED = ("wrong", "unsupported", "error_median")


def step(gain, offset=(0, 0, 0)):
    """Of blue, green, red, at once."""
    return lambda k: (np.array(gain, float), np.array(offset, float)) if k >= FROM else (np.ones(3), np.zeros(3))


def veil(share, colour=220):
    return step([1 - share] * 3, [share * colour] * 3)


def ramp(gains):
    """From each gain to the next one, all channels alike."""
    return lambda k: (np.full(3, np.interp(k - FROM, LONG * np.arange(len(gains)), gains)), np.zeros(3))


def rolling(share, colour=220):
    """A veil that comes and goes."""
    def light(k):
        now = share * 0.5 * (1 - np.cos(2 * np.pi * max(0, k - FROM) / LONG))
        return np.full(3, 1 - now), np.full(3, now * colour)
    return light


def flicker(amount):
    return lambda k: (np.full(3, 1.0 + (0 if k < FROM else amount if k % 2 else -amount)), np.zeros(3))


LIGHTS = {
    "warmer_10": step((0.9, 1.0, 1.1)), "colder_10": step((1.1, 1.0, 0.9)),
    "warmer_20": step((0.8, 1.0, 1.2)), "colder_20": step((1.2, 1.0, 0.8)), "green_20": step((1.2, 0.8, 1.0)),
    **{f"veil_{p}": veil(p / 100) for p in (10, 20, 33, 40, 50)}, "veil_grey_50": veil(0.5, 128), "veil_rolling_50": rolling(0.5),
    "flicker_10": flicker(0.10), "flicker_25": flicker(0.25),
    **{f"gain_{g}": step([g] * 3) for g in (0.5, 0.7, 1.4, 2.0)}, "ramp": ramp((1.0, 0.5, 2.0, 1.0)),
}


def strong_red(video, roi):
    """Of the whole recording, its first image too: nine tenths of the region have no red left to vary."""
    x, y, w, h = roi
    red = next(footage.images(video))[y:y + h, x:x + w, 2]
    gain = 255.0 / max(1.0, np.percentile(red, 10))
    return lambda k: (np.array([1.0, 1.0, gain]), np.zeros(3))


def changed(video, light):
    for k, image in enumerate(footage.images(video)):
        gain, offset = light(k)
        table = np.rint(gain * np.arange(256)[:, None] + offset).clip(0, 255).astype(np.uint8)
        yield cv2.LUT(image, table[:, None])


def row(name, base, now, roi, verdict):
    wanted = base.tracking
    kept = wanted & now.tracking
    missing = np.flatnonzero(wanted & ~now.tracking)
    apart = footage.apart(now.homography[kept], base.homography[kept], footage.corners(roi)).max(1)
    print(f"{name:16s} {kept.sum():4d}/{wanted.sum():<4d} {missing[0] if len(missing) else '-':>5} {np.median(apart):6.2f} {apart.max():6.2f}  "
          + "  ".join(f"{k} {verdict[k]}" for k in JUDGED if k in verdict), flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("track_bag", help="the program")
    p.add_argument("video", type=pathlib.Path)
    p.add_argument("roi", help="x,y,w,h in its first image")
    p.add_argument("--only", action="append", help="this change only; may be repeated")
    p.add_argument("--judge", help="program")
    p.add_argument("--params", help="as of track_bag")
    a = p.parse_args()
    roi = footage.roi_of(a.roi)
    params = ["--rate", footage.rate_of(a.video), *(["--params", a.params] if a.params else [])]
    lights = {"none": lambda k: (np.ones(3), np.zeros(3)), **LIGHTS, "strong_red": strong_red(a.video, roi)}
    unknown = set(a.only or ()) - set(lights)
    if unknown:
        p.error(f"no change {', '.join(unknown)}; there are {', '.join(lights)}")
    print(f"{'change':16s} {'track':>9s} {'first':>5s} {'differ':>6s} {'most':>6s}")
    base = None
    for name, light in lights.items():
        if base is not None and a.only and name not in a.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            frames, table = pathlib.Path(folder, "frames"), pathlib.Path(folder, "track.csv")
            footage.write_images(changed(a.video, light), frames)
            try:
                now = footage.track(a.track_bag, frames, roi, table, params)
            except footage.Refused as refused:
                sys.exit(f"light: {refused}")
            base = base or now
            verdict = {}
            if a.judge:
                judged = subprocess.run([a.judge, str(frames), str(table), "--roi", a.roi], capture_output=True, text=True)
                verdict = json.loads(judged.stdout.splitlines()[-1]) if judged.returncode == 0 else {}
            row(name, base, now, roi, verdict)


if __name__ == "__main__":
    main()
